"""At what angle does a bed of grains slide, and how sure is that angle?

Six beds that differ in their seed are tilted until they slide. It prints the mean angle, the scatter of the beds,
and the interval in which the mean of very many beds lies. Takes about half a minute.
"""

import tempfile

import cargolab

box = cargolab.Preset("tilting/quick", tank={"width": "72 mm"}, grains={"depth": "34 mm"})  # about 280 grains

with tempfile.TemporaryDirectory() as folder:
    result = box.run(f"{folder}/run", repeats=6, video=False, plots=False, quiet=True)
    angle = result.measures["critical_angle"]

low, high = angle.interval
print(f"angle of each bed: {', '.join(f'{one:.1f}' for one in angle.worlds if one is not None)} {angle.unit}")
print(f"mean ± standard deviation of the beds: {angle.value:.1f} ± {angle.std:.1f} {angle.unit}, {angle.n} beds")
print(f"mean of very many beds, at 95 %: {low:.1f} to {high:.1f} {angle.unit}")
