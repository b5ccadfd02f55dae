"""The view of a picture: the beds side by side in one scale, with all that stands around them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image

from lab.paint import decorations as deco
from lab.paint.bulk.layer import BulkLayer
from lab.paint.colours import Colouring, spread
from lab.paint.footage import Bed
from lab.paint.page.layout import TEXT, Box
from lab.paint.page.theme import Theme
from lab.paint.painter import Camera, Edges, paint_grains, paint_tank, to_discs
from lab.paint.scene.backdrop import paint_sky
from lab.paint.scene.bodies import paint_parts
from lab.paint.scene.cells import Cells, Room, lay_cells
from lab.paint.scene.drive import paint_arrow
from lab.paint.scene.ends import BAND, draw_ends
from lab.paint.scene.floating_ship import FloatingShip
from lab.paint.scene.openings import name_openings
from lab.paint.scene.overlay import Overlay
from lab.paint.scene.ship import silhouette
from lab.paint.water.gauges import Marks, hues_of
from lab.paint.water.layer import WaterLayer

WALL = 0.36  # thickness in u
THICKEST = 0.04  # largest wall thickness relative to the tank's smaller side
ROOM = 0.3  # largest margin around an open tank relative to its larger side; smaller for many tanks
ARROW, LABEL = 1.4, 2.3  # u, room for the arrow of the drive and for names of gauges
AIR = 0.6  # u, between a name and what is to its right
STILL = 1e-9  # m, rad: poses that differ by less are told once, for all beds
NAME = 1.8  # u, for the name of a bed
FOLLOW = 0.35  # of her breadth and height: a ship that goes farther sideways or up is followed by the camera
HOUSE = 1.0, 0.8  # of the superstructure's height that has room in the view, of one ship alone and of several


@dataclass(frozen=True)
class ViewSetting:
    """How a view is painted: its box and the canvas around it in pixels, pixels a unit, theme, frame and overlay."""

    box: Box
    canvas: Box
    unit: float
    theme: Theme
    frame: str
    overlay: str = "none"


class SceneView:
    """Beds in one scale; rows (K, F): of their frames, maybe between two, pose (F, K, 3): at the pictures' times."""

    def __init__(
        self, beds: Sequence[Bed], setting: ViewSetting, rows: np.ndarray, pose: np.ndarray, time: np.ndarray
    ) -> None:
        self.beds, self.setting, self._unit, self._theme = list(beds), setting, setting.unit, setting.theme
        self._rows, self._time = rows, time
        self._earth = setting.frame == "earth"
        self._named = any(bed.name for bed in beds)
        alike = bool(np.ptp(pose, axis=1).max(initial=0.0) < STILL)  # else readings stand behind the names
        self._may_stand_beside = self._named and alike
        self._sorts = _sort_by_shape(beds)
        self._afloat = self._earth and all(bed.footage.sea for bed in beds)
        self._drift = pose * np.array([self._drifts(bed) for bed in beds])
        self._pose = pose - self._drift
        self.grounds = [self._ground(bed) for bed in beds]
        if self._afloat:  # still water at one height
            low, high = np.min(self.grounds, axis=0)[0], np.max(self.grounds, axis=0)[1]
            self.grounds = [(low, high)] * len(beds)
        self._cells = self._place_beds()
        self.cameras, self.names_at, self.name_width = self._cells.cameras, self._cells.names, self._cells.width
        self.marks: dict[int, Marks] = {}
        self.overlay = Overlay(setting.overlay, self.beds, rows, setting.theme)

    def style(self, grains: Colouring | None, water: WaterLayer, bulk: BulkLayer, hues: Sequence[tuple]) -> None:
        """Say what the colours show; hues: of the beds."""
        self._colouring, self._water, self._bulk = grains, water, bulk
        for k, bed in enumerate(self.beds):
            if pool := bed.footage.water:
                own = hues_of(pool, self._theme.series) if len(hues) == 1 else None
                named = own or dict.fromkeys((*pool.gauges, *pool.levels), hues[k])
                self.marks[k] = Marks(bed.footage.outline, pool, named, self._unit, self._theme.paper)

    # What stays the same

    def paint_backdrop(self, page: np.ndarray) -> None:
        """Paint what does not move: the sky, tanks that the camera moves with, and the ghosts of tanks at rest."""
        theme = self._theme
        for k, (bed, camera) in enumerate(zip(self.beds, self.cameras, strict=True)):
            if bed.footage.sea and self._earth:
                paint_sky(page, self._sea_box(k), camera.offset[1], theme)
            elif self._earth:
                self._paint_tank(page, bed, camera, ghost=True)
            else:
                self._paint_tank(page, bed, camera)
                self._paint_fixed(page, bed, camera)

    def _sea_box(self, k: int) -> Box:
        """The pixels that sky and sea of bed k fill: of a single one all around the view."""
        if len(self.beds) == 1:
            return self.setting.canvas
        return self._cells.boxes[k]

    def _drifts(self, bed: Bed) -> np.ndarray:
        """Whether (3,) a ship goes so far in sway, or in heave, that the camera goes with her; never in roll."""
        if not self._afloat:
            return np.zeros(3, dtype=bool)
        return np.append(np.ptp(bed.pose[:, :2], axis=0) > FOLLOW * np.ptp(bed.footage.sea.hull, axis=0), False)

    # What moves

    def paint(self, picture: np.ndarray, frame: int) -> None:
        """Paint the beds at the time of a picture, in place."""
        grains, theme = {}, self._theme
        for k in range(len(self.beds)):
            if self._earth:
                self._paint_around(picture, k, frame)
            grains |= self._paint_inside(picture, k, frame, self.tank_camera(k, frame))
        self._paint_grains(picture, grains)
        for k, bed in enumerate(self.beds):
            self._water.paint_table(picture, self.tank_camera(k, frame), bed, self._rows[k][frame])
            self.overlay.paint(picture, self.tank_camera(k, frame), bed, k, frame)
            self._paint_marks(picture, k, frame)
            if self._earth and not bed.footage.sea:
                unit = self._unit / np.sqrt(len(self.beds))
                paint_arrow(picture, self.cameras[k], bed.footage.outline, self._pose[frame, k], unit, theme.accent)

    def paint_part(self, picture: np.ndarray, k: int, frame: int, camera: Camera) -> None:
        """Paint a part of bed k alone, larger, in place; camera: of the tank's points."""
        bed = self.beds[k]
        self._paint_tank(picture, bed, camera)
        self._paint_fixed(picture, bed, camera)
        self._paint_grains(picture, self._paint_inside(picture, k, frame, camera, part=True))
        self._water.paint_table(picture, camera, bed, self._rows[k][frame])
        self.overlay.paint(picture, camera, bed, k, frame)
        self._paint_marks(picture, k, frame, camera)

    def tank_camera(self, k: int, frame: int) -> Camera:
        """The camera for points of the tank of bed k."""
        camera = self.cameras[k]
        return camera.carried(self._pose[frame, k]) if self._earth else camera

    def write_names(self, image: Image.Image, frame: int) -> None:
        """Write the names of gauges and openings beside them."""
        for k, marks in self.marks.items():
            camera, row = self.tank_camera(k, frame), self._rows[k][frame]
            marks.name(image, camera)
            name_openings(image, camera, self.beds[k], row, self._time[frame], self._unit, self._theme)

    def draw_ends(self, image: Image.Image, frame: int) -> None:
        """Draw a band with the text on the loss of each ship lost so far, at the foot of her cell."""
        draw_ends(image, self.beds, self._cells.boxes, self._time[frame], self._unit, self._theme)

    def _paint_around(self, picture: np.ndarray, k: int, frame: int) -> None:
        """Sea and hull, or the tank."""
        bed, camera, carried = self.beds[k], self.cameras[k], self.tank_camera(k, frame)
        if bed.footage.sea:
            across, up, _ = camera.scale * self._drift[frame, k]
            still, thick = camera.shifted(across, -up), self._thick(bed.footage.sea.hull, camera)
            sea = bed.footage.sea_of(round(float(self._rows[k][frame])))
            afloat = FloatingShip(sea, carried, still, self._time[frame], thick, self._unit)
            afloat.paint(picture, self._sea_box(k), self._theme)
        self._paint_tank(picture, bed, carried)
        self._paint_fixed(picture, bed, carried)

    def _paint_inside(self, picture: np.ndarray, k: int, frame: int, camera: Camera, part: bool = False) -> dict:
        """Water and parts; returns what the grains of the bed need to be painted."""
        bed, row, found = self.beds[k], self._rows[k][frame], {}
        self._water.paint(picture, camera, bed, row, self._theme.hold)
        self._bulk.paint(picture, camera, bed, row, self._theme.hold)
        if not bed.empty:
            place = bed.position(row)
            place = place if part else self._on_ground(k, place, self._pose[frame, k])
            colour = self.overlay.under(self._colouring.colours(bed, row))
            marks, *rest = self._colouring.style(bed, colour)
            size = self._water.grain_size * bed.radius
            found[k] = to_discs(camera, place, size, bed.angle(row)), colour, (self.overlay.under(marks), *rest)
        paint_parts(picture, camera, bed, row, self._time[frame], self._unit, self._theme)
        return found

    def _paint_grains(self, picture: np.ndarray, grains: dict) -> None:
        for painted, edges in self._sorts:
            here = [k for k in painted if k in grains]
            if not here:
                continue
            dressed = [grains[k] for k in here]
            if edges is not None and len(here) < len(painted):
                edges = Edges.joined([self.beds[k].edges for k in here])
            discs, colour = (np.concatenate([one[part] for one in dressed]) for part in (0, 1))
            marks = np.concatenate([one[2][0] for one in dressed])
            finish = None if dressed[0][2][2] is None else np.concatenate([one[2][2] for one in dressed])
            paint_grains(picture, discs, colour, marks, edges, finish)

    def _on_ground(self, k: int, position: np.ndarray, pose: np.ndarray) -> np.ndarray:
        """Grain positions (n, 2), NaN for those outside the box that is shown for bed k."""
        low, high = self.grounds[k]
        radius = self.beds[k].radius[:, None]
        seen = self._seen(position, pose)
        off = (seen < low - radius) | (seen > high + radius)
        return np.where(off.any(axis=1, keepdims=True), np.nan, position)

    def _paint_marks(self, picture: np.ndarray, k: int, frame: int, camera: Camera | None = None) -> None:
        """The gauges of bed k, with the levels at the time of a frame."""
        if k not in self.marks:
            return
        depths = self.beds[k].depths(self._time[frame])
        self.marks[k].paint(picture, camera or self.tank_camera(k, frame), depths)

    def _thick(self, outline: np.ndarray, camera: Camera) -> float:
        return min(WALL * self._unit, max(1.0, THICKEST * camera.scale * np.ptp(outline, axis=0).min()))

    def _paint_tank(self, picture: np.ndarray, bed: Bed, camera: Camera, ghost: bool = False) -> None:
        """The tank, of steel aboard a ship and of glass ashore, or its ghost at rest."""
        footage, thick, theme = bed.footage, self._thick(bed.footage.outline, camera), self._theme
        wall, hold = (theme.ghost, theme.paper) if ghost else (theme.wall, theme.hold)
        core = None if ghost or footage.sea else theme.glass
        for basin in footage.basins:
            paint_tank(picture, camera, basin.drawn, thick, wall, hold, basin.open_edges, core)

    def _paint_fixed(self, picture: np.ndarray, bed: Bed, camera: Camera) -> None:
        """The fixed grains of a rough wall, grey and without marks."""
        fixed = bed.footage.fixed
        if not len(fixed):
            return
        colour = np.tile(self._theme.fixed, (len(fixed), 1))
        paint_grains(picture, to_discs(camera, fixed[:, :2], fixed[:, 2], np.zeros(len(fixed))), colour, colour)

    # Where the beds stand

    def _ground(self, bed: Bed) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the box around a tank, its parts and, up to a limit, its grains."""
        footage = bed.footage
        if footage.sea and self._earth:
            pose = np.where(self._drifts(bed), 0.0, bed.pose)
            low, high = footage.sea.ground(self._seen(footage.afloat, pose).reshape(-1, 2))
            house = silhouette(footage.sea.ship)
            above = 0.0 if house is None else HOUSE[len(self.beds) > 1] * np.ptp(house[:, 1])
            return low, high + np.array([0.0, above])
        tank = self._seen(footage.outline, bed.pose).reshape(-1, 2)
        corners = [tank.min(axis=0), tank.max(axis=0)]
        if self._earth:
            corners += list(footage.outline)
        if footage.protrudes:
            for _, frame in spread([bed]):
                places = bed.plates(frame)
                if footage.open_edges and not bed.empty:
                    places.append(bed.position(frame))
                for points in places:
                    seen = self._seen(points, bed.pose[frame])
                    corners += [np.fmin.reduce(seen), np.fmax.reduce(seen)]
        room = ROOM / np.sqrt(len(self.beds)) * np.ptp(footage.outline, axis=0).max()
        around = np.clip(corners, corners[0] - room, corners[1] + room)
        return np.nanmin(around, axis=0), np.nanmax(around, axis=0)

    def _seen(self, points: np.ndarray, pose: np.ndarray) -> np.ndarray:
        """Points of the tank in the frame of reference that is drawn."""
        return carried(points, pose) if self._earth else np.asarray(points)

    def _place_beds(self) -> Cells:
        """Cameras, names and boxes of the beds."""
        afloat, several = self._afloat, len(self.beds) > 1
        room = max(ARROW * (self._earth and not afloat), LABEL * any(bed.footage.water for bed in self.beds))
        lost = afloat and several and any(bed.footage.ends[bed.world] for bed in self.beds)
        around = Room(
            (WALL + room / np.sqrt(len(self.beds))) * self._unit,
            NAME * self._unit * self._named,
            BAND * self._unit * lost,
            filled=afloat and several,
            beside=self._names_wide() * (self._may_stand_beside and not afloat),
        )
        return lay_cells(self.grounds, self.setting.box, self._unit, around)

    def _names_wide(self) -> float:
        """The width (pixels) of the longest name, with some air."""
        return max(deco.font(TEXT * self._unit).getlength(bed.name) for bed in self.beds) + AIR * self._unit


def carried(points: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Earth-frame places (..., m, 2) of tank points (m, 2): (Y, Z) + R(phi) r, pose (..., 3)."""
    cosine, sine = np.cos(pose[..., 2, None]), np.sin(pose[..., 2, None])
    y, z = np.asarray(points).T
    across = pose[..., 0, None] + cosine * y - sine * z
    up = pose[..., 1, None] + sine * y + cosine * z
    return np.stack([across, up], axis=-1)


def _sort_by_shape(beds: Sequence[Bed]) -> list[tuple[list[int], Edges | None]]:
    """Indices of the beds of discs, and of the beds of irregular grains with their edges; without empty groups."""
    round_ones = [k for k, bed in enumerate(beds) if bed.edges is None and not bed.empty]
    others = [k for k, bed in enumerate(beds) if bed.edges is not None]
    groups = [(round_ones, None)] if round_ones else []
    return [*groups, (others, Edges.joined([beds[k].edges for k in others]))] if others else groups
