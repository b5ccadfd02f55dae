"""A store of hydrodynamic tables, so that a section that was solved once is not solved again.

The folder `hydrodynamics` of the user's cache, or of the folder that CARGOLAB_CACHE names; what cannot be read there
counts as not there.
"""

import hashlib
from contextlib import suppress
from pathlib import Path
from tempfile import NamedTemporaryFile

import numpy as np

from lab.caches import cache_folder
from solvers.ship import radiation
from solvers.ship.radiation import Hydrodynamics, hydrodynamics
from solvers.ship.section import Section
from solvers.ship.water import Water

PANELS = 80
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
    section: Section, water: Water, heave: float, frequency: np.ndarray, about: tuple[float, float]
) -> Hydrodynamics:
    """`hydrodynamics` of an upright section, from the store if it is there. Raises Unavailable as that does."""
    path = cache_folder() / "hydrodynamics" / f"{_key(section, water, heave, frequency, about)}.npz"
    found = _load(path)
    if found is None:
        found = hydrodynamics(section, water, heave, frequency, about=about, count=PANELS)
        _save(path, found)
    return found


def _key(section: Section, water: Water, heave: float, frequency: np.ndarray, about: tuple[float, float]) -> str:
    digest = hashlib.blake2b(digest_size=16)
    code = Path(radiation.__file__).parent
    for name in ("green", "panels", "radiation", "section", "water", "hydrostatics"):
        digest.update((code / f"{name}.py").read_bytes())
    numbers = [water.density, water.depth, water.gravity, heave, *about, PANELS]
    for values in (section.outline, np.array(numbers), np.asarray(frequency)):
        digest.update(np.ascontiguousarray(values, dtype=float).tobytes())
    digest.update(FORMAT.encode())
    return digest.hexdigest()


def _load(path: Path) -> Hydrodynamics | None:
    try:
        with np.load(path, allow_pickle=False) as file:
            return Hydrodynamics(*(file[name] for name in COLUMNS))
    except Exception:  # whatever may be wrong with a file, there is no table in it then
        return None


def _save(path: Path, table: Hydrodynamics) -> None:
    """As far as the disk allows; a reader sees the whole file or none."""
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as file:
            half = Path(file.name)
            np.savez_compressed(file, **{name: getattr(table, name) for name in COLUMNS})
        half.replace(path)
