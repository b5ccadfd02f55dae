"""The grains of a scene: their sizes, places, materials and laws, from a preset."""

from dataclasses import replace

import numpy as np

from lab.assembly.drawn import classes, draw_shapes
from lab.base.errors import LabError
from lab.preset.schema import Preset
from lab.preset.sections.bodies.checks import check_draught
from lab.preset.units import show
from solvers.grains.bed.filling import (
    SPACING,
    DoesNotFit,
    count_for_depth,
    headroom,
    lattice,
    layered,
    start_positions,
)
from solvers.grains.bed.sizes import Sizes
from solvers.grains.checks import DEEPEST_OVERLAP
from solvers.grains.given import Grains
from solvers.grains.shapes.given import Shapes
from solvers.grains.timestep import closing_speed
from solvers.machine.quantity import SPACE
from solvers.scene import Scene
from solvers.tank.outline import NONE_FIXED, lining, raised
from solvers.tank.tank import Tank

THROUGH = 1.0  # radii: at this overlap grains pass through each other and the walls


def grain_count(preset: Preset) -> int:
    """Number of grains in one tank, fixed ones not counted; 0 without grains."""
    grains = preset.grains
    if grains is None:
        return 0
    if grains.listed:
        return len(grains.listed)
    if grains.count is not None:
        return grains.count
    return count_for_depth(
        grains.depth, np.array(preset.hold.corners), preset.sizes, fixed_grains(preset), preset.hold.solid
    )


def fixed_grains(preset: Preset) -> np.ndarray:
    """The fixed grains (k, 3) y, z, radius in m that line a rough tank, the same in all repeats (seed run.seed)."""
    tank = preset.hold
    if tank.roughness is None:
        return NONE_FIXED
    return lining(np.array(tank.corners), tank.roughness, np.random.default_rng(preset.run.seed))


def filling_outline(preset: Preset) -> np.ndarray:
    """The outline (m, 2) m of the tank in which the grains settle.

    Grains start higher than they come to rest. If they are thrown, fill an open tank to its rim, or have no room to
    start in a closed one, the walls are extended upwards until the bed has settled.
    """
    outline, grains = np.array(preset.hold.corners), preset.grains
    if grains.listed or grains.region or not preset.run.settles:
        return outline
    low = not (grains.surface == "disturbed" or preset.hold.open_edges)
    solid, layers = preset.hold.solid, _layers(preset)
    if solid is not None and not solid.heightens:
        return outline
    if low and _fits(preset, outline, layers):
        return outline
    across = [2.0 * solid.half(outline)] if solid else []
    return raised(outline, sum(headroom(count, largest, preset.hold.extent[0], *across) for count, largest in layers))


def _layers(preset: Preset) -> list[tuple[int, float]]:
    """Number and largest radius (m) of the grains of each layer in which they start, from the lowest up."""
    count = grain_count(preset)
    if not preset.grains.layered:
        return [(count, _farthest(preset))]
    each, larger = np.bincount(_ordered(preset, count), minlength=1 + len(preset.kinds)), 1.0
    if preset.classes:
        larger = np.array([diameter for diameter, _ in preset.classes])
        larger = larger / larger.max()
    return list(zip(each.tolist(), (_farthest(preset) * larger * np.ones(len(each))).tolist(), strict=True))


def _fits(preset: Preset, outline: np.ndarray, layers: list[tuple[int, float]]) -> bool:
    """Whether lattices have places for all layers of grains in a tank with this outline, one above the other."""
    above = -np.inf
    for count, largest in layers:
        sites = lattice(largest, outline, fixed_grains(preset), _plates(preset), preset.hold.solid)
        heights = np.sort(sites[:, 1])
        heights = heights[heights >= above + SPACING * largest]
        if len(heights) < count:
            return False
        above = float(heights[count - 1]) + SPACING * largest if count else above
    return True


def _farthest(preset: Preset) -> float:
    """Upper bound (m) on the distance of a grain's outline from its centroid."""
    if not preset.shapes:
        return 0.5 * preset.diameters[1]
    alone = [
        (replace(preset.sizes, classes=((shape.diameter, 1.0),)), shape) for shape in preset.shape_classes.values()
    ]
    return max(0.5 * sizes.range[1] * shape.reach for sizes, shape in alone)


def radii_of(scene: Scene) -> np.ndarray:
    """Radii (W, n) m of a scene's grains; n is 0 without them."""
    return scene.grains.radius if scene.grains else np.zeros((scene.worlds, 0))


