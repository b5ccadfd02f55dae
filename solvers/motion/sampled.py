"""A motion that is known as a function of time: smooth curves through samples of it, as fine as they need to be."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.motion.history import Recorded

FEWEST, MOST = 1024, 65_536  # intervals between samples
TOLERANCE = 1e-3  # of the acceleration, both as root mean squares over the motion
STILL = 1e-4  # of the largest speed: a motion that is slower at an end counts as at rest there
GROWS = 1.35  # a peak of the acceleration that grows by this with twice the samples has no end: it doubles at a jump
STAYS = 0.75  # of the largest way between two samples: with twice the samples it halves, unless the place jumps
ASIDE = 0.381966  # of an interval, where places are compared: no period of a function goes by it


@dataclass(frozen=True)
class Sampled(Recorded):
    """Motion of one coordinate through samples of a function of time, joined as a record's by a cubic spline.

    The spline has no conditions at its ends ("not a knot"), since it follows the function there as well as anywhere.
    Its speed and acceleration are the derivatives of its place (de Boor 1978, A Practical Guide to Splines, chapter
    IV): all three are consistent. `place_error` (m or rad) is the largest distance of the spline from the function, as
    seen between the samples, and `acceleration_error` (of 1) the change of the acceleration by half the samples.
    """

    place_error: float = 0.0
    acceleration_error: float = 0.0

    @cached_property
    def curve(self):
        """The spline (scipy CubicSpline) over the time since the first sample."""
        return spline(np.array(self.time), np.array(self.values))

    @cached_property
    def rests(self) -> tuple[bool, bool]:
        """Whether it is at rest at its first and at its last sample."""
        speed = np.abs(self.curve(self.curve.x, 1))
        return bool(speed[0] <= STILL * speed.max()), bool(speed[-1] <= STILL * speed.max())


class Jump(ValueError):
    """A function jumps at the `time` (s), itself or its speed (`what`)."""

    def __init__(self, what: str, time: float) -> None:
        super().__init__(f"its {what} jumps at about {time:.4g} s")
        self.what, self.time = what, time


def sampled(
    place: Callable[[float], Sequence[float]], length: float, coordinates: dict[str, tuple[float, float]]
) -> list[Sampled]:
    """The motions of these coordinates, each with its centre (m), from time 0 to `length` (s).

    place: the coordinates (m or rad) at a time (s). The samples are doubled until twice as many change the acceleration
    by TOLERANCE at most, or there are MOST. Where the acceleration jumps they never agree, and the error says so.
    Raises Jump where the place or the speed does.
    """
    count, time = FEWEST, np.linspace(0.0, length, FEWEST + 1)
    rough = _values(place, time)
    while True:
        count *= 2
        fine_time = np.linspace(0.0, length, count + 1)
        fine = np.empty((len(coordinates), count + 1))
        fine[:, ::2], fine[:, 1::2] = rough, _values(place, fine_time[1::2])
        aside = time[:-1] + ASIDE * np.diff(time)
        seen = _values(place, aside)
        curves = [(spline(time, one), spline(fine_time, two)) for one, two in zip(rough, fine, strict=True)]
        away = [float(np.abs(curve(aside) - one).max()) for (curve, _), one in zip(curves, seen, strict=True)]
        change = [_change(*pair) for pair in curves]
        if max(change) <= TOLERANCE or count >= MOST:
            break
        time, rough = fine_time, fine
    if max(change) > TOLERANCE:
        _refuse_jumps(curves)
    found = zip(coordinates.items(), fine, away, change, strict=True)
    times = tuple(fine_time.tolist())
    return [Sampled(name, times, tuple(row.tolist()), centre, a, c) for (name, centre), row, a, c in found]


def spline(time: np.ndarray, values: np.ndarray):
    """The cubic spline through values (n,), whose third derivative is continuous next to its ends, too."""
    from scipy.interpolate import CubicSpline  # slow to import

    return CubicSpline(time, values)


def _values(place: Callable[[float], Sequence[float]], time: np.ndarray) -> np.ndarray:
    """The coordinates (k, n) at times (n,)."""
    return np.array([place(float(t)) for t in time]).T


def _change(rough, fine) -> float:
    """By how much of it twice the samples change the acceleration, both as root mean squares."""
    new = fine(fine.x, 2)
    size = float(np.sqrt(np.mean(new**2)))
    moved = float(np.abs(fine(fine.x)).max()) / fine.x[-1] ** 2
    if size <= 1e-9 * moved:  # rounding alone, as of a tank that moves at a steady speed
        return 0.0
    return float(np.sqrt(np.mean((new - rough(fine.x, 2)) ** 2))) / size


def _refuse_jumps(curves: Sequence) -> None:
    """Raise Jump where the largest acceleration grows with the number of samples."""
    for rough, fine in curves:
        bent, before = np.abs(fine(fine.x, 2)), np.abs(rough(rough.x, 2)).max()
        if bent.max() > GROWS * before:
            ways = [np.abs(np.diff(curve(curve.x))).max() for curve in (rough, fine)]
            raise Jump("place" if ways[1] > STAYS * ways[0] else "speed", float(fine.x[bent.argmax()]))
