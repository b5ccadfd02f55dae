"""Pictures of a flooded ship: two views of her cut open, and curves of heel and water; without Taichi."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from lab.naval.flooding.results import Results
from lab.paint import decorations as deco
from lab.paint.encoder import write_video
from lab.paint.flooding.views import Profile, Section, View
from lab.paint.page.layout import overlap
from lab.paint.page.live_plot import LivePlot
from lab.paint.page.texts import Texts
from lab.paint.page.theme import LIGHT, blend
from lab.paint.scene.backdrop import shades

SIZE = 1280, 720
FINE = 2  # the views are drawn so many times larger and then reduced
RATE, PICTURES, HELD = 20.0, 120, 20  # pictures a second, of the run, and of its end
AROUND = 0.12  # room around the hull in a view, of its size
PLATE = 0.009  # thickness of the hull's plates, of a view's width
BOXES = {  # left, top, right, bottom in pixels
    "title": (28, 20, 1252, 56),
    "section": (28, 92, 628, 520),
    "profile": (652, 92, 1252, 520),
    "section name": (36, 98, 620, 120),
    "profile name": (660, 98, 1244, 120),
    "clock": (28, 60, 1252, 86),
    "heel": (28, 544, 628, 704),
    "water": (652, 544, 1252, 704),
}
FLOOD = (38, 116, 178)  # water in rooms


class LevelFilm:
    """The pictures of a run; `title` is written above them."""

    def __init__(self, results: Results, title: str):
        self._results, self._title = results, title
        self._views = {"section": Section(results.built), "profile": Profile(results.built)}
        self._cameras = {name: self._fitted(name) for name in self._views}
        self._plots = self._make_plots()
        self._page = Image.new("RGB", SIZE, LIGHT.paper)

    def picture(self, frame: int) -> np.ndarray:
        """The picture (height, width, 3), u8, of a moment of the run."""
        moment = self._results.moments[frame]
        image = self._page.copy()
        names = []
        for name, view in self._views.items():
            box = BOXES[name]
            part, marks = self._draw(name, view.at(moment, self._results.course.doors))
            image.paste(part, box[:2])
            names += [(name, mark, text) for mark, text in marks]
        texts = Texts(image)
        texts.write("title", BOXES["title"], self._title, 26, LIGHT.ink, bold=True)
        texts.write("clock", BOXES["clock"], self._reading(frame), 18, LIGHT.quiet)
        for name, view in self._views.items():
            texts.write(f"{name} name", BOXES[f"{name} name"], view.title, 15, LIGHT.ink)
        placed: list[tuple] = []
        for view, mark, text in names:
            placed.append(_label(texts, BOXES[view], view, mark, text, placed))
        for name, plot in self._plots.items():
            image.paste(plot.picture([frame + 1]), BOXES[name][:2])
        return np.asarray(image)

    def pictures(self) -> Iterator[np.ndarray]:
        """The pictures of the film: evenly through the run, and its end held."""
        last = len(self._results.moments) - 1
        for k in range(PICTURES):
            yield self.picture(round(k / (PICTURES - 1) * last))
        end = self.picture(last)
        for _ in range(HELD):
            yield end

    def _reading(self, frame: int) -> str:
        results = self._results
        heel = float(np.degrees(results.heel[frame]))
        side = "" if abs(heel) < 0.05 else " to starboard" if heel > 0.0 else " to port"
        mass = results.mass[frame]
        water = f"{mass / 1000.0:.4g} t" if results.mass.max() >= 1000.0 else f"{mass:.3g} kg"
        return f"{_time(results.time[frame])}, heel {abs(heel):.1f} deg{side}, {water} of water aboard"

    def _make_plots(self) -> dict[str, LivePlot]:
        results = self._results
        heavy = results.mass.max() >= 1000.0
        water, unit = (results.mass / 1000.0, "t") if heavy else (results.mass, "kg")
        minutes = results.time[-1] > 300.0
        time, label = (results.time / 60.0, "time (min)") if minutes else (results.time, "time (s)")
        curves = {
            "heel": (np.degrees(results.heel), "heel, starboard down (deg)"),
            "water": (water, f"water aboard ({unit})"),
        }
        plots = {}
        for k, (name, (values, text)) in enumerate(curves.items()):
            left, top, right, bottom = BOXES[name]
            size = right - left, bottom - top
            plots[name] = LivePlot(size, [(time, values)], [LIGHT.series[k]], (label, text), 13.0)
        return plots

    def _fitted(self, name: str) -> tuple[float, np.ndarray]:
        """Pixels a metre and the middle (2,) m of a view, in which the hull stays all the time."""
        left, top, right, bottom = BOXES[name]
        step = max(1, len(self._results.moments) // 60)
        hulls = [self._views[name].at(one, {}).hull for one in self._results.moments[::step]]
        low = np.min([one.min(axis=0) for one in hulls], axis=0)
        high = np.max([one.max(axis=0) for one in hulls], axis=0)
        high[1], low[1] = max(high[1], 0.0), min(low[1], 0.0)
        room = AROUND * float((high - low).max())
        size = high - low + 2.0 * room
        scale = FINE * min((right - left) / size[0], (bottom - top) / size[1])
        return float(scale), 0.5 * (low + high)

    def _draw(self, name: str, view: View) -> tuple[Image.Image, list]:
        """One view, and places of openings in it with their names."""
        left, top, right, bottom = BOXES[name]
        wide, high = FINE * (right - left), FINE * (bottom - top)
        scale, middle = self._cameras[name]

        def pixels(points: np.ndarray) -> list[tuple[float, float]]:
            moved = (np.asarray(points) - middle) * scale
            return [(0.5 * wide + x, 0.5 * high - y) for x, y in moved]

        sea = float(np.clip(pixels([[0.0, 0.0]])[0][1], 0, high))
        image = _backdrop(wide, high, sea)
        draw = ImageDraw.Draw(image, "RGBA")
        plate = max(2, round(PLATE * wide))
        draw.polygon(pixels(view.hull), fill=(*LIGHT.hold, 255))
        for water in view.water:
            if len(water) > 2:
                draw.polygon(pixels(water), fill=(*FLOOD, 175))
                draw.line(pixels(_surface(water)), fill=(*blend(FLOOD, (0, 0, 0), 0.2), 255), width=FINE)
        for room in view.rooms:
            draw.line([*pixels(room), pixels(room)[0]], fill=(*LIGHT.wall, 255), width=max(FINE, plate // 3))
        outline = pixels(view.hull)
        draw.line([*outline, *outline[:2]], fill=(*LIGHT.hull, 255), width=plate, joint="curve")
        marks = []
        for text, (line, opened) in view.openings.items():
            colour = LIGHT.accent if opened else LIGHT.quiet
            ends = pixels(line)
            draw.line(ends, fill=(*colour, 255), width=plate + FINE)
            marks.append(((0.5 * (ends[0][0] + ends[1][0]) / FINE, 0.5 * (ends[0][1] + ends[1][1]) / FINE), text))
        draw.line([(0, sea), (wide, sea)], fill=(*LIGHT.surface, 140), width=FINE)
        return image.reduce(FINE), marks if name == "section" else []


def _backdrop(wide: int, high: int, sea: float) -> Image.Image:
    """Sky and sea."""
    row = round(sea)
    column = np.concatenate([shades(*LIGHT.sky, row)[:row], shades(*LIGHT.sea, high - row)[: high - row]])
    return Image.fromarray(column).resize((wide, high), Image.Resampling.NEAREST)


def _surface(water: np.ndarray) -> np.ndarray:
    """The upper edge (2, 2) m of the water in a room."""
    top = water[water[:, 1] >= water[:, 1].max() - 1e-9 * max(float(np.ptp(water)), 1e-9)]
    return np.array([top[np.argmin(top[:, 0])], top[np.argmax(top[:, 0])]])


def _label(texts: Texts, box: tuple, view: str, mark: tuple[float, float], text: str, placed: list[tuple]) -> tuple:
    """Write an opening's name beside it, to the right or where there is room, and below others; returns its box."""
    x, y = box[0] + mark[0], box[1] + mark[1]
    face = deco.font(13, True)
    wide = face.getlength(text) + 6
    left = x + 10 if x + 10 + wide < box[2] else x - 10 - wide
    place = (round(left), round(y - 9), round(left + wide), round(y + 9))
    while any(overlap(place, other) for other in placed):
        place = (place[0], place[1] + 20, place[2], place[3] + 20)
    texts.draw.rounded_rectangle(place, 4, fill=LIGHT.panel)
    texts.write(f"{view} {text}", (place[0] + 3, place[1], place[2], place[3]), text, 13, LIGHT.accent, bold=True)
    return place


def _time(value: float) -> str:
    """A time as a clock shows it."""
    if value < 100.0:
        return f"{value:.2f} s"
    return f"{int(value // 60)} min {int(value % 60):02d} s"


def write_film(results: Results, title: str, out: Path) -> Path:
    """Write the film of levels as an .mp4 file. Raises LabError."""
    out.parent.mkdir(parents=True, exist_ok=True)
    return write_video(out, LevelFilm(results, title).pictures(), RATE)
