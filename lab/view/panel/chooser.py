"""The first page of the window: every preset with its poster, to choose one from."""

from collections.abc import Iterator, Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageOps

from lab.base.data import poster
from lab.paint import decorations as deco
from lab.paint import palette
from lab.preset.find import QUICK, load, names
from lab.preset.schema import Preset

COLUMNS, ROWS = 4, 3
GRAIN, WATER = (196, 176, 150), (154, 196, 222)
EDGE = 0.025  # space between the cards, relative to the window's height
FOOT, TITLE = 3.1, 0.68  # height of the text below a poster and of the title's letters, relative to the name's letters


class Chooser:
    """Cards of all presets; `chosen` is the name of the selected one, "" before a selection."""

    def __init__(self, size: tuple[int, int]) -> None:
        self.size, self.ended, self.chosen = size, False, ""
        self._names = [name for name in names() if not name.endswith(QUICK)]
        self._titles, self._at = names(), 0
        self._posters: dict[str, Image.Image] = {}

    def tick(self) -> None:
        """Do nothing: the page changes only by the user's actions."""

    def picture(self) -> np.ndarray:
        """The picture of this page of cards, with a frame around the current one."""
        height = self.size[1]
        image = Image.new("RGB", self.size, palette.PAPER)
        draw = ImageDraw.Draw(image)
        edge, size = round(EDGE * height), 0.026 * height
        page, pages = self._at // (COLUMNS * ROWS) + 1, -(-len(self._names) // (COLUMNS * ROWS))
        head = f"Choose an experiment   ({page} of {pages}; arrows, Enter or the mouse; Q: its quick variant)"
        draw.text((edge, edge), head, palette.INK, deco.font(1.1 * size, True), anchor="la")
        for k, name in enumerate(self._shown()):
            left, top, wide, high = self._card(k)
            self._draw_card(image, name, left, top, wide, high, size)
            if name == self._names[self._at]:
                box = (left - 3, top - 3, left + wide + 3, top + high + 3)
                draw.rectangle(box, outline=palette.SERIES[1], width=3)
        return np.asarray(image)

    def key(self, name: str) -> None:
        """Handle a key: arrows move between cards, Enter selects one, Q its quick variant."""
        step = {"left": -1, "right": 1, "up": -COLUMNS, "down": COLUMNS}.get(name, 0)
        self._at = int(np.clip(self._at + step, 0, len(self._names) - 1))
        if name in ("return", "space"):
            self._take(self._names[self._at])
        elif name == "q" and self._names[self._at] + QUICK in self._titles:
            self._take(self._names[self._at] + QUICK)
        elif name == "escape":
            self.ended = True

    def press(self, x: float, y: float, button: str = "left") -> None:
        """Choose the card at the pixel."""
        for k, name in enumerate(self._shown()):
            left, top, wide, high = self._card(k)
            if left <= x <= left + wide and top <= y <= top + high:
                self._take(name)

    def drag(self, x: float, y: float) -> None:
        """Do nothing: cards cannot be dragged."""

    def release(self, x: float, y: float) -> None:
        """Do nothing: the press has chosen the card."""

    def wheel(self, turns: float, x: float, y: float) -> None:
        """Turn to the next or the previous page."""
        self.key("up" if turns > 0 else "down")

    def close(self) -> None:
        """Do nothing: no experiment is running."""
        self.ended = True

    def _take(self, name: str) -> None:
        self.chosen, self.ended = name, True

    def _shown(self) -> list[str]:
        first = self._at // (COLUMNS * ROWS) * COLUMNS * ROWS
        return self._names[first : first + COLUMNS * ROWS]

    def _card(self, k: int) -> tuple[int, int, int, int]:
        """Left, top, width, height of a card in pixels."""
        width, height = self.size
        edge, head = round(EDGE * height), round(0.09 * height)
        wide, high = (width - (COLUMNS + 1) * edge) // COLUMNS, (height - head - ROWS * edge) // ROWS
        return edge + k % COLUMNS * (wide + edge), head + k // COLUMNS * (high + edge), wide, high

    def _draw_card(self, image: Image.Image, name: str, left: int, top: int, wide: int, high: int, size: float) -> None:
        draw, foot = ImageDraw.Draw(image), round(FOOT * size)
        if name not in self._posters:
            self._posters[name] = _poster(name, (wide, high - foot))
        draw.rectangle((left, top, left + wide, top + high), outline=palette.LINE)
        image.paste(self._posters[name], (left + 1, top + 1))
        room, x, y = wide - size, left + 0.5 * size, top + high - foot
        said, face = deco.fitted(name, room, 0.85 * size, True)
        draw.text((x, y + 0.2 * size), said, palette.INK, face, anchor="la")
        for line, part in enumerate(deco.wrapped(self._titles[name], room, TITLE * size, 2)):
            draw.text(
                (x, y + (1.3 + 1.25 * TITLE * line) * size), part, palette.INK, deco.font(TITLE * size), anchor="la"
            )


def _poster(name: str, size: tuple[int, int]) -> Image.Image:
    """The preset's poster or a sketch of its tank."""
    path = poster(name)
    if path:
        return ImageOps.fit(Image.open(path).convert("RGB"), (size[0] - 1, size[1] - 1))
    return _sketch(name, (size[0] - 1, size[1] - 1))


def _fillings(preset: Preset) -> Iterator[tuple[tuple[int, int, int], Sequence[tuple[float, float]]]]:
    """Colour and corners (m) of what fills the tank: its water, then its cargo over that."""
    corners = np.array(preset.tank.corners)
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    for colour, matter in ((WATER, preset.water), (GRAIN, preset.bulk), (GRAIN, preset.grains)):
        depth = matter and (matter.depth or (0.4 * (high - low) if matter is preset.grains else None))
        if matter and matter.region:
            yield colour, matter.region
        elif depth:
            yield colour, [(left, low), (right, low), (right, low + depth), (left, low + depth)]


def _sketch(name: str, size: tuple[int, int]) -> Image.Image:
    """A sketch of the tank, its filling and its moving parts."""
    preset = load(name).resolved
    outline = np.array(preset.tank.corners)
    image, inside = Image.new("RGB", size, palette.HOLD), Image.new("RGB", size, palette.PAPER)
    draw, middle = ImageDraw.Draw(image), 0.5 * (outline.min(axis=0) + outline.max(axis=0))
    scale = 0.8 * float((np.array(size) / np.ptp(outline, axis=0)).min())

    def placed(points: np.ndarray) -> list[tuple[float, float]]:
        away = (np.asarray(points) - middle) * scale
        return [(0.5 * size[0] + x, 0.5 * size[1] - y) for x, y in away]

    for colour, corners in _fillings(preset):
        ImageDraw.Draw(inside).polygon(placed(corners), fill=colour)
    mask = Image.new("1", size)
    ImageDraw.Draw(mask).polygon(placed(outline), fill=1)
    image.paste(inside, mask=mask)
    draw.line([*placed(outline), placed(outline)[0]], fill=palette.WALL, width=3)
    for part in preset.parts.values():
        draw.line(placed(part.line), fill=palette.PART, width=3)
    return image
