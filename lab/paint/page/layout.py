"""Where everything stands on a page, for any size: boxes that do not overlap and lie within the picture.

Lengths are in units u, which follow from the size, so that pages of one shape are alike in all sizes. A wide page has a
panel with readings, plot and legend at the right; a square and an upright one have it below the view.
"""

from collections.abc import Mapping
from dataclasses import dataclass

Box = tuple[int, int, int, int]  # left, top, right, bottom in pixels

TEXT, READING, CLOCK, TITLE = 1.1, 1.35, 2.1, 1.5  # heights of letters in u
WIDE, UPRIGHT = 1.25, 0.8  # width over height above which a page is wide, and below which it is upright
MARGIN, GAP = 1.4, 0.9  # in u
COLUMN = 17.0  # u, width of the texts in the panel of a wide page
LINE = 1.75  # height of a line of text over that of its letters
DIAL, BAND = 5.0, 2.4  # u
LEGEND, INSET, PLOT, TALL = 4.4, 8.0, 8.5, 17.0  # u, heights; of a plot at least and at most
SQUARE, NARROW, LOWEST = (
    42.0,
    36.0,
    18.0,
)  # u, least width of a square and of an upright page, and height of the view's part


@dataclass(frozen=True)
class Needs:
    """What a page has: numbers of plots and of lines of readings; whether it has the others."""

    plots: int = 1
    lines: int = 1
    legend: bool = True
    inset: bool = False
    dial: bool = False
    band: bool = False


@dataclass(frozen=True)
class Layout:
    """The boxes of a page by name, pixels a unit, and the part of the picture behind the view.

    Boxes: title, view, scale, note, clock, readings, plots, and where they are needed band, dial, inset, legend.
    """

    boxes: Mapping[str, Box]
    unit: float
    canvas: Box

    def __getitem__(self, name: str) -> Box:
        return self.boxes[name]

    def u(self, units: float) -> int:
        """A length in units u as pixels."""
        return round(units * self.unit)


def lay_out(width: int, height: int, needs: Needs) -> Layout:
    """The layout of a page of this size in pixels."""
    shape = width / height
    if shape >= WIDE:
        return _wide(width, height, needs)
    return _stacked(width, height, needs, upright=shape < UPRIGHT)


def _wide(width: int, height: int, needs: Needs) -> Layout:
    unit = min(width / 64, height / 36)
    across, down = width / unit, height / unit
    edge = across - COLUMN - 2 * MARGIN
    left, right = edge + MARGIN, across - MARGIN
    boxes = _of_stage(edge, down, needs)
    top = MARGIN
    boxes |= _heading(left, top, right, needs)
    top = max(boxes["readings"][3], boxes["dial"][3] if needs.dial else 0.0) + GAP
    bottom = down - MARGIN
    if needs.legend:
        boxes["legend"] = (left, bottom - LEGEND, right, bottom)
        bottom -= LEGEND + GAP
    if needs.inset:
        low = min(top + 1.5 * INSET, bottom - PLOT * min(needs.plots, 1) - GAP)
        boxes["inset"] = (left, top, right, low)
        top = low + GAP
    boxes["plots"] = (left, max(top, bottom - TALL * needs.plots), right, bottom)
    return _in_pixels(boxes, unit, (0.0, 0.0, edge, down))


def _stacked(width: int, height: int, needs: Needs, upright: bool) -> Layout:
    """The panel below the view: upright all in one column, else the readings and the legend beside the plots."""
    head = max(_heading(0.0, 0.0, 99.0, needs)["readings"][3], DIAL * needs.dial)
    legend, inset = (LEGEND + GAP) * needs.legend, (INSET + GAP) * needs.inset
    plots = PLOT * (1.0 + 0.6 * (needs.plots - 1))
    tall = head + GAP + inset + plots + legend if upright else max(head + legend, inset + plots)
    tall += 2 * MARGIN
    unit = min(width / (NARROW if upright else SQUARE), height / (tall + LOWEST))
    across, down = width / unit, height / unit
    edge = down - max(tall, (0.4 if upright else 0.3) * down)
    left, right, top, bottom = MARGIN, across - MARGIN, edge + MARGIN, down - MARGIN
    boxes = _of_stage(across, edge, needs)
    middle = right if upright else 0.45 * across
    boxes |= _heading(left, top, middle, needs)
    if needs.legend:
        boxes["legend"] = (left, bottom - LEGEND, middle, bottom)
    if upright:
        top, bottom = top + head + GAP, bottom - legend
    else:
        left = middle + GAP
    if needs.inset:
        boxes["inset"] = (left, top, right, top + INSET)
    boxes["plots"] = (left, top + inset, right, bottom)
    return _in_pixels(boxes, unit, (0.0, 0.0, across, edge))


def _of_stage(across: float, down: float, needs: Needs) -> dict[str, tuple]:
    """The title, the view, the band on it, and the scale and the note below it, in a part of the page this large."""
    foot, middle = down - MARGIN, 0.5 * across
    low = foot - 1.6 * TEXT - 0.5
    boxes = {"band": (MARGIN, low - BAND, across - MARGIN, low)} if needs.band else {}
    low -= (BAND + 0.3) * needs.band
    return boxes | {
        "title": (MARGIN, MARGIN, across - MARGIN, MARGIN + 1.9 * TITLE),
        "view": (MARGIN, MARGIN + 1.9 * TITLE + 0.5, across - MARGIN, low),
        "scale": (MARGIN, foot - 1.6 * TEXT, middle - 0.5 * GAP, foot),
        "note": (middle + 0.5 * GAP, foot - 1.6 * TEXT, across - MARGIN, foot),
    }


def _heading(left: float, top: float, right: float, needs: Needs) -> dict[str, tuple]:
    """The clock, the readings below it, and the dial beside them."""
    edge = right - (DIAL + GAP if needs.dial else 0.0)
    low = top + 1.3 * CLOCK
    boxes = {
        "clock": (left, top, edge, low),
        "readings": (left, low + 0.3, edge, low + 0.3 + LINE * READING * needs.lines),
    }
    return {**boxes, "dial": (right - DIAL, top, right, top + DIAL)} if needs.dial else boxes


def _in_pixels(boxes: Mapping[str, tuple], unit: float, canvas: tuple) -> Layout:
    def pixels(box: tuple) -> Box:
        left, top, right, bottom = (round(unit * edge) for edge in box)
        return left, top, right, bottom

    return Layout({name: pixels(box) for name, box in boxes.items()}, unit, pixels(canvas))


def overlap(one: Box, other: Box) -> bool:
    """Whether two boxes have a pixel in common."""
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def within(inner: Box, outer: Box, slack: float = 0.0) -> bool:
    """Whether a box lies in another one."""
    return (
        inner[0] >= outer[0] - slack
        and inner[1] >= outer[1] - slack
        and inner[2] <= outer[2] + slack
        and inner[3] <= outer[3] + slack
    )
