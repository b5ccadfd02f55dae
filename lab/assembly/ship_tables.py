"""A cache of hydrodynamic tables, so that each section is solved only once.

It is the folder `hydrodynamics` in the user's cache, or in the folder that CARGOLAB_CACHE names. A file that cannot be
read counts as missing.
"""

import hashlib
from contextlib import suppress
from pathlib import Path
from tempfile import NamedTemporaryFile

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
    path = cache_folder() / "hydrodynamics" / f"{_key(hull, sea, heave, frequency, about)}.npz"
    found = _load(path)
    if found is None:
        found = hydrodynamics(hull, sea, heave, frequency, about=about, count=PANELS)
        _save(path, found)
    return found


def _key(hull: Section, sea: Water, heave: float, frequency: np.ndarray, about: tuple[float, float]) -> str:
    digest = hashlib.blake2b(digest_size=16)
    for module in SOLVED_BY:
        digest.update(Path(module.__file__).read_bytes())
    numbers = [sea.density, sea.depth, sea.gravity, heave, *about, PANELS]
    for values in (hull.outline, np.array(numbers), np.asarray(frequency)):
        digest.update(np.ascontiguousarray(values, dtype=float).tobytes())
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
