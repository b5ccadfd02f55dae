"""What of a hull or of rooms is below a level surface, with heel and trim: volumes, their moments, and the surface.

In the hull's axes turned by her roll, x forward, y across and z up, the surface is the plane z = level + slope x; a
slope above 0 puts her bow deeper. Heights above it are (z − level − slope x) / √(1 + slope²), exactly, at any trim.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.ship.naval.form import Form

GAUSS = np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)]), np.array([5.0, 8.0, 5.0]) / 18.0  # exact for quintics


@dataclass(frozen=True, eq=False)
class Wet:
    """Of n bodies what is below the surface: volume (n,) m³, moments ∫x, ∫y, ∫z dV (n, 3) m⁴, surface dV/dlevel m²."""

    volume: np.ndarray
    moment: np.ndarray
    surface: np.ndarray

    @property
    def centre(self) -> np.ndarray:
        """Centres (n, 3) m in the turned axes; 0 where all is dry."""
        safe = np.where(self.volume > 0.0, self.volume, 1.0)
        return np.where(self.volume[:, None] > 0.0, self.moment / safe[:, None], 0.0)


class Prisms:
    """Polygons (m, 2) of y, z from x = `aft` to `forward` (n,) m each."""

    def __init__(self, outlines: Sequence[np.ndarray], aft: Sequence[float], forward: Sequence[float]):
        most = max(map(len, outlines), default=0) + 1
        closed = [np.concatenate([one, np.repeat(one[:1], most - len(one), axis=0)]) for one in outlines]
        self.corners = np.array(closed, dtype=float).reshape(len(closed), most, 2)
        self.aft, self.forward = np.asarray(aft, dtype=float), np.asarray(forward, dtype=float)
        y, z = self.corners[..., 0], self.corners[..., 1]
        area = 0.5 * (y[:, :-1] * z[:, 1:] - y[:, 1:] * z[:, :-1]).sum(axis=1)
        self.volume = np.abs(area) * (self.forward - self.aft)
        width = np.ptp(self.corners, axis=1).max(initial=0.0)
        self.size = float(max(width, (self.forward - self.aft).max(initial=0.0)))

    def turned(self, roll: float) -> tuple[np.ndarray, np.ndarray]:
        """The corners' y and z (n, m + 1) m at a roll (rad), closed."""
        cos, sin = np.cos(roll), np.sin(roll)
        y, z = self.corners[..., 0], self.corners[..., 1]
        return cos * y - sin * z, sin * y + cos * z

    def reach(self, slope: float, roll: float) -> tuple[np.ndarray, np.ndarray]:
        """The levels (n,) m at which each body begins to be wet, and is wholly wet."""
        z = self.turned(roll)[1]
        ends = slope * np.stack([self.aft, self.forward])
        return z.min(axis=1) - ends.max(axis=0), z.max(axis=1) - ends.min(axis=0)

    def wet(self, level: np.ndarray, slope: float, roll: float) -> Wet:
        """What is below `level` (n,) m, exactly: between the places where corners go under all is polynomial in x."""
        y, z = self.turned(roll)
        if slope == 0.0:
            x = 0.5 * (self.aft + self.forward)[:, None]
            weight = (self.forward - self.aft)[:, None]
        else:
            places = np.clip((z - level[:, None]) / slope, self.aft[:, None], self.forward[:, None])
            places = np.sort(np.column_stack([self.aft, places, self.forward]), axis=1)
            half, middle = 0.5 * np.diff(places, axis=1), 0.5 * (places[:, 1:] + places[:, :-1])
            shape = len(level), half.shape[1] * len(GAUSS[0])
            x = (middle[..., None] + half[..., None] * GAUSS[0]).reshape(shape)
            weight = (2.0 * half[..., None] * GAUSS[1]).reshape(shape)
        area, along, up, breadth = cut(y[:, None], z[:, None], (level[:, None] + slope * x)[..., None])
        moment = np.stack([(weight * part).sum(axis=1) for part in (x * area, along, up)], axis=1)
        return Wet((weight * area).sum(axis=1), moment, (weight * breadth).sum(axis=1))


