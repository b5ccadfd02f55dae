"""Pressure gauges: probes on the walls, among the wall particles but without volume, averaged and low-passed."""

import numpy as np
import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.given import Gauge
from solvers.fluid.state import Particles
from solvers.machine.state import Axis, State, padded, roomy
from solvers.motion.poses import Poses

USUAL = 8  # gauges, and probes of each, for which there is room at least
DRY = 0.5  # of what water can cover of a probe's kernel: half of it in a plane wall, a quarter in a corner


def probes(gauge: Gauge, outline: np.ndarray, spacing: float) -> np.ndarray:
    """Points (n, 2) m, at most half a spacing apart, along a gauge in the wall of a polygon (m, 2) nearest to it."""
    place = np.asarray(gauge.place, dtype=float)
    edges = np.roll(outline, -1, axis=0) - outline
    shares = np.clip(((place - outline) * edges).sum(axis=1) / (edges**2).sum(axis=1), 0.0, 1.0)
    nearest = np.linalg.norm(outline + shares[:, None] * edges - place, axis=1).argmin()
    along = edges[nearest] / np.linalg.norm(edges[nearest])
    count = max(1, int(np.ceil(2.0 * gauge.length / spacing)))
    return place + along * (gauge.length * ((np.arange(count) + 0.5) / count - 0.5))[:, None]


@ti.data_oriented
class Gauges:
    """What the pressure gauges of each world show (W, gauges), Pa, and the highest since it was last taken.

    A probe's pressure is extrapolated to the wall as a wall particle's is, less that of the background; where water
    covers less than DRY of the `open` part of its kernel (of each probe, what wall particles leave) it is zero. A gauge
    with the time constant τ follows by 1 − exp(−Δt/τ) of the difference in each step.
    """

    def __init__(
        self,
        arrays: State,
        particles: Particles,
        constants: Constants,
        poses: Poses,
        gauges: tuple[Gauge, ...],
        slots: list[np.ndarray],
        open_part: list[np.ndarray],
    ):
        self.particles, self.constants, self.count = particles, constants, len(gauges)
        self.poses = poses
        own, each = arrays.under("gauges"), (Axis("world", particles.worlds), Axis("gauge", roomy(self.count, USUAL)))
        self.shown, self.peak = own.reals(each, "shown", "peak", kind=own.exact)
        if self.count:
            ends, room = np.cumsum([0, *(len(slot) for slot in slots)]), each[1].length
            probes = roomy(int(ends[-1]), USUAL * room)
            self.number = own.holding("number", np.array([self.count]), "one", ti.i32)
            self.slots = own.holding("slots", padded(np.concatenate(slots), probes), "probe", ti.i32)
            self.open = own.holding("open", padded(np.concatenate(open_part), probes), "probe")
            self.ends = own.holding("ends", padded(ends, room + 1), "end", ti.i32)
            response = padded(np.array([gauge.response for gauge in gauges]), room)
            self.response = own.holding("response", response, "gauge", own.exact)

    def forget(self) -> None:
        """Show nothing, as before the first step."""
        self.shown.fill(0.0)
        self.peak.fill(0.0)

    @ti.func
    def measure(self, w, t, kick, dt):
        """Let the gauges of a world follow the pressures of their probes."""
        p = self.particles
        for gauge in range(self.number[0]):
            total = ti.cast(0.0, p.exact)
            for k in range(self.ends[gauge], self.ends[gauge + 1]):
                b, lane = w * p.stride + self.slots[k] // p.lanes, self.slots[k] % p.lanes
                if p.eigenvalue[b, lane] > DRY * self.open[k]:
                    total += ti.cast(self.at(b, lane), p.exact)
                    if ti.static(self.constants.pressed):
                        total -= ti.cast(self.constants.get("background"), p.exact)
                    if ti.static(self.constants.modified):
                        total += self.head(w, b, lane)
            mean = total / (self.ends[gauge + 1] - self.ends[gauge])
            follows = ti.cast(1.0, p.exact)
            if self.response[gauge] > 0.0:
                follows = 1.0 - ti.exp(0.0 - ti.cast(dt, p.exact) / self.response[gauge])
            self.shown[w, gauge] = self.shown[w, gauge] + follows * (mean - self.shown[w, gauge])
            self.peak[w, gauge] = ti.max(self.peak[w, gauge], self.shown[w, gauge])

    @ti.func
    def head(self, w, b, lane):
        """What the pressure (Pa) of a probe is over that which is reduced, see `ReducedPressure`."""
        p, c = self.particles, self.constants
        pull = [self.poses.felt[a][w] for a in ti.static(range(p.axes))]
        place = [ti.cast(p.place[a][b, lane], p.exact) for a in ti.static(range(p.axes))]
        return c.reduced.above(c, pull, place)

    @ti.func
    def at(self, b, lane):
        """The pressure (Pa) of a probe; of two phases the water's where that is more than DRY of both, else the air's.

        So one and two phases show water alike, and where without air it is zero a gauge shows the air. A bubble of a
        particle or two, which keeps the density at which it was cut off (`Dispersed`), is not shown.
        """
        p = self.particles
        if ti.static(p.two):
            return ti.select(p.share[b, lane] > DRY, p.pressure[b, lane], p.pressure_of_air[b, lane])
        else:
            return p.pressure[b, lane]

    def read_and_reset(self) -> dict[str, np.ndarray]:
        """What the gauges show, and their peaks (W, gauges), which begin anew from here."""
        shown, peak = self.shown.to_numpy()[:, : self.count], self.peak.to_numpy()[:, : self.count]
        self.peak.from_numpy(self.shown.to_numpy())
        return {"gauge_pressure": shown, "gauge_peak": peak}
