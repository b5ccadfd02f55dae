"""The constants of the water's pair sums, in an array: scenes that differ in them alone share compiled kernels."""

import numpy as np
import taichi as ti

from solvers.fluid.diffusion import DIFFUSION
from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS
from solvers.fluid.shifting import SHIFTING
from solvers.fluid.states import STATES
from solvers.fluid.viscosity import VISCOSITY
from solvers.machine.state import State

FLOOR = 1e-6  # of h², added to squared distances that are divided by
FASTEST = 0.5  # Mach number at which a run is stopped
# Of c0/Δx, frequency of a particle behind the face of a wall: at a tenth of the speed of sound, the highest that water
# is to have, it comes half a spacing deep.
HARD = 0.2


@ti.data_oriented
class Constants:
    """The models of a scene's water, and their numbers (SI) by name, read by `get` from one small array."""

    def __init__(self, arrays: State, water: Water, gravity: float):
        self.kernel, self.state = KERNELS[water.kernel](), STATES[water.state]()
        self.diffusion, self.viscosity = DIFFUSION[water.diffusion](), VISCOSITY[water.viscosity]()
        self.shifting = SHIFTING[water.shifting]()
        length, sound = water.length, water.sound_speed
        value, slope = self.kernel.factors(length)
        strength = self.viscosity.strength(water)
        self.viscous, self.slip, self.full = strength > 0.0, water.slip, water.full
        self.pressed = water.background > 0.0
        self.smoothing = water.smoothing  # h/Δx
        pull = water.pull
        numbers = {
            "shrink": 0.5 / length,  # 1/(2h): t = 1 − r/(2h)
            "value": value,
            "slope": slope,
            "floor": FLOOR * length**2,
            "density": water.density,
            "stiffness": water.density * sound**2,  # ρ0 c0², Pa
            "background": water.background,
            "spread": water.delta * length * sound,  # δ h c0, m²/s
            "strength": strength,
            "hydrostatic": gravity / sound**2,  # g/c0², 1/m
            "spacing": water.spacing,
            "reach": water.reach,
            "hard": water.density * (HARD * sound / water.spacing) ** 2 / (slope * water.spacing**2),
            "fastest": FASTEST * sound,
            "shift": self.shifting.strength(water) * slope if self.shifting.acts else 0.0,
            "shift_most": 0.5 * water.speed,
            "shift_scale": value / self.kernel.printed(water.spacing, length),
            "pull": pull.rate**2 if pull else 0.0,
            "pull_y": pull.centre[0] if pull else 0.0,
            "pull_z": pull.centre[1] if pull else 0.0,
        }
        self.at = {name: place for place, name in enumerate(numbers)}
        self.pulled = pull is not None
        self.values = arrays.under("water").holding("constants", np.array(list(numbers.values())), "number")

    def set(self, name: str, value: float) -> None:
        """Change the constant of that name."""
        values = self.values.to_numpy()
        values[self.at[name]] = value
        self.values.from_numpy(values)

    @ti.func
    def get(self, name: ti.template()):
        """The constant of that name."""
        return self.values[ti.static(self.at[name])]

    @ti.func
    def hardness(self, square, firm):
        """What a dummy adds at the squared distance (m²), per volume, so that a thin layer does not pass the wall.

        A spring up to the distance `firm` (m), that of the dummy from its wall's face, for pressure alone does not hold
        water that parts along a wall it nears.
        """
        return self.get("hard") * ti.max(firm / ti.sqrt(square + self.get("floor")) - 1.0, 0.0)
