"""The window's first page: every preset can be found and selected."""

import numpy as np

from lab.preset.find import names
from lab.view.panel.chooser import COLUMNS, ROWS, Chooser

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
