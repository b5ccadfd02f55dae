"""What is the pressure of the water at a point in a tank, in the units I like?

A tank of water sways. Points and keys are quantities of pint. It prints the pressure at a depth over time, beside
that of water at rest. Takes about half a minute.
"""

import tempfile

from pint import get_application_registry

import cargolab

units = get_application_registry()
tank = cargolab.Preset("sloshing/quick")
tank["water.spacing"] = 9.3 * units.mm
tank["motion.roll.amplitude"] = 0.03 * units.rad
tank["run.duration"] = 3 * units.s
point = units.Quantity([-30.0, 3.0], "cm")  # across from the middle, up from the floor

with tempfile.TemporaryDirectory() as folder:
    result = tank.run(f"{folder}/run", video=False, plots=False, quiet=True)
    times = result.recording.frames["time"][:]
    for frame in range(0, len(times), len(times) // 6):
        found = cargolab.water_at(result.recording, [point.to("m").magnitude], frame)
        pressure = units.Quantity(float(found.pressure[0]), found.pressure.units)
        print(f"{times[frame]:.2f} s: {pressure.to('mbar'):.2f~P}")

above = tank.quantity("water.depth") - point[1]
rest = tank.quantity("water.density") * tank.quantity("run.gravity") * above
print(f"at rest: {rest.to('mbar'):.2f~P}")
