"""The sea outside the ship, and the waves on it."""

from dataclasses import dataclass
from typing import Annotated, Literal

from solvers.machine.marks import Doc, Interval, Unit, Usual

AngularFrequency = Annotated[float, Unit("rad/s"), Interval(gt=0)]
Height = Annotated[float, Unit("m"), Interval(ge=0)]


@dataclass(frozen=True)
class Sea:
    """The water that the ship floats in."""

    density: Annotated[float, Unit("kg/m^3"), Interval(ge=500, le=2000), Doc("Density of the sea's water.")] = 1000.0
    depth: Annotated[
        Annotated[float, Unit("m"), Interval(ge=1e-3, le=2e4)] | None, Doc("Depth of the sea; it is deep without it.")
    ] = None


@dataclass(frozen=True)
class Waves:
    """Waves that travel to starboard: regular ones, a packet, or a random sea."""

    frequency: Annotated[
        AngularFrequency,
        Usual(2.5, 10.0, "rad/s"),
        Doc("Angular frequency; of a random sea that of the peak, of white noise the middle."),
    ]
    kind: Annotated[
        Literal["regular", "packet", "jonswap", "pierson-moskowitz", "white-noise"], Doc("Kind of waves.")
    ] = "regular"
    amplitude: Annotated[
        Height | None, Usual(0.0, 0.05, "mm"), Doc("Amplitude of regular waves, or of a packet at its peak.")
    ] = None
    height: Annotated[Height | None, Usual(0.0, 0.1, "mm"), Doc("Significant wave height of a random sea.")] = None
    spread: Annotated[
        AngularFrequency | None,
        Doc("Standard deviation of a packet's frequency; of white noise half the breadth of its band."),
    ] = None
    time: Annotated[Annotated[float, Unit("s"), Interval(ge=0)] | None, Doc("When a packet peaks at the ship.")] = None
    peakedness: Annotated[float, Interval(ge=1, le=10), Doc("Peakedness of the JONSWAP spectrum.")] = 3.3
    seed: Annotated[int, Interval(ge=0, le=2**31 - 1), Doc("Seed of a random sea's phases.")] = 1
    soft_start: Annotated[float, Unit("s"), Interval(ge=0), Doc("Time in which the waves come up.")] = 0.0
    begin: Annotated[float, Unit("s"), Interval(ge=0), Doc("Time in the life of the waves at which a run begins.")] = (
        0.0
    )
