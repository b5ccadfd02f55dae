"""At which frequency does the liquid in a tank answer most, and what does the tank feel of it?

A tank of oil sways at seven frequencies; the sweep's rows become a table of pandas. It prints added mass and
damping of the liquid over the frequency, and linear theory's first frequency. Takes about half a minute.
"""

import tempfile
from math import pi, sqrt, tanh

import pandas

import cargolab

WIDTH, DEPTH, GRAVITY = 0.4, 0.1, 9.81  # m, m, m/s²
tank = cargolab.Preset("sloshing/sway-sweep-quick", motion__soft_start="2 s", run__duration="12 s")
frequencies = {"motion.sway.frequency": "0.8:1.4:7 Hz"}

with tempfile.TemporaryDirectory() as folder:
    result = tank.sweep(frequencies, f"{folder}/sweep", video=False, plots=False, quiet=True)
    table = pandas.DataFrame(result.rows)

columns = ["motion.sway.frequency (Hz)", "liquid_added_mass", "liquid_damping (N s/m)"]
print(table[columns].round(2).to_string(index=False))
print(f"first frequency by linear theory: {sqrt(GRAVITY * pi / WIDTH * tanh(pi * DEPTH / WIDTH)) / 2 / pi:.3f} Hz")
