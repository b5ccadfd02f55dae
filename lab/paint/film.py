"""A film: the layout of its page, and the picture of any frame.

Lengths on the page are in units u, 1/36 of the height of a 16:9 picture, so that all sizes have the same layout: the
tanks on the left, a column of readings, plot and colour bar on the right.
"""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from PIL import Image, ImageDraw

from lab.base.errors import LabError
from lab.paint import decorations as deco
from lab.paint import palette
from lab.paint.colours import bed_colours, colouring, mark_colours, spread
from lab.paint.curves import TOLERANCE, plots
from lab.paint.footage import Bed, Footage
from lab.paint.painter import Camera, Edges, paint_grains, paint_plate, paint_tank, to_discs
from lab.paint.sea import LINE
from lab.paint.water.gauges import Marks, hues_of
from lab.paint.water.layer import WaterLayer
from lab.preset.fields import taken_of
from lab.preset.sections.ship import axis_motion
from lab.preset.sections.video import Video, colours_of
from lab.preset.units import quoted

FRAMES = taken_of(Video)["frame"].words
SMALLEST, LARGEST = (320, 180), (7680, 4320)  # pixels
MOST_BEDS = 6  # beds of one recording shown side by side

MARGIN, COLUMN, GAP, WALL, PLATE = 2.0, 17.0, 2.5, 0.36, 0.3  # in u
TEXT, READING, TITLE = 1.1, 1.35, 1.45  # heights of letters in u
BAND = 2.6  # height in u of the band across the picture of a lost ship
THICKEST = 0.04  # largest wall thickness relative to the tank's smaller side
ROOM = 0.3  # largest margin around an open tank relative to its larger side; smaller for many tanks


@dataclass(frozen=True)
class Look:
    """The user's choices: size in pixels, colour and frame by name, playback speed (1: real time)."""

    width: int
    height: int
    colour: str
    frame: str
    speed: float


def choose_look(footage: Footage, **options: object) -> Look:
    """The look from the `options` that are not None, else the preset's [video]; raises LabError."""
    wanted = {key: value for key, value in options.items() if value is not None}
    look = Look(**{**asdict(footage.settings), **wanted})
    words = colours_of(footage.matters)
    look = look if look.colour else replace(look, colour=words[0])
    pairs = zip((look.width, look.height), SMALLEST, LARGEST, strict=True)
    if not all(isinstance(size, int) and size % 2 == 0 and low <= size <= high for size, low, high in pairs):
        raise LabError(
            f"Pictures of {quoted(look.width)} x {quoted(look.height)} pixels cannot be filmed: width and height must "
            f"be even, {SMALLEST[0]} x {SMALLEST[1]} at least and {LARGEST[0]} x {LARGEST[1]} at most."
        )
    if look.colour not in words:
        raise LabError(f"Unknown colour '{quoted(str(look.colour))[1:-1]}': choose one of {', '.join(words)}.")
    if look.frame not in FRAMES:
        raise LabError(f"Unknown frame '{quoted(str(look.frame))[1:-1]}': choose one of {', '.join(FRAMES)}.")
    if not isinstance(look.speed, int | float) or not 0 < look.speed < math.inf:
        raise LabError(f"The playback speed {quoted(look.speed)} cannot be used: choose one above 0.")
    return look


def choose_beds(footage: Footage, world: int | None = None) -> list[Bed]:
    """The beds of a recording, or only number `world`, counted from 0; raises LabError."""
    if world is not None and not 0 <= world < footage.worlds:
        last = footage.worlds - 1
        raise LabError(f"There is no world {world} in this recording: choose 0 to {last}.")
    worlds = range(footage.worlds) if world is None else [world]
    return [Bed(footage, k, f"bed {k + 1}" if footage.worlds > 1 else "") for k in worlds]


