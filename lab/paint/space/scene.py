"""What a recording of a scene in space has besides places: walls, moving plates, and where all of them stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from lab.paint.space.hulls import hull_walls
from lab.paint.space.stance import stances
from lab.paint.space.walls import Walls, drawn_out, lying_tank, prism, solid_walls, turned_plate, turned_tank
from lab.preset.sections.bodies.hulls import hull_of
from lab.preset.sections.bodies.in_space import shape_of
from solvers.tank.parts import Hull
from solvers.tank.shapes import PrismShape
from solvers.tank.solids.mesh import Mesh
from solvers.tank.solids.solid import Lying, Prism

if TYPE_CHECKING:
    from lab.preset.schema import Preset


@dataclass(frozen=True, eq=False)
class SpaceScene:
    """The tank of a footage in space, m and rad.

    walls: of the tank at rest; plates: the moving parts at rest, in the order of the parts; stance (F, W, 6): of the
    tank in the frames, series_stance (T, W, 6): in the series; part_stance (F, W, P, 6): of the parts in the tank;
    hull: the walls of the ship round it, in its axes, None without one; hulls: of those of the parts that are hulls,
    by their numbers, their shapes and what is in them; periodic: whether it is a slice without ends.
    """

    walls: Walls
    plates: tuple[Walls, ...]
    stance: np.ndarray
    series_stance: np.ndarray
    part_stance: np.ndarray
    hull: Walls | None = None
    hulls: dict[int, tuple[PrismShape, Hull]] = field(default_factory=dict)
    periodic: bool = False

    @classmethod
    def of(
        cls,
        walls: Walls,
        plates: Sequence[Walls],
        where: tuple[np.ndarray, np.ndarray],
        moves: tuple[np.ndarray, np.ndarray],
    ) -> SpaceScene:
        """A tank with these walls, and plates in it.

        where: stances of frames (F, W, 6) and of the series; moves: displacements (F, W, P, 2 or 3) and turns (F, W, P)
        or (F, W, P, 3) of the parts.
        """
        shift, turn = moves
        part = np.zeros((*shift.shape[:-1], 6))
        part[..., : shift.shape[-1]] = shift
        if turn.ndim == shift.ndim:
            part[..., 3:] = turn
        else:
            part[..., 5] = turn
        return cls(walls, tuple(plates), *where, part)

    def cut_open(self, x: float) -> tuple[Walls, ...]:
        """The parts at rest, of which hulls are cut open at a place along x (m)."""
        opened = {k: hull_walls(*hull, x) for k, hull in self.hulls.items()}
        return tuple(opened.get(k, plate) for k, plate in enumerate(self.plates))

    def part_at(self, number: int, world: int, row: float) -> np.ndarray:
        """The stance (6,) of a part in the tank, in a frame or between two."""
        first = int(row)
        after, share = min(first + 1, len(self.part_stance) - 1), row - first
        one, two = self.part_stance[[first, after], world, number]
        return one + share * (two - one)


def scene_in_space(preset: Preset, footage) -> SpaceScene | None:
    """The scene of a footage (`lab.paint.footage.Footage`) whose preset is of a tank in space; None in the plane."""
    solid = preset.tank.solid
    if solid is None:
        return None
    rest = np.zeros(6)
    if preset.ship:  # she is drawn from where her hold is as she rests
        rest[:2] = preset.ship.hold_at_rest
    where = [stances(pose) - rest for pose in (footage.pose, footage.series_pose)]
    moves, lines = (footage.part, turns_of(footage)), footage.parts.values()
    if isinstance(solid, Prism):
        walls = prism(footage.outline, solid.along, footage.open_edges)
        parts = [preset.parts[name] for name in footage.parts]
        drawn = [drawn_part(part, line, solid.along) for part, line in zip(parts, lines, strict=True)]
        hulls = {k: (shape_of(part), hull_of(part)) for k, part in enumerate(parts) if part.wall is not None}
        found = replace(SpaceScene.of(walls, drawn, where, moves), hulls=hulls, periodic=solid.periodic)
        return replace(found, hull=prism(footage.sea.hull, solid.along)) if preset.ship else found
    if isinstance(solid, Mesh):
        return SpaceScene.of(Walls.of(list(solid.points)), [], where, moves)
    if isinstance(solid, Lying):
        return SpaceScene.of(lying_tank(solid.corners), [], where, moves)
    walls = turned_tank(footage.outline, footage.open_edges)
    return SpaceScene.of(walls, [turned_plate(line) for line in lines], where, moves)


def drawn_part(part, line: np.ndarray, along: float) -> Walls:
    """The faces of a part of a preset with this `line`: a plate, a solid body, or a hull that is closed."""
    shape, hull = shape_of(part), hull_of(part)
    if shape is None:
        return drawn_out(line, along)
    return hull_walls(shape, hull, None) if hull else solid_walls(shape)


def turns_of(footage) -> np.ndarray:
    """The turns (F, W, P) of parts about x, or as vectors (F, W, P, 3) rad where they float in space."""
    if footage.part_pitch_yaw is None:
        return footage.part_turn
    angles = np.concatenate([footage.part_pitch_yaw, footage.part_turn[..., None]], axis=-1)
    return stances(np.concatenate([np.zeros_like(angles), angles], axis=-1))[..., 3:]
