"""The picture of a live experiment: the tank, and a column of readings and sliders beside it.

Lengths are in units u, 1/36 of the height of a 16:9 picture, as in `lab.paint.film`.
"""

import time
from collections.abc import Callable

import numpy as np
from PIL import Image, ImageDraw, ImageOps

from lab.paint import decorations as deco
from lab.paint import palette
from lab.paint.colours import Colouring, colouring
from lab.paint.forces.chains import newtons
from lab.paint.page.live_plot import LivePlot
from lab.paint.painter import Camera, paint_grains, paint_plate, paint_strokes, paint_tank, to_discs
from lab.paint.sea import LINE
from lab.paint.water.gauges import Marks, hues_of
from lab.paint.water.layer import WaterLayer
from lab.recording.ship_end import End
from lab.view.footage import LiveFootage
from lab.view.overlays import force_strokes, ring, velocity_strokes
from lab.view.panel.controls import CONTROLS, RESTARTS
from lab.view.panel.curves import CURVES
from lab.view.panel.help import draw_help
from lab.view.panel.readings import clock, readings
from lab.view.shown import Shown

MARGIN, COLUMN, GAP, WALL, PLATE = 1.2, 17.0, 1.5, 0.36, 0.3  # in u
TEXT, READING, TITLE, ROW, BAND = 1.0, 1.2, 1.4, 1.5, 2.4  # heights in u
LINES = 5  # lines of readings below the clock
PLOT = 14.0, 8.5  # width and height in u
SENTENCE = 0.8, 3  # a message: height of its letters in u, largest number of lines
SCALE_UPDATE, CURVE_UPDATE, TEXT_UPDATE = 2.0, 0.25, 0.1  # s after which colour scale, curve and readings are updated
HANDLE = 0.42  # u, half the height of a slider's handle
GRIP = 0.8  # u around the centre of roll
GRAB, FORCE, PICKED = (213, 94, 0), (200, 30, 30), (213, 94, 0)


