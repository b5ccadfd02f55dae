"""One film: where everything stands on the page, and the picture of any frame.

Lengths on the page are counted in units u, 1/36 of the height of a 16:9 picture, so that every size
looks alike: the tanks on the left, a column of readings, plot and colour bar on the right.
"""

from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw

from lab.errors import LabError
from lab.paint import decorations as deco
from lab.paint.colours import colouring, mark_colours
from lab.paint.footage import Footage
from lab.paint.painter import Camera, paint_grains, paint_tank, to_discs

FALLBACK = {"width": 1280, "height": 720, "colour": "speed", "frame": "tank", "speed": 1.0}
FRAMES = ("tank", "earth")
SMALLEST = (320, 180)  # pixels
MOST_BEDS = 6  # shown side by side
MOST_SAMPLES = 800  # of a curve of the plot

MARGIN, COLUMN, GAP, WALL = 2.0, 17.0, 2.5, 0.36  # in u
TEXT, READING, TITLE = 1.1, 1.35, 1.45  # heights of letters in u
ALIKE = 1e-9  # poses that differ by less (m, rad) are the same


@dataclass(frozen=True)
class Look:
    """What a person may choose.

    Size in pixels, colour and frame by name, playback speed (1: real time), world by its number
    from 0 (None: all).
    """

    width: int
    height: int
    colour: str
    frame: str
    speed: float
    world: int | None = None


def choose_look(footage: Footage, world: int | None = None, **wishes: object) -> Look:
    """The wishes that are not None, else the preset's [video], else FALLBACK; raises LabError."""
    wanted = {key: value for key, value in wishes.items() if value is not None}
    settings = {**FALLBACK, **footage.settings, **wanted}
    look = Look(world=world, **{key: settings[key] for key in FALLBACK})
    if look.width % 2 or look.height % 2 or look.width < SMALLEST[0] or look.height < SMALLEST[1]:
        raise LabError(
            f"Pictures of {look.width} x {look.height} pixels cannot be filmed: "
            f"width and height must be even, {SMALLEST[0]} x {SMALLEST[1]} at least."
        )
    if look.frame not in FRAMES:
        raise LabError(f"Unknown frame '{look.frame}': choose one of {', '.join(FRAMES)}.")
    if world is not None and not 0 <= world < footage.worlds:
        last = footage.worlds - 1
        raise LabError(f"There is no world {world} in this recording: choose 0 to {last}.")
    if not look.speed > 0:
        raise LabError(f"The playback speed {look.speed} cannot be used: choose one above 0.")
    return look


