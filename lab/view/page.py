"""The picture of a live experiment: the tank on its stage, and a column of readings and sliders.

Lengths are in units u, 1/36 of the height of a 16:9 picture, as in `lab.paint.film`.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageChops, ImageDraw

from lab.paint import decorations as deco
from lab.paint.colours import Colouring, colouring, mark_colours
from lab.paint.painter import Camera, paint_grains, paint_plate, paint_tank, to_discs
from lab.paint.sea import LINE
from lab.view.controls import CONTROLS, RESTARTS
from lab.view.curves import CURVES
from lab.view.forces import pressed_pairs

if TYPE_CHECKING:
    from lab.view.session import Session

MARGIN, COLUMN, GAP, WALL, PLATE = 1.2, 17.0, 1.5, 0.36, 0.3  # in u
TEXT, READING, TITLE, ROW = 1.0, 1.2, 1.4, 1.5  # heights in u
ANEW = 2.0  # s after which scale and curve are looked at anew
HANDLE = 0.42  # u, half the height of a slider's handle
GRIP = 0.8  # u around the centre of roll
THICKEST = 0.7  # of the mean radius: a line of the largest force
GRAB, FORCE, PICKED = (213, 94, 0), (200, 30, 30), (213, 94, 0)


class Page:
    """Pictures of sessions in one size (pixels); with `panel` the sliders are part of them."""

    def __init__(self, size: tuple[int, int], panel: bool) -> None:
        self.width, self.height, self.panel = *size, panel
        self.unit = min(self.width / 64, self.height / 36)
        self._colouring: tuple[tuple, float, Colouring] | None = None
        self._plot: tuple[tuple, float, Image.Image] | None = None
        self._sliders: dict[str, tuple[float, float, float, float]] = {}
        self._kept: dict[str, tuple[tuple, Image.Image]] = {}

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
            self._draw_help(image)
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
        left, top, right, bottom = self.stage
        stage = np.array([right - left, bottom - top]) - 2.0 * self.u(WALL + 0.4)
        scale = float((stage / (high - low)).min()) * session.look.zoom
        middle = 0.5 * (low + high)
        x = 0.5 * (left + right) + session.look.pan[0] - scale * middle[0]
        y = 0.5 * (top + bottom) + session.look.pan[1] + scale * middle[1]
        return Camera(scale, (x, y))

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
        if session.look.overlay == "forces":
            self._draw_forces(draw, session, camera)
        elif session.look.overlay == "velocities":
            self._draw_velocities(draw, session, camera)
        centre = self._centre(session)
        if centre is not None:
            x, y, r = centre[0] - left, centre[1] - top, self.u(0.45)
            draw.ellipse((x - r, y - r, x + r, y + r), outline=GRAB, width=max(1, self.u(0.12)))
            draw.line([(x - 1.7 * r, y), (x + 1.7 * r, y)], fill=GRAB)
            draw.line([(x, y - 1.7 * r), (x, y + 1.7 * r)], fill=GRAB)
        if session.look.picked is not None:
            self._draw_picked(draw, session, camera)
        if session.look.inset != "nothing":
            curve, place = self._curve(session), (self.u(0.4), self.u(0.4))
            below = layer.crop((*place, place[0] + curve.width, place[1] + curve.height))
            layer.paste(ImageChops.darker(below, curve), place)  # its paper is as of glass
        image.paste(layer, (left, top))
        text, scale = TEXT * self.unit, self.camera(session).scale
        foot = self._still("foot", (scale,), lambda: self._scale_bar(0.4 * (right - left), scale))
        image.paste(foot, (left, self.height - foot.height))
        title = self._still("title", (session.footage.title,), lambda: self._title(session.footage.title, right - left))
        image.paste(title, (left, self.u(MARGIN)))
        said, face = deco.fitted(session.said or "H: help", 0.6 * (right - left), text)
        place = right, self.height - self.u(MARGIN) - 0.3 * text
        ImageDraw.Draw(image).text(place, said, GRAB if session.said else deco.QUIET, face, anchor="rm")

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

    def _draw_forces(self, draw: ImageDraw.ImageDraw, session: Session, camera: Camera) -> None:
        """Force chains: lines between the centres of grains that press, as thick as the force."""
        footage, frame = session.footage, session.frame
        if footage.shapes:
            session.say("forces are drawn between round grains only")
            session.look.overlay = "velocities"
            return
        place = footage.grains("position", frame)
        pairs, force = pressed_pairs(place, footage.radius[0])
        if not len(pairs):
            return
        largest = np.quantile(force, 0.99)
        width = THICKEST * 2.0 * footage.radius[0].mean() * camera.scale * np.minimum(force / largest, 1.5)
        ends = camera.pixels(place[pairs.ravel()]).reshape(-1, 4)
        for line, thick in zip(ends[width >= 0.4].tolist(), width[width >= 0.4], strict=True):
            draw.line(line, fill=FORCE, width=max(1, round(thick)))

    def _draw_velocities(self, draw: ImageDraw.ImageDraw, session: Session, camera: Camera) -> None:
        """Lines along the velocities in the tank; the 99th percentile is three diameters long."""
        footage, frame = session.footage, session.frame
        place, velocity = (footage.grains(name, frame) for name in ("position", "velocity"))
        speed = np.hypot(*velocity.T)
        longest = max(np.nanquantile(speed, 0.99), 1e-9)
        tips = place + velocity * (6.0 * footage.radius[0].mean() / longest)
        ends = camera.pixels(np.hstack([place, tips]).reshape(-1, 2)).reshape(-1, 4)
        for line in ends[np.isfinite(ends).all(axis=1) & (speed > 0.03 * longest)].tolist():
            draw.line(line, fill=deco.INK, width=1)

    def _draw_picked(self, draw: ImageDraw.ImageDraw, session: Session, camera: Camera) -> None:
        footage, frame, i = session.footage, session.frame, session.look.picked
        (x, y), r = camera.pixels(footage.grains("position", frame)[i][None])[0], 0.0
        r = 1.3 * footage.radius[0][i] * camera.scale + 2.0
        draw.ellipse((x - r, y - r, x + r, y + r), outline=PICKED, width=max(2, self.u(0.15)))

    def _curve(self, session: Session) -> Image.Image:
        """A small plot of what the experiment does, drawn anew a few times a second."""
        size = self.u(13.0), self.u(7.5)
        key, now = (session.look.inset, id(session.footage), session.playhead), time.monotonic()
        if self._plot and self._plot[0] == key and now - self._plot[1] < 0.1 * ANEW:
            return self._plot[2]
        drawing = CURVES[session.look.inset](session.footage, session.frame)
        labels, colours = (drawing.across, drawing.upwards), deco.SERIES[: len(drawing.curves)]
        plot = deco.LivePlot(size, drawing.curves, colours, labels, 0.9 * TEXT * self.unit)
        image = plot.picture(drawing.counts)
        self._plot = key, now, image
        return image

    # The column

    def _draw_column(self, image: Image.Image, session: Session, scale: Colouring) -> None:
        draw = ImageDraw.Draw(image)
        left = self.width - self.u(MARGIN + COLUMN)
        right, y = self.width - self.u(MARGIN), self.u(MARGIN)
        for reading in self._readings(session):
            text, face = deco.fitted(reading, right - left, READING * self.unit)
            draw.text((left, y), text, deco.INK, face, anchor="la")
            y += self.u(1.5 * READING)
        rest = self._still(
            "column", (id(scale), *session.values.items()), lambda: self._still_column(session, scale, y)
        )
        image.paste(rest, (left, y))

    def _still_column(self, session: Session, scale: Colouring, top: int) -> Image.Image:
        """What stands below the readings until somebody changes it: sliders and colour bar."""
        size = self.u(MARGIN + COLUMN), self.height - top
        image = Image.new("RGB", size, deco.PAPER)
        bar = 0, size[1] - self.u(MARGIN + 4.4), self.u(COLUMN), size[1] - self.u(MARGIN)
        deco.draw_colour_bar(image, bar, scale, TEXT * self.unit)
        if self.panel:
            left = self.width - size[0]
            self._draw_sliders(ImageDraw.Draw(image), session, (left, top), self.u(0.6), bar[1] - self.u(0.8))
        return image

    def _still(self, name: str, key: tuple, make: Callable[[], Image.Image]) -> Image.Image:
        """A part of the picture that stays as it is while its key does."""
        if name not in self._kept or self._kept[name][0] != key:
            self._kept[name] = key, make()
        return self._kept[name][1]

    def _readings(self, session: Session) -> list[str]:
        footage, frame = session.footage, session.frame
        number = deco.number
        pace = "as fast as possible" if np.isinf(session.pace) else f"{session.pace:g} of real time"
        state = "running" if session.going else "paused" if session.playhead is None else "looking back"
        readings = [
            f"t = {number(footage.time[frame], 2)} s, {state}",
            f"pace: {pace}; reaches {session.factor:.2g}",
        ]
        sway, heave, tilt = self._pose(session)
        readings.append(f"φ = {number(np.degrees(tilt), 1)}°, y {number(1e3 * sway, 0)}, z {number(1e3 * heave, 0)} mm")
        count = footage.radius.size
        readings.append(f"{count} grains, {footage.row(frame, 'contacts') * 2 / count:.2f} contacts each")
        i = session.look.picked
        if i is not None:
            speed = float(np.hypot(*footage.grains("velocity", frame)[i]))
            spin = float(footage.grains("spin", frame)[i])
            readings.append(f"grain {i}: {1e3 * speed:.3g} mm/s, {spin:.3g} rad/s")
        return readings

    def _draw_sliders(
        self, draw: ImageDraw.ImageDraw, session: Session, corner: tuple, top: float, bottom: float
    ) -> None:
        """A row a control, name, slider and value, on a part of the picture whose corner is there."""
        left, right = 0, self.u(COLUMN)
        names = list(session.values)
        pitch = min(self.u(ROW), (bottom - top) / max(1, len(names)))
        size = min(TEXT * self.unit, 0.72 * pitch)
        begin, end = left + 0.44 * (right - left), left + 0.74 * (right - left)
        self._sliders = {}
        for row, name in enumerate(names):
            control, value = CONTROLS[name], session.values[name]
            y = top + (row + 0.5) * pitch
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

    def _draw_help(self, image: Image.Image) -> None:
        from lab.view.session import KEYS

        draw, size = ImageDraw.Draw(image, "RGBA"), TEXT * self.unit
        mouse = [
            ("drag", "move the picture"),
            ("right drag", "tilt the tank"),
            ("drag the cross", "move the centre of roll"),
            ("click a grain", "its speed and spin"),
            ("wheel", "nearer or farther"),
        ]
        rows = [(name, says) for name, (says, _) in KEYS.items()] + mouse
        width, height = self.u(30.0), (len(rows) + 1) * 1.35 * size
        left, top = (self.width - self.u(COLUMN) - width) / 2, (self.height - height) / 2
        draw.rectangle((left, top, left + width, top + height), fill=(255, 255, 255, 248), outline=deco.LINE)
        for k, (name, says) in enumerate(rows):
            y = top + (k + 1) * 1.35 * size
            draw.text((left + self.u(1.0), y), name, deco.INK, deco.font(size, True), anchor="lm")
            draw.text((left + self.u(10.0), y), says, deco.INK, deco.font(size), anchor="lm")
