"""The report on ships: what it draws and says of runs whose numbers are known."""

import numpy as np
import pytest

from lab.measures.value import over_worlds
from lab.studies.reproduce.claims import experiments
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships.rolls import AMPLITUDE, FREQUENCY, rolls_figure

STAYS = np.nan
response_tell, capsize_tell, freedom_tell = (
    experiments("ship")[name].report for name in ("barge-roll", "barge-capsize", "barge-3dof")
)


def ended(key, said, loose, frozen, *, capsized=(STAYS, STAYS), frozen_capsized=STAYS, apart=1.0) -> Outcome:
    """Two beds that rolled `apart` deg off `loose` (steady, largest), frozen by `frozen`; when they capsized."""
    lost = np.isfinite(capsized)
    measures = {
        "roll_amplitude": over_worlds(np.where(lost, np.nan, [loose[0] - apart, loose[0] + apart]), "deg"),
        "largest_roll": over_worlds(np.where(lost, 90.0, [loose[1] - apart, loose[1] + apart]), "deg"),
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


def test_both_panels_distinguish_loose_and_frozen_cargo(responses):
    """Mean amplitude above and largest roll below, each its own; of capsized ships a cross, over no other's beds."""
    figure = rolls_figure({"10 mm": responses}, FREQUENCY, "frequency", ["10 mm"])
    upper, lower = figure.axes
    nan = np.nan
    assert curves(upper)["10 mm, loose"] == pytest.approx([4.0, 20.0, nan, 1.0], nan_ok=True)
    assert curves(lower)["10 mm, loose"] == pytest.approx([6.0, 26.0, nan, 2.0], nan_ok=True)
    assert curves(upper)["10 mm, frozen"] == pytest.approx([5.0, 34.0, nan, 2.5], nan_ok=True)
    assert curves(lower)["10 mm, frozen"] == pytest.approx([7.0, 38.0, nan, 3.5], nan_ok=True)
    for axes in figure.axes:
        assert crosses(axes) == [[5.0, 6.5], [5.0]]


def test_the_response_is_judged_by_loose_cargo_if_beds_allow_it(responses):
    """Less than 30 deg and less than frozen; and off the resonance by no more than 5: two beds cannot tell by far."""
    rows = {row.quantity: row for row in response_tell({"10 mm": responses}).rows}
    assert rows["3.5 rad/s, loose and frozen"].verdict is Verdict.CANNOT_TELL
    assert rows["largest with loose cargo"].verdict is Verdict.CANNOT_TELL
    calm = [ended(FREQUENCY, "3.5 rad/s", (2.0, 6.0), (5.0, 7.0), apart=0.01)]
    rows = {row.quantity: row for row in response_tell({"10 mm": calm}).rows}
    assert rows["3.5 rad/s, loose and frozen"].verdict is Verdict.AGREES
    assert rows["largest with loose cargo"].verdict is Verdict.AGREES
    wild = [ended(FREQUENCY, "4.4 rad/s", (35.0, 36.0), (34.0, 38.0), apart=0.01)]
    assert response_tell({"10 mm": wild}).rows[-1].verdict is Verdict.DIFFERS


def test_a_frozen_ship_far_below_the_sources_peak_differs_from_it():
    """36 deg at 4.4 rad/s beside 5.9 deg there and 32 at 5.2: neither is hidden by what agrees elsewhere."""
    runs = [
        ended(FREQUENCY, "4.4 rad/s", (5.8, 9.0), (5.9, 9.0)),
        ended(FREQUENCY, "5.2 rad/s", (21.0, 25.0), (32.0, 36.0)),
    ]
    rows = {row.quantity: row for row in response_tell({"10 mm": runs}).rows}
    for quantity in ("4.4 rad/s, frozen", "largest with frozen cargo", "largest with frozen cargo: frequency"):
        assert rows[quantity].verdict is Verdict.DIFFERS
    assert rows["4.4 rad/s, frozen"].source == "36 deg" and rows["4.4 rad/s, frozen"].ours == "5.9 deg"


def test_capsizes_are_reported_with_their_cargo(responses):
    row = capsize_tell({"19 mm": responses[2:3]}).rows[0]
    assert row.ours == "capsizes at 11.50 ± 0.71 s (2 beds); frozen capsizes at 9 s"
    row = capsize_tell({"19 mm": responses[1:2]}).rows[0]
    assert row.ours.startswith("rolls 20.0 ± 1.4 deg") and "frozen rolls 34 deg" in row.ours
    assert row.verdict is Verdict.CANNOT_TELL  # none of two beds: it may still be half of all


def test_a_wet_frozen_ship_is_not_drawn_twice():
    found = {name: [ended(AMPLITUDE, "20 mm", (12.0, 14.0), (13.0, 15.0))] for name in ("dry", "wet", "at once")}
    upper = freedom_tell(found).figure.axes[0]
    assert list(curves(upper)) == ["dry, loose", "wet, loose", "at once, loose", "dry, frozen", "at once, frozen"]