class Film:
    """The pictures of one recording in one look; Taichi must be running (`solvers.runtime`)."""

    def __init__(self, footage: Footage, look: Look) -> None:
        self._footage, self._look = footage, look
        self._unit = min(look.width / 64, look.height / 36)
        everyone = range(footage.worlds) if look.world is None else [look.world]
        self._worlds = list(everyone)[:MOST_BEDS]
        self._pose = footage.pose[:, self._worlds]
        self._together = bool(np.ptp(self._pose, axis=1).max() < ALIKE)
        self._colouring = colouring(look.colour, footage)
        self._cameras, self._names_at = self._place_beds()
        self._plot, self._samples = self._prepare_plot(list(everyone))
        self._page = self._draw_page(len(everyone))

    def picture(self, frame: int) -> np.ndarray:
        """The picture (height, width, 3), u8, of one frame."""
        picture = self._page.copy()
        self._paint_beds(picture, frame)
        image = Image.fromarray(picture)
        self._draw_readings(image, frame)
        sampled = np.searchsorted(self._samples, self._footage.time[frame] + 1e-9, "right")
        image.paste(self._plot.picture(max(1, int(sampled))), self._plot_box()[:2])
        return np.asarray(image)

    def _u(self, units: float) -> int:
        return round(units * self._unit)

    def _column(self) -> tuple[int, int]:
        """Left and right edge of the column of readings."""
        right = self._look.width - self._u(MARGIN)
        return right - self._u(COLUMN), right

    def _plot_box(self) -> tuple[int, int, int, int]:
        left, right = self._column()
        lowest = self._look.height - self._u(MARGIN + 4.6 + 2.2)
        return left, self._u(12.0), right, min(lowest, self._u(12.0 + 16.0))

    def _stage(self) -> tuple[int, int, int, int]:
        """The part of the page where the tanks stand."""
        right, bottom = self._column()[0] - self._u(GAP), self._look.height - self._u(MARGIN + 2.8)
        return self._u(MARGIN), self._u(MARGIN + TITLE + 1.5), right, bottom

    def _ground(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the box that holds the tank in every frame."""
        corners = self._footage.outline
        if self._look.frame == "earth":
            corners = _carried(corners, self._pose).reshape(-1, 2)
        return corners.min(axis=0), corners.max(axis=0)

    def _place_beds(self) -> tuple[list[Camera], list[tuple[float, float]]]:
        """Camera and place of the name of each bed, in the grid that shows the beds largest."""
        low, high = self._ground()
        left, top, right, bottom = self._stage()
        stage = np.array([right - left, bottom - top])
        wall, gap = WALL * self._unit, 1.5 * self._unit
        name = 1.8 * self._unit if self._footage.worlds > 1 else 0.0
        around = np.array([2 * wall, 2 * wall + name])
        count = len(self._worlds)

        def grid(columns: int) -> np.ndarray:
            return np.array([columns, -(-count // columns)])

        def scale(columns: int) -> float:
            cell = (stage - gap * (grid(columns) - 1)) / grid(columns)
            return float(((cell - around) / (high - low)).min())

        columns = max(range(1, count + 1), key=scale)
        largest = scale(columns)
        pitch = largest * (high - low) + around + gap
        start = np.array([left, top]) + (stage - pitch * grid(columns) + gap) / 2
        cells = [start + pitch * (k % columns, k // columns) for k in range(count)]
        inner = np.array([wall, wall + name]) + largest * np.array([-low[0], high[1]])
        names = [(x, y + name - 0.5 * self._unit) for x, y in cells]
        return [Camera(largest, tuple(cell + inner)) for cell in cells], names

    def _prepare_plot(self, worlds: list[int]) -> tuple[deco.LivePlot, np.ndarray]:
        """The plot of the shift of the centres of mass, and the times of its samples."""
        footage = self._footage
        count = len(footage.series_time)
        kept = np.unique(np.linspace(0, count - 1, min(count, MOST_SAMPLES)).astype(int))
        time, tilt = footage.series_time[kept], footage.series_pose[kept][:, worlds, 2]
        centre = footage.centre_of_mass[kept][:, worlds, 0]
        shift = (centre - centre[0]) / footage.diameter
        steady = _monotonic(tilt)
        across = np.degrees(tilt) if steady else np.repeat(time[:, None], len(worlds), axis=1)
        label = "tilt φ (°)" if steady else "time (s)"
        order = range(len(worlds) - 1, -1, -1)  # the beds that are shown on top
        curves = [(across[:, k], shift[:, k]) for k in order]
        colours = [deco.SERIES[k] if k < MOST_BEDS else deco.LINE for k in order]
        left, top, right, bottom = self._plot_box()
        labels = (label, "shift Δy (diameters)")
        size = right - left, bottom - top
        return deco.LivePlot(size, curves, colours, labels, TEXT * self._unit), time

    def _draw_page(self, beds: int) -> np.ndarray:
        """What stays the same in all frames."""
        look, text = self._look, TEXT * self._unit
        image = Image.new("RGB", (look.width, look.height), deco.PAPER)
        draw = ImageDraw.Draw(image)
        left, _, right, _ = self._stage()
        column_left, column_right = self._column()
        bottom = look.height - self._u(MARGIN)
        deco.draw_title(draw, (left, self._u(MARGIN)), self._footage.title, right - left, TITLE * self._unit)
        longest = 0.25 * (right - left)
        deco.draw_scale_bar(draw, (left, bottom), longest, self._cameras[0].scale, text)
        note = self._note(beds)
        draw.text((right, bottom - 0.3 * text), note, deco.QUIET, deco.font(text), anchor="rm")
        bar = column_left, bottom - self._u(4.6), column_right, bottom
        deco.draw_colour_bar(image, bar, self._colouring, text)
        page = np.array(image)
        colours = (deco.WALL, deco.HOLD) if look.frame == "tank" else (deco.GRID, deco.PAPER)
        for camera in self._cameras:  # in the earth frame a faint tank stays where it was at rest
            self._paint_tank(page, camera, *colours)
        return page

    def _note(self, beds: int) -> str:
        """What a person must know to read the film rightly."""
        notes = []
        if self._look.speed != 1:
            notes.append(f"played at {self._look.speed:g} times real time")
        if beds > len(self._worlds):
            notes.append(f"{len(self._worlds)} of {beds} beds")
        return ", ".join(notes)

    def _paint_beds(self, picture: np.ndarray, frame: int) -> None:
        footage, discs, colours = self._footage, [], []
        for k, world in enumerate(self._worlds):
            camera = self._cameras[k]
            if self._look.frame == "earth":
                camera = camera.carried(self._pose[frame, k])
                self._paint_tank(picture, camera, deco.WALL, deco.HOLD)
            place, angle = footage.position(frame, world), footage.angle(frame, world)
            discs.append(to_discs(camera, place, footage.radius[world], angle))
            colours.append(self._colouring.colours(frame, world))
        colour = np.concatenate(colours)
        paint_grains(picture, np.concatenate(discs), colour, mark_colours(colour))

    def _paint_tank(self, picture: np.ndarray, camera: Camera, wall: tuple, hold: tuple) -> None:
        paint_tank(picture, camera, self._footage.outline, WALL * self._unit, wall, hold)

    def _draw_readings(self, image: Image.Image, frame: int) -> None:
        """Clock, tilt, displacement and gravity in the column, names above the beds."""
        draw = ImageDraw.Draw(image)
        left, right = self._column()
        top, face = self._u(MARGIN), deco.font(READING * self._unit)
        readings = [f"t = {deco.number(self._footage.time[frame], 2)} s"]
        if self._together:
            readings += [f"{name} {value}" for name, value in self._pose_readings(frame, 0)]
            if self._look.frame == "tank":
                dial = deco.gravity_dial(self._u(5.6), float(self._pose[frame, 0, 2]))
                image.paste(dial, (right - dial.width, top))
        for line, reading in enumerate(readings):
            place = left, top + line * self._u(1.75 * READING)
            draw.text(place, reading, deco.INK, face, anchor="la")
        if self._footage.worlds > 1:
            self._draw_names(draw, frame)

    def _draw_names(self, draw: ImageDraw.ImageDraw, frame: int) -> None:
        """The beds' names, and what tells their poses apart."""
        for k, world in enumerate(self._worlds):
            readings = self._pose_readings(frame, k)
            aside = "" if self._together else f" ({readings[0][1]})"
            text, face = f"bed {world + 1}{aside}", deco.font(TEXT * self._unit)
            draw.text(self._names_at[k], text, deco.SERIES[k], face, anchor="ls")

    def _pose_readings(self, frame: int, k: int) -> list[tuple[str, str]]:
        """Names and values of tilt, sway and heave of a shown bed, of those that are ever used."""
        sway, heave, tilt = self._pose[frame, k]
        moves = (np.abs(self._pose) > ALIKE).any(axis=(0, 1))[[2, 0, 1]]
        readings = [
            ("φ =", f"{deco.number(np.degrees(tilt), 1)}°"),
            ("sway", f"{deco.number(1000 * sway, 1)} mm"),
            ("heave", f"{deco.number(1000 * heave, 1)} mm"),
        ]
        return [reading for reading, moving in zip(readings, moves, strict=True) if moving]


def _carried(points: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Earth-frame places (F, S, m, 2) of tank points (m, 2): (Y, Z) + R(phi) r, pose (F, S, 3)."""
    cosine, sine = np.cos(pose[..., 2, None]), np.sin(pose[..., 2, None])
    y, z = points.T
    across = pose[..., 0, None] + cosine * y - sine * z
    up = pose[..., 1, None] + sine * y + cosine * z
    return np.stack([across, up], axis=-1)


def _monotonic(tilt: np.ndarray) -> bool:
    """Whether tilt (T, W) in rad moves by half a degree at least and never back."""
    steps = np.diff(tilt, axis=0)
    one_way = bool((steps >= -ALIKE).all() or (steps <= ALIKE).all())
    return one_way and bool(np.ptp(tilt, axis=0).min() > np.radians(0.5))
