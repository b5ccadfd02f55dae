"""How do I get a number that the lab does not measure, with its scatter over the beds?

A measure is a function of a recording that gives a number for each bed. This one is how high cargo has run up the
lower wall of a tilted tank. It prints the mean and its scatter. Takes about half a minute.
"""

import tempfile

import numpy as np

import cargolab


@cargolab.measure(unit="mm", of="grains")
def run_up(recording):
    """Height of the highest grain beside the lower wall in the last picture, less that in the first one."""
    wall = recording.outline[:, 0].min()
    place, reach = recording.frames["position"], 6.0 * recording.radius.mean()

    def highest(frame):
        y, z = place[frame][..., 0], place[frame][..., 1]
        return np.where(abs(y - wall) < reach, z, 0.0).max(axis=1)

    return 1e3 * (highest(-1) - highest(0))


bed = cargolab.Preset("tilting/quick", tank={"width": "72 mm"}, grains={"depth": "34 mm"})
with tempfile.TemporaryDirectory() as folder:
    result = bed.run(f"{folder}/run", video=False, plots=False, quiet=True)

found = result.measures["run_up"]
print(f"run-up on the lower wall: {found.value:.1f} ± {found.std:.1f} {found.unit}, {found.n} beds")
