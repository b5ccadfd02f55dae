"""A page is laid out once: nothing overlaps or is cut off in any shape and size, and every text can be read."""

from itertools import combinations, product

import numpy as np
import pytest

from lab.paint import colours
from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import open_footage
from lab.paint.page.layout import Needs, lay_out, overlap, within
from lab.paint.page.theme import THEMES, contrast, luminance
from lab.paint.painter import Camera
from lab.paint.scene.floating_ship import FloatingShip
from lab.paint.sea import Sea
from lab.preset.find import load
from lab.preset.recorded import to_table
from solvers.machine.runtime import initialise
from tests.oracles.synthetic import box, frame, of_a_ship, recorder, sample

SIZES = (
    (640, 360),
    (1920, 1080),
    (3840, 2160),
    (360, 360),
    (1080, 1080),
    (360, 640),
    (1080, 1920),
    (320, 180),
    (2560, 1080),
)
READABLE = 4.5
LONG = "A long title of an experiment whose author wanted to say in one line all that there is to be said about it"


@pytest.mark.parametrize("size", [*SIZES, (1024, 768), (800, 1000), (7680, 320), (500, 640), (180, 320)])
def test_boxes_neither_overlap_nor_leave_the_picture(size):
    for plots, lines, legend, inset, dial, band in product((1, 2), (0, 1, 3), *[(False, True)] * 4):
        layout = lay_out(*size, Needs(plots, lines, legend, inset, dial, band))
        for name, one in layout.boxes.items():
            assert within(one, (0, 0, *size)) and one[2] > one[0], name
            assert one[3] > one[1] or name == "readings"
        for one, other in combinations(layout.boxes, 2):
            assert not overlap(layout[one], layout[other]), (one, other)


def recorded(folder, ship=False, worlds=1, turn=0.5):
    """Two frames of a few grains in a tank, or aboard a ship that heels by `turn` (rad)."""
    said = to_table(load("ship/capsize-map").resolved) if ship else {}
    hold = np.array(load("ship/capsize-map").resolved.tank.corners) if ship else box()
    place = np.tile([[-0.02, 0.02], [0.0, 0.02], [0.02, 0.02], [0.0, 0.03]], (worlds, 1, 1))
    with recorder(folder, worlds, resolved={**said, "title": LONG}, outline=hold) as writer:
        for now in (0.0, 1.0):
            pose = np.tile([0.02 * now, 0.01 * now, turn * now], (worlds, 1))
            writer.sample(sample(now, worlds, pose=pose, **(of_a_ship(worlds) if ship else {})))
            writer.frame(frame(now, worlds, pose=pose, position=place))
    return folder


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """A tank, three tanks, and a ship."""
    new = tmp_path_factory.mktemp
    return {"tank": recorded(new("a")), "three": recorded(new("b"), worlds=3), "ship": recorded(new("c"), ship=True)}


@pytest.mark.parametrize(
    "what", [pytest.param("tank", marks=pytest.mark.slow), "three", pytest.param("ship", marks=pytest.mark.slow)]
)
def test_texts_lie_in_their_boxes_and_none_covers_another_or_the_stage(runs, what):
    initialise(fields=False)
    with open_footage(runs[what]) as footage:
        for size in SIZES:
            for wishes in ({}, {"frame": "tank", "inset": "surface", "colour": "displacement"}):
                film = Film(choose_beds(footage), choose_look(footage, width=size[0], height=size[1], **wishes))
                picture = film.picture(1)
                assert picture.shape[:2] == size[::-1] and {"title", "scale"} <= film.written.keys()
                slack = 0.012 * max(size) if max(size) < 700 else 4
                for name, text in film.written.items():
                    slot = {"bed": "view", "reading": "readings"}.get(name.split()[0], name)
                    assert within(text, film.layout[slot], slack), (size, name)
                    others = film.layout.keys() - {slot}
                    assert not [other for other in others if overlap(shrunk(text), film.layout[other])], (size, name)
                for one, other in combinations(film.written.values(), 2):
                    assert not overlap(shrunk(one), shrunk(other))


def shrunk(box_of):
    """A box without its outermost pixels."""
    return box_of[0] + 2, box_of[1] + 2, box_of[2] - 2, box_of[3] - 2


