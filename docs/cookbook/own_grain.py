"""How does a cargo hold whose grains have my own outline?

The outline is a table of points y, z; here a lens twice as long as high. Beds of it and of discs of the same area are
tilted until they slide. It prints both angles. Takes about half a minute, and more the first time, for compiling.
"""

import tempfile
from pathlib import Path

import numpy as np

import cargolab

turn = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
lens = np.column_stack([2.0 * np.cos(turn), np.sin(turn)])
box = cargolab.Preset(
    "shapes/box-quick",
    tank={"width": "120 mm", "height": "100 mm"},
    grains={"depth": "45 mm"},
    run={"repeats": 3},
)

with tempfile.TemporaryDirectory() as folder:
    np.savetxt(f"{folder}/lens.csv", lens, delimiter=",", header="y,z", comments="")
    outlines = {"lens": {"contour": f"{folder}/lens.csv", "share": 1.0}, "disc": {"disc": True, "share": 1.0}}
    for name, outline in outlines.items():
        bed = box.changed({"shapes.grain": False, f"shapes.{name}": outline})
        angle = bed.run(Path(folder, name), video=False, plots=False, quiet=True).measures["critical_angle"]
        print(f"{name}: slides at {angle.value:.1f} ± {angle.std:.1f} {angle.unit}, {angle.n} beds")