def fixed_of(scene: Scene) -> np.ndarray:
    """The fixed grains (k, 3) y, z, radius in m of a scene."""
    return scene.grains.fixed if scene.grains else NONE_FIXED


def grains_of(preset: Preset) -> tuple[Grains | None, np.ndarray]:
    """The grains of a scene, of all repeats, and their starting positions (W, n, 2) m; None and n = 0 without grains.

    Repeat w has the seed run.seed + w. Raises LabError if the grains do not fit into the tank.
    """
    if preset.grains is None:
        return None, np.zeros((preset.run.repeats, 0, 2))
    kind = _kind(preset)
    radius, position, more = _listed(preset) if preset.grains.listed else _filled(preset, kind)
    low, high = preset.diameters
    given = Grains(
        radius,
        preset.material,
        preset.wall_material,
        **_kinds(preset, kind),
        normal=preset.contact.normal,
        tangential=preset.contact.tangential,
        rolling=preset.contact.rolling,
        cohesion=preset.contact.cohesion,
        twisting=preset.contact.twisting,
        stiffness_scale=preset.stiffness_scale,
        sizes=(0.5 * low, 0.5 * high),
        fixed=fixed_grains(preset),
        integrator=preset.run.integrator,
        **more,
    )
    return given, position


def _filled(preset: Preset, kind: np.ndarray | None) -> tuple[np.ndarray, np.ndarray, dict]:
    """Radii (W, n), positions (W, n, axes) and shapes of the grains that fill a tank, each repeat from its own seed.

    `kind` (W, n): their kinds, None if there is one. The grains are at rest, and so far apart that irregular ones can
    turn freely.
    """
    grains, count = preset.grains, grain_count(preset)
    shapes = draw_shapes(preset, count)
    random = [np.random.default_rng(preset.run.seed + w) for w in range(preset.run.repeats)]
    if shapes is None and kind is not None and preset.classes and not grains.table:
        radius = reach = _spread(preset, np.array([diameter for diameter, _ in preset.classes])[kind], random)
    elif shapes is None:
        radius = reach = np.stack([preset.sizes.draw(count, r) for r in random])
    else:
        radius = _sized(preset, shapes, random)
        reach = radius * np.array([outline.bounding_radius for outline in shapes.outlines])[shapes.which]
    outline, fixed = filling_outline(preset), fixed_grains(preset)
    plates, thrown = _plates(preset), grains.surface == "disturbed"
    region = np.array(grains.place) if grains.place else None
    solid = preset.hold.solid and preset.hold.solid.over(outline)
    given = [(outline, r, fixed, plates, thrown, region, solid) for r in random]
    try:
        if grains.layered:
            position = [layered(*layers, *how) for *layers, how in zip(kind, reach, given, strict=True)]
        else:
            position = [start_positions(size, *how) for size, how in zip(reach, given, strict=True)]
    except DoesNotFit as error:
        raise LabError(f"grains.{'count' if grains.count else 'depth'}: {error}") from None
    return radius, np.stack(position), {"shapes": shapes} if shapes else {}


def _sized(preset: Preset, shapes: Shapes, random: list[np.random.Generator]) -> np.ndarray:
    """Radii (W, n) of discs of equal area, spread about that of each grain's class."""
    diameter = np.array([shape.diameter for shape in preset.shape_classes.values()])[classes(preset)][shapes.which]
    return _spread(preset, diameter, random)


def _spread(preset: Preset, diameter: np.ndarray, random: list[np.random.Generator]) -> np.ndarray:
    """Radii (W, n) spread about those of mean diameters (W, n) m, each repeat from its own numbers."""
    relative = Sizes(((2.0, 1.0),), preset.grains.spread, preset.grains.normal)
    return 0.5 * diameter * np.stack([relative.draw(diameter.shape[1], r) for r in random])


def _plates(preset: Preset) -> list[np.ndarray]:
    """The parts in the grains' tank as polylines (m, 2) in m, in their rest position; a body's ends where it begins."""
    return [np.array(part.line) for part in preset.parts.values() if part.tank == preset.grains.room]


def grain_masses(preset: Preset, radius: np.ndarray, kind: np.ndarray) -> np.ndarray:
    """Masses (n,) kg of grains of these radii (n,) m and kinds (n,): of spheres, also for discs and outlines."""
    densities = np.array([preset.material.density, *(other.material.density for other in preset.others.values())])
    return 4.0 / 3.0 * np.pi * radius**3 * densities[kind]


