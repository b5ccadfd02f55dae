"""How far does a ship heel when a wing tank is holed, and does a wider cross-flooding duct help?

By formula, without particles, of a case that comes with the lab: a box barge, whose duct opens after 30 s. It prints
the largest heel, and the heel after 90 s, for two ducts. Takes some ten seconds.
"""

import numpy as np

import cargolab

for diameter in ("0.4 m", "0.8 m"):
    duct = {"openings.duct.diameter": diameter, "openings.duct.opens": "30 s"}
    found = cargolab.flood("wing-tank", **duct, run__duration="90 s")
    largest, when = found.largest
    print(f"duct of {diameter}: largest heel {np.degrees(largest):.2f} deg after {when:.0f} s,", end=" ")
    print(f"at the end {np.degrees(found.heel[-1]):.2f} deg with {found.mass[-1] / 1000.0:.0f} t of water aboard")
