"""A cache of hydrodynamic tables, so that each section and each hull is solved only once.

It is the folder `hydrodynamics` in the user's cache, or in the folder that CARGOLAB_CACHE names. A file that cannot be
read counts as missing.
"""

import hashlib
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from tempfile import NamedTemporaryFile
from types import ModuleType

import numpy as np

from lab.base.caches import cache_folder
from solvers.ship import hydrostatics, section, water
from solvers.ship.potential import green, panels, radiation
from solvers.ship.potential.radiation import Hydrodynamics, hydrodynamics
from solvers.ship.section import Section
from solvers.ship.water import Water

PANELS = 80
SOLVED_BY = (green, panels, radiation, section, water, hydrostatics)  # a change of their code makes stored tables stale
FORMAT = "cargo-shift-lab hydrodynamics 1"
COLUMNS = (
    "frequency",
    "added_mass",
    "damping",
    "excitation",
    "froude_krylov",
    "haskind",
    "infinite_added_mass",
)


def stored_table(
    hull: Section, sea: Water, heave: float, frequency: np.ndarray, about: tuple[float, float]
) -> Hydrodynamics:
    """`hydrodynamics` of an upright section, from the cache if possible. Raises Unavailable as `hydrodynamics`."""
    numbers = [sea.density, sea.depth, sea.gravity, heave, *about, PANELS]
    values = hull.outline, np.array(numbers), np.asarray(frequency)
    return kept(values, SOLVED_BY, lambda: hydrodynamics(hull, sea, heave, frequency, about=about, count=PANELS))


def kept(values: Sequence[np.ndarray], solved_by: Sequence[ModuleType], make: Callable[[], Hydrodynamics]):
    """The table that `make` solves for from `values` by the code of some modules, from the cache if it has it."""
    path = cache_folder() / "hydrodynamics" / f"{_key(values, solved_by)}.npz"
    found = _load(path)
    if found is None:
        found = make()
        _save(path, found)
    return found


def _key(values: Sequence[np.ndarray], solved_by: Sequence[ModuleType]) -> str:
    digest = hashlib.blake2b(digest_size=16)
    for module in solved_by:
        digest.update(Path(module.__file__).read_bytes())
    for one in values:
        digest.update(np.ascontiguousarray(one, dtype=float).tobytes())
    digest.update(FORMAT.encode())
    return digest.hexdigest()


def _load(path: Path) -> Hydrodynamics | None:
    try:
        with np.load(path, allow_pickle=False) as file:
            return Hydrodynamics(*(file[name] for name in COLUMNS))
    except Exception:  # a damaged file, in whatever way, counts as missing
        return None


def _save(path: Path, table: Hydrodynamics) -> None:
    """Store a table if the disk allows; the file is replaced atomically."""
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as file:
            half = Path(file.name)
            np.savez_compressed(file, **{name: getattr(table, name) for name in COLUMNS})
        half.replace(path)
