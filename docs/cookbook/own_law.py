"""How do I try a contact law of my own?

The law here gives back only a share e² of the force while grains part, so that every impact has the restitution e
(after Walton and Braun 1986). A grain falls on a floor. It prints e by the height of its rebound. Takes about ten
seconds.
"""

import tempfile

import numpy as np
import taichi as ti

import cargolab
from solvers.grains.laws.hertz import Hertz


@cargolab.law("normal", "latching")
@ti.data_oriented
class Latching(Hertz):
    """F_n = k ξ^(3/2) while grains approach, e² k ξ^(3/2) while they part."""

    def coefficients(self, between):
        """[e²]."""
        return [between.restitution**2]

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, approach, overlap, root, rate, dt):
        """F_n (N) of a block of contacts from the overlap ξ (m), its root √ξ and its rate ξ̇ (m/s)."""
        return contacts.stiffness[w, block] * root * overlap * ti.select(rate > 0.0, 1.0, c[0])


above = [["-5 mm", "40 mm"], ["5 mm", "40 mm"], ["5 mm", "50 mm"], ["-5 mm", "50 mm"]]
drop = {"grains": {"depth": False, "count": 1, "region": above}, "motion": False, "contact": {"normal": "latching"}}
with tempfile.TemporaryDirectory() as folder:
    bed = cargolab.Preset("tilting/quick", **drop, run={"repeats": 1, "settle": False, "duration": "0.3 s"})
    result = bed.run(f"{folder}/run", video=False, plots=False, quiet=True)
    height = result.recording.series["centre_of_mass"][:, 0, 1] - result.recording.radius[0, 0]

lowest = int(np.argmax(height < 0.05 * height[0]))
print(f"restitution: {np.sqrt(height[lowest:].max() / height[0]):.3f}, asked: {bed['material.restitution']}")
