"""The constants of the water's pair sums, in an array: scenes that differ in them alone share compiled kernels."""

import numpy as np
import taichi as ti

from solvers.fluid.diffusion import DIFFUSION
from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS
from solvers.fluid.phases.adiabatic import Adiabatic
from solvers.fluid.phases.cohesion import Cohesion
from solvers.fluid.phases.numbers import of_air
from solvers.fluid.phases.reduced_pressure import ReducedPressure
from solvers.fluid.shifting import SHIFTING
from solvers.fluid.states import STATES
from solvers.fluid.surface.reinitialisation import Reinitialisation
from solvers.fluid.surface.void_indicator import VoidIndicator
from solvers.fluid.terms.end_walls import EndWallFriction
from solvers.fluid.viscosity import VISCOSITY
from solvers.fluid.walls.layers import FIRM
from solvers.machine.quantity import PLANE
from solvers.machine.state import State

FLOOR = 1e-6  # of h², added to squared distances that are divided by
FASTEST = 0.5  # Mach number at which a run is stopped
AIR = "air_"  # how names of the air's constants begin
PULL = 1e20  # Pa, with which walls may hold air: without bound
# Of c0/Δx, frequency of a particle behind the face of a wall: at a tenth of the speed of sound, the highest that water
# is to have, it comes half a spacing deep.
HARD = 0.2


