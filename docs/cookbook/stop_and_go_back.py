"""Can I stop a run when something happens, go back, and try something else from there?

A tank is tilted until its bed has shifted by 3 mm. Then the run goes back by a second, and on from there with more
friction. It prints when the bed slid, both times. Takes about half a minute.
"""

import tempfile
from collections import deque

import cargolab

SHIFTED = 0.003  # m


def go_on(simulation):
    """Run until it stops, and say why."""
    simulation.run()
    return "held to the end" if simulation.ended else f"slid at {simulation.time:.2f} s"


with (
    tempfile.TemporaryDirectory() as folder,
    cargolab.Simulation("tilting/quick", f"{folder}/run", repeats=1, quiet=True) as simulation,
):
    start = simulation.now["centre_of_mass"][0, 0]
    moments = deque(maxlen=10)  # the last second

    @simulation.every("0.1 s")
    def look(now):
        if abs(now.now["centre_of_mass"][0, 0] - start) > SHIFTED:
            now.stop()
        else:
            moments.append((now.time, now.save()))

    print(f"as it is: {go_on(simulation)}")
    time, moment = moments[0]
    simulation.restore(moment)
    simulation.set("material.friction", 0.5)
    print(f"with a friction of 0.5 from {time:.2f} s on: {go_on(simulation)}")
