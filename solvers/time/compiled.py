"""Which kinds of scenes have kernels in Taichi's cache, and how long it took to compile them here.

Kernels are compiled for laws, schedules and the lengths of arrays, not for sizes and materials. Taichi can tell whether
it has a kernel only once it has traced it, which takes a second. So the lab notes each kind of scene when its kernels
are compiled, in a file beside them: whoever removes them removes the note. A kernel that Taichi dropped for want of
room is still noted; the estimate is then too low.
"""

import hashlib
import json
import os
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path

from solvers.machine import compiling
from solvers.machine.kernel_cache import usual_folder
from solvers.machine.state import Axes, world_axis

FILE = "scenes.json"
MOST = 1000  # scenes that are remembered
SOLVERS = Path(__file__).parents[1]


def kind_of(run, worlds: int) -> str:
    """What selects the kernels of a `solvers.simulation.Simulation`, were it one of so many worlds; a hash."""
    scene, own = run.scene, run.scene.worlds
    arrays = {name: _of_one_world(array.axes, own) for name, array in run.arrays.arrays.items()}
    laws = [scene.grains.laws, scene.grains.twist_law, scene.grains.integrator] if scene.grains else []
    cut = run.schedule_name, run.units_a_world, run.arch, run.vectors, run.largest_multiple, run.threads
    what = worlds, arrays, [_named(law) for law in laws], scene.kinds_of_motions, scene.precision, cut
    whole = repr(what), compiling.quick(), _written()
    return hashlib.sha256(repr(whole).encode()).hexdigest()[:32]


def family_of(run) -> str:
    """What scenes that take about as long to compile have in common: matters, axes, and whether they are a ship's."""
    ship = " ship" * bool(run.scene.vessels)
    return f"{'+'.join(sorted(run.matters)) or 'nothing'} {run.scene.axes}{ship}{' quick' * compiling.quick()}"


def note(run, seconds: float) -> None:
    """Remember that the kernels of a simulation have been compiled, or read, in so many seconds."""
    kind, noted = kind_of(run, run.scene.worlds), _noted()
    if kind in noted and noted[kind]["seconds"] >= seconds:
        return
    noted.pop(kind, None)
    kept = dict(list(noted.items())[1 - MOST :]) | {kind: {"family": family_of(run), "seconds": round(seconds, 2)}}
    with suppress(OSError):
        _write(kept)


def taken(run, worlds: int) -> tuple[bool, float | None]:
    """Whether kernels of a simulation of so many worlds are there, and the seconds that compiling them takes here.

    The seconds are those of its own kind, else the median of scenes with the same matters, else None.
    """
    noted = _noted()
    own = noted.get(kind_of(run, worlds))
    if own:
        return True, own["seconds"]
    alike = sorted(one["seconds"] for one in noted.values() if one["family"] == family_of(run))
    return False, alike[len(alike) // 2] if alike else None


def _noted() -> dict[str, Mapping]:
    """The notes by kind, the oldest first; empty where none can be read."""
    folder = usual_folder()
    try:
        noted = json.loads((folder / FILE).read_text()) if folder else {}
        return {kind: one for kind, one in noted.items() if one["seconds"] >= 0.0 and isinstance(one["family"], str)}
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return {}


def _write(noted: Mapping[str, Mapping]) -> None:
    """Write the notes at once, so that a process beside this one reads the old ones or the new."""
    if (folder := usual_folder()) is None:
        return
    handle, draft = tempfile.mkstemp(dir=folder, suffix=".json")
    with os.fdopen(handle, "w") as file:
        json.dump(noted, file)
    os.replace(draft, folder / FILE)


def _of_one_world(axes: Axes, worlds: int) -> list[tuple[str, int]]:
    """Names and lengths of axes, were there one world."""
    along = world_axis(axes)
    return [(axis.name, axis.length // (worlds if k == along else 1)) for k, axis in enumerate(axes)]


def _named(law: object) -> str:
    kind = law if isinstance(law, type) else type(law)
    return law if isinstance(law, str) else f"{kind.__module__}.{kind.__qualname__}"


@cache
def _written() -> str:
    """When the solvers' files were written, and how long they are: other code has other kernels."""
    found = sorted((str(path.relative_to(SOLVERS)), path.stat().st_size) for path in SOLVERS.rglob("*.py"))
    latest = max(path.stat().st_mtime_ns for path in SOLVERS.rglob("*.py"))
    return hashlib.sha256(repr((found, latest)).encode()).hexdigest()
