"""What can touch a free body: the corners and edges of bodies and tanks, the pairs of them, and how stiff these are."""

from dataclasses import dataclass
from math import hypot, pi, sqrt

import numpy as np

from solvers.machine.limit import Limit
from solvers.space.impact import damping_ratio_for
from solvers.tank.outline import moments
from solvers.tank.parts import Part
from solvers.tank.tank import Tank

# Steps of half an undamped bounce on two corners, at least and times ζ: by `impact` in plain numbers, restitution from
# 0.05 to 1 is right to 1 %, wherever in a step it begins.
STEPS, DAMPED_STEPS = 28.0, 56.0
POISSON = 0.3  # of solids
SHEAR = 2.0 * (1.0 - POISSON) / (2.0 - POISSON)  # k_t/k of solids that are alike (Mindlin 1949)
DEEPEST = 0.5  # spacings of the water that a body may be pressed into a wall by the fall that is to be expected
LEAST_RESTITUTION = 0.05
STRAIGHT = 1e-6  # sine of the turn of a corner that is none
OF_TANK = -1  # in place of a part's number


@dataclass(frozen=True)
class Shape:
    """The outline of a solid: of the `part` with that number, or of all that is outside of a `tank`.

    `edges` (e, 7) are start (m), direction, length (m), and whether the solid has a re-entrant corner at the start and
    at the end: what is pressed into that touches both edges. `nodes` (n, 4) are the corners that stand out (m), with
    the direction into the solid. The solid is to the left of each edge. `thickness` (m) is about that of its parts.
    """

    part: int
    tank: int
    edges: np.ndarray
    nodes: np.ndarray
    thickness: float


def shape_of(corners: np.ndarray, part: int, tank: int, absent: tuple[int, ...] = ()) -> Shape:
    """The shape with these `corners` (m, 2) m, counter-clockwise or, of a tank, without its `absent` edges."""
    corners = np.asarray(corners, dtype=float)
    along = np.roll(corners, -1, axis=0) - corners
    lengths = np.hypot(*along.T)
    along /= lengths[:, None]
    if (part == OF_TANK) == (moments(corners)[0] > 0.0):  # turn it, so that the solid is to the left
        count = len(corners)
        return shape_of(corners[::-1], part, tank, tuple((count - 2 - k) % count for k in absent))
    before = np.roll(along, 1, axis=0)
    turn = before[:, 0] * along[:, 1] - before[:, 1] * along[:, 0]
    there = ~np.isin(np.arange(len(corners)), absent)
    both = there & np.roll(there, 1)
    inward = along - before  # half-way between both edges
    out, back = both & (turn > STRAIGHT), both & (turn < -STRAIGHT)
    rows = np.column_stack([corners, along, lengths, back, np.roll(back, -1)])[there]
    area, perimeter = abs(moments(corners)[0]), lengths.sum()
    nodes = np.column_stack([corners, inward / np.maximum(np.hypot(*inward.T), STRAIGHT)[:, None]])[out]
    return Shape(part, tank, rows, nodes, 2.0 * area / perimeter)


def shapes_of(tanks: tuple[Tank, ...], parts: tuple[Part, ...]) -> list[Shape]:
    """The tanks that hold free bodies, and the closed parts in these."""
    used = {part.tank for part in parts if part.free}
    found = [shape_of(tanks[k].outline, OF_TANK, k, tanks[k].open_edges) for k in sorted(used)]
    solid = ((k, part) for k, part in enumerate(parts) if part.closed and part.tank in used)
    return found + [shape_of(part.points, k, part.tank) for k, part in solid]


