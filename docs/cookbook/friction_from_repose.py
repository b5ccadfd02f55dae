"""Which friction of the grains gives the angle that was measured of a cargo?

Eight beds are tilted at several values of the friction. Where their angle meets the measured one is the friction
that is looked for. It prints that friction with its standard error and its 95 % interval. Takes about a minute.
"""

import tempfile

import cargolab

MEASURED = "critical_angle=28 ± 1 deg"
bed = cargolab.Preset("tilting/quick", tank={"width": "60 mm"}, grains={"depth": "30 mm"})

with tempfile.TemporaryDirectory() as folder:
    found = cargolab.calibrate(bed, MEASURED, "friction=0.1:0.5", f"{folder}/run", repeats=8, quiet=True)

low, high = found.interval
print(f"{found.key}: {found.value:.3f} ± {found.standard_error:.3f} (s.e.), 95 %: {low:.3f} to {high:.3f}")
print(f"tried: {', '.join(f'{trial.x:.3f}' for trial in found.trials)}, {found.beds} beds each")
