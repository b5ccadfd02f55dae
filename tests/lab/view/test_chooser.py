"""The window's first page: every preset can be found and selected."""

import numpy as np
import pytest

from lab.paint import palette
from lab.preset.find import names
from lab.view.panel.chooser import COLUMNS, GRAIN, ROWS, WATER, Chooser, _sketch

SIZE = 1280, 720


def test_arrows_reach_every_preset_and_enter_selects_it():
    chooser = Chooser(SIZE)
    wanted = sorted(name for name in names() if not name.endswith("-quick"))
    for _ in range(COLUMNS * ROWS + 3):
        chooser.key("right")
    chooser.key("return")
    assert (chooser.chosen, chooser.ended) == (wanted[COLUMNS * ROWS + 3], True)


def test_a_click_selects_the_card_below_it():
    chooser = Chooser(SIZE)
    left, top, wide, high = chooser._card(5)
    chooser.press(left + 0.5 * wide, top + 0.5 * high)
    assert chooser.chosen == chooser._shown()[5]


def test_q_selects_the_quick_variant_if_there_is_one():
    chooser = Chooser(SIZE)
    chooser.key("q")
    assert chooser.chosen.endswith("-quick")
    assert chooser.chosen in names()


def test_the_current_card_is_framed():
    chooser = Chooser(SIZE)
    before = chooser.picture()
    chooser.key("right")
    assert np.any(chooser.picture() != before)


def test_escape_selects_none():
    chooser = Chooser(SIZE)
    chooser.key("escape")
    assert (chooser.chosen, chooser.ended) == ("", True)


@pytest.mark.parametrize(
    ("name", "cargo", "water"),
    [
        ("bulk/box", 9.0 / 16.0, 0.0),
        ("flooding/box", 0.0, 2.0 / 3.2),
        ("wet/collapse-loose", 0.06 / 0.3, (0.3 - 0.06) / 0.3 * 0.088 / 0.11),
    ],
)
def test_a_preset_without_a_poster_is_sketched_with_what_fills_its_tank(name, cargo, water):
    """Shares of the tank by colour: depths or widths of what fills it over those of the tank."""
    picture = np.asarray(_sketch(name, (800, 600)))
    of_cargo, of_water, empty = ((picture == colour).all(axis=2).sum() for colour in (GRAIN, WATER, palette.PAPER))
    inside = of_cargo + of_water + empty
    assert [of_cargo / inside, of_water / inside] == pytest.approx([cargo, water], abs=0.02)
