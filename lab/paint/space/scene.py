"""What a recording of a scene in space has besides places: walls, moving plates, and where all of them stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from lab.paint.space.stance import stances
from lab.paint.space.walls import Walls, drawn_out, lying_tank, prism, turned_plate, turned_tank
from solvers.tank.solids.mesh import Mesh
from solvers.tank.solids.solid import Lying, Prism

if TYPE_CHECKING:
    from lab.preset.schema import Preset


@dataclass(frozen=True, eq=False)
class SpaceScene:
    """The tank of a footage in space, m and rad.

    walls: of the tank at rest; plates: the moving parts at rest, in the order of the parts; stance (F, W, 6): of the
    tank in the frames, series_stance (T, W, 6): in the series; part_stance (F, W, P, 6): of the parts in the tank;
    hull: the walls of the ship round it, in its axes, None without one.
    """

    walls: Walls
    plates: tuple[Walls, ...]
    stance: np.ndarray
    series_stance: np.ndarray
    part_stance: np.ndarray
    hull: Walls | None = None

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
    moves, lines = (footage.part, footage.part_turn), footage.parts.values()
    if isinstance(solid, Prism):
        walls = prism(footage.outline, solid.along, footage.open_edges)
        found = SpaceScene.of(walls, [drawn_out(line, solid.along) for line in lines], where, moves)
        return replace(found, hull=prism(footage.sea.hull, solid.along)) if preset.ship else found
    if isinstance(solid, Mesh):
        return SpaceScene.of(Walls.of(list(solid.points)), [], where, moves)
    if isinstance(solid, Lying):
        return SpaceScene.of(lying_tank(solid.corners), [], where, moves)
    walls = turned_tank(footage.outline, footage.open_edges)
    return SpaceScene.of(walls, [turned_plate(line) for line in lines], where, moves)
