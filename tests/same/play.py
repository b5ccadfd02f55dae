"""Runs scenes by the lab that Python finds first, and keeps their arrays: `python play.py FOLDER [--strict] [SCENE …]`.

This file is run with the tree of the base, too, so it uses nothing but `lab.run` and the recording that it gives.
`--strict` switches off fast-math, whose regrouping of sums is the compiler's own.
"""

import os
import sys
from pathlib import Path

import numpy as np
import taichi as ti


def play(name: str, changes: dict, bed: Path, folder: Path) -> None:
    """Run one scene and keep what was recorded in FOLDER/NAME.npz, as arrays by name."""
    import lab

    recording = lab.run(str(bed), folder / name, video=False, quiet=True, **changes).recording
    arrays = {"radius": recording.radius}
    for group, table in (("series", recording.series), ("frames", recording.frames)):
        arrays |= {f"{group}/{key}": np.asarray(table[key][:]) for key in ("time", *table)}
    np.savez(folder / f"{name}.npz", **arrays)


def main() -> None:
    """Run the scenes that are named, or all, one after the other."""
    folder, strict = Path(sys.argv[1]), "--strict" in sys.argv
    wanted = [name for name in sys.argv[2:] if not name.startswith("--")]
    tree = Path(os.environ["TREE"])
    own = tree / "tests" / "same"  # a base that has scenes of its own knows their keys best
    sys.path.insert(0, str(own if (own / "scenes.py").exists() else Path(__file__).parent))
    import scenes

    if strict:
        begin = ti.init
        ti.init = lambda *args, **options: begin(*args, **{**options, "fast_math": False})
    for name in wanted or scenes.SCENES:
        if name in scenes.SCENES:
            try:
                play(name, scenes.SCENES[name], Path(scenes.__file__).parent / "bed.toml", folder)
            except Exception as error:  # the other scenes go on
                print(f"{name} in {tree}: {type(error).__name__}: {error}", file=sys.stderr)


if __name__ == "__main__":
    main()