class Film:
    """The pictures of some beds in one look; Taichi must be running (`solvers.machine.runtime`).

    beds: of one or several recordings, all drawn to one scale and with the times of the longest recording; the others
    keep their last frame. most: how many are shown; the plot has all. time (F,): of the pictures, s.
    """

    def __init__(self, beds: Sequence[Bed], look: Look, title: str | None = None, most: int = MOST_BEDS) -> None:
        self._look, self._all, self._beds = look, list(beds), list(beds)[:most]
        self._title = title or beds[0].footage.title
        self._unit = min(look.width / 64, look.height / 36)
        self.time = max((bed.footage.time for bed in self._beds), key=lambda time: time[-1])
        self._rows = [_nearest(bed.footage.time, self.time) for bed in self._beds]
        self._pose = np.stack([bed.pose[rows] for bed, rows in zip(self._beds, self._rows, strict=True)], axis=1)
        self._moved = np.stack([_motion(bed, self._pose[:, k]) for k, bed in enumerate(self._beds)], axis=1)
        self._together = bool(np.ptp(self._pose, axis=1).max() < TOLERANCE)
        self._named = any(bed.name for bed in self._beds)
        self._hues = palette.SERIES if len(self._beds) <= len(palette.SERIES) else bed_colours(len(self._beds))
        self._colouring = colouring(look.colour, self._beds)
        self._water = WaterLayer(self._beds, look.colour, self._unit)
        self._bar = self._water.colouring or self._colouring
        self._marks = self._find_marks()
        self._sorts = _sort_by_shape(self._beds)
        self._grounds = self._find_grounds()
        self._cameras, self._names_at, self._name_width = self._place_beds()
        self._plots = self._prepare_plots()
        self._page = self._draw_page()

    def picture(self, frame: int) -> np.ndarray:
        """The picture (height, width, 3), u8, of one frame."""
        picture = self._page.copy()
        self._paint_beds(picture, frame)
        self._paint_marks(picture, frame)
        image = Image.fromarray(picture)
        self._draw_readings(image, frame)
        self._draw_ends(image, frame)
        for k, marks in self._marks.items():
            marks.name(image, self._tank_camera(k, frame))
        now = self.time[frame] + 1e-9
        for plot, samples, corner in self._plots:
            image.paste(plot.picture([max(1, int(np.searchsorted(time, now, "right"))) for time in samples]), corner)
        return np.asarray(image)

    @property
    def lost(self) -> bool:
        """Whether a ship that is shown capsizes or floods."""
        return any(bed.footage.ends[bed.world] for bed in self._beds)

    def _draw_ends(self, image: Image.Image, frame: int) -> None:
        """Draw a band with the text on the loss of each ship lost so far, across the foot of her picture."""
        draw = ImageDraw.Draw(image)
        for bed, camera, ground in zip(self._beds, self._cameras, self._grounds, strict=True):
            end = bed.footage.ends[bed.world]
            if end and end.time <= self.time[frame] + TOLERANCE:
                (left, bottom), (right, _) = camera.pixels(np.array(ground))
                height = min(BAND * self._unit, 0.25 * (right - left))
                box = left, bottom - height, right, bottom
                deco.draw_band(draw, box, f"She {end.words}", min(TITLE * self._unit, 0.6 * height))

    def _u(self, units: float) -> int:
        return round(units * self._unit)

    def _column(self) -> tuple[int, int]:
        """Left and right edge of the column of readings."""
        right = self._look.width - self._u(MARGIN)
        return right - self._u(COLUMN), right

    def _plot_box(self, count: int) -> tuple[int, int, int, int]:
        """Left, top, right, bottom of so many plots, above the colour bar if there is one."""
        left, right = self._column()
        top, bar = (12.0, 4.6 + 2.2) if count == 1 or self._beds[0].footage.sea else (9.6, 4.6 + 1.2)
        lowest = self._look.height - self._u(MARGIN + (bar if self._bar or count == 1 else 0.0))
        return left, self._u(top), right, min(lowest, self._u(top + 16.0 * count))

    def _stage(self) -> tuple[int, int, int, int]:
        """Left, top, right, bottom of the part of the page with the tanks."""
        right, bottom = self._column()[0] - self._u(GAP), self._look.height - self._u(MARGIN + 2.8)
        return self._u(MARGIN), self._u(MARGIN + TITLE + 1.5), right, bottom

    def _find_grounds(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Lower and upper corner (m) of the box around each tank, its parts and, up to a limit, its grains."""
        tanks = [self._seen(bed.footage.outline, bed.pose).reshape(-1, 2) for bed in self._beds]
        reached = {bed: [tank.min(axis=0), tank.max(axis=0)] for bed, tank in zip(self._beds, tanks, strict=True)}
        for bed, frame in spread([bed for bed in self._beds if bed.footage.protrudes]):
            places = bed.plates(frame)
            if bed.footage.open_edges and not bed.empty:
                places.append(bed.position(frame))
            for points in places:
                seen = self._seen(points, bed.pose[frame])
                reached[bed] += [np.fmin.reduce(seen), np.fmax.reduce(seen)]
        grounds = []
        for bed, corners in reached.items():
            room = ROOM / np.sqrt(len(self._beds)) * np.ptp(bed.footage.outline, axis=0).max()
            within = np.clip(corners, corners[0] - room, corners[1] + room)
            if bed.footage.sea and self._look.frame == "earth":
                grounds.append(bed.footage.sea.ground(self._seen(bed.footage.afloat, bed.pose).reshape(-1, 2)))
                continue
            grounds.append((np.nanmin(within, axis=0), np.nanmax(within, axis=0)))
        return grounds

    def _seen(self, points: np.ndarray, pose: np.ndarray) -> np.ndarray:
        """Points of the tank in the frame of reference that is drawn."""
        return _carried(points, pose) if self._look.frame == "earth" else np.asarray(points)

    def _place_beds(self) -> tuple[list[Camera], list[tuple[float, float]], float]:
        """Camera and place of the name of each bed, in the grid that shows them largest; the width of a cell."""
        left, top, right, bottom = self._stage()
        stage = np.array([right - left, bottom - top])
        wall, gap = WALL * self._unit, 1.5 * self._unit
        name = 1.8 * self._unit if self._named else 0.0
        around = np.array([2 * wall, 2 * wall + name])
        extent = np.max([high - low for low, high in self._grounds], axis=0)
        count = len(self._beds)

        def grid(columns: int) -> np.ndarray:
            return np.array([columns, -(-count // columns)])

        def scale(columns: int) -> float:
            cell = (stage - gap * (grid(columns) - 1)) / grid(columns)
            return float(((cell - around) / extent).min())

        columns = max(range(1, count + 1), key=scale)
        largest = scale(columns)
        pitch = largest * extent + around + gap
        start = np.array([left, top]) + (stage - pitch * grid(columns) + gap) / 2
        cells = [start + pitch * (k % columns, k // columns) for k in range(count)]
        cameras = []
        for cell, (low, high) in zip(cells, self._grounds, strict=True):
            spare = largest * (extent - (high - low)) * (0.5, 1.0)  # a smaller tank is centred, at the bottom
            inner = np.array([wall, wall + name]) + spare + largest * np.array([-low[0], high[1]])
            cameras.append(Camera(largest, tuple(cell + inner)))
        names = [(x, y + name - 0.5 * self._unit) for x, y in cells]
        return cameras, names, float(pitch[0] - 0.5 * gap)

    def _find_marks(self) -> dict[int, Marks]:
        """The gauges of each bed with water, in the colours of their curves."""
        found = {}
        for k, bed in enumerate(self._beds):
            if pool := bed.footage.water:
                names = (*pool.gauges, *pool.levels)
                hues = hues_of(pool) if len(self._all) == 1 else dict.fromkeys(names, self._hues[k])
                found[k] = Marks(bed.footage.outline, pool, hues, self._unit)
        return found

    def _paint_marks(self, picture: np.ndarray, frame: int) -> None:
        """The gauges, with the levels at the time of a frame."""
        for k, marks in self._marks.items():
            footage, world = self._beds[k].footage, self._beds[k].world
            depths = {}
            for level, name in enumerate(marks.pool.levels):
                measured = footage.measured("level_depth")[:, world, level]
                depths[name] = float(np.interp(self.time[frame], footage.series_time, measured))
            marks.paint(picture, self._tank_camera(k, frame), depths)

    def _tank_camera(self, k: int, frame: int) -> Camera:
        """The camera for points of the tank of bed k."""
        camera = self._cameras[k]
        return camera.carried(self._pose[frame, k]) if self._look.frame == "earth" else camera

    def _prepare_plots(self) -> list[tuple[deco.LivePlot, list[np.ndarray], tuple[int, int]]]:
        """The plots one above the other: each with the times of the points of each curve, and its corner."""
        drawn = plots(self._all, self._hues[: len(self._beds)])
        left, top, right, bottom = self._plot_box(len(drawn))
        gap, below = (self._u(0.8), self._u(1.2)) if len(drawn) > 1 else (0, 0)  # the last one says what is across
        height, found = (bottom - top - below - gap * (len(drawn) - 1)) // len(drawn), []
        indent = 0.0
        for plot in (*drawn, *drawn):  # twice, since the axes stand below each other
            last = plot is drawn[-1]
            labels, size = (plot.labels[0] if last else "", plot.labels[1]), (right - left, height + last * below)
            live = deco.LivePlot(size, plot.curves, plot.colours, labels, TEXT * self._unit, plot.names, indent)
            found.append((live, plot.samples, (left, top + (len(found) % len(drawn)) * (height + gap))))
            indent = max(indent, live.indent)
        return found[len(drawn) :]

    def _draw_page(self) -> np.ndarray:
        """Draw the parts that stay the same in all frames."""
        look, text = self._look, TEXT * self._unit
        image = Image.new("RGB", (look.width, look.height), palette.PAPER)
        draw = ImageDraw.Draw(image)
        left, _, right, _ = self._stage()
        column_left, column_right = self._column()
        bottom = look.height - self._u(MARGIN)
        title, face = deco.fitted(self._title, right - left, TITLE * self._unit, bold=True)
        draw.text((left, self._u(MARGIN)), title, palette.INK, face, anchor="la")
        longest = 0.25 * (right - left)
        deco.draw_scale_bar(draw, (left, bottom), longest, self._cameras[0].scale, text)
        draw.text((right, bottom - 0.3 * text), self._note(), palette.QUIET, deco.font(text), anchor="rm")
        bar = column_left, bottom - self._u(4.6), column_right, bottom
        if self._bar:
            deco.draw_colour_bar(image, bar, self._bar, text)
        page = np.array(image)
        colours = (palette.WALL, palette.HOLD) if look.frame == "tank" else (palette.GRID, palette.PAPER)
        for bed, camera in zip(self._beds, self._cameras, strict=True):
            if not (bed.footage.sea and look.frame == "earth"):
                self._paint_tank(page, bed, camera, *colours)  # in the earth frame, a faint tank at its rest position
            if look.frame == "tank":
                _paint_fixed(page, bed, camera)
        return page

    def _note(self) -> str:
        """A note on playback speed and number of beds shown, if they need one."""
        notes = []
        if self._look.speed != 1:
            notes.append(f"played at {self._look.speed:g} times real time")
        if len(self._all) > len(self._beds):
            notes.append(f"{len(self._beds)} of {len(self._all)} beds")
        return ", ".join(notes)

    def _paint_beds(self, picture: np.ndarray, frame: int) -> None:
        discs, colours = {}, {}
        for k, bed in enumerate(self._beds):
            row, camera = self._rows[k][frame], self._cameras[k]
            if self._look.frame == "earth":
                if bed.footage.sea:
                    self._paint_ship(picture, k, frame)
                camera = self._tank_camera(k, frame)
                self._paint_tank(picture, bed, camera, palette.WALL, palette.HOLD)
                _paint_fixed(picture, bed, camera)
            self._water.paint(picture, camera, bed, row)
            if not bed.empty:
                place = self._on_ground(k, bed.position(row), self._pose[frame, k])
                discs[k] = to_discs(camera, place, bed.radius, bed.angle(row))
                colours[k] = self._colouring.colours(bed, row)
            for line in bed.plates(row):
                paint_plate(picture, camera, line, PLATE * self._unit, palette.PART)
        for painted, edges in self._sorts:
            colour = np.concatenate([colours[k] for k in painted])
            paint_grains(picture, np.concatenate([discs[k] for k in painted]), colour, mark_colours(colour), edges)

    def _paint_ship(self, picture: np.ndarray, k: int, frame: int) -> None:
        """The sea around bed k, and the hull in it."""
        sea, camera = self._beds[k].footage.sea_of(self._rows[k][frame]), self._cameras[k]
        sea.paint(picture, camera, self._grounds[k], self.time[frame], LINE * self._unit)
        thick = min(WALL * self._unit, max(1.0, THICKEST * camera.scale * np.ptp(sea.hull, axis=0).min()))
        sea.paint_hull(picture, camera.carried(self._pose[frame, k]), thick)

    def _on_ground(self, k: int, position: np.ndarray, pose: np.ndarray) -> np.ndarray:
        """Grain positions (n, 2), NaN for those outside the box that is shown for bed k."""
        low, high = self._grounds[k]
        radius = self._beds[k].radius[:, None]
        seen = self._seen(position, pose)
        off = (seen < low - radius) | (seen > high + radius)
        return np.where(off.any(axis=1, keepdims=True), np.nan, position)

    def _paint_tank(self, picture: np.ndarray, bed: Bed, camera: Camera, wall: tuple, hold: tuple) -> None:
        thick = min(WALL * self._unit, max(1.0, THICKEST * camera.scale * np.ptp(bed.footage.outline, axis=0).min()))
        for basin in bed.footage.basins:
            paint_tank(picture, camera, basin.drawn, thick, wall, hold, basin.open_edges)

    def _draw_readings(self, image: Image.Image, frame: int) -> None:
        """Clock, tilt, displacement and gravity in the column, names above the beds."""
        draw = ImageDraw.Draw(image)
        left, right = self._column()
        top, width = self._u(MARGIN), right - left
        readings = [f"t = {deco.number(self.time[frame], 2)} s"]
        if self._together:
            readings += [f"{name} {value}" for name, value in self._pose_readings(frame, 0)]
            if self._look.frame == "tank":
                dial = deco.gravity_dial(self._u(5.6), float(self._pose[frame, 0, 2]))
                image.paste(dial, (right - dial.width, top))
                width -= dial.width + self._u(0.5)
        for line, reading in enumerate(readings):
            place = left, top + line * self._u(1.75 * READING)
            text, face = deco.fitted(reading, width, READING * self._unit)
            draw.text(place, text, palette.INK, face, anchor="la")
        if self._named:
            self._draw_names(draw, frame)

    def _draw_names(self, draw: ImageDraw.ImageDraw, frame: int) -> None:
        """The beds' names and, for a few beds, the readings in which their poses differ."""
        with_readings = not self._together and len(self._beds) <= MOST_BEDS
        for k, bed in enumerate(self._beds):
            aside = f" ({self._pose_readings(frame, k)[0][1]})" if with_readings else ""
            text, face = deco.fitted(bed.name + aside, self._name_width, TEXT * self._unit)
            draw.text(self._names_at[k], text, self._hues[k], face, anchor="ls")

    def _pose_readings(self, frame: int, k: int) -> list[tuple[str, str]]:
        """Names and values of tilt, sway and heave of a shown bed, without those that never change."""
        sway, heave, tilt = self._moved[frame, k].tolist()
        moves = (np.abs(self._moved) > TOLERANCE).any(axis=(0, 1))[[2, 0, 1]]
        readings = [
            ("φ =", f"{deco.number(np.degrees(tilt), 1)}°"),
            ("sway", f"{deco.number(1000 * sway, 1)} mm"),
            ("heave", f"{deco.number(1000 * heave, 1)} mm"),
        ]
        return [reading for reading, moving in zip(readings, moves, strict=True) if moving]


def _motion(bed: Bed, pose: np.ndarray) -> np.ndarray:
    """Sway, heave and roll (F, 3) as displayed: of the tank, or of a ship's axis."""
    return axis_motion(bed.footage.sea.ship, pose) if bed.footage.sea else pose


def _sort_by_shape(beds: Sequence[Bed]) -> list[tuple[list[int], Edges | None]]:
    """Indices of the beds of discs, and of the beds of irregular grains with their edges; without empty groups."""
    round_ones = [k for k, bed in enumerate(beds) if bed.edges is None and not bed.empty]
    others = [k for k, bed in enumerate(beds) if bed.edges is not None]
    groups = [(round_ones, None)] if round_ones else []
    return [*groups, (others, Edges.joined([beds[k].edges for k in others]))] if others else groups


def _paint_fixed(picture: np.ndarray, bed: Bed, camera: Camera) -> None:
    """The fixed grains of a rough wall, grey and without marks."""
    fixed = bed.footage.fixed
    colour = np.tile(palette.FIXED, (len(fixed), 1))
    paint_grains(picture, to_discs(camera, fixed[:, :2], fixed[:, 2], np.zeros(len(fixed))), colour, colour)


def _nearest(there: np.ndarray, time: np.ndarray) -> np.ndarray:
    """The rows of `there` (K,), ascending, that are nearest to each of `time` (F,)."""
    after = np.clip(np.searchsorted(there, time), 1, max(len(there) - 1, 1))
    before = after - 1
    after = np.minimum(after, len(there) - 1)
    return np.where(time - there[before] <= there[after] - time, before, after)


def _carried(points: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Earth-frame places (..., m, 2) of tank points (m, 2): (Y, Z) + R(phi) r, pose (..., 3)."""
    cosine, sine = np.cos(pose[..., 2, None]), np.sin(pose[..., 2, None])
    y, z = points.T
    across = pose[..., 0, None] + cosine * y - sine * z
    up = pose[..., 1, None] + sine * y + cosine * z
    return np.stack([across, up], axis=-1)
