"""The water in the tank, and its gauges, as a preset gives them."""

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Literal

import numpy as np

from lab.preset.outline import simple_polygon
from lab.preset.sections.water.flow import Flow
from lab.preset.sections.water.schemes import SCHEMES
from solvers.fluid.diffusion import DIFFUSION
from solvers.fluid.kernels import KERNELS
from solvers.fluid.shifting import SHIFTING
from solvers.fluid.start.rest import STARTS
from solvers.fluid.states import STATES
from solvers.fluid.viscosity import VISCOSITY
from solvers.machine.marks import Cheap, Doc, Interval, Unit, Usual
from solvers.mixture.drag import DRAG

Length = Annotated[float, Unit("m"), Interval(gt=0)]
SIDES = 160  # of the polygon in place of a circle: 3e-4 less area


@dataclass(frozen=True)
class Water:
    """Water in the plane as particles: weakly compressible, δ-SPH.

    It stands level up to its `depth`, or fills a `region`, such as a column that collapses, or is a round drop of a
    `radius`; at rest, unless there is a `flow`. What of a region stands on nothing begins without pressure. The spacing
    is rounded so that a whole number of particles makes up the depth, or the height of the region. The models that are
    not given are those of the `scheme`, see `lab.preset.sections.water.schemes`.
    """

    depth: Annotated[
        Length | None,
        Usual(0.02, 1.0, "mm"),
        Doc("Depth of the water over the tank's lowest point; or give `region`. Further tanks have their own."),
    ] = None
    moisture: Annotated[
        Annotated[float, Interval(gt=0, lt=1)] | None,
        Doc("Share of the mass of grains and water together that is water, in place of `depth`."),
    ] = None
    saturation: Annotated[
        Annotated[float, Interval(gt=0, le=10)] | None,
        Doc("Share of the settled bed's pores that the water fills, in place of `depth`; over 1 it stands on the bed."),
    ] = None
    model: Annotated[
        Literal["sph", "linear", "frozen", "level"],
        Doc(
            "How water moves in a ship: as particles, by linear potential theory in box-shaped tanks, not at all, or "
            "as a weight whose surface is level at any heel."
        ),
    ] = "sph"
    swing_damping: Annotated[
        float, Interval(ge=0, le=1), Doc('Damping of each wave, a fraction of the critical, for model = "linear".')
    ] = 0.0
    added_mass: Annotated[
        Literal["none", "layer"],
        Doc(
            "Whether a ship has the mass of the layer of water before her tanks' walls on her own side: for water that "
            "is far heavier than she is."
        ),
    ] = "none"
    region: Annotated[
        Annotated[tuple[tuple[float, float], ...], Unit("m")] | None,
        Doc("Corners, y and z each, of the part of the tank that is filled with water, in place of `depth`."),
    ] = None
    radius: Annotated[Length | None, Doc("Radius of a round drop, in place of `depth`.")] = None
    centre: Annotated[
        Annotated[tuple[float, float], Unit("m")] | None, Doc("Middle of this drop, y and z in the tank.")
    ] = None
    flow: Annotated[Flow | None, Doc("How the water moves at first; it is at rest without it.")] = None
    periodic: Annotated[
        Literal["y", "z", "yz"] | None,
        Doc(
            "Axes along which space repeats itself with the width or height of the tank, a rectangle, which has no "
            "walls there."
        ),
    ] = None
    spacing: Annotated[
        Length | Literal["auto"],
        Cheap(),
        Usual(1e-3, 2e-2, "mm"),
        Doc("Distance of the particles; a share of the depth by the level of accuracy without it."),
    ] = "auto"
    density: Annotated[float, Unit("kg/m^3"), Interval(gt=0), Doc("Density at rest.")] = 1000.0
    sound_speed: Annotated[
        Annotated[float, Unit("m/s"), Interval(gt=0)] | Literal["auto"],
        Doc("Speed of sound of the weakly compressible water; ten times the expected speed without it."),
    ] = "auto"
    scheme: Annotated[Literal[*SCHEMES], Doc("Whose models and numbers are used where no others are given.")] = "lab"
    kernel: Annotated[
        Literal[*KERNELS] | None, Doc("Kernel that smooths over neighbours; the scheme's without it.")
    ] = None
    smoothing: Annotated[
        Annotated[float, Interval(ge=1, le=4)] | None,
        Doc("Smoothing length in spacings, half the kernel's radius; the scheme's without it."),
    ] = None
    state: Annotated[Literal[*STATES] | None, Doc("Equation of state; the scheme's without it.")] = None
    diffusion: Annotated[
        Literal[*DIFFUSION] | None, Doc("Diffusion of density, which quietens pressures; the scheme's without it.")
    ] = None
    delta: Annotated[
        Annotated[float, Interval(ge=0, le=1)] | None, Doc("Strength of that diffusion; the scheme's without it.")
    ] = None
    viscosity: Annotated[Literal[*VISCOSITY] | None, Doc("Viscous law; the scheme's without it.")] = None
    alpha: Annotated[
        Annotated[float, Interval(ge=0, le=1)] | None,
        Doc("Strength of the artificial viscosity; the scheme's without it."),
    ] = None
    kinematic_viscosity: Annotated[
        Annotated[float, Unit("m^2/s"), Interval(gt=0)] | None,
        Doc(
            'Viscosity of the liquid, for viscosity = "laminar", beside air "laminar-stress", between_walls, or grains.'
        ),
    ] = None
    drag: Annotated[
        Literal[*DRAG] | None, Doc('Law of the drag between grains and water in one tank; "di-felice" without it.')
    ] = None
    slip: Annotated[bool, Doc("Whether water slides along walls; else it sticks to them.")] = True
    between_walls: Annotated[
        bool,
        Doc(
            "Whether walls before and behind, the tank's length or thickness apart, hold the water back as well, by "
            "the friction of laminar flow between them; with the liquid's kinematic_viscosity, under any viscous law."
        ),
    ] = False
    full: Annotated[bool, Doc("Whether the water fills the whole tank, so that walls may pull at it.")] = False
    background_pressure: Annotated[
        Annotated[float, Unit("Pa"), Interval(ge=0)] | None,
        Doc(
            "Pressure that water in a full tank, or water and air, bear besides, so that suction tears nothing apart; "
            "without it 0.3 of the air's own pressure, at most ρ U², and none where there is no air."
        ),
    ] = None
    shifting: Annotated[
        Literal[*SHIFTING],
        Doc('How particles are shifted to even their distances; below a free surface take "delta-plus-momentum".'),
    ] = "none"
    start: Annotated[
        Literal[*STARTS],
        Doc("How the particles are laid: packed evenly up to walls and plates of any slant, or as a square lattice."),
    ] = "packed"

    @cached_property
    def shape(self) -> np.ndarray | None:
        """The polygon (m, 2) m of a region or a drop; None where the water stands level. Raises LabError."""
        if self.radius is not None:
            turns = 2.0 * np.pi * np.arange(SIDES) / SIDES
            return np.array(self.centre) + self.radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
        return None if self.region is None else np.array(simple_polygon(self.region))


