"""Checks of the parts in a preset's water: plates and bodies that can be represented, and stay in the tank."""

from collections.abc import Iterator

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import simple_polygon
from lab.preset.sections.bodies.checks import check_floating
from lab.preset.sections.history import check_end
from lab.preset.sections.parts import PartGroup, parts_of
from lab.preset.sections.water import liquid
from lab.preset.sections.water.tanks import outline_at, pools
from lab.preset.units import show
from solvers.fluid.bodies.solids import counter_clockwise
from solvers.tank.tank import Tank as Outline

THINNEST = (
    4.0  # smoothing lengths: the least thickness at which no wall particle of a body is seen from both of its sides
)
THINNEST_WALL = 0.5  # spacings, of a hull
LOOKS = 41  # places at which a motion is looked at
ALONG = 33  # points at which a part's sides are looked at
NEAR = 1e-3  # of the tank's larger side: how far a part may stand in a wall


def check_solids(preset: liquid.Wet) -> None:
    """Raise LabError, one sentence, for the first part that water cannot have in it, or that cannot float."""
    check_floating(preset)
    if preset.water is None:
        return
    wet = {pool.number for pool in pools(preset)}
    for (name, part), solved in zip(preset.parts.items(), parts_of(preset), strict=True):
        key = f"parts.{name}"
        if part.history:
            _check_end(preset, part, key)
        if solved.tank not in wet or part.sieve:
            continue
        if part.closed:
            _check_body(part, 2.0 * preset.liquid.reach, key)
            if part.wall is not None and part.wall < THINNEST_WALL * preset.liquid.spacing:
                least = show(THINNEST_WALL * preset.liquid.spacing, "m")
                raise LabError(f"{key}.wall: it is thinner than half a spacing, {least}; take smaller particles.")
        elif len(part.points) != 2:
            remedy = "give two points, or set closed = true for a solid body"
            raise LabError(f"{key}.points: a plate in water is straight (got {len(part.points)} points); {remedy}.")
        _check_place(outline_at(preset, solved.tank), part, key)


def _check_end(preset: liquid.Wet, part: PartGroup, key: str) -> None:
    """Raise LabError if the run goes on after a record that ends in motion."""
    try:
        check_end(part.history.history, preset.duration)
    except LabError as error:
        raise LabError(str(error).replace("the motion's record", f"the record of {key}.history")) from None


def _check_body(part: PartGroup, least: float, key: str) -> None:
    """Raise LabError for a body that is no simple polygon, or thinner (m) than `least`."""
    try:
        corners = counter_clockwise(simple_polygon(part.section))
    except LabError as error:
        raise LabError(f"{key}.points: {error}") from None
    thin = thickness(corners)
    if thin < least:
        remedy = "take smaller particles, or draw it as a plate of two points"
        raise LabError(f"{key}.points: this body is {show(thin, 'm')} thin, under 4 h = {show(least, 'm')}; {remedy}.")


def thickness(corners: np.ndarray) -> float:
    """The least distance (m) from the middle of an edge of a polygon (m, 2), counter-clockwise, straight through it."""
    found, ends = np.inf, np.roll(corners, -1, axis=0)
    for begin, end in zip(corners, ends, strict=True):
        along = (end - begin) / np.hypot(*(end - begin))
        inwards, middle = np.array([-along[1], along[0]]), 0.5 * (begin + end)
        deep, aside = (corners - middle) @ inwards, (corners - middle) @ along
        after, beside = np.roll(deep, -1), np.roll(aside, -1)
        for d, e, a, b in zip(deep, after, aside, beside, strict=True):
            if (a > 0.0) != (b > 0.0):
                at = d + (e - d) * a / (a - b)
                if at > 1e-9 * np.ptp(corners):
                    found = min(found, at)
    return float(found)


def _check_place(tank: np.ndarray, part: PartGroup, key: str) -> None:
    """Raise LabError for a part that stands in a wall of its tank, at the start or on its way; above it, it may be."""
    outline, top, left = Outline(tank, 1.0), tank[:, 1].max(), NEAR * float(np.ptp(tank, axis=0).max())
    points = np.array(part.section)
    sides = points[:-1] if not part.closed else points
    share = np.linspace(0.0, 1.0, ALONG)[:, None]
    ends = points[1:] if not part.closed else np.roll(points, -1, axis=0)
    drawn = np.concatenate([a + share * (b - a) for a, b in zip(sides, ends, strict=True)])
    for motion, moved in _ways(part, np.concatenate([sides, ends, drawn])):
        begin, end, places = np.split(moved, [len(sides), 2 * len(sides)])
        places = np.concatenate([places, _between_walls(begin, end, tank)])
        inside = outline.holds(places) | (places[:, 1] >= top - left)
        for step in left * np.array([(1, 0), (-1, 0), (0, 1), (0, -1)]):
            if inside.all():
                break
            inside[~inside] = outline.holds(places[~inside] + step)
        if not inside.all():
            y, z = places[(~inside).argmax()]
            where = f"[{show(float(y), 'm')}, {show(float(z), 'm')}]"
            when = "" if motion == "points" else " on its way"
            raise LabError(
                f"{key}.{motion}: it stands in a wall of the tank at {where}{when}; keep it inside, or let it out "
                "through the top."
            )


def _between_walls(begin: np.ndarray, end: np.ndarray, tank: np.ndarray) -> np.ndarray:
    """The middles (n, 2) of the pieces into which a tank's walls cut straight sides from `begin` to `end` (k, 2) m."""
    side, wall = (end - begin)[:, None], (np.roll(tank, -1, axis=0) - tank)[None]
    apart, across = tank[None] - begin[:, None], _cross(side, wall)
    with np.errstate(divide="ignore", invalid="ignore"):  # of parallels
        share, other = _cross(apart, wall) / across, _cross(apart, side) / across
    meets = (share > 0.0) & (share < 1.0) & (other >= 0.0) & (other <= 1.0)
    cuts = np.pad(np.where(meets, share, 1.0), ((0, 0), (1, 1)), constant_values=(0.0, 1.0))
    cuts.sort(axis=1)
    which, piece = np.nonzero(np.diff(cuts) > 0.0)
    middle = 0.5 * (cuts[which, piece] + cuts[which, piece + 1])
    return begin[which] + middle[:, None] * side[which, 0]


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a × b of vectors in the plane."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _ways(part: PartGroup, drawn: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Where points of a part (n, 2) m come to by each of its motions alone, with the key of that motion."""
    yield "points", drawn
    for share in np.linspace(0.0, 1.0, LOOKS) if part.way else ():
        yield "move", drawn + share * np.array(part.move)
    for name, motion in part.moves.items():
        if hasattr(motion, "values"):
            ways = motion.values
        else:
            farthest = motion.amplitude if hasattr(motion, "amplitude") else motion.angle
            ways = farthest * np.linspace(-1.0 if hasattr(motion, "amplitude") else 0.0, 1.0, LOOKS)
        for way in ways:
            if motion.coordinate == "turn":
                arm, (c, s) = drawn - motion.centre, (np.cos(way), np.sin(way))
                yield (
                    name,
                    motion.centre + np.column_stack([c * arm[:, 0] - s * arm[:, 1], s * arm[:, 0] + c * arm[:, 1]]),
                )
            else:
                yield name, drawn + way * np.array([motion.coordinate == "y", motion.coordinate == "z"])
