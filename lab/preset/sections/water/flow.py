"""How the water of a preset moves at first, and the point that pulls at it."""

from dataclasses import dataclass
from typing import Annotated

from solvers.machine.marks import Doc, Interval, Unit


@dataclass(frozen=True)
class Flow:
    """How water without weight moves at first, and a point that pulls at it, under the pressure that this takes.

    The water floats free of walls, or fills a periodic tank with vortices. See `solvers.fluid.start.flow`.
    """

    strain: Annotated[
        float,
        Unit("1/s"),
        Doc("Rate σ of strain, with velocities σ (y, −z) from the centre; below zero it is along z."),
    ] = 0.0
    rotation: Annotated[float, Unit("rad/s"), Doc("Rate ω of rotation, with velocities ω (−z, y) from the centre.")] = (
        0.0
    )
    pull: Annotated[
        float,
        Unit("rad/s"),
        Interval(ge=0),
        Doc("Rate Ω of a force −Ω² r per mass towards the centre, which acts throughout the run."),
    ] = 0.0
    centre: Annotated[
        Annotated[tuple[float, float], Unit("m")] | None,
        Doc("The centre of these, y and z in the tank; the water's centre of mass without it."),
    ] = None
    vortices: Annotated[
        float,
        Unit("m/s"),
        Interval(ge=0),
        Doc('Highest speed of Taylor and Green\'s vortices, two by two in a tank with water.periodic = "yz".'),
    ] = 0.0

    @property
    def free(self) -> bool:
        """Whether there is anything but vortices, for which water floats free."""
        return bool(self.strain or self.rotation or self.pull)