@dataclass(frozen=True)
class Gauge:
    """A pressure gauge in a wall, a gauge of the water's depth, or one of the force on a whole edge of the tank."""

    kind: Annotated[Literal["pressure", "level", "force"], Doc("What it measures.")] = "pressure"
    place: Annotated[
        Annotated[tuple[float, float], Unit("m")] | None,
        Doc("Middle of a pressure gauge on the wall, y and z in the tank; of a force gauge, a point of its edge."),
    ] = None
    x: Annotated[
        Annotated[float, Unit("m")] | None, Doc("Where a gauge of pressure or level is along x, in space.")
    ] = None
    length: Annotated[
        Annotated[float, Unit("m"), Interval(ge=0)],
        Doc("Length of a pressure gauge along the wall; it shows the mean."),
    ] = 0.0
    radius: Annotated[
        Annotated[float, Unit("m"), Interval(ge=0)],
        Doc("Radius of a pressure gauge in space, a disc in one face of the tank; it shows the mean."),
    ] = 0.0
    response: Annotated[
        Annotated[float, Unit("s"), Interval(ge=0)], Doc("Time constant of a pressure gauge, a low-pass filter.")
    ] = 0.0
    y: Annotated[Annotated[float, Unit("m")] | None, Doc("Where a level gauge measures the depth over the floor.")] = (
        None
    )


@dataclass(frozen=True)
class DampingZone:
    """A beach: from `start` to `end` water is damped more and more, and waves that run in do not return."""

    start: Annotated[float, Unit("m"), Doc("Where it starts, along the tank's floor.")]
    end: Annotated[float, Unit("m"), Doc("Where it ends, and damps most; a wave's length away, or more.")]
    period: Annotated[float, Unit("s"), Interval(gt=0), Doc("Period of the waves that it is to take.")]
