"""Which friction must a continuum have to shift as far as a cargo did in a tilted box?

A box of 24 m is tilted by 35 deg at several values of the friction of bulk. Where the shift meets the measured one is
the friction that is looked for; the error of the measurement becomes its interval. It prints both, and the angle of
repose that goes with it. Takes about a minute.
"""

import tempfile
from math import atan, degrees

import cargolab

MEASURED = "bulk_shift=-7.2 ± 0.4 %"  # of the width, mean ± standard error
box = cargolab.Preset("bulk/tilt-quick", motion={"tilt": {"rate": "2 deg/s"}})  # other cells need another friction

with tempfile.TemporaryDirectory() as folder:
    found = cargolab.calibrate(box, MEASURED, "bulk.friction=0.34:0.54", f"{folder}/run", repeats=2, quiet=True)

low, high = found.interval
print(f"{found.key}: {found.value:.3f} ± {found.standard_error:.3f} (s.e.), 95 %: {low:.3f} to {high:.3f}")
print(f"angle of repose: {degrees(atan(found.value)):.1f} deg")
print(f"tried: {', '.join(f'{trial.x:.3f}' for trial in found.trials)}")