@ti.data_oriented
class Constants:
    """The models of a scene's water, and their numbers (SI) by name, read by `get` from one small array."""

    def __init__(self, arrays: State, water: Water, gravity: float, axes: int = PLANE):
        self.axes, self.kernel, self.state = axes, KERNELS[water.kernel](), STATES[water.state]()
        self.diffusion, self.viscosity = DIFFUSION[water.diffusion](), VISCOSITY[water.viscosity]()
        self.shifting = SHIFTING[water.shifting]()
        self.slip, self.full, self.pressed = water.slip, water.full, water.background > 0.0
        self.smoothing = water.smoothing  # h/Δx
        self.two, self.gas, self.cohesion = water.air is not None, Adiabatic(), Cohesion()
        self.tense = self.two and water.air.tension > 0.0
        self.coheres = self.two and water.air.cohesion > 0.0
        self.reduced, self.modified = ReducedPressure(), self.two and water.air.reduced is not None
        self.accounted = not (self.tense or self.coheres)  # for whether all energy has a name
        self.pulled, self.end_walls = water.pull is not None, water.gap > 0.0
        self.numbers = numbers = self.numbers_of(water, gravity)
        self.viscous = numbers["strength"] > 0.0 or (self.two and numbers["air_strength"] > 0.0)
        self.at = {name: place for place, name in enumerate(numbers)}
        self.at_air = {name[len(AIR) :]: place for name, place in self.at.items() if name.startswith(AIR)}
        self.values = arrays.under("water").holding("constants", np.array(list(numbers.values())), "number")

    def numbers_of(self, water: Water, gravity: float) -> dict[str, float]:
        """The numbers (SI) of a scene's water by name, those of its air after its own."""
        length, sound, pull = water.length, water.sound_speed, water.pull
        value, slope = self.kernel.factors(length, self.axes)
        numbers = {
            "shrink": 0.5 / length,  # 1/(2h): t = 1 − r/(2h)
            "value": value,
            "slope": slope,
            "floor": FLOOR * length**2,
            "density": water.density,
            "stiffness": water.density * sound**2,  # ρ0 c0², Pa
            "background": water.background,
            "thinnest": float(self.state.deviation(-water.background / (water.density * sound**2))),
            "spread": water.delta * length * sound,  # δ h c0, m²/s
            "strength": self.viscosity.strength(water, self.axes),
            "hydrostatic": gravity / sound**2,  # g/c0², 1/m
            "spacing": water.spacing,
            "reach": water.reach,
            "hard": water.density * (HARD * sound / water.spacing) ** 2 / (slope * water.spacing**self.axes),
            "fastest": FASTEST * sound,
            "shift": self.shifting.strength(water) * slope if self.shifting.acts else 0.0,
            "shift_most": 0.5 * water.speed,
            "shift_scale": value / self.kernel.printed(water.spacing, length, self.axes),
            "end_walls": EndWallFriction.rate(water),  # 1/s
            "pull": pull.rate**2 if pull else 0.0,
            "pull_y": pull.centre[0] if pull else 0.0,
            "pull_z": pull.centre[1] if pull else 0.0,
        }
        numbers |= VoidIndicator.numbers(self.kernel, length, sound, self.axes)
        numbers |= Reinitialisation.numbers(self.kernel, water, self.axes)
        return numbers | (of_air(water, gravity, numbers, self.viscosity) if self.two else {})

    def become(self, water: Water, gravity: float) -> None:
        """Take the numbers of another water with the same models."""
        self.numbers = self.numbers_of(water, gravity)
        self.values.from_numpy(np.array(list(self.numbers.values())))

    @ti.func
    def get(self, name: ti.template()):
        """The constant of that name."""
        return self.values[ti.static(self.at[name])]

    @ti.func
    def of(self, name: ti.template(), gas: ti.template()):
        """The constant of that name: of particles of water where `gas` is 0, of air where it is 1."""
        if ti.static(self.two):
            return (1.0 - gas) * self.get(name) + gas * self.values[ti.static(self.at_air[name])]
        else:
            return self.get(name)

    @ti.func
    def pressure_of_air(self, s):
        """The pressure (Pa) of air at a density deviation, a single number."""
        pressure = self.get("air_stiffness") * self.gas.share(s)
        if ti.static(self.coheres):
            pressure += self.get("cohesion") * self.cohesion.share(s)
        return pressure

    @ti.func
    def strength(self):
        """The factor (Pa s) of the pairs' viscous sums; of two phases each pair has its own."""
        return 1.0 if ti.static(self.two) else self.get("strength")

    @ti.func
    def drag(self, gas: ti.template(), there):
        """The strength of viscosity (Pa s) between particles with these numbers of their phases, 0 or 1."""
        other = gas - there
        return (
            (1.0 - gas) * (1.0 - there) * self.get("strength")
            + gas * there * self.get("air_strength")
            + other * other * self.get("both_strength")
        )

    @ti.func
    def clipped(self, pressure: ti.template(), gas: ti.template()):
        """The pressure (Pa) with which walls may push: not below zero where there is a free surface."""
        if ti.static(self.full):
            return pressure
        elif ti.static(self.two):
            return ti.max(pressure, gas * (0.0 - PULL))
        else:
            return ti.max(pressure, 0.0)

    def pressures(self, deviation: np.ndarray, gas: np.ndarray) -> np.ndarray:
        """Pressures (Pa) over that of the surroundings, for density deviations and phases of the same shape."""
        water = self.numbers["stiffness"] * self.state.pressure(deviation)
        if not self.two:
            return water
        thin = np.maximum(deviation, -0.999)
        air = self.numbers["air_stiffness"] * self.gas.pressure(thin)
        return np.where(gas > 0.5, air + self.cohesion.pressure(self.numbers["cohesion"], thin), water)

    @ti.func
    def hardness(self, square, firm, gas: ti.template()):
        """What a wall particle adds at the squared distance (m²), per volume: a thin layer does not pass the wall.

        A spring up to the distance `firm` (m), that of the wall particle from its wall's face, for pressure alone does
        not hold water that parts along a wall it nears. With air, `firm` is the depth of each layer: all of them hold
        air.
        """
        away = ti.sqrt(square + self.get("floor"))
        if ti.static(self.two):
            layer = firm / self.get("spacing") - (0.5 + FIRM)
            for_water = ti.select(layer * layer < 0.0625, firm, 0.0 * firm)
            spring = ti.max(((1.0 - gas) * for_water + gas * firm) / away - 1.0, 0.0)
            # Air that is driven deep comes near to walls, which must not throw it back at many times its speed.
            return self.of("hard", gas) * ti.min(spring, 1.0 + (1.0 - gas) * PULL)
        else:
            return self.get("hard") * ti.max(firm / away - 1.0, 0.0)