class Stations:
    """A hull by her stations (`solvers.ship.naval.form.Form`): one body, summed along her as there."""

    def __init__(self, form: Form):
        kept = [k for k, one in enumerate(form.sections) if one is not None]
        outlines = [form.sections[k].outline for k in kept]
        self._x, self._weights = form.x[kept], form.weights[kept]
        self._prisms = Prisms(outlines, self._x, self._x)
        self.aft, self.forward = form.x[:1], form.x[-1:]
        self.volume = np.array([form.volume])
        self.size = float(max(self._prisms.size, np.ptp(form.x)))

    def reach(self, slope: float, roll: float) -> tuple[np.ndarray, np.ndarray]:
        """The levels (1,) m at which she begins to be wet, and is wholly wet."""
        low, high = self._prisms.reach(slope, roll)
        return low.min(keepdims=True), high.max(keepdims=True)

    def wet(self, level: np.ndarray, slope: float, roll: float) -> Wet:
        """What of her is below a level (1,) m."""
        y, z = self._prisms.turned(roll)
        area, along, up, breadth = cut(y, z, (level + slope * self._x)[:, None])
        moment = [self._weights @ part for part in (self._x * area, along, up)]
        return Wet(np.array([self._weights @ area]), np.array([moment]), np.array([self._weights @ breadth]))


class Less:
    """A hull without rooms that are open to the sea: what is left of her buoyancy. `share` (n,) of them is lost."""

    def __init__(self, hull: "Prisms | Stations", rooms: Prisms, share: np.ndarray):
        self._hull, self._rooms, self._share = hull, rooms, share
        self.aft, self.forward, self.size = hull.aft, hull.forward, hull.size
        self.volume = hull.volume - share @ rooms.volume

    def reach(self, slope: float, roll: float) -> tuple[np.ndarray, np.ndarray]:
        """The levels (1,) m at which she begins to be wet, and is wholly wet."""
        return self._hull.reach(slope, roll)

    def wet(self, level: np.ndarray, slope: float, roll: float) -> Wet:
        """What of her buoyancy is below a level (1,) m."""
        whole = self._hull.wet(level, slope, roll)
        lost = self._rooms.wet(np.repeat(level, len(self._share)), slope, roll)
        moment = whole.moment - (self._share @ lost.moment)[None]
        return Wet(whole.volume - self._share @ lost.volume, moment, whole.surface - self._share @ lost.surface)


def cut(y: np.ndarray, z: np.ndarray, level: np.ndarray) -> tuple[np.ndarray, ...]:
    """Of outlines, closed in the last axis, what is below a level (…, 1): ∫dA, ∫y dA, ∫z dA and the breadth there.

    By Green's theorem along the immersed edges, as in `solvers.ship.section`: in one pass, since it is asked often.
    """
    depth = level - z
    wet = depth > 0.0
    first, last = wet[..., :-1], wet[..., 1:]
    cuts = first != last
    d0, d1, y0, y1 = depth[..., :-1], depth[..., 1:], y[..., :-1], y[..., 1:]
    crossing = y0 + d0 / np.where(cuts, d0 - d1, 1.0) * (y1 - y0)
    begin, end = np.where(first, y0, crossing), np.where(last, y1, crossing)
    d0, d1 = np.where(first, d0, 0.0), np.where(last, d1, 0.0)
    along, both = np.where(first | last, end - begin, 0.0), d0 + d1
    area = 0.5 * (along * both).sum(-1)
    across = (along * (begin * (d0 + both) + end * (both + d1))).sum(-1) / 6.0
    deep = (along * (both * both - d0 * d1)).sum(-1) / 6.0
    breadth = np.where(cuts, np.where(first, crossing, -crossing), 0.0).sum(-1)
    return area, across, level[..., 0] * area - deep, breadth
