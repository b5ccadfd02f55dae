"""Slow tilting: at a constant rate to an angle, a hold, and optionally back."""

from dataclasses import dataclass
from math import pi, sqrt
from typing import Annotated

import taichi as ti

from solvers.machine.marks import Cheap, Doc, Interval, Unit, Usual

KNOTS = 8


@ti.func
def rate_programme(table: ti.template(), w, first, t):
    """Angle, rate and acceleration at time t of a rate that is piecewise linear between (time, rate) knots.

    The angle is the exact integral of the rate, so the three are consistent to rounding.
    """
    angle, rate, acceleration = 0.0, 0.0, 0.0
    for k in range(KNOTS - 1):
        start, after = table[w, first + 2 * k], table[w, first + 2 * k + 2]
        rate_start, rate_after = table[w, first + 2 * k + 1], table[w, first + 2 * k + 3]
        if t > start and after > start:
            slope = (rate_after - rate_start) / (after - start)
            passed = ti.min(t, after) - start
            angle += passed * (rate_start + 0.5 * slope * passed)
            if t <= after:
                rate = rate_start + slope * passed
                acceleration = slope
    return ti.Vector([angle, rate, acceleration])


@dataclass(frozen=True)
class Tilt:
    """φ = ∫ rate dt: slow turning of the tank about a fixed point.

    Source: none is needed, the programme of the rate is the user's. The rate rises and falls linearly over the time
    `ease`, so that the angular acceleration stays finite. A negative angle tilts to starboard. With `reverse` the tank
    turns back to upright after the hold, at the same rate.

    Limits: a tilt too short to reach its rate turns at a lower one; at angles at which a bed slides the rate matters.

    Units: φ rad, rate rad/s, t s.
    """

    rate: Annotated[
        float, Unit("rad/s"), Interval(gt=0), Cheap(), Usual(pi / 1800, pi / 3, "deg/s"), Doc("Speed of turning.")
    ]
    angle: Annotated[
        float, Unit("rad"), Usual(-pi / 2, pi / 2, "deg"), Doc("Angle to turn to; a negative one is to starboard.")
    ]
    centre: Annotated[tuple[float, float], Unit("m"), Doc("The fixed point, y and z, about which the tank turns.")] = (
        0.0,
        0.0,
    )
    hold: Annotated[float, Unit("s"), Interval(ge=0), Doc("How long the tank stays at the angle.")] = 0.0
    reverse: Annotated[bool, Doc("Turn back to upright after the hold, at the same rate.")] = False
    ease: Annotated[float, Unit("s"), Interval(gt=0), Doc("Time in which the rate rises and falls.")] = 0.1

    coordinate = "turn"
    state = staticmethod(rate_programme)

    def knots(self) -> list[tuple[float, float]]:
        """The programme as (time s, rate rad/s) knots."""
        size = abs(self.angle)
        if size == 0.0:
            return [(0.0, 0.0)]
        # A tilt too short to reach its rate has the same acceleration and a lower top rate.
        rate = min(self.rate, sqrt(size * self.rate / self.ease))
        ease = self.ease * rate / self.rate
        turning = size / rate + ease
        signed = rate if self.angle > 0 else -rate
        outward = [(0.0, 0.0), (ease, signed), (turning - ease, signed), (turning, 0.0)]
        if not self.reverse:
            return outward
        back = turning + self.hold
        return outward + [(back + t, -r) for t, r in outward]

    def duration(self) -> float:
        """Time until the programme has ended (s)."""
        return self.knots()[-1][0] + (0.0 if self.reverse else self.hold)

    def parameters(self, soft_start: float) -> list[float]:
        """The kernel's table; the tilt has its own easing, `soft_start` does not apply."""
        knots = self.knots()
        knots += [knots[-1]] * (KNOTS - len(knots))
        return [value for knot in knots for value in knot]

    def fastest(self, soft_start: float) -> float:
        """Largest rate (rad/s)."""
        return self.rate
