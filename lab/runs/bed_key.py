"""What a settled bed follows from, as a hash by which it is found again."""

import hashlib
import platform
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path

import numpy as np

from solvers.grains.shapes.given import Shapes
from solvers.machine.marks import EachWorld, NotOfBed, marked
from solvers.simulation import Simulation

FORMAT = "cargo-shift-lab bed 2"


def bed_key(simulation: Simulation, world: int, position: np.ndarray, how: object) -> str:
    """Hash of all that determines the bed of one world: scene, start (n, 2) m, settling, and the solver's code."""
    scene = simulation.scene
    parts = [FORMAT, _engine(), repr(how), position, simulation.dt]
    parts += [simulation.arch, simulation.schedule_name, simulation.units_a_world, simulation.skin]
    parts += [(type(motion).__name__, motion.coordinate) for motion in scene.motions[world]]
    if scene.vessels:
        parts.append(simulation.carrier.sizes)  # of its arrays, and with them of the bed's
    parts += _told(scene, world)
    digest = hashlib.blake2b(digest_size=16)
    for part in parts:
        _feed(digest, part)
    return digest.hexdigest()


def _told(given: object, world: int) -> Iterator[tuple[str, object]]:
    """What a scene, or a part of it, says of a settled bed in one world, each field with its name."""
    each, unrelated = marked(type(given), EachWorld), marked(type(given), NotOfBed)
    for field in fields(given):
        if field.init and field.name not in unrelated:  # the rest is derived from these
            value = getattr(given, field.name)
            if isinstance(value, Shapes):
                value = _shapes_of(value, world)
            elif field.name in each and value is not None:
                value = value[world]
            elif isinstance(value, tuple):
                value = tuple(tuple(_told(one, world)) if _is_of_bed(one) else one for one in value)
            yield field.name, value


def _is_of_bed(value: object) -> bool:
    """Whether it has fields from which a bed does not follow."""
    return is_dataclass(value) and bool(marked(type(value), NotOfBed))


def _shapes_of(shapes: Shapes, world: int) -> tuple:
    """All data on the shapes in one world, independent of the other worlds."""
    used, which = np.unique(shapes.which[world], return_inverse=True)
    outlines = tuple(shapes.outlines[k] for k in used)
    return outlines, which, shapes.angle[world], shapes.contact, shapes.nodes


def _feed(digest, value: object) -> None:
    """Add a value to a hash, arrays with all their digits."""
    if isinstance(value, np.ndarray):
        digest.update(f"{value.dtype}{value.shape}".encode())
        digest.update(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, tuple):
        for item in value:
            _feed(digest, item)
    else:
        digest.update(repr(value).encode())
    digest.update(b"\0")


@cache
def _engine() -> str:
    """Identifies the engine: the solver's source text, its compiler, and the processor that it compiles for."""
    digest = hashlib.blake2b(digest_size=16)
    for path in sorted(Path(str(files("solvers"))).rglob("*.py")):
        digest.update(path.read_bytes())
    return f"{digest.hexdigest()} taichi {version('taichi')} numpy {version('numpy')} {platform.machine()}"
