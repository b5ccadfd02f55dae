"""Damping zones: beaches that take the waves that run into them."""

import numpy as np
import taichi as ti

from solvers.fluid.given import Water
from solvers.fluid.state import Particles
from solvers.machine.state import State
from solvers.machine.units import Units

START, OVER, RATE = range(3)  # of a zone: where it starts (m), one over its length (1/m, with its sign), rate (1/s)
CALM = 0.02  # of its amplitude, what a wave has left when it has been through its zone to and fro


@ti.data_oriented
class DampingZones:
    """du/dt = −γ u, γ = γ_m s²: a sponge layer (Israeli & Orszag 1981, J. Comput. Phys. 41, 115), s from 0 to 1.

    s grows with the distance from where the zone starts to where it ends. Half of the energy of a wave is kinetic, so
    that its amplitude falls as exp(−∫γ dy/2c_g); to and fro it keeps exp(−γ_m L/3c_g), of which γ_m follows
    (`rate_of`). A zone as long as a wave, or longer, hardly reflects it. What it takes is told with what viscosity
    takes. Its momentum leaves the tank.

    Limits: of tanks that stand still; a zone also stops a current.
    """

    def __init__(self, arrays: State, water: Water, particles: Particles, units: Units):
        self.particles, self.count = particles, len(water.damping)
        if self.count:
            own = arrays.under("water.damping")
            rows = [[zone.start, 1.0 / (zone.end - zone.start), zone.rate] for zone in water.damping]
            self.zones = own.holding("zones", np.array(rows), "zone number")
            (self.taken,) = own.reals((units.axis,), "taken", kind=own.exact)

    def total(self, worlds: int) -> np.ndarray:
        """The energy (W,) J/m that the zones have taken."""
        return self.taken.to_numpy().reshape(worlds, -1).sum(axis=1) if self.count else np.zeros(worlds)

    def forget(self) -> None:
        """Forget what the zones have taken."""
        if self.count:
            self.taken.fill(0.0)

    @ti.func
    def slow(self, u, b, dt):
        """Slow the particles of a block that are in a zone down, in a step of dt (s)."""
        p = self.particles
        place = p.offset(b, ti.cast(0.0, p.where), 0)
        rate = p.zeros()
        for k in range(self.count):
            s = ti.max(0.0, ti.min(1.0, (place - self.zones[k, START]) * self.zones[k, OVER]))
            rate += self.zones[k, RATE] * s * s
        keep, lost = 1.0 / (1.0 + dt * rate), p.zeros()
        for a in ti.static(range(p.axes)):
            before = p.load(p.velocity[a], b)
            after = keep * before
            lost += before * before - after * after
            p.store(p.velocity[a], b, after)
        self.taken[u] = self.taken[u] + 0.5 * ti.cast((p.load(p.mass, b) * lost).sum(), p.exact)


def rate_of(length: float, group_speed: float) -> float:
    """γ_m (1/s) of a zone of a length (m) in which waves of this group velocity (m/s) keep CALM of their amplitude."""
    return 3.0 * group_speed / length * float(np.log(1.0 / CALM))
