"""Viscous roll damping of a preset's ship by Ikeda's components, with bilge keels."""

import numpy as np
import pytest

from lab.assembly.scene import vessels
from lab.assembly.ship import make_vessel
from lab.base.errors import LabError
from lab.preset.find import load
from solvers.ship.damping.components import FITTED, Particulars, Slice, components, linear_quadratic
from solvers.ship.damping.keels import Keels

SHIP = "ship/handysize-grain"
FREE = {"ship.damping": 0, "ship.quadratic_damping": 0, "ship.viscous_damping": "ikeda"}
WITH = FREE | {"ship.bilge_keels.breadth": "0.4 m", "ship.bilge_keels.length": "40 m"}


def damping(changes):
    """The vessel's damping, in calm water, of the hull with her cargo fixed."""
    said = load(SHIP, changes).resolved
    return make_vessel(said.ship, said.sea, None, said.run.gravity).ship.damping


def test_keels_add_to_what_the_hull_has():
    bare, kept = damping(FREE), damping(WITH)
    at = lambda one: one.linear + 8.0 / (3.0 * np.pi) * 0.45 * np.radians(15.0) * one.quadratic  # noqa: E731
    assert 0.0 < at(bare) < 0.9 * at(kept)


def test_damping_is_that_of_the_components_a_metre():
    """Of a box 27 by 9.7 m under water, G 9.11 m above the keel, rolling in 14 s with her cargo."""
    keels = Keels(0.4, 40.0 / 130.7)
    ship = Particulars(1.0, 27.0, 9.7, 1.0, 1.0, 9.11, keels, None, 1025.0)
    omega = 2.0 * np.pi / 14.0
    parts = components(ship, omega, FITTED, [Slice(1.0, 27.0, 9.7, 27.0 * 9.7)], waves=0.0)
    linear, quadratic, _ = linear_quadratic(omega, FITTED, parts.sum(axis=1))
    found = damping(WITH)
    assert found.quadratic == pytest.approx(quadratic, rel=0.05)
    assert found.linear == pytest.approx(linear, rel=0.05, abs=1e-3 * quadratic)


def test_without_the_key_damping_is_as_given():
    said = load(SHIP).resolved
    ship = vessels(said)[0].ship
    assert ship.damping.quadratic > 0.0 and said.ship.viscous_damping == "given"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"ship.viscous_damping": "ikeda"}, "ship.damping: is computed"),
        (FREE | {"ship.linear_damping": "5 N s"}, "ship.damping: is computed"),
        (WITH | {"ship.viscous_damping": "given"}, "ship.bilge_keels: are not used"),
        (WITH | {"ship.bilge_keels.length": "140 m"}, "ship.bilge_keels.length: more than the ship's"),
        (WITH | {"ship.bilge_keels.breadth": "4 m"}, "ship.bilge_keels.breadth: at most 2.7 m"),
    ],
)
def test_errors_name_key_and_remedy(changes, words):
    with pytest.raises(LabError, match=words):
        load(SHIP, changes)