@pytest.mark.parametrize("name", THEMES)
def test_every_text_has_a_contrast_of_four_and_a_half(name):
    theme = THEMES[name]
    for ground in (theme.paper, theme.panel):
        for text in (theme.ink, theme.quiet, theme.accent, *theme.series):
            assert contrast(ground, text) >= READABLE
    assert contrast(theme.lost, theme.on_lost) >= READABLE
    assert min(contrast(theme.ink, sky) for sky in theme.sky) >= READABLE
    assert contrast(theme.on_sea, theme.sea[1]) >= READABLE
    assert contrast((0, 0, 0), (255, 255, 255)) == pytest.approx(21.0)


def test_scales_can_be_read_without_seeing_hues():
    """Lightness alone tells how far along a scale a colour is: it falls on light paper, and rises on dark paper."""
    for stops in (colours.EMBERS, colours.DEEPS, colours.ORCHID):
        assert (np.diff([luminance(colour) for colour in colours.ramp(stops)]) < 0.0).all()
    for stops in colours.ON_DARK.values():
        assert (np.diff([luminance(colour) for colour in colours.ramp(stops)]) > 0.0).all()


SEEN = {  # linear RGB as seen without long, middle or short cones (Machado, Oliveira & Fernandes 2009, table 1)
    "all": np.eye(3),
    "no long": [[0.1523, 1.0526, -0.2049], [0.1145, 0.7863, 0.0992], [-0.0039, -0.0481, 1.0520]],
    "no middle": [[0.3673, 0.8607, -0.2280], [0.2801, 0.6725, 0.0474], [-0.0118, 0.0429, 0.9689]],
    "no short": [[1.2555, -0.0767, -0.1788], [-0.0784, 0.9308, 0.1476], [0.0047, 0.6914, 0.3039]],
}
TOLD_APART = 9.0  # CIE 1976 colour difference; some two can just be seen side by side


def in_lab(linear):
    """CIE L*a*b* of linear RGB (n, 3) under D65."""
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    x, y, z = np.cbrt((np.clip(linear, 0.0, 1.0) @ to_xyz.T / [0.9505, 1.0, 1.089]).T)
    return np.column_stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


@pytest.mark.parametrize("seen", SEEN)
@pytest.mark.parametrize("name", THEMES)
def test_curves_differ_for_the_colour_blind(name, seen):
    share = np.array(THEMES[name].series) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    places = in_lab(linear @ np.array(SEEN[seen]).T)
    for one, other in combinations(places, 2):
        assert np.linalg.norm(one - other) > TOLD_APART


def test_a_ship_beyond_her_box_is_cut_off_and_else_is_the_same(monkeypatch):
    initialise(fields=False)
    sea, theme = Sea(load("ship/capsize-map").resolved), THEMES["light"]

    def painted(box):
        page = np.full((360, 640, 3), 7, dtype=np.uint8)
        still = Camera(600.0, (300.0, 200.0))
        afloat = FloatingShip(sea, still.carried(np.array([0.0, 0.0, 0.5])), still, 0.4, 4.0, 9.0)
        afloat.paint(page, box, theme)
        return page

    free, cut = painted((10, 10, 600, 350)), painted((10, 10, 290, 350))
    np.testing.assert_array_equal(cut[10:350, 10:290], free[10:350, 10:290])
    assert (cut[:, 290:] == 7).all() and (free[10:350, 290:600] != 7).any()
    monkeypatch.setattr(FloatingShip, "_keeps_within", lambda self, box: False)
    np.testing.assert_array_equal(painted((10, 10, 600, 350)), free)


def rows_of(picture, colour):
    """Mean row of the pixels of a colour."""
    rows, _ = np.nonzero((np.abs(picture.astype(int) - colour).max(axis=2) <= 3)[:, :430])
    assert len(rows) > 20
    return rows.mean()


def test_a_capsized_ship_is_upside_down_in_the_picture(tmp_path):
    """Her red bottom is below her deck while she is upright, and above it at 175 degrees."""
    initialise(fields=False)
    theme = THEMES["light"]
    with open_footage(recorded(tmp_path, ship=True, turn=np.radians(175.0))) as footage:
        film = Film(choose_beds(footage), choose_look(footage, width=640, height=360, frame="earth"))
        upright, over = film.picture(0), film.picture(1)
    assert rows_of(upright, theme.bottom) > rows_of(upright, theme.hull) + 10
    assert rows_of(over, theme.bottom) < rows_of(over, theme.hull) - 10
    assert (upright[200, 0] != upright[200 - 150, 0]).any()
    assert (np.abs(upright[340, :430].astype(int) - upright[340, 0]).max(axis=1) < 3)[
        [0, 429]
    ].all()  # sea at both edges