@dataclass(frozen=True)
class Touch:
    """The contacts of two bodies, or of one with what does not respond to it (None).

    The spring is k = min(m/2, 2 m_c) (π/(N Δt))² with N = max(28, 56 ζ), where 1/m is the sum of both bodies' inverse
    masses, and 1/m_c that of 1/m + r²/I, r from the centre to the farthest corner. So half an undamped oscillation
    takes N steps Δt or more if a face of a body lands on both its ends, and N/√2, at least 20, if one corner does,
    wherever it is. ζ is the damping ratio that the restitution needs (`damping_ratio_for`). The tangential spring is
    k_t = k 2(1 − ν)/(2 − ν), ν = 0.3. Friction and restitution of two free bodies are the means of theirs, else those
    of the body.
    """

    one: Part | None
    other: Part | None

    def _mean(self, name: str) -> float:
        return float(np.mean([getattr(part.free, name) for part in self._free]))

    @property
    def _free(self) -> list[Part]:
        return [part for part in (self.one, self.other) if part is not None and part.free]

    @property
    def mass(self) -> float:
        """m (kg), of a head-on collision through the centres."""
        return 1.0 / sum(1.0 / part.free.mass for part in self._free)

    @property
    def least_mass(self) -> float:
        """m_c (kg), of a collision of the farthest corners."""
        return 1.0 / sum(1.0 / part.free.mass + _arm(part) ** 2 / part.free.least_inertia for part in self._free)

    @property
    def friction(self) -> float:
        """The coefficient of friction."""
        return self._mean("friction")

    @property
    def damping_ratio(self) -> float:
        """ζ of the restitution."""
        restitution = self._mean("restitution")
        if not LEAST_RESTITUTION <= restitution <= 1.0:
            raise ValueError(f"restitution of a free body: must be {LEAST_RESTITUTION:g} to 1 (got {restitution:g})")
        return damping_ratio_for(restitution) if restitution < 1.0 else 0.0

    @property
    def steps(self) -> float:
        """N, steps of half an undamped oscillation."""
        return max(STEPS, DAMPED_STEPS * self.damping_ratio)

    def spring(self, dt: float) -> float:
        """k (N/m) at steps of dt (s)."""
        return min(0.5 * self.mass, 2.0 * self.least_mass) * (pi / (self.steps * dt)) ** 2

    def deepest(self, speed: float) -> float:
        """Largest overlap (m) a second of step of a head-on impact at a speed (m/s) on one corner, v √(m/k)/Δt."""
        return speed * sqrt(self.mass / self.spring(1.0))


def _arm(part: Part) -> float:
    """Distance (m) of the farthest corner from the centre of mass."""
    if part.shape:
        return part.shape.farthest(np.array(part.free.centre))
    return max(hypot(y - part.free.centre[0], z - part.free.centre[1]) for y, z in part.points)


def pairs_of(shapes: list[Shape], parts: tuple[Part, ...]) -> list[tuple[Shape, Shape, Touch]]:
    """All (whose corners, whose edges, touch) in one tank of which one at least is free."""

    def free(shape: Shape) -> bool:
        return shape.part != OF_TANK and parts[shape.part].free is not None

    def part(shape: Shape) -> Part | None:
        return parts[shape.part] if free(shape) else None

    both = [(a, b) for a in shapes for b in shapes if a is not b and a.tank == b.tank and (free(a) or free(b))]
    return [(a, b, Touch(part(a), part(b))) for a, b in both]


def fall_speed(scene, part: Part) -> float:
    """Speed (m/s) at which a free body reaches the floor of its tank: falling through air, then in water at rest.

    By the energy of its weight less its buoyancy, without drag or added mass: v² = 2 g [h_a + h_w (1 − ρ/ρ_b)].
    """
    tank, fluid = scene.tanks[part.tank], scene.fluid
    floor = tank.outline[:, 1].min()
    height = max(0.0, part.lowest - floor)
    wet, ratio = 0.0, 0.0
    if fluid:
        places = fluid.particles["position"][0][~fluid.particles["gas"][0], :2]
        wet = min(height, places[tank.holds(places), 1].max(initial=floor) - floor)
        ratio = fluid.water.density * part.volume(tank.thickness) / part.free.mass
    return sqrt(max(0.0, 2.0 * scene.gravity * (height - ratio * wet)))


def limits_of_contacts(scene, driven: float) -> list[Limit]:
    """Bounds on the step (s) of a scene (`solvers.scene.Scene`) with free bodies and water, by their contacts.

    A body that falls, or is met by walls that are `driven` (m/s), overlaps by at most half a spacing of the water.
    """
    free = [part for part in scene.parts if part.free]
    if not (scene.fluid and free):
        return []
    ways = [Touch(part, None).deepest(max(driven, fall_speed(scene, part))) for part in free]
    if max(ways) <= 0.0:
        return []
    longest = DEEPEST * scene.fluid.water.spacing / max(ways)
    return [Limit(longest, f"an overlap of {DEEPEST:g} spacings where a body falls on the floor", firm=True)]
