"""What stress does a bed of grains carry, and is it the weight above?

The stress on a grid, by coarse graining, in a bed at rest, averaged across its middle. It prints the upright stress
beside the weight above, and the stress across over that upright. Takes about ten seconds.
"""

import tempfile

import numpy as np

import cargolab

GRAVITY = 9.81  # m/s²

with (
    tempfile.TemporaryDirectory() as folder,
    cargolab.Simulation("tilting/quick", f"{folder}/run", repeats=1, quiet=True) as simulation,
):
    bed = cargolab.fields(simulation, spacing=0.003, width=0.0045)

middle = bed.sel(y=slice(-0.03, 0.03)).mean("y")
upright, across = middle.stress.sel(axis="z", across="z"), middle.stress.sel(axis="y", across="y")
above = GRAVITY * 0.003 * np.cumsum(middle.density.values[::-1])[::-1] - 0.5 * GRAVITY * 0.003 * middle.density.values
print(" height   upright stress   weight above   across/upright")
for z, stress, weight, side in zip(middle.z.values, upright.values, above, across.values, strict=True):
    if 0.006 < z < 0.036:
        print(f"{1e3 * z:4.0f} mm {stress:11.0f} Pa {weight:11.0f} Pa {side / stress:12.2f}")
