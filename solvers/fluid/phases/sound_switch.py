"""Air that is soft at the start and stiff from a moment on."""

import numpy as np
import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.state import UNUSED, Particles
from solvers.fluid.timestep import stiff_step
from solvers.machine.state import Axes, State

NEVER = 2**30  # base steps


@ti.data_oriented
class SoundSwitch:
    """p_2(s_2) = p_1(s_1) at `stiff_from`: the air's speed of sound changes from c_1 to c_2, its pressure goes on.

    For `Adiabatic` ρ_2/ρ_a = [1 + (c_1/c_2)² ((ρ_1/ρ_a)^1.4 − 1)]^(1/1.4) (own derivation, from its equation at both
    speeds). Each particle keeps its place, its velocity and its mass, so that mass and momentum of the air are what
    they were; its volume m/ρ changes. To keep the volume would be to make or to lose mass, and momentum with it. In a
    closed tank the mean pressure of soft air is what of its volume the water has taken; with masses kept the stiff air
    comes to as much more in the time τ of `Reinitialisation`. So a moment is right at which the air is about as large
    as at rest and nothing is trapped; and it should be before what is trapped by as long as sound takes to cross the
    tank.

    The time step, viscosity, diffusion, τ and all else that follows from the speed of sound change with it; the
    background pressure, that of the softer air, stays. What the air's elastic energy loses is booked as diffused.

    Limits: not with cohesion, which is another equation of state; not where the tank responds to its load, since then
    steps are as long as it has them.

    Units: p Pa, c m/s, ρ kg/m³.
    """

    def __init__(self, arrays: State, particles: Particles, constants: Constants, scene, largest_multiple: int):
        self.particles, self.constants = particles, constants
        self.soft, self.stiff = scene.fluid.water.softened, scene.fluid.water
        self.acts, self.now = self.soft is not self.stiff, self.soft
        self.when, self.largest_multiple = stiff_step(scene) if self.acts else NEVER, largest_multiple
        self.has_multiples = self.acts and largest_multiple > 1
        if self.has_multiples:
            self.multiple = arrays.under("water").holding("multiple", np.array([largest_multiple]), "number", ti.i32)

    @ti.func
    def allowed_multiple(self):
        """The largest multiple."""
        longest = 1
        if ti.static(self.has_multiples):
            longest = self.multiple[0]
        return longest

    @property
    def next(self) -> int:
        """The base step at which the air is to become stiff; NEVER if it is, or never will be."""
        return self.when if self.now is self.soft else NEVER

    def use(self, stiff: bool, gravity: float) -> None:
        """Let the constants and the multiple be those of stiff or of soft air."""
        self.now = self.stiff if stiff else self.soft
        self.constants.become(self.now, gravity)
        if self.has_multiples:
            self.multiple.fill(1 if stiff else self.largest_multiple)

    def change(self, gravity: float) -> np.ndarray:
        """Make the air stiff; returns the energy (W,) J/m that it loses."""
        p = self.particles
        mass, s, gas, number = (field.to_numpy() for field in (p.mass, p.deviation, p.gas, p.number))
        air, before = (gas > 0.5) & (number != UNUSED), s.astype(float)
        share = self.constants.gas.pressure(before) * (self.soft.air.sound_speed / self.stiff.air.sound_speed) ** 2
        p.deviation.from_numpy(np.where(air, self.constants.gas.deviation(share), s).astype(s.dtype))
        after = p.deviation.to_numpy().astype(float)
        lost = np.where(air, mass * (self._elastic(before, self.soft) - self._elastic(after, self.stiff)), 0.0)
        self.use(True, gravity)
        return lost.reshape(p.worlds, -1).sum(axis=1)

    def _elastic(self, s: np.ndarray, water) -> np.ndarray:
        """Elastic energy (J/kg) of air at density deviations s, and what the background pressure holds of it."""
        return water.air.sound_speed**2 * self.constants.gas.elastic(s) + water.background / water.air.density * (
            s / (1.0 + s)
        )

    def state(self) -> dict[str, np.ndarray]:
        """What `restore` continues from, beside the arrays: whether the air is stiff."""
        return {"water_stiff": np.array(float(self.now is self.stiff))} if self.acts else {}

    def axes(self) -> dict[str, Axes]:
        """The axes of the arrays of `state`, by name."""
        return {"water_stiff": ()} if self.acts else {}

    def restore(self, state: dict[str, np.ndarray], gravity: float) -> None:
        """Restore what `state` returned."""
        if self.acts:
            self.use(bool(state["water_stiff"] > 0.5), gravity)
