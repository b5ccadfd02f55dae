"""The water's force on W hulls in waves as Taichi functions: `loads.Floating` for the time loop."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.state import State
from solvers.motion.frame import turned
from solvers.motion.harmonic import soft_start
from solvers.ship.loads import Floating
from solvers.ship.motion import Ship
from solvers.ship.section import Immersible


@ti.data_oriented
class Hulls:
    """Outlines, waves and openings of W ships whose loads are `Floating`, padded to the largest numbers of these.

    `openings`: points (m) of each hull through which it floods.
    """

    def __init__(self, arrays: State, ships: Sequence[Ship], openings: Sequence[Sequence[tuple[float, float]]]):
        self.exact = arrays.exact
        loads = [ship.load for ship in ships]
        chains = [chain(load.section) for load in loads]
        self.corners = max(len(shares) for _, shares in chains)
        self.waves = max(len(load.waves.amplitude) for load in loads)

        own = arrays.under("hull")

        def table(name: str, values, axes: str) -> ti.Field:
            return own.holding(name, np.array(values, dtype=float), f"world {axes}", own.exact, kept=True)

        self.outline = table("outline", [self._padded(corners) for corners, _ in chains], "corner direction")
        self.share = table("share", [self._padded(shares) for _, shares in chains], "corner")
        self.pressure = table("pressure", [load.water.density * load.water.gravity for load in loads], "")
        self.about = table("about", [load.about for load in loads], "direction")
        self.openings = max(len(points) for points in openings)
        if self.openings:
            places = [[*points, *[(0.0, 0.0)] * (self.openings - len(points))] for points in openings]
            self.opening = table("opening", places, "opening direction")
            counts = np.array([len(points) for points in openings])
            self.opened = own.holding("opened", counts, "world", ti.i32, kept=True)
        if self.waves:
            self.length = table("length", [load.waves.soft_start for load in loads], "")
            number, frequency, real_part, imaginary_part = self._of_waves(loads)
            self.number = table("number", number, "wave")
            self.frequency = table("frequency", frequency, "wave")
            self.real_part = table("real_part", real_part, "wave factor")
            self.imaginary_part = table("imaginary_part", imaginary_part, "wave factor")

    def _of_waves(self, loads: Sequence[Floating]) -> list[list[np.ndarray]]:
        """Wave numbers, frequencies, and real and imaginary parts of the factors, per ship and wave component.

        The factors of a component, each times its complex amplitude, are those of elevation, slope and excess force
        (`Floating.factors`).
        """
        factors = [load.waves.amplitude[:, None] * load.factors for load in loads]
        of_ships = [
            (load.waves.wave_number, load.waves.frequency, factor.real, factor.imag)
            for load, factor in zip(loads, factors, strict=True)
        ]
        return [[self._filled(values) for values in column] for column in zip(*of_ships, strict=True)]

    def meet(self, loads: Sequence[Floating]) -> None:
        """Change the waves from now on, to others with as many components."""
        fields = self.number, self.frequency, self.real_part, self.imaginary_part
        for field, values in zip(fields, self._of_waves(loads), strict=True):
            field.from_numpy(np.array(values))

    def _padded(self, values: np.ndarray) -> np.ndarray:
        """Values of corners padded with copies of the last, which add edges of zero length."""
        return np.pad(values, ((0, self.corners - len(values)), *[(0, 0)] * (values.ndim - 1)), "edge")

    def _filled(self, values: np.ndarray) -> np.ndarray:
        whole = np.zeros((self.waves, *values.shape[1:]))
        whole[: len(values)] = values
        return whole

    @ti.func
    def water(self, w, pose, t):
        """Force y, z (N/m) and moment (N) about P at a pose of P (m, m, rad) and a time (s)."""
        arm = turned(self.about[w, 0], self.about[w, 1], pose[2])
        sea = self.sea(w, pose[0] - arm[0], t)
        force = self.buoyancy(w, pose[1] - arm[1], pose[2], arm, sea[0], sea[1])
        return force + ti.Vector([sea[2], sea[3], sea[4]])

    @ti.func
    def calm(self, w, pose):
        """Force and moment about P in calm water."""
        arm = turned(self.about[w, 0], self.about[w, 1], pose[2])
        zero = ti.cast(0.0, self.exact)
        return self.buoyancy(w, pose[1] - arm[1], pose[2], arm, zero, zero)

    @ti.func
    def floods(self, w, pose, t):
        """Whether an opening is below the local water surface; see `loads.Floating.depths`."""
        arm = turned(self.about[w, 0], self.about[w, 1], pose[2])
        found = False
        for k in range(self.opened[w]):
            place = turned(self.opening[w, k, 0], self.opening[w, k, 1], pose[2])
            y, z = pose[0] - arm[0] + place[0], pose[1] - arm[1] + place[1]
            if self.sea(w, y, t)[0] > z:
                found = True
        return found

    @ti.func
    def sea(self, w, y, t):
        """Elevation (m) and slope of the surface at the hull's origin, and the excess force over their buoyancy."""
        sums = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(5))])
        if ti.static(self.waves > 0):
            for n in range(self.waves):
                phase = self.number[w, n] * y - self.frequency[w, n] * t
                cos, sin = ti.cos(phase), ti.sin(phase)
                for k in ti.static(range(5)):
                    sums[k] = sums[k] + self.real_part[w, n, k] * cos - self.imaginary_part[w, n, k] * sin
            start = soft_start(t, self.length[w])[0]
            for k in ti.static(range(5)):
                sums[k] = start * sums[k]
        return sums

    @ti.func
    def buoyancy(self, w, heave, roll, arm, elevation, slope):
        """Force and moment about P, `arm` (m) from the hull's origin; see `hydrostatics.buoyancy` and `section`."""
        area, moment = ti.cast(0.0, self.exact), ti.cast(0.0, self.exact)
        depth_moment = ti.cast(0.0, self.exact)
        cos, sin = ti.cos(roll), ti.sin(roll)
        before = self.corner(w, 0, heave, cos, sin, elevation, slope)
        for k in range(1, self.corners):
            after = self.corner(w, k, heave, cos, sin, elevation, slope)
            y0, d0, y1, d1 = before[0], ti.max(before[1], 0.0), after[0], ti.max(after[1], 0.0)
            if (before[1] > 0.0) != (after[1] > 0.0):
                crossing = y0 + before[1] / (before[1] - after[1]) * (y1 - y0)
                if before[1] > 0.0:
                    y1 = crossing
                else:
                    y0 = crossing
            along = self.share[w, k] * (y1 - y0)
            area += 0.5 * along * (d0 + d1)
            moment += along / 6.0 * (y0 * (2.0 * d0 + d1) + y1 * (d0 + 2.0 * d1))
            depth_moment += along / 6.0 * (d0 * d0 + d0 * d1 + d1 * d1)
            before = after
        height = elevation * area + slope * moment - depth_moment
        lever_y, lever_z = moment - arm[0] * area, height - (heave + arm[1]) * area
        return self.pressure[w] * ti.Vector([-slope * area, area, lever_y + slope * lever_z])

    @ti.func
    def corner(self, w, k, heave, cos, sin, elevation, slope):
        """A corner's y from the hull's origin and its depth below the surface (m)."""
        along, up = self.outline[w, k, 0], self.outline[w, k, 1]
        y, z = cos * along - sin * up, sin * along + cos * up
        return ti.Vector([y, elevation + slope * y - heave - z])


def chain(hull: Immersible) -> tuple[np.ndarray, np.ndarray]:
    """Corners (k, 2) m of a hull's outlines, each closed, and the share of the edge before each, 0 between outlines."""
    closed = [np.concatenate([outline[-1:], outline]) for outline, _ in hull.outlines]
    shares = [np.concatenate([[0.0], np.full(len(outline), share)]) for outline, share in hull.outlines]
    return np.concatenate(closed), np.concatenate(shares)
