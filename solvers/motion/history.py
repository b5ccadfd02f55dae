"""Recorded motion: smooth curves through samples of sway, heave, surge, roll, pitch and yaw at any spacing."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np
import taichi as ti

from solvers.machine.marks import Unit
from solvers.motion.harmonic import STEEPEST, soft_start

LEAST_SAMPLES = 4  # needed for a cubic spline
HEAD = 2  # numbers in the kernel's table before the pieces
PIECE = 5  # numbers per piece: the time at which it begins, and its four coefficients
COORDINATES = {"roll": "turn", "pitch": "pitch", "yaw": "yaw", "sway": "y", "heave": "z", "surge": "x"}
SLOW = 0.05  # of the largest speed: a record counts as at rest at an end if it is slower there


@ti.func
def recorded(table: ti.template(), w, first, t):
    """Displacement, velocity and acceleration at time t of D(t) x(t); at rest before t = 0.

    x is piecewise cubic, x = c₀ + c₁ s + c₂ s² + c₃ s³ with s the time since the piece began. The last piece has no
    end. D is the soft start.
    """
    displacement, velocity, acceleration = ti.zero(t), ti.zero(t), ti.zero(t)
    if t >= 0.0:
        begin = first + HEAD
        low, high = 0, ti.cast(table[w, first], ti.i32)
        while high - low > 1:  # the piece that t is in, by bisection
            middle = (low + high) // 2
            if table[w, begin + PIECE * middle] <= t:
                low = middle
            else:
                high = middle
        piece = begin + PIECE * low
        s = t - table[w, piece]
        c0, c1, c2, c3 = table[w, piece + 1], table[w, piece + 2], table[w, piece + 3], table[w, piece + 4]
        x = c0 + s * (c1 + s * (c2 + s * c3))
        v = c1 + s * (2.0 * c2 + s * 3.0 * c3)
        a = 2.0 * c2 + s * 6.0 * c3
        d = soft_start(t, table[w, first + 1])
        displacement = d[0] * x
        velocity = d[1] * x + d[0] * v
        acceleration = d[2] * x + 2.0 * d[1] * v + d[0] * a
    return ti.Vector([displacement, velocity, acceleration])


@dataclass(frozen=True)
class Recorded:
    """Motion of one coordinate through `values` (m or rad) at the rising times `time` (s).

    It is "y", "z" or "turn", in space also "x", "pitch" or "yaw". The first sample is at the start of the motion. The
    samples are joined by the cubic spline with continuous acceleration (de Boor 1978, A Practical Guide to Splines,
    chapter IV). At an end where the record is at rest the spline's slope is zero, so that the tank starts or stops
    without a jump of its speed. At any other end the spline follows the record's own speed ("not a knot"), since a zero
    slope would add a jolt that was not recorded. After the last sample the tank keeps its last speed, which is zero if
    the record comes to rest.
    """

    coordinate: str
    time: tuple[float, ...]
    values: tuple[float, ...]
    centre: tuple[float, float] = (0.0, 0.0)

    state = staticmethod(recorded)

    @cached_property
    def curve(self):
        """The spline (scipy CubicSpline) over the time since the first sample."""
        from scipy.interpolate import CubicSpline  # slow to import, and only records of motion need it

        time = np.array(self.time) - self.time[0]
        ends = [(1, 0.0) if rests else "not-a-knot" for rests in self.rests]
        return CubicSpline(time, self.values, bc_type=tuple(ends))

    @cached_property
    def rests(self) -> tuple[bool, bool]:
        """Whether the record is at rest at its first and at its last sample."""
        return at_rest(self.time, self.values)

    def duration(self) -> float:
        """Time from the first sample to the last (s)."""
        return self.time[-1] - self.time[0]

    def parameters(self, soft_start: float) -> list[float]:
        """The kernel's table: number of pieces, length of the soft start (s), then the pieces."""
        time, curve = self.curve.x, self.curve
        pieces = np.column_stack([time[:-1], curve.c[::-1].T])
        last_speed = 0.0 if self.rests[1] else float(curve(time[-1], 1))
        onwards = [float(time[-1]), self.values[-1], last_speed, 0.0, 0.0]
        return [len(time), soft_start, *pieces.ravel().tolist(), *onwards]

    def fastest(self, soft_start: float) -> float:
        """Upper bound on the speed (m/s or rad/s): the spline's largest plus the contribution of the soft start."""
        speed = _largest(self.curve.derivative())
        return speed + (STEEPEST / soft_start * _largest(self.curve) if soft_start else 0.0)

    def hardest(self) -> float:
        """The spline's largest acceleration (m/s² or rad/s²)."""
        return float(np.abs(self.curve(self.curve.x, 2)).max())  # it is linear between samples


def at_rest(time: Sequence[float], values: Sequence[float]) -> tuple[bool, bool]:
    """Whether a record (n,) at times (n,) is at rest at its first and at its last sample."""
    from scipy.interpolate import CubicSpline

    speed = np.abs(CubicSpline(time, values)(time, 1))
    limit = SLOW * speed.max()
    return bool(speed[0] <= limit), bool(speed[-1] <= limit)


def _largest(curve) -> float:
    """Largest absolute value of a piecewise polynomial, found at its knots and where its slope is zero."""
    turning = curve.derivative().roots(extrapolate=False)
    places = np.concatenate([curve.x, turning[np.isfinite(turning)]])
    return float(np.abs(curve(places)).max())


@dataclass(frozen=True)
class History:
    """Recorded motions of the tank at common times (s), m or rad; None for one that was not recorded.

    It rolls about `centre` (y, z), and in space pitches and yaws about the same point, x = 0.
    """

    time: Annotated[tuple[float, ...], Unit("s")]
    sway: Annotated[tuple[float, ...] | None, Unit("m")] = None
    heave: Annotated[tuple[float, ...] | None, Unit("m")] = None
    roll: Annotated[tuple[float, ...] | None, Unit("rad")] = None
    centre: Annotated[tuple[float, float], Unit("m")] = (0.0, 0.0)
    surge: Annotated[tuple[float, ...] | None, Unit("m")] = None
    pitch: Annotated[tuple[float, ...] | None, Unit("rad")] = None
    yaw: Annotated[tuple[float, ...] | None, Unit("rad")] = None

    @cached_property
    def motions(self) -> dict[str, Recorded]:
        """The recorded motions by name, innermost first: it turns about a centre that sways, heaves and surges."""
        y, z = self.centre
        centres = {"pitch": (z, 0.0), "yaw": (y, 0.0)}
        return {
            name: Recorded(coordinate, self.time, getattr(self, name), centres.get(name, self.centre))
            for name, coordinate in COORDINATES.items()
            if getattr(self, name) is not None
        }