def _kinds(preset: Preset, kind: np.ndarray | None) -> dict:
    """The kinds of grains and their materials; empty if there is only one kind."""
    if kind is None:
        return {}
    against = [((0, k), other.against) for k, other in enumerate(preset.others.values(), start=1) if other.against]
    return {
        "kind": kind,
        "others": tuple(other.material for other in preset.others.values()),
        "unlike": tuple(against),
    }


def _kind(preset: Preset) -> np.ndarray | None:
    """The kind (W, n) of each grain, as listed or mixed at random, each repeat from its seed; None if there is one."""
    if not preset.kinds:
        return None
    if preset.grains.listed and preset.grains.listed.kind is not None:
        return np.stack([preset.grains.listed.kind.astype(int)] * preset.run.repeats)
    ordered = _ordered(preset, grain_count(preset))
    random = [np.random.default_rng([preset.run.seed + w, 1]) for w in range(preset.run.repeats)]
    return np.stack([r.permutation(ordered) for r in random])


def _ordered(preset: Preset, count: int) -> np.ndarray:
    """The kinds (n,) of so many grains: first those of [kinds], in their order, then the rest, which is 0."""
    bounds = np.round(np.cumsum([kind.share for kind in preset.kinds.values()]) * count)
    return (np.searchsorted(bounds, np.arange(count), side="right") + 1) % (len(preset.kinds) + 1)


def _listed(preset: Preset) -> tuple[np.ndarray, np.ndarray, dict]:
    """Radii and positions of the listed grains, the same in all repeats, and their velocities if any."""
    grains, worlds, axes = preset.grains.listed, preset.run.repeats, preset.axes
    motion = {}
    if grains.move:
        velocity = np.stack([grains.velocity[:, :axes]] * worlds)
        spin = np.stack([grains.spin if axes == SPACE else grains.spin[:, -1]] * worlds)
        motion = {"velocity": velocity, "spin": spin, "start_speed": closing_speed(velocity[0])}
    return np.stack([grains.radius] * worlds), np.stack([grains.place[:, :axes]] * worlds), motion


def check_softness(scene: Scene) -> None:
    """Raise LabError if the starting speeds make grains overlap so deeply in a collision that the watch stops the run.

    Speeds from a fall or from the moving tank are not known beforehand; for these only passing through is refused.
    """
    for what, speed, most in (
        ("start", scene.grains.start_speed, DEEPEST_OVERLAP),
        ("may meet", scene.credible_speed(), THROUGH),
    ):
        deep = scene.grains.deepest_overlap(speed)
        if deep > most:
            stiffer = scene.grains.stiffness_scale * (deep / most) ** 2.5
            remedy = f"set it to at least {stiffer:.2g}"
            if stiffer > 1.0:
                remedy = "raise material.young or slow them down"
            raise LabError(
                f"contact.stiffness_scale: grains {what} at {show(speed, 'm/s')} here and would overlap by "
                f"{100 * deep:.3g} % of a radius, where {100 * most:g} % is the most; {remedy}."
            )


def rooms_of_bodies(preset: Preset) -> tuple[Tank, ...]:
    """The room of a hull that the grains are in, as a tank aboard it; none if they are in a tank of their own."""
    if preset.grains is None or preset.grains.room is None:
        return ()
    hull = list(preset.parts).index(carrier_of_grains(preset))
    return (Tank(np.array(preset.hold.corners), preset.thickness, aboard=hull),)


def carrier_of_grains(preset: Preset) -> str:
    """The name of the hull whose room the grains are in."""
    return preset.grains.room.rpartition(".")[0]


def check_laden(preset: Preset, scene: Scene) -> None:
    """Raise LabError for a hull that its own weight and that of the grains in it sink, or carry too high."""
    if scene.hold:
        name = carrier_of_grains(preset)
        part = preset.parts[name]
        key = f"parts.{name}.{'density' if part.mass is None else 'mass'}"
        check_draught(preset, part, key, cargo_of(scene))


def cargo_of(scene: Scene) -> float:
    """Mass (kg) of a scene's grains, that of the heaviest world."""
    given = scene.grains
    return float((4.0 / 3.0 * np.pi * given.radius**3 * given.density).sum(axis=1).max())
