"""The picture of a live experiment: the tank on its stage, and a column of readings and sliders.

Lengths are in units u, 1/36 of the height of a 16:9 picture, as in `lab.paint.film`.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageOps

from lab.paint import decorations as deco
from lab.paint.colours import Colouring, colouring, mark_colours
from lab.paint.painter import Camera, paint_grains, paint_plate, paint_strokes, paint_tank, to_discs
from lab.paint.sea import LINE
from lab.view.controls import CONTROLS, RESTARTS
from lab.view.curves import CURVES
from lab.view.forces import chains, newtons
from lab.view.help import draw_help
from lab.view.readings import clock, readings

if TYPE_CHECKING:
    from lab.view.session import Session

MARGIN, COLUMN, GAP, WALL, PLATE = 1.2, 17.0, 1.5, 0.36, 0.3  # in u
TEXT, READING, TITLE, ROW = 1.0, 1.2, 1.4, 1.5  # heights in u
LINES = 5  # of readings below the clock
PLOT = 14.0, 8.5  # width and height in u
SENTENCE = 0.8, 3  # height of its letters in u, lines at most
ANEW = 2.0  # s after which scale and curve are looked at anew
HANDLE = 0.42  # u, half the height of a slider's handle
GRIP = 0.8  # u around the centre of roll
THICKEST = 0.3  # of the mean radius: half the thickness of a line of the largest force
LONGEST, FASTEST = 6.0, 0.99  # radii: a velocity's line, of which quantile
GRAB, FORCE, PICKED = (213, 94, 0), (200, 30, 30), (213, 94, 0)


class Page:
    """Pictures of sessions in one size (pixels)."""

    def __init__(self, size: tuple[int, int]) -> None:
        self.width, self.height = size
        self.unit = min(self.width / 64, self.height / 36)
        self._colouring: tuple[tuple, float, Colouring] | None = None
        self._plot: tuple[tuple, float, Image.Image] | None = None
        self._sliders: dict[str, tuple[float, float, float, float]] = {}
        self._kept: dict[str, tuple[tuple, Image.Image]] = {}
        self._largest = 0.0  # force (N) or speed (m/s), of the overlay that was painted last

    def picture(self, session: Session) -> np.ndarray:
        """The picture (height, width, 3), u8."""
        image = Image.new("RGB", (self.width, self.height), deco.PAPER)
        if session.footage is None or not len(session.footage):
            self._draw_waiting(image, session)
            return np.asarray(image)
        picture = np.array(image)
        scale = self._scale(session)
        self._paint_stage(picture, session, scale)
        image = Image.fromarray(picture)
        self._draw_column(image, session, scale)
        self._draw_stage_marks(image, session)
        if session.look.help:
            draw_help(image, session.keys, 0.9 * TEXT * self.unit)
        return np.asarray(image)

    # Places

    def u(self, units: float) -> int:
        """Pixels."""
        return round(units * self.unit)

    @property
    def stage(self) -> tuple[int, int, int, int]:
        """Left, top, right, bottom of where the tank stands."""
        right = self.width - self.u(MARGIN + COLUMN + GAP)
        return self.u(MARGIN), self.u(MARGIN + TITLE + 1.0), right, self.height - self.u(MARGIN + 2.4)

    def camera(self, session: Session) -> Camera:
        """Of the frame that is drawn: the tank's or the earth's."""
        low, high = self._ground(session)
        scale = self._fit(self._room(session), high - low) * session.look.zoom
        (x, y), pan, centre = self.middle(session), session.look.pan, 0.5 * (low + high)
        return Camera(scale, (x + pan[0] - scale * centre[0], y + pan[1] + scale * centre[1]))

    def middle(self, session: Session) -> tuple[float, float]:
        """The pixel where the middle of what is shown is, as long as it is not moved."""
        left, top, right, bottom = self._room(session)
        return 0.5 * (left + right), 0.5 * (top + bottom)

    def _room(self, session: Session) -> tuple[int, int, int, int]:
        """The part of the stage for the tank: the one in which it is largest."""
        low, high = self._ground(session)
        return max(self._rooms(session), key=lambda room: self._fit(room, high - low))

    def _rooms(self, session: Session) -> list[tuple[int, int, int, int]]:
        """Parts of the stage for the tank: all of it, or what is right of the plot or below it."""
        left, top, right, bottom = self.stage
        width, height = (self.u(side) for side in PLOT)
        if session.look.inset == "nothing":
            return [self.stage]
        if session.look.frame == "earth":  # which has room beside the tank, or sky over a ship
            return [self.stage if session.footage.sea else (left + width // 2, top, right, bottom)]
        return [(left + width, top, right, bottom), (left, top + height, right, bottom)]

    def _fit(self, room: tuple[int, int, int, int], extent: np.ndarray) -> float:
        """Pixels a metre at which so much (m) fits in a room."""
        left, top, right, bottom = room
        spare = np.array([right - left, bottom - top]) - 2.0 * self.u(WALL + 0.4)
        return float((spare / extent).min())

    def tank_camera(self, session: Session) -> Camera:
        """Of points of the tank."""
        camera = self.camera(session)
        return camera.carried(self._pose(session)) if session.look.frame == "earth" else camera

    def earth_place(self, session: Session, x: float, y: float) -> tuple[float, float]:
        """The point of the earth's frame (m) below a pixel."""
        camera = self.camera(session)
        place = complex(x - camera.offset[0], camera.offset[1] - y) / camera.scale
        if session.look.frame == "tank":
            pose = self._pose(session)
            place = complex(pose[0], pose[1]) + np.exp(1j * pose[2]) * place
        return place.real, place.imag

    def slider_at(self, x: float, y: float) -> str | None:
        """The name of the control whose slider is at a pixel."""
        for name, (left, top, right, bottom) in self._sliders.items():
            if left - self.u(0.5) <= x <= right + self.u(0.5) and top <= y <= bottom:
                return name
        return None

    def share_of_slider(self, name: str, x: float) -> float:
        """How far along its slider a pixel is, 0 to 1."""
        left, _, right, _ = self._sliders[name]
        return float(np.clip((x - left) / (right - left), 0.0, 1.0))

    def centre_at(self, session: Session, x: float, y: float) -> bool:
        """Whether the centre of roll is at a pixel."""
        place = self._centre(session)
        return place is not None and np.hypot(place[0] - x, place[1] - y) < self.u(GRIP)

    def grain_at(self, session: Session, x: float, y: float) -> int | None:
        """The number of the grain at a pixel, None where there is none."""
        places = self.tank_camera(session).pixels(session.footage.grains("position", session.frame))
        away = np.hypot(places[:, 0] - x, places[:, 1] - y) / self.camera(session).scale
        nearest = int(np.nanargmin(away - session.footage.radius[0]))
        return nearest if away[nearest] <= session.footage.radius[0][nearest] else None

    def _pose(self, session: Session) -> np.ndarray:
        return np.array([session.footage.row(session.frame, f"pose_{name}") for name in ("y", "z", "angle")])

    def _ground(self, session: Session) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of what is shown where nothing is zoomed."""
        footage = session.footage
        points = [footage.outline, *footage.parts.values()]
        low = np.min([line.min(axis=0) for line in points], axis=0)
        high = np.max([line.max(axis=0) for line in points], axis=0)
        if footage.sea:
            return footage.sea_ground if session.look.frame == "earth" else (low, high)
        if session.look.frame == "earth":  # room to turn and to sway
            low, high = low - 0.35 * (high - low), high + 0.35 * (high - low)
        return low, high

    def _centre(self, session: Session) -> np.ndarray | None:
        """The pixel of the centre of roll, None where there is none to be dragged."""
        if "centre_y" not in session.values or not session.footage:
            return None
        centre = np.array([session.values["centre_y"], session.values["centre_z"]])
        if session.look.frame == "tank":
            pose = self._pose(session)
            seen = np.exp(-1j * pose[2]) * complex(*(centre - pose[:2]))
            centre = np.array([seen.real, seen.imag])
        return self.camera(session).pixels(centre[None])[0]

    # Paint

    def _scale(self, session: Session) -> Colouring:
        """The colouring, its scale looked at anew now and then."""
        key, now = (session.look.colour, id(session.footage)), time.monotonic()
        if self._colouring is None or self._colouring[0] != key or now - self._colouring[1] > ANEW:
            self._colouring = key, now, colouring(session.look.colour, [session.footage.bed])
        return self._colouring[2]

    def _paint_stage(self, picture: np.ndarray, session: Session, scale: Colouring) -> None:
        footage, frame = session.footage, session.frame
        left, top, right, bottom = self.stage
        stage = np.ascontiguousarray(picture[top:bottom, left:right])
        camera, moved = (self._shifted(c, left, top) for c in (self.camera(session), self.tank_camera(session)))
        if session.look.frame == "earth":
            if footage.sea:
                ground = self._ground(session)
                footage.sea_of(frame).paint(stage, camera, ground, footage.row_time(frame), LINE * self.unit)
                paint_tank(stage, moved, footage.sea.hull, self._wall(camera, footage.sea.hull), deco.WALL, deco.LINE)
            else:
                faint = self._wall(camera, footage.outline)
                paint_tank(stage, camera, footage.outline, faint, deco.GRID, deco.PAPER, footage.open_edges)
        thick = self._wall(camera, footage.outline)
        paint_tank(stage, moved, footage.outline, thick, deco.WALL, deco.HOLD, footage.open_edges)
        fixed = footage.fixed
        if len(fixed):
            grey = np.tile(deco.FIXED, (len(fixed), 1))
            paint_grains(stage, to_discs(moved, fixed[:, :2], fixed[:, 2], np.zeros(len(fixed))), grey, grey)
        bed = footage.bed
        colour = scale.colours(bed, frame)
        if session.look.overlay == "forces":
            colour = 0.25 * colour + 0.75 * np.array(deco.PAPER)
        discs = to_discs(moved, bed.position(frame), bed.radius, bed.angle(frame))
        paint_grains(stage, discs, colour, mark_colours(colour), footage.edges)
        for line, shift in zip(footage.parts.values(), footage.moved_parts(frame), strict=True):
            paint_plate(stage, moved, line + shift, PLATE * self.unit, deco.PART)
        if session.look.overlay == "forces":
            paint_strokes(stage, self._force_strokes(session, moved), FORCE)
        elif session.look.overlay == "velocities":
            paint_strokes(stage, self._velocity_strokes(session, moved), deco.INK)
        picture[top:bottom, left:right] = stage

    @staticmethod
    def _shifted(camera: Camera, left: int, top: int) -> Camera:
        return Camera(camera.scale, (camera.offset[0] - left, camera.offset[1] - top), camera.turn)

    def _wall(self, camera: Camera, outline: np.ndarray) -> float:
        return min(WALL * self.unit, max(1.0, 0.04 * camera.scale * np.ptp(outline, axis=0).min()))

    # Drawings over the stage

    def _draw_stage_marks(self, image: Image.Image, session: Session) -> None:
        left, top, right, bottom = self.stage
        layer = image.crop((left, top, right, bottom))
        draw = ImageDraw.Draw(layer)
        camera = self._shifted(self.tank_camera(session), left, top)
        centre = self._centre(session)
        if centre is not None:
            x, y, r = centre[0] - left, centre[1] - top, self.u(0.45)
            draw.ellipse((x - r, y - r, x + r, y + r), outline=GRAB, width=max(1, self.u(0.12)))
            draw.line([(x - 1.7 * r, y), (x + 1.7 * r, y)], fill=GRAB)
            draw.line([(x, y - 1.7 * r), (x, y + 1.7 * r)], fill=GRAB)
        if session.look.picked is not None:
            self._draw_picked(draw, session, camera)
        if session.look.inset != "nothing":
            layer.paste(self._curve(session), (0, 0))
        image.paste(layer, (left, top))
        scale = self.camera(session).scale
        foot = self._still("foot", (scale,), lambda: self._scale_bar(0.4 * (right - left), scale))
        image.paste(foot, (left, self.height - foot.height))
        title = self._still("title", (session.footage.title,), lambda: self._title(session.footage.title, right - left))
        image.paste(title, (left, self.u(MARGIN)))
        self._draw_sentence(ImageDraw.Draw(image), session)

    def _draw_sentence(self, draw: ImageDraw.ImageDraw, session: Session) -> None:
        """What has just been said, in a few lines below the stage, or else what the overlay means."""
        right, middle = self.stage[2], 0.5 * (self.stage[3] + self.height)
        if not session.said:
            text, face = deco.fitted(self._hint(session), 0.6 * right, TEXT * self.unit)
            draw.text((right, self.height - self.u(MARGIN) - 0.3 * TEXT * self.unit), text, deco.QUIET, face, "rm")
            return
        size, most = SENTENCE[0] * self.unit, SENTENCE[1]
        lines = deco.wrapped(session.said, 0.62 * right, size, most)
        for k, line in enumerate(lines):
            y = middle + (k - 0.5 * (len(lines) - 1)) * 1.3 * size
            draw.text((0.38 * right, y), line, GRAB, deco.font(size), "lm")

    def _hint(self, session: Session) -> str:
        if session.look.overlay == "forces" and self._largest:
            return f"thickest lines: {newtons(self._largest)}    H: help"
        if session.look.overlay == "velocities" and self._largest:
            return f"longest lines: {1e3 * self._largest:.2g} mm/s    H: help"
        return "H: help"

    def _scale_bar(self, width: float, scale: float) -> Image.Image:
        image = Image.new("RGB", (round(width), self.u(MARGIN + 1.6)), deco.PAPER)
        place = 0, image.height - self.u(MARGIN)
        deco.draw_scale_bar(ImageDraw.Draw(image), place, 0.5 * width, scale, TEXT * self.unit)
        return image

    def _title(self, text: str, width: float) -> Image.Image:
        image = Image.new("RGB", (round(width), self.u(1.3 * TITLE)), deco.PAPER)
        said, face = deco.fitted(text, width, TITLE * self.unit, bold=True)
        ImageDraw.Draw(image).text((0, 0), said, deco.INK, face, anchor="la")
        return image

    def _force_strokes(self, session: Session, camera: Camera) -> np.ndarray:
        """Chains of force: lines as thick as the force, from the grains to where they press."""
        footage, frame = session.footage, session.frame
        lines, thickness, self._largest = chains(footage.pressing(frame), footage.grains("position", frame))
        half = thickness * (THICKEST * footage.radius[0].mean() * camera.scale)
        return _strokes(camera, lines, half, half)

    def _velocity_strokes(self, session: Session, camera: Camera) -> np.ndarray:
        """Lines along the velocities in the tank, which end in a point."""
        footage, frame = session.footage, session.frame
        place, velocity = (footage.grains(name, frame) for name in ("position", "velocity"))
        speed, radius = np.hypot(*velocity.T), footage.radius[0].mean()
        self._largest = float(np.nanquantile(speed, FASTEST))
        moving = speed > 0.03 * self._largest
        tips = place + velocity * (LONGEST * radius / max(self._largest, 1e-9))
        half = np.full(moving.sum(), max(0.15 * radius * camera.scale, 0.7))
        return _strokes(camera, np.stack([place, tips], axis=1)[moving], half, 0.0 * half)

    def _draw_picked(self, draw: ImageDraw.ImageDraw, session: Session, camera: Camera) -> None:
        footage, frame, i = session.footage, session.frame, session.look.picked
        (x, y), r = camera.pixels(footage.grains("position", frame)[i][None])[0], 0.0
        r = 1.3 * footage.radius[0][i] * camera.scale + 2.0
        draw.ellipse((x - r, y - r, x + r, y + r), outline=PICKED, width=max(2, self.u(0.15)))

    def _curve(self, session: Session) -> Image.Image:
        """A small plot of what the experiment does, drawn anew a few times a second."""
        key, now = (session.look.inset, id(session.footage), session.playhead), time.monotonic()
        if self._plot and self._plot[0] == key and now - self._plot[1] < 0.1 * ANEW:
            return self._plot[2]
        drawing = CURVES[session.look.inset](session.footage, session.frame)
        labels, colours = (drawing.across, drawing.upwards), deco.SERIES[: len(drawing.curves)]
        edge, size = self.u(0.5), (self.u(PLOT[0] - 1.5), self.u(PLOT[1] - 1.5))
        plot = deco.LivePlot(size, drawing.curves, colours, labels, 0.9 * TEXT * self.unit)
        image = ImageOps.expand(plot.picture(drawing.counts), edge, deco.PAPER)
        self._plot = key, now, image
        return image

    # The column

    def _draw_column(self, image: Image.Image, session: Session, scale: Colouring) -> None:
        draw, left, width = ImageDraw.Draw(image), self.width - self.u(MARGIN + COLUMN), self.u(COLUMN)
        text, face = deco.fitted(clock(session), width, READING * self.unit)
        draw.text((left, self.u(MARGIN)), text, deco.INK, face, anchor="la")
        for line, reading in enumerate(readings(session)):
            text, face = deco.fitted(reading, width, TEXT * self.unit)
            y = self.u(MARGIN + 1.6 * READING + 1.4 * TEXT * line)
            draw.text((left, y), text, deco.INK, face, anchor="la")
        key = id(scale), session.look.typing, *session.values.items()
        rest = self._still("column", key, lambda: self._still_column(session, scale))
        image.paste(rest, (left, self.controls[0]))

    @property
    def controls(self) -> tuple[int, int]:
        """Top and bottom of where the sliders are in the column."""
        return self.u(MARGIN + 1.6 * READING + 1.4 * TEXT * LINES + 0.6), self.height - self.u(MARGIN + 5.2)

    def _still_column(self, session: Session, scale: Colouring) -> Image.Image:
        """What stands below the readings until somebody changes it: sliders and colour bar."""
        top, bottom = self.controls
        size = self.u(MARGIN + COLUMN), self.height - top
        image = Image.new("RGB", size, deco.PAPER)
        bar = 0, size[1] - self.u(MARGIN + 4.4), self.u(COLUMN), size[1] - self.u(MARGIN)
        deco.draw_colour_bar(image, bar, scale, TEXT * self.unit)
        self._sliders = {}
        if not session.look.typing:
            self._draw_sliders(ImageDraw.Draw(image), session, (self.width - size[0], top), bottom - top)
        return image

    def _still(self, name: str, key: tuple, make: Callable[[], Image.Image]) -> Image.Image:
        """A part of the picture that stays as it is while its key does."""
        if name not in self._kept or self._kept[name][0] != key:
            self._kept[name] = key, make()
        return self._kept[name][1]

    def _draw_sliders(
        self, draw: ImageDraw.ImageDraw, session: Session, corner: tuple[int, int], height: float
    ) -> None:
        """A row a control, name, slider and value, on a part of the picture with this corner, so many pixels high."""
        left, right = 0, self.u(COLUMN)
        names = list(session.values)
        pitch = min(self.u(ROW), height / max(1, len(names)))
        size = min(TEXT * self.unit, 0.72 * pitch)
        begin, end = left + 0.41 * (right - left), left + 0.67 * (right - left)
        for row, name in enumerate(names):
            control, value = CONTROLS[name], session.values[name]
            y = (row + 0.5) * pitch
            x, above = corner[0], corner[1] + y - 0.5 * pitch
            self._sliders[name] = (x + begin, above, x + end, above + pitch)
            colour = deco.QUIET if control.kind == RESTARTS else deco.INK
            text, face = deco.fitted(control.label, begin - left - self.u(0.5), size)
            draw.text((left, y), text, colour, face, anchor="lm")
            draw.line([(begin, y), (end, y)], fill=deco.LINE, width=max(2, self.u(0.18)))
            share = (value - control.low) / (control.high - control.low)
            x, r = begin + float(np.clip(share, 0.0, 1.0)) * (end - begin), self.u(HANDLE)
            draw.ellipse((x - r, y - r, x + r, y + r), fill=deco.SERIES[0] if colour == deco.INK else deco.LINE)
            text, face = deco.fitted(control.shown(value), right - end - self.u(0.6), size)
            draw.text((right, y), text, colour, face, anchor="rm")

    # Whole pages

    def _draw_waiting(self, image: Image.Image, session: Session) -> None:
        draw = ImageDraw.Draw(image)
        middle = self.width / 2, self.height / 2
        text, face = deco.fitted(session.over or session.status, 0.9 * self.width, TITLE * self.unit)
        draw.text(middle, text, GRAB if session.over else deco.INK, face, anchor="mm")
        name, face = deco.fitted(session.name, 0.9 * self.width, TEXT * self.unit)
        draw.text((middle[0], middle[1] - self.u(3.0)), name, deco.QUIET, face, anchor="mm")


def _strokes(camera: Camera, lines: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Lines (k, 2, 2) m as strokes (k, 6) in pixels, half as thick (pixels) as this at their ends."""
    ends = camera.pixels(lines.reshape(-1, 2)).reshape(-1, 2, 2)
    return np.column_stack([ends[:, 0], first, ends[:, 1], second])
