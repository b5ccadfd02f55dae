"""The view of scenes in space: tanks side by side in one scale, seen from one direction, with what is in them."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from PIL import Image

from lab.paint.colours import Colouring, spread
from lab.paint.footage import Bed
from lab.paint.page.theme import blend
from lab.paint.raster.grains import FLAT
from lab.paint.scene.cells import Room, lay_cells
from lab.paint.scene.drive import AWAY, STEPS, paint_way
from lab.paint.scene.ends import BAND, draw_ends
from lab.paint.scene.overlay import TRAILS, Overlay
from lab.paint.scene.trails import LEAST, THICK
from lab.paint.scene.view import ARROW, NAME, ROOM, STILL, WALL, ViewSetting
from lab.paint.space.camera import SpaceCamera, gaze_at, ground, orbit
from lab.paint.space.gauges import SpaceMarks
from lab.paint.space.marks import TurningAxes
from lab.paint.space.painter import Skin, paint_space
from lab.paint.space.raster.layers import Layers
from lab.paint.space.raster.lines import edge_lines, lines_between, paint_lines_in_space
from lab.paint.space.raster.shade import Paints
from lab.paint.space.stance import carried, lengths, rotation
from lab.paint.space.viewpoint import Viewpoint
from lab.paint.space.walls import Walls
from lab.paint.space.water import SpaceWater

EDGE = 0.065  # half thickness of edges in u
GLOSS = 0.12  # of grains in the colours of a scale
PALE = 0.55  # of the empty tank's colour in that of turned plates; the rest is the parts'


class SpaceView:
    """Beds in space in one scale, as `SceneView` has those in a plane.

    rows (K, F): of their frames, maybe between two; stance (F, K, 6): of the tanks at the pictures' times.
    """

    def __init__(
        self,
        beds: Sequence[Bed],
        setting: ViewSetting,
        viewpoint: Viewpoint,
        rows: np.ndarray,
        stance: np.ndarray,
        time: np.ndarray,
    ) -> None:
        self.beds, self.setting, self._viewpoint, self._theme = list(beds), setting, viewpoint, setting.theme
        self._rows, self._time = rows, time
        self._stance = stance if setting.frame == "earth" else np.zeros_like(stance)
        self._azimuth = orbit(viewpoint.azimuth, viewpoint.turns, time)
        self._moves = bool(np.abs(self._stance).max(initial=0.0) > STILL)
        self.overlay = Overlay("none", self.beds, rows, setting.theme)
        self._reach = [_reach(bed, ROOM / np.sqrt(len(beds))) for bed in beds]
        self._cameras = self._place_beds()
        self._axes = [TurningAxes(bed) for bed in beds]
        section = viewpoint.section
        self._plates = [
            bed.footage.space.plates if section is None else bed.footage.space.cut_open(section.point[2])
            for bed in self.beds
        ]
        self._layers: dict[tuple, Layers] = {}  # by the size of the part of the picture
        self.marks: dict[int, SpaceMarks] = {}

    def _place_beds(self) -> list[SpaceCamera]:
        """The camera of each bed for the points of the earth, from the first azimuth; and the cells."""
        unit, count = self.setting.unit, len(self.beds)
        shown = [list(self._framed(k)) for k in range(count)]
        every = [np.concatenate([points for _, points in one]) for one in shown]
        stand = self._viewpoint.azimuth, self._viewpoint.elevation
        away = max(gaze_at(points, *stand).distance for points in every)
        gazes = [gaze_at(points, *stand, away) for points in every]
        grounds = [ground(gaze, one) for gaze, one in zip(gazes, shown, strict=True)]
        around = (WALL + ARROW * self._moves / np.sqrt(count)) * unit
        lost = count > 1 and any(bed.footage.ends[bed.world] for bed in self.beds)
        named = any(bed.name for bed in self.beds)
        self._cells = lay_cells(grounds, self.setting.box, unit, Room(around, NAME * unit * named, BAND * unit * lost))
        self.cameras, self.names_at, self.name_width = self._cells.cameras, self._cells.names, self._cells.width
        return [SpaceCamera(gaze, screen) for gaze, screen in zip(gazes, self.cameras, strict=True)]

    def _framed(self, k: int) -> Iterator[tuple[float, np.ndarray]]:
        """The points (n, 3) m that the camera is to show of bed k at each azimuth: at rest, and where its tank is."""
        points = self._reach[k]
        for azimuth, *stance in np.unique(np.column_stack([self._azimuth, self._stance[:, k]]), axis=0):
            yield azimuth, np.concatenate([points, carried(points, np.array(stance))]) if self._moves else points

    def style(self, grains: Colouring | None, water: object, bulk: object, hues: Sequence[tuple]) -> None:
        """Say what the colours show."""
        self._colouring, self._water = grains, SpaceWater(self.beds, water.colouring)
        for k, bed in enumerate(self.beds):
            first = None if len(hues) == 1 else hues[k]
            if marks := SpaceMarks.of(bed, self._theme.series, self.setting.unit, self._theme, first):
                self.marks[k] = marks

    def paint_backdrop(self, page: np.ndarray) -> None:
        """What does not move: nothing, since the camera may go round."""

    def write_names(self, image: Image.Image, frame: int) -> None:
        """Write the names of gauges beside them."""
        for k, marks in self.marks.items():
            marks.name(image, self.tank_camera(k, frame))

    def draw_ends(self, image: Image.Image, frame: int) -> None:
        """Draw a band with the text on the loss of each ship lost so far, at the foot of her cell."""
        draw_ends(image, self.beds, self._cells.boxes, self._time[frame], self.setting.unit, self._theme)

    def earth_camera(self, k: int, frame: int) -> SpaceCamera:
        """The camera of bed k for the points of the earth."""
        return self._cameras[k].from_azimuth(float(self._azimuth[frame]))

    def tank_camera(self, k: int, frame: int) -> SpaceCamera:
        """The camera for points (n, 3) of the tank of bed k."""
        stance = self._stance[frame, k]
        return self.earth_camera(k, frame).carried(stance[:3], rotation(stance[3:]))

    def paint(self, picture: np.ndarray, frame: int) -> None:
        """Paint the beds at the time of a picture, in place."""
        for k in range(len(self.beds)):
            left, top, right, bottom = self._cells.boxes[k] if len(self.beds) > 1 else self.setting.canvas
            part = np.ascontiguousarray(picture[top:bottom, left:right])
            if part.size:
                self._paint_bed(part, (left, top), k, frame)
                picture[top:bottom, left:right] = part
            if k in self.marks:
                depths = self.beds[k].depths(self._time[frame])
                self.marks[k].paint(picture, self.tank_camera(k, frame), depths)
            if self._moves:
                self._paint_arrow(picture, k, frame)

    def _paint_bed(self, part: np.ndarray, corner: tuple[int, int], k: int, frame: int) -> None:
        bed, row, theme, half = self.beds[k], self._rows[k][frame], self._theme, EDGE * self.setting.unit
        space, camera = bed.footage.space, self.tank_camera(k, frame).shifted(*corner)
        layers = self._layers.get(part.shape) or Layers(*part.shape[:2])
        self._layers[part.shape] = layers
        if self._moves:
            still = self.earth_camera(k, frame).shifted(*corner)
            self._paint_edges(part, layers, still, space.walls, half, theme.ghost)
        if space.hull is not None:
            self._paint_edges(part, layers, camera, space.hull, half, theme.far)
        place, radius, paints = self._cargo(bed, row)
        plates = [_moved(plate, space.part_at(n, bed.world, row)) for n, plate in enumerate(self._plates[k])]
        walls = Walls.apart([space.walls, *plates]) if plates else space.walls
        tints = np.tile(np.array(theme.hold, dtype=float), (len(walls.pane), 1))
        tints[len(space.walls.pane) :] = blend(theme.part, theme.hold, PALE)
        tints[walls.pane] = theme.part
        skin = Skin(tints, theme.wall, half)
        drops = self._drops(bed, row)

        def over(picture: np.ndarray, found: Layers) -> None:
            self._water.paint(picture, found, camera, bed, drops)

        if len(drops):
            balls = self._water.balls(bed, row, drops)
            place, radius, paints = balls if bed.empty else (place, radius, paints)
        paint_space(part, camera, place, radius, paints, walls, skin, layers, over if len(drops) else None)
        if self.setting.overlay == "trails":
            self._paint_trails(part, layers, camera, k, frame)

    def _paint_edges(
        self, part: np.ndarray, layers: Layers, camera: SpaceCamera, walls: Walls, half: float, colour: tuple
    ) -> None:
        """The edges of the tank at rest, or of a ship's hull, behind all else."""
        layers.clear(camera)
        paint_lines_in_space(part, layers, edge_lines(camera, walls, half), colour)

    def _cargo(self, bed: Bed, row: float) -> tuple[np.ndarray, np.ndarray, Paints]:
        """Places, radii and looks of the grains that are shown, and of those that line the tank."""
        fixed = bed.footage.fixed
        if bed.empty:
            place, radius, colour, gloss = np.zeros((0, 3)), np.zeros(0), np.zeros((0, 3)), np.zeros(0)
            axes = mark = None
        else:
            place, radius = self._shown(bed, row), bed.radius
            colour = self._colouring.colours(bed, row)
            mark, _, finish = self._colouring.style(bed, colour)
            gloss, strength = (GLOSS, FLAT.strength) if finish is None else (finish[:, 1], finish[:, 7:])
            gloss, mark = np.broadcast_to(gloss, len(colour)), colour + strength * (mark - colour)
            axes = self._axes[self.beds.index(bed)].at(row)
        if fixed.shape[-1] == 4 and len(fixed):
            count = len(fixed)
            place, radius = np.concatenate([place, fixed[:, :3]]), np.concatenate([radius, fixed[:, 3]])
            colour = np.concatenate([colour, np.tile(self._theme.fixed, (count, 1))])
            gloss = np.concatenate([gloss, np.zeros(count)])
            if axes is not None:
                axes, mark = np.concatenate([axes, np.zeros((count, 3))]), np.concatenate([mark, np.zeros((count, 3))])
        return place, radius, Paints(colour, gloss, axes, mark)

    def _drops(self, bed: Bed, row: float) -> np.ndarray:
        """Places (n, 3) m of the water, NaN for what is cut away or far from the tank; none without water."""
        if not bed.footage.water:
            return np.zeros((0, 3))
        place, reach = bed.drops("water_position", row), self._reach[self.beds.index(bed)]
        off = (place < reach.min(axis=0)) | (place > reach.max(axis=0))
        place = np.where(off.any(axis=1, keepdims=True), np.nan, place)
        return place if self._viewpoint.section is None else self._viewpoint.section.shown(place)

    def _shown(self, bed: Bed, row: float) -> np.ndarray:
        """Places (n, 3) m of grains, NaN for those that are cut away or far from the tank."""
        place, reach = bed.position(row), self._reach[self.beds.index(bed)]
        off = (place < reach.min(axis=0) - bed.radius[:, None]) | (place > reach.max(axis=0) + bed.radius[:, None])
        place = np.where(off.any(axis=1, keepdims=True), np.nan, place)
        return place if self._viewpoint.section is None else self._viewpoint.section.shown(place)

    def _paint_trails(self, part: np.ndarray, layers: Layers, camera: SpaceCamera, k: int, frame: int) -> None:
        """The ways that the grains have come in the last pictures, relative to the tank."""
        bed = self.beds[k]
        if bed.empty:
            return
        rows = [self._rows[k][max(frame - back, 0)] for back in range(TRAILS)]
        places = [self._shown(bed, row) for row in rows]
        way = sum(lengths(one - two) for one, two in pairwise(places))
        moved = np.isfinite(way) & (way > LEAST * bed.radius)
        scale, lines = camera.screen.scale * THICK * bed.radius[moved], []
        for back, (one, two) in enumerate(pairwise(places)):
            thick = scale * (1.0 - (back + 0.5) / (TRAILS - 1))
            lines.append(lines_between(camera, np.stack([one[moved], two[moved]], axis=1), thick, 1.0))
        paint_lines_in_space(part, layers, np.concatenate(lines), self._theme.ink)

    def _paint_arrow(self, picture: np.ndarray, k: int, frame: int) -> None:
        """The way of the tank's upper corner from rest to now."""
        camera, unit = self.earth_camera(k, frame), self.setting.unit / np.sqrt(len(self.beds))
        corners, stance = self.beds[k].footage.space.walls.points, self._stance[frame, k]
        flat = camera.gaze.flat(corners)
        corner = int(np.argmax(flat @ [1.0, 2.0]))
        away = AWAY * unit / camera.screen.scale * np.sign(flat[corner] - flat.mean(axis=0))
        start = (corners[corner] + away @ camera.gaze.axes[:2])[None]
        way = [carried(start, share * stance)[0] for share in np.linspace(0.0, 1.0, STEPS + 1)]
        paint_way(picture, camera.pixels(np.array(way)), unit, self._theme.accent)


def _moved(plate: Walls, stance: np.ndarray) -> Walls:
    return plate.carried(stance[:3], rotation(stance[3:]))


def _reach(bed: Bed, most: float) -> np.ndarray:
    """The corners of a tank, and of the box around what stands out by `most` of its size at most, (n, 3) m."""
    space, footage = bed.footage.space, bed.footage
    points = space.walls.outmost if space.hull is None else np.concatenate([space.walls.outmost, space.hull.points])
    low, high = points.min(axis=0), points.max(axis=0)
    if not footage.protrudes:
        return points
    room, found = most * float(np.ptp(points, axis=0).max()), [low, high]
    for _, frame in spread([bed]):
        places = [_moved(plate, space.part_at(k, bed.world, frame)).points for k, plate in enumerate(space.plates)]
        places += [bed.position(frame)] if footage.open_edges and not bed.empty else []
        found += [pick.reduce(place) for place in places if len(place) for pick in (np.fmin, np.fmax)]
    around = np.clip(found, low - room, high + room)
    ends = np.array([np.nanmin(around, axis=0), np.nanmax(around, axis=0)])
    corners = [(ends[a, 0], ends[b, 1], ends[c, 2]) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    return np.concatenate([points, corners])
