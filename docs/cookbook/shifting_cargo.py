"""Does the cargo of a barge shift in this sea, and how far does she roll because of it?

A barge with a hatch and loose grains in beam waves, beside the same barge with her cargo frozen. It prints shift,
rolls, and when the hatch goes under, and writes a page with a player, for people without Python. Takes about half
a minute.
"""

import tempfile
from pathlib import Path

import cargolab

folder = Path(tempfile.mkdtemp(prefix="barge-"))
barge = cargolab.Preset("ship/capsize-map-quick", grains={"diameter": "10 mm"}, waves={"amplitude": "19 mm"})
result = barge.run(folder / "run", repeats=2, video=False, plots=False, quiet=True)

found = result.measures
for name in ("largest_shift", "largest_roll", "frozen_largest_roll"):
    print(f"{name}: {found[name].value:.1f} {found[name].unit}")
lost = [f"{time:.1f} s" if time else "never" for time in found["flooded_at"].worlds]
print(f"her hatch goes under water after: {', '.join(lost)}; frozen: {found['frozen_flooded_at'].value or 'never'}")
print("open in a browser:", cargolab.export(folder / "run", "html", folder / "barge.html"))
