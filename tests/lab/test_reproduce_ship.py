"""The report on ships: what it draws and says of runs whose numbers are known."""

import numpy as np
import pytest

from lab.measures.value import over_worlds
from lab.reproduce.rolls import rolls_against
from lab.reproduce.runs import Outcome
from lab.reproduce.ship import AMPLITUDE, FREQUENCY, capsize_tell, freedom_tell, response_tell

STAYS = np.nan


def ended(key, said, loose, frozen, *, capsized=(STAYS, STAYS), frozen_capsized=STAYS) -> Outcome:
    """Two beds that rolled by `loose` (steady, largest) deg ± 1, the frozen ship by `frozen`; when they capsized."""
    lost = np.isfinite(capsized)
    measures = {
        "roll_amplitude": over_worlds(np.where(lost, np.nan, [loose[0] - 1.0, loose[0] + 1.0]), "deg"),
        "largest_roll": over_worlds(np.where(lost, 90.0, [loose[1] - 1.0, loose[1] + 1.0]), "deg"),
        "capsized_at": over_worlds(capsized, "s"),
        "frozen_amplitude": over_worlds([frozen[0]], "deg"),
        "frozen_largest_roll": over_worlds([frozen[1]], "deg"),
        "frozen_capsized_at": over_worlds([frozen_capsized], "s"),
    }
    return Outcome({key: said}, None, "complete", measures, {})


def curves(axes):
    """Ordinates of the curves of a panel, by their words in the legend."""
    handles, labels = axes.get_legend_handles_labels()
    return {label: handle.lines[0].get_ydata() for handle, label in zip(handles, labels, strict=True)}


def crosses(axes):
    """Where crosses stand, a list a curve."""
    return [list(line.get_xdata()) for line in axes.lines if line.get_marker() == "X" and len(line.get_xdata())]


@pytest.fixture
def responses():
    return [
        ended(FREQUENCY, "3.5 rad/s", (4.0, 6.0), (5.0, 7.0)),
        ended(FREQUENCY, "4.4 rad/s", (20.0, 26.0), (34.0, 38.0)),
        ended(FREQUENCY, "5.0 rad/s", (22.0, 28.0), (np.nan, 90.0), capsized=(11.0, 12.0), frozen_capsized=9.0),
        ended(FREQUENCY, "6.5 rad/s", (2.0, 3.0), (2.5, 3.5), capsized=(STAYS, 30.0)),
    ]


def test_both_panels_tell_loose_from_frozen_cargo(responses):
    """Mean amplitude above and largest roll below, each its own; of capsized ships a cross, over no other's beds."""
    figure = rolls_against(FREQUENCY, "frequency", {"10 mm": responses}, ["10 mm"])
    upper, lower = figure.axes
    nan = np.nan
    assert curves(upper)["10 mm, loose"] == pytest.approx([4.0, 20.0, nan, 1.0], nan_ok=True)
    assert curves(lower)["10 mm, loose"] == pytest.approx([6.0, 26.0, nan, 2.0], nan_ok=True)
    assert curves(upper)["10 mm, frozen"] == pytest.approx([5.0, 34.0, nan, 2.5], nan_ok=True)
    assert curves(lower)["10 mm, frozen"] == pytest.approx([7.0, 38.0, nan, 3.5], nan_ok=True)
    for axes in figure.axes:
        assert crosses(axes) == [[5.0, 6.5], [5.0]]


def test_the_response_is_judged_by_loose_cargo(responses):
    """Less than 30 deg and less than frozen; and off the resonance by no more than 5."""
    rows = {row.quantity: row for row in response_tell({"10 mm": responses}).rows}
    assert rows["largest with loose cargo"].agrees
    assert rows["largest with frozen cargo"].ours == "34 deg at 4.4 rad/s"
    assert rows["3.5 rad/s, loose and frozen"].agrees
    wild = [ended(FREQUENCY, "4.4 rad/s", (35.0, 36.0), (34.0, 38.0))]
    assert not response_tell({"10 mm": wild}).rows[-1].agrees


def test_capsizes_are_told_of_the_cargo_they_are_of(responses):
    row = capsize_tell({"19 mm": responses[2:3]}).rows[0]
    assert row.ours == "capsizes at 11.50 ± 0.71 s (2 beds); frozen capsizes at 9 s (1 bed)"
    row = capsize_tell({"19 mm": responses[1:2]}).rows[0]
    assert row.ours.startswith("rolls 20.0 ± 1.4 deg") and "frozen rolls 34 deg" in row.ours and row.agrees is False


def test_a_wet_frozen_ship_is_not_drawn_twice():
    found = {name: [ended(AMPLITUDE, "20 mm", (12.0, 14.0), (13.0, 15.0))] for name in ("dry", "wet", "at once")}
    upper = freedom_tell(found).figure.axes[0]
    assert list(curves(upper)) == ["dry, loose", "wet, loose", "at once, loose", "dry, frozen", "at once, frozen"]
