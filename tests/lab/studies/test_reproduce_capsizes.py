"""Readings of the source's equation of roll: their natural frequencies, what capsizes, and what is read off scans."""

from dataclasses import replace

import numpy as np
import pytest

from lab.measures.value import over_worlds
from lab.studies.reproduce.claims import experiments
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships.capsizes import NATURAL, READINGS, Scan, _heap_beside_grains, _rows, scan
from lab.studies.reproduce.ships.rolls import AMPLITUDE, FREQUENCY

BOX_ONCE, BOX_TWICE, SOFT_ONCE, SOFT_TWICE = READINGS
HEIGHT = 0.055 + 0.34**2 / (12.0 * 0.11) - 0.0926  # m, GM


@pytest.mark.parametrize("reading", READINGS, ids=lambda one: one.words)
def test_every_reading_has_the_sources_free_roll(reading):
    """With the cargo loose but still, 34.5 mm under the axis; frozen it counts once, in spring and in inertia."""
    ship, frozen = reading.ship, reading.frozen
    assert ship.natural_frequency == pytest.approx(NATURAL)
    assert ship.height == pytest.approx(HEIGHT, abs=1e-9) and ship.lever(0.01) == pytest.approx(0.01 * HEIGHT, rel=1e-3)
    spring = 1000.0 * 0.34 * 0.11 * 9.81 * HEIGHT
    whole = (spring + 23.9 * 9.81 * 0.0345) / NATURAL**2 - 23.9 * ((0.3**2 + 0.111**2) / 12.0 + 0.0345**2)
    wanted = np.sqrt(spring / whole) if reading.twice else NATURAL
    assert frozen.natural_frequency == pytest.approx(wanted, rel=1e-6)


@pytest.mark.slow
def test_only_both_effects_together_capsize_in_the_sources_waves():
    """Loose cargo in 19 mm at 4.6 rad/s: not by the softening lever alone, nor by counting twice alone, nor frozen."""
    waves = np.array([19.0]), np.array([4.6])
    lost = {reading.words: scan(reading.ship, *waves).capsized[0, 0] for reading in READINGS}
    assert {words for words, share in lost.items() if share > 0.5} == {SOFT_TWICE.words}
    assert scan(SOFT_TWICE.frozen, *waves).capsized[0, 0] == 0.0


def test_a_softening_lever_peaks_below_the_natural_frequency_and_a_box_above():
    frequencies = np.arange(42, 56) / 10.0
    soft, box = (scan(one.frozen, np.array([10.0]), frequencies).peak[1] for one in (SOFT_ONCE, BOX_ONCE))
    assert soft < NATURAL - 0.1 and box > NATURAL + 0.1


def test_values_derived_from_scans():
    """Lost where half the reposes or more are; the lowest such waves; frozen ones are judged by 17 and 19 mm."""
    sizes, frequencies = np.array([15.0, 17.0, 19.0, 30.0]), np.array([4.4, 4.6, 4.7])
    shares = np.array([[0.0, 0.4, 0.0], [0.0, 0.6, 0.0], [0.0, 1.0, 0.5], [1.0, 1.0, 1.0]])
    rolls = np.array([[9.0, 31.0, 20.0]] * 4)
    loose = Scan(sizes, frequencies, rolls, shares)
    frozen = Scan(sizes, frequencies, rolls, np.zeros((4, 3)))
    peak, roll, capsized, at, kept = _rows("so", loose, frozen)
    assert peak.ours == "4.6 rad/s" and peak.verdict is Verdict.DIFFERS
    assert roll.source == "36 deg" and roll.ours == "31 deg" and roll.verdict is Verdict.DIFFERS
    assert capsized.ours == "from 17 mm on" and capsized.verdict is Verdict.AGREES
    assert at.ours == "at 4.6 to 4.7 rad/s" and at.verdict is Verdict.DIFFERS  # the source: from 4.4
    assert kept.ours == "none up to 30 mm" and kept.verdict is Verdict.AGREES
    early = replace(loose, capsized=np.maximum(shares, [[0.5, 0.0, 0.0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]))
    assert [_rows("so", early, early)[k].verdict for k in (2, 4)] == [Verdict.DIFFERS] * 2


def test_that_frozen_cargo_does_not_capsize_her_says_nothing_where_loose_cargo_does_not_either():
    """Loose cargo capsizes her in 30 mm only: in 17 and 19 mm nothing does."""
    sizes, frequencies = np.array([10.0, 17.0, 19.0, 30.0]), np.array([4.4, 4.6])
    shares = np.array([[0.0, 0.0]] * 3 + [[1.0, 1.0]])
    rolls = np.full((4, 2), 9.0)
    loose, frozen = (Scan(sizes, frequencies, rolls, one) for one in (shares, np.zeros((4, 2))))
    kept = _rows("so", loose, frozen)[4]
    assert kept.verdict is None and kept.ours.startswith("none up to 30 mm; not judged")


def test_an_agreeing_peak_does_not_hide_another_roll_angle():
    """26 deg at 4.4 rad/s, where the source has 36."""
    one = Scan(np.array([10.0, 19.0]), np.array([4.4, 4.6]), np.array([[26.0, 9.0]] * 2), np.zeros((2, 2)))
    peak, roll, *_ = _rows("so", one, one)
    assert peak.verdict is Verdict.AGREES and roll.verdict is Verdict.DIFFERS


def test_the_heap_is_compared_with_the_grains_in_the_same_waves():
    """At 4.5 rad/s, well below the resonance, both roll as the linear ship and the row says how far they are apart."""
    batches = experiments("ship")["barge-capsize"].batches(True)
    assert {key for batch in batches.values() for key in batch.axes} == {FREQUENCY}  # what a run's setting tells
    assert [batch.changes[AMPLITUDE] for batch in batches.values()] == list(batches)  # and what its batch's name does
    setting = {FREQUENCY: "4.5 rad/s"}

    def run(roll):
        return Outcome(setting, None, "complete", {"roll_amplitude": over_worlds([roll], "deg")}, {})

    said = _heap_beside_grains({"17 mm": [run(11.0), run(np.nan), run(31.0)], "19 mm": [run(np.nan)]}).ours
    mean, most = (float(part.split()[0]) for part in said.split(", "))
    assert mean == pytest.approx(10.0, abs=0.1) and 18.0 < most < 22.0 and "(2 runs)" in said
    assert _heap_beside_grains({"17 mm": [run(np.nan)]}).ours == "no run"