class Page:
    """Pictures of experiments in one size (pixels)."""

    def __init__(self, size: tuple[int, int]) -> None:
        self.width, self.height = size
        self.unit = min(self.width / 64, self.height / 36)
        self._paper = np.tile(np.array(palette.PAPER, dtype=np.uint8), (self.height, self.width, 1))
        self._colouring: tuple[tuple, float, Colouring] | None = None
        self._sliders: dict[str, tuple[float, float, float, float]] = {}
        self._kept: dict[str, tuple[tuple, float, np.ndarray]] = {}
        self._largest = 0.0  # force (N) or speed (m/s), of the overlay that was painted last

    def picture(self, shown: Shown) -> np.ndarray:
        """The picture (height, width, 3), u8."""
        if shown.footage is None or not len(shown.footage):
            return self._waiting(shown)
        picture = self._paper.copy()
        scale = self._scale(shown)
        left, top, right, bottom = self.view
        picture[top:bottom, left:right] = self._stage_picture(shown, scale)
        self._put_texts(picture, shown)
        self._put_column(picture, shown, scale)
        if shown.look.help:
            image = Image.fromarray(picture)
            draw_help(image, shown.keys, 0.9 * TEXT * self.unit)
            return np.array(image)
        return picture

    # Layout

    def u(self, units: float) -> int:
        """A length in units u as pixels."""
        return round(units * self.unit)

    @property
    def view(self) -> tuple[int, int, int, int]:
        """Left, top, right, bottom of the view, the part of the picture with the tank."""
        right = self.width - self.u(MARGIN + COLUMN + GAP)
        return self.u(MARGIN), self.u(MARGIN + TITLE + 1.0), right, self.height - self.u(MARGIN + 2.4)

    def camera(self, shown: Shown) -> Camera:
        """The camera of the frame that is drawn: the tank's or the earth's."""
        low, high = self._ground(shown)
        scale = self._fit(self._room(shown), high - low) * shown.look.zoom
        (x, y), pan, centre = self.middle(shown), shown.look.pan, 0.5 * (low + high)
        return Camera(scale, (x + pan[0] - scale * centre[0], y + pan[1] + scale * centre[1]))

    def middle(self, shown: Shown) -> tuple[float, float]:
        """The pixel of the middle of the view before panning."""
        left, top, right, bottom = self._room(shown)
        return 0.5 * (left + right), 0.5 * (top + bottom)

    def _room(self, shown: Shown) -> tuple[int, int, int, int]:
        """The part of the view in which the tank is largest."""
        low, high = self._ground(shown)
        return max(self._rooms(shown), key=lambda room: self._fit(room, high - low))

    def _rooms(self, shown: Shown) -> list[tuple[int, int, int, int]]:
        """The parts of the view where the tank may be: all of it, or the part right of the plot or below it."""
        left, top, right, bottom = self.view
        width, height = (self.u(side) for side in PLOT)
        if shown.curve == "nothing":
            return [self.view]
        if shown.look.frame == "earth":  # this view has room beside the tank
            return [(left + width // 2, top, right, bottom)]
        return [(left + width, top, right, bottom), (left, top + height, right, bottom)]

    def _fit(self, room: tuple[int, int, int, int], extent: np.ndarray) -> float:
        """Pixels per metre at which an extent (2,) m fits into a part of the view."""
        left, top, right, bottom = room
        spare = np.array([right - left, bottom - top]) - 2.0 * self.u(WALL + 0.4)
        return float((spare / extent).min())

    def tank_camera(self, shown: Shown) -> Camera:
        """The camera for points of the tank."""
        camera = self.camera(shown)
        return camera.carried(self._pose(shown)) if shown.look.frame == "earth" else camera

    def earth_place(self, shown: Shown, x: float, y: float) -> tuple[float, float]:
        """The point of the earth's frame (m) below a pixel."""
        camera = self.camera(shown)
        place = complex(x - camera.offset[0], camera.offset[1] - y) / camera.scale
        if shown.look.frame == "tank":
            pose = self._pose(shown)
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

    def centre_at(self, shown: Shown, x: float, y: float) -> bool:
        """Whether the centre of roll is at a pixel."""
        place = self._centre(shown)
        return place is not None and np.hypot(place[0] - x, place[1] - y) < self.u(GRIP)

    def grain_at(self, shown: Shown, x: float, y: float) -> int | None:
        """The number of the grain at a pixel, None if there is none."""
        if shown.footage.bed.empty:
            return None
        places = self.tank_camera(shown).pixels(shown.footage.grains("position", shown.frame))
        away = np.hypot(places[:, 0] - x, places[:, 1] - y) / self.camera(shown).scale
        nearest = int(np.nanargmin(away - shown.footage.radius[0]))
        return nearest if away[nearest] <= shown.footage.radius[0][nearest] else None

    def _pose(self, shown: Shown) -> np.ndarray:
        return shown.footage.row(shown.frame, "pose")

    def _ground(self, shown: Shown) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the view without zoom."""
        footage = shown.footage
        low, high = footage.extent
        if footage.sea:
            return footage.sea_ground if shown.look.frame == "earth" else (low, high)
        if shown.look.frame == "earth":  # room to turn and to sway
            low, high = low - 0.35 * (high - low), high + 0.35 * (high - low)
        return low, high

    def _centre(self, shown: Shown) -> np.ndarray | None:
        """The pixel of the centre of roll, None if there is none to drag."""
        if "centre_y" not in shown.values or not shown.footage:
            return None
        centre = np.array([shown.values["centre_y"], shown.values["centre_z"]])
        if shown.look.frame == "tank":
            pose = self._pose(shown)
            seen = np.exp(-1j * pose[2]) * complex(*(centre - pose[:2]))
            centre = np.array([seen.real, seen.imag])
        return self.camera(shown).pixels(centre[None])[0]

    # Paint

    def _scale(self, shown: Shown) -> Colouring | None:
        """The colouring of the grains, None without any; the scales are updated from time to time."""
        key, now, beds = (shown.look.colour, shown.footage), time.monotonic(), [shown.footage.bed]
        if self._colouring is None or self._colouring[0] != key or now - self._colouring[1] > SCALE_UPDATE:
            self._colouring = key, now, colouring(shown.look.colour, beds)
            self._water = WaterLayer(beds, shown.look.colour, self.unit)
        return self._colouring[2]

    def _stage_picture(self, shown: Shown, scale: Colouring | None) -> np.ndarray:
        """The tank with its contents, the marks of centre and picked grain, and the plot."""
        footage, frame, (left, top, _, _) = shown.footage, shown.frame, self.view
        camera, moved = (self._shifted(c, left, top) for c in (self.camera(shown), self.tank_camera(shown)))
        if shown.look.frame == "tank":
            key = footage, camera.scale, camera.offset
            view = self._still("tank", key, lambda: self._empty_view(shown, camera, moved)).copy()
        else:
            view = self._empty_view(shown, camera, moved)
        if footage.water:
            self._paint_water(view, shown, moved)
        if scale:
            self._paint_grains(view, shown, moved, scale)
        for line in footage.plates(frame):
            paint_plate(view, moved, line, PLATE * self.unit, palette.PART)
        if scale and shown.look.overlay == "forces":
            lines, self._largest = force_strokes(shown, moved)
            paint_strokes(view, lines, FORCE)
        elif scale and shown.look.overlay == "velocities":
            lines, self._largest = velocity_strokes(shown, moved)
            paint_strokes(view, lines, palette.INK)
        self._mark(view, shown, moved)
        if shown.curve != "nothing":
            _put(view, self._curve(shown), 0, 0)
        if footage.water:
            image = Image.fromarray(view)
            self._marks(footage).name(image, moved)
            view = np.array(image)
        if shown.lost:
            _put(view, self._still("lost", (shown.lost,), lambda: self._lost(shown.lost)), 0, -self.u(BAND))
        return view

    def _paint_water(self, view: np.ndarray, shown: Shown, camera: Camera) -> None:
        """The water and its gauges, whose names are written at the end."""
        footage, frame = shown.footage, shown.frame
        self._water.paint(view, camera, footage.bed, frame)
        levels = footage.row(frame, "level_depth") if footage.water.levels else ()
        self._marks(footage).paint(view, camera, dict(zip(footage.water.levels, levels, strict=True)))

    def _marks(self, footage: LiveFootage) -> Marks:
        return Marks(footage.outline, footage.water, hues_of(footage.water), self.unit)

    def _paint_grains(self, view: np.ndarray, shown: Shown, camera: Camera, scale: Colouring) -> None:
        """The grains, paler below force chains."""
        bed, frame = shown.footage.bed, shown.frame
        colour = scale.colours(bed, frame)
        if shown.look.overlay == "forces":
            colour = 0.25 * colour + 0.75 * np.array(palette.PAPER)
        discs = to_discs(camera, bed.position(frame), bed.radius, bed.angle(frame))
        paint_grains(view, discs, colour, *scale.style(bed, colour))

    def _lost(self, end: End) -> Image.Image:
        """The band across the foot of the view with the text on how the ship was lost."""
        left, _, right, _ = self.view
        image = Image.new("RGB", (right - left, self.u(BAND)))
        deco.draw_band(ImageDraw.Draw(image), (0, 0, *image.size), f"She {end.words}", 1.4 * TEXT * self.unit)
        return image

    def _empty_view(self, shown: Shown, camera: Camera, moved: Camera) -> np.ndarray:
        """The sea, the hull and the tank with its fixed grains."""
        footage, frame, (left, top, right, bottom) = shown.footage, shown.frame, self.view
        view = self._paper[top:bottom, left:right].copy()
        if shown.look.frame == "earth":
            if footage.sea:
                whole = np.array([[0, view.shape[0]], [view.shape[1], 0]]) - camera.offset
                ground = tuple(whole * [1.0, -1.0] / camera.scale)
                footage.sea_of(frame).paint(view, camera, ground, footage.row_time(frame), LINE * self.unit)
                footage.sea.paint_hull(view, moved, self._wall(camera, footage.sea.hull))
            else:
                faint = self._wall(camera, footage.outline)
                paint_tank(view, camera, footage.outline, faint, palette.GRID, palette.PAPER, footage.open_edges)
        thick = self._wall(camera, footage.outline)
        for basin in footage.basins:
            paint_tank(view, moved, basin.drawn, thick, palette.WALL, palette.HOLD, basin.open_edges)
        if len(fixed := footage.fixed):
            grey = np.tile(palette.FIXED, (len(fixed), 1))
            paint_grains(view, to_discs(moved, fixed[:, :2], fixed[:, 2], np.zeros(len(fixed))), grey, grey)
        return view

    @staticmethod
    def _shifted(camera: Camera, left: int, top: int) -> Camera:
        return Camera(camera.scale, (camera.offset[0] - left, camera.offset[1] - top), camera.turn)

    def _wall(self, camera: Camera, outline: np.ndarray) -> float:
        return min(WALL * self.unit, max(1.0, 0.04 * camera.scale * np.ptp(outline, axis=0).min()))

    # Drawings over the view

    def _mark(self, view: np.ndarray, shown: Shown, camera: Camera) -> None:
        """The centre of roll, a cross in a ring, and a ring around the grain that was picked."""
        centre, picked, footage = self._centre(shown), shown.look.picked, shown.footage
        if centre is not None:
            (x, y), r = centre - self.view[:2], self.u(0.45)
            arms = np.array([[x - 1.7 * r, y, 0.7, x + 1.7 * r, y, 0.7], [x, y - 1.7 * r, 0.7, x, y + 1.7 * r, 0.7]])
            paint_strokes(view, np.concatenate([arms, ring(x, y, r, 0.07 * self.unit)]), GRAB)
        if picked is not None:
            place = camera.pixels(footage.grains("position", shown.frame)[picked][None])[0]
            r = 1.3 * footage.radius[0][picked] * camera.scale + 2.0
            paint_strokes(view, ring(*place, r, 0.08 * self.unit), PICKED)

    def _put_texts(self, picture: np.ndarray, shown: Shown) -> None:
        """The title above the view; below it the scale, and the latest message or else the meaning of the overlay."""
        left, _, right, bottom = self.view
        title, scale, said = shown.footage.title, self.camera(shown).scale, shown.said
        _put(picture, self._still("title", (title,), lambda: self._title(title, right - left)), left, self.u(MARGIN))
        bar = self._still("bar", (scale,), lambda: self._scale_bar(round(0.38 * right) - left, scale))
        _put(picture, bar, left, self.height - len(bar))
        size = right - round(0.38 * right), self.height - bottom
        hint = "" if said else self._hint(shown)
        words = self._still("words", (said, hint), lambda: self._words(said, hint, size))
        _put(picture, words, right - size[0], bottom)

    def _words(self, said: str, hint: str, size: tuple[int, int]) -> Image.Image:
        """A sentence in a few lines, or a hint in one."""
        image = Image.new("RGB", size, palette.PAPER)
        draw, letters = ImageDraw.Draw(image), SENTENCE[0] * self.unit
        text, face = deco.fitted(hint, size[0], TEXT * self.unit)
        draw.text((size[0], size[1] - self.u(MARGIN) - 0.3 * TEXT * self.unit), text, palette.QUIET, face, "rm")
        lines = deco.wrapped(said, size[0], letters, SENTENCE[1])
        for k, line in enumerate(lines):
            y = 0.5 * size[1] + (k - 0.5 * (len(lines) - 1)) * 1.3 * letters
            draw.text((0, y), line, GRAB, deco.font(letters), "lm")
        return image

    def _hint(self, shown: Shown) -> str:
        if shown.look.overlay == "forces" and self._largest:
            return f"thickest lines: {newtons(self._largest)}    H: help"
        if shown.look.overlay == "velocities" and self._largest:
            speed = float(f"{1e3 * self._largest:.2g}")  # with two digits, and no power of ten
            return f"longest lines: {speed:g} mm/s    H: help"
        return "H: help"

    def _scale_bar(self, width: int, scale: float) -> Image.Image:
        image = Image.new("RGB", (width, self.u(MARGIN + 1.6)), palette.PAPER)
        place = 0, image.height - self.u(MARGIN)
        deco.draw_scale_bar(ImageDraw.Draw(image), place, 0.6 * width, scale, TEXT * self.unit)
        return image

    def _title(self, text: str, width: int) -> Image.Image:
        image = Image.new("RGB", (width, self.u(1.3 * TITLE)), palette.PAPER)
        said, face = deco.fitted(text, width, TITLE * self.unit, bold=True)
        ImageDraw.Draw(image).text((0, 0), said, palette.INK, face, anchor="la")
        return image

    def _curve(self, shown: Shown) -> np.ndarray:
        """The small plot of the experiment, redrawn a few times a second."""

        def drawn() -> Image.Image:
            drawing = CURVES[shown.curve](shown.footage, shown.frame)
            labels, colours = (drawing.across, drawing.upwards), drawing.colours
            colours = colours or palette.SERIES[: len(drawing.curves)]
            edge, size = self.u(0.5), (self.u(PLOT[0] - 1.5), self.u(PLOT[1] - 1.5))
            plot = LivePlot(size, drawing.curves, colours, labels, 0.9 * TEXT * self.unit, drawing.names)
            return ImageOps.expand(plot.picture(drawing.counts), edge, palette.PAPER)

        return self._still("plot", (shown.curve, shown.footage, shown.playhead), drawn, CURVE_UPDATE)

    # The column

    def _put_column(self, picture: np.ndarray, shown: Shown, scale: Colouring | None) -> None:
        left, look = self.width - self.u(MARGIN + COLUMN), shown.look
        key = shown.playhead, shown.going, shown.pace, look.picked, shown.footage
        lines = self._still("readings", key, lambda: self._lines(shown), TEXT_UPDATE)
        _put(picture, lines, left, self.u(MARGIN))
        bar = self._water.colouring or scale
        key = id(bar), look.typing, *shown.values.items()
        rest = self._still("column", key, lambda: self._still_column(shown, bar))
        _put(picture, rest, left, self.controls[0])

    def _lines(self, shown: Shown) -> Image.Image:
        """The clock and the readings below it."""
        image = Image.new("RGB", (self.u(COLUMN), self.controls[0] - self.u(MARGIN)), palette.PAPER)
        draw = ImageDraw.Draw(image)
        text, face = deco.fitted(clock(shown), image.width, READING * self.unit)
        draw.text((0, 0), text, palette.INK, face, anchor="la")
        for line, reading in enumerate(readings(shown)):
            text, face = deco.fitted(reading, image.width, TEXT * self.unit)
            draw.text((0, self.u(1.6 * READING + 1.4 * TEXT * line)), text, palette.INK, face, anchor="la")
        return image

    @property
    def controls(self) -> tuple[int, int]:
        """Top and bottom of the sliders in the column."""
        return self.u(MARGIN + 1.6 * READING + 1.4 * TEXT * LINES + 0.6), self.height - self.u(MARGIN + 5.2)

    def _still_column(self, shown: Shown, scale: Colouring | None) -> Image.Image:
        """The part below the readings, which changes only when the user acts: sliders and colour bar."""
        top, bottom = self.controls
        size = self.u(MARGIN + COLUMN), self.height - top
        image = Image.new("RGB", size, palette.PAPER)
        bar = 0, size[1] - self.u(MARGIN + 4.4), self.u(COLUMN), size[1] - self.u(MARGIN)
        if scale:
            deco.draw_colour_bar(image, bar, scale, TEXT * self.unit)
        self._sliders = {}
        if not shown.look.typing:
            self._draw_sliders(ImageDraw.Draw(image), shown, (self.width - size[0], top), bottom - top)
        return image

    def _still(
        self, name: str, key: tuple, make: Callable[[], Image.Image | np.ndarray], lasts: float = np.inf
    ) -> np.ndarray:
        """A cached part of the picture, made again when its `key` changes or after `lasts` seconds."""
        now = time.monotonic()
        if name not in self._kept or self._kept[name][0] != key or now - self._kept[name][1] > lasts:
            self._kept[name] = key, now, np.asarray(make())
        return self._kept[name][2]

    def _draw_sliders(self, draw: ImageDraw.ImageDraw, shown: Shown, corner: tuple[int, int], height: float) -> None:
        """Draw one row per control, with name, slider and value, from this corner on, `height` pixels high."""
        left, right = 0, self.u(COLUMN)
        names = list(shown.values)
        pitch = min(self.u(ROW), height / max(1, len(names)))
        size = min(TEXT * self.unit, 0.72 * pitch)
        begin, end = left + 0.41 * (right - left), left + 0.67 * (right - left)
        for row, name in enumerate(names):
            control, value = CONTROLS[name], shown.values[name]
            y = (row + 0.5) * pitch
            x, above = corner[0], corner[1] + y - 0.5 * pitch
            self._sliders[name] = (x + begin, above, x + end, above + pitch)
            colour = palette.QUIET if control.kind == RESTARTS else palette.INK
            text, face = deco.fitted(control.label, begin - left - self.u(0.5), size)
            draw.text((left, y), text, colour, face, anchor="lm")
            draw.line([(begin, y), (end, y)], fill=palette.LINE, width=max(2, self.u(0.18)))
            share = (value - control.low) / (control.high - control.low)
            x, r = begin + float(np.clip(share, 0.0, 1.0)) * (end - begin), self.u(HANDLE)
            draw.ellipse(
                (x - r, y - r, x + r, y + r), fill=palette.SERIES[0] if colour == palette.INK else palette.LINE
            )
            text, face = deco.fitted(control.shown(value), right - end - self.u(0.6), size)
            draw.text((right, y), text, colour, face, anchor="rm")

    # Whole pages

    def _waiting(self, shown: Shown) -> np.ndarray:
        """The page before the first frame, or if none comes."""
        image = Image.new("RGB", (self.width, self.height), palette.PAPER)
        draw, middle, size = ImageDraw.Draw(image), (self.width / 2, self.height / 2), TEXT * self.unit
        name, face = deco.fitted(shown.name, 0.9 * self.width, size)
        draw.text((middle[0], middle[1] - 3.0 * size), name, palette.QUIET, face, anchor="mm")
        for k, line in enumerate(deco.wrapped(shown.over or shown.status, 0.8 * self.width, 1.2 * size, 6)):
            colour, y = GRAB if shown.over else palette.INK, middle[1] + 1.7 * size * k
            draw.text((middle[0], y), line, colour, deco.font(1.2 * size), anchor="mm")
        return np.array(image)


def _put(picture: np.ndarray, part: np.ndarray, left: int, top: int) -> None:
    """Put a part into a picture, in place; a negative `top` counts from below."""
    top %= len(picture)
    picture[top : top + part.shape[0], left : left + part.shape[1]] = part
