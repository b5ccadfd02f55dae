"""Arrays that a study needs again, kept in its folder."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np


def remembered(path: Path, said: str, make: Callable[[], Mapping[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Arrays by name from a .npz file; where it is missing this is `said`, and they are made and put there."""
    if not path.is_file():
        print(said, flush=True)
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part.npz")
        np.savez(part, **make())
        part.replace(path)
    with np.load(path) as found:
        return dict(found)
