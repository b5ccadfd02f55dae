"""A cache of what the solver solved for collisions: the damping that gives a restitution, and the other way round.

That takes SciPy's solvers, and loading them half of the time before a run begins. The file is in the folder
`collisions` in the user's cache, or in the folder that CARGOLAB_CACHE names. One that cannot be read counts as missing.
"""

import hashlib
import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from tempfile import NamedTemporaryFile

from lab.base.caches import cache_folder
from solvers.grains import restitution

MOST = 1000  # solutions that are kept
LARGEST_FILE = 200 * MOST  # bytes


@contextmanager
def known_collisions() -> Iterator[None]:
    """Context in which what is known of collisions is not solved again; what is new is kept."""
    path = cache_folder() / "collisions" / f"{_key()}.json"
    _load(path)
    before = len(restitution.solved)
    yield
    if before < len(restitution.solved) <= MOST:
        _save(path)


@cache
def _key() -> str:
    """Hash of what determines the solutions: the code and the versions of what it calls."""
    digest = hashlib.blake2b(Path(restitution.__file__).read_bytes(), digest_size=16)
    digest.update(f"{version('numpy')} {version('scipy')}".encode())
    return digest.hexdigest()


@cache
def _load(path: Path) -> None:
    with suppress(Exception):  # a damaged file, in whatever way, counts as missing
        text = path.read_text(encoding="utf-8") if path.stat().st_size <= LARGEST_FILE else "[]"
        found = {
            (str(name), float(number), float(power)): float(known) for name, number, power, known in json.loads(text)
        }
        restitution.solved.update(found)


def _save(path: Path) -> None:
    """Store all if the disk allows; the file is replaced atomically."""
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with NamedTemporaryFile("w", dir=path.parent, suffix=".part", delete=False, encoding="utf-8") as file:
            json.dump([[*asked, known] for asked, known in restitution.solved.items()], file)
        Path(file.name).replace(path)
