"""Extended XYZ: a text file with all pictures, a line a particle.

Source: the comment line of extended XYZ, `Properties=name:kind:columns:…`, kinds S (text), R (real) and I (integer), as
in libAtoms (Csányi et al.; github.com/libAtoms/extxyz). Lengths are in m and times in s.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lab.base.text import one_line
from lab.export.columns import species, table

if TYPE_CHECKING:
    from lab.export.stage import Stage

CALLED = {"velocity": "velo"}  # where programs know a quantity by another name


def write_xyz(stage: Stage, rows: Sequence[int], path: Path, reach: Callable[[int], None]) -> None:
    """Write all particles at these pictures."""
    with path.open("w", encoding="utf-8") as file:
        for done, row in enumerate(rows):
            file.writelines(_picture(stage, row))
            reach(done + 1)


def _picture(stage: Stage, row: int) -> Iterator[str]:
    """The lines of a picture: how many particles, what their columns are, and the particles."""
    names, values = table(stage, row)
    places = values.pop("position")
    yield f"{len(places)}\n"
    columns = ["species:S:1", "pos:R:3"]
    columns += [f"{CALLED.get(name, name)}:{_kind(one)}" for name, one in values.items()]
    title = one_line(stage.title).replace('"', "'").replace("\\", "/")
    pose = " ".join(f"{x:.9g}" for x in stage.stance[row])
    yield (
        f'Properties={":".join(columns)} Time={stage.time[row]:.9g} pbc="F F F" '
        f'tank_pose="{pose}" frame={"earth" if stage.earth else "tank"} title="{title}"\n'
    )
    numbers = np.column_stack([places, *values.values()])
    form = " ".join("%d" if kind == "i" else "%.8g" for kind in _kinds(places, values))
    words = species(stage, names, values)
    for word, line in zip(words, numbers.tolist(), strict=True):
        yield f"{word} {form % tuple(line)}\n"


def _kind(values: np.ndarray) -> str:
    width = 1 if values.ndim == 1 else values.shape[1]
    return f"{'I' if values.dtype.kind in 'iu' else 'R'}:{width}"


def _kinds(places: np.ndarray, values: dict[str, np.ndarray]) -> Iterator[str]:
    """Of each column in turn whether it holds integers, "i", or real numbers, "r"."""
    for one in (places, *values.values()):
        width = 1 if one.ndim == 1 else one.shape[1]
        yield from ("i" if one.dtype.kind in "iu" else "r",) * width
