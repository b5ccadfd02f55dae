"""How stable is my own hull? Her draught, GM and righting levers from a table of offsets.

The table here is a barge of 40 by 10 by 4 m with a rake at both ends. It prints draught and GM at 900 t, and GZ at
some angles of heel. Takes a second.
"""

import tempfile
from math import sin
from pathlib import Path

import numpy as np

import cargolab

MASS, KG = 900.0, 3.1  # t and m
rows = ["station,z,half_breadth"]
for station in range(0, 41, 2):  # evenly spaced, and enough of them where she changes
    bottom = max(0.0, 1.5 - 0.375 * min(station, 40 - station))  # both ends are cut up by 1.5 m
    rows += [f"{station},{z},5" for z in (bottom, 4)]

with tempfile.TemporaryDirectory() as folder:
    table = Path(folder, "barge.csv")
    table.write_text("\n".join(rows), encoding="utf-8")
    barge = cargolab.hull(table)

upright = barge.at(displacement=MASS)
print(f"draught {upright.draught:.3f} m, KM {upright.km:.3f} m, GM {upright.km - KG:.3f} m")

heels = np.radians([5, 10, 20, 30, 40, 50, 60])
levers = barge.form.righting_levers(MASS, barge.water, heels, (0.0, KG))
for heel, lever in zip(heels, levers, strict=True):
    wall_sided = sin(heel) * (upright.km - KG + 0.5 * upright.bm * np.tan(heel) ** 2)
    print(f"{np.degrees(heel):2.0f} deg: GZ {lever:6.3f} m, by the formula of wall-sided ships {wall_sided:6.3f} m")
