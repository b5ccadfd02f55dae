"""The prismatic tank: how runs are compared with the finest, what gauges show, and when water is at the roof."""

import dataclasses

import numpy as np
import pytest

from lab.measures.value import Value
from lab.preset.find import load
from lab.studies.reproduce import experiments
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.water import prismatic
from tests.lab.studies.test_reproduce_water import ran


def swayed(spacing: float, extra: float, highest: float = 100.0, preset: str = "sloshing/source-p-25"):
    """A run whose pressure at P1 is 300 Pa and a sine of 200 Pa of the motion's frequency, and `extra` (Pa) of it."""
    time = np.arange(0.0, 20.0, 1e-3)
    pressure = 300.0 + (200.0 + extra) * np.sin(2.0 * np.pi * 1.08 * time)
    dry = np.zeros_like(time)
    shown = np.stack([pressure, dry, dry], axis=-1)[:, None]
    one = ran(preset, {"water.spacing": f"{spacing} mm"}, time=time, gauge_pressure=shown)
    one.measures["highest_water"] = Value(highest, "mm")
    return [one]


def hit(preset: str, frequency: float, steady: float, hits: list[float], changes: dict | None = None):
    """A run with a steady pressure (Pa) at P1, hits (Pa) of 40 ms at P2, one in each of the last cycles, none at P3.

    Where P2 is hit a square centimetre of water is there, which is elsewhere else.
    """
    time = np.arange(0.0, 20.0, 1e-3)
    struck = np.zeros_like(time)
    for back, high in enumerate(reversed(hits)):
        struck[np.abs(time - (time[-1] - (back + 0.5) / frequency)) < 0.02] = high
    shown = np.stack([np.full_like(time, steady), struck, np.zeros_like(time)], axis=-1)[:, None]
    place = np.where(struck[::10, None, None, None] > 0.0, [-0.15, 0.155], 0.0) + np.zeros((1, 1, 100, 1))
    of = {"time": time, "gauge_pressure": shown, "frames_time": time[::10], "frames_water_position": place}
    one = ran(preset, {"water.spacing": "3.5 mm", **(changes or {})}, **of)
    one.recording.volume = np.full((1, 100), 1e-6)
    one.measures["highest_water"] = Value(100.0, "mm")
    return [one]


def test_the_difference_from_the_finest_run_is_root_mean_square():
    found = {"4 mm": swayed(4.0, 100.0), "2.4 mm": swayed(2.4, 50.0), "1.6 mm": swayed(1.6, 0.0)}
    told = prismatic.convergence(found)
    assert [row.verdict for row in told.rows] == [Verdict.AGREES] * 2
    cells = dict(zip(told.table[0], told.table[1], strict=True))
    assert cells["off 1.6 mm"] == "71 Pa" and cells["mean at P1"] == "300 Pa"  # 100/√2
    assert cells["mean peak of 9 cycles"] == "600 Pa"


def test_a_finer_run_that_is_farther_off_differs():
    found = {"4 mm": swayed(4.0, 50.0), "2.4 mm": swayed(2.4, 100.0), "1.6 mm": swayed(1.6, 0.0)}
    assert [row.verdict for row in prismatic.convergence(found).rows] == [Verdict.DIFFERS] * 2


def test_cycles_that_scatter_may_have_the_same_mean():
    """Amplitudes of 60 Pa more and less: a difference of 60 √(8/9)/√2 Pa in time and none of the mean cycle, for which
    their scatter allows √(3600/9/2)."""
    time = np.linspace(0.0, 9.0, 9001)
    more = np.array([60.0, -60.0] * 4 + [0.0])[np.minimum(time.astype(int), 8)]
    wave = np.sin(2.0 * np.pi * time)
    scattered, same = (prismatic.Pressure(time, (200.0 + one) * wave) for one in (more, 0.0))
    assert scattered.off(same) == pytest.approx(40.0, rel=1e-3)
    mean, by_scatter = scattered.mean_cycle_off(same)
    assert mean == pytest.approx(0.0, abs=0.5) and by_scatter == pytest.approx(200.0**0.5, rel=1e-2)


def test_peaks_are_less_the_pressure_at_rest_at_each_gauge():
    """Half full, P1 is 52.5 mm below the surface and bears 515 Pa at rest; P2 and P3 are above it."""
    half = hit("sloshing/source-p-50-roll", 1.34, 1015.0, [200.0, 400.0] * 4 + [300.0])
    first, second, third = (prismatic.peak_at(half, given) for given in (1, 2, 3))
    assert first.value == pytest.approx(1015.0 - 1000.0 * 9.81 * 0.0525) and first.uncertainty == pytest.approx(0.0)
    assert second.value == pytest.approx(300.0) and second.note == ""
    assert second.uncertainty == pytest.approx(100.0 / 3.0)  # √(8 · 100² / 8) / √9
    assert third.value is None and third.note == "dry"
    quarter = hit("sloshing/source-p-25-roll", 1.04, 1015.0, [])
    assert prismatic.peak_at(quarter, 1).value == pytest.approx(1015.0)  # the still level is at P1's middle


def test_a_gauge_is_dry_below_the_weight_of_one_layer_of_particles():
    """Particles of 3.5 mm weigh 34 Pa a layer; cycles without a hit count as nothing in the mean of nine."""
    of = "sloshing/source-p-50"
    assert prismatic.peak_at(hit(of, 1.34, 600.0, [33.0] * 9), 2).note == "dry"
    some = prismatic.peak_at(hit(of, 1.34, 600.0, [90.0, *[0.0] * 7, 90.0]), 2)
    assert some.value == pytest.approx(20.0) and some.note == ", wet in 2 of 9"


def test_what_air_adds_is_told_cycle_by_cycle():
    """Cycles whose peaks are 100 Pa apart, however they scatter, differ by 100 Pa without an error."""
    of, hits = "sloshing/source-p-50-roll", np.array([200.0, 400.0] * 4 + [300.0])
    water = hit(of, 1.34, 1015.0, list(hits))
    for more, verdict in ((100.0, Verdict.AGREES), (-100.0, Verdict.DIFFERS)):
        both = hit(of, 1.34, 1015.0, list(hits + more), {"air.sound_speed": "equal"})
        assert prismatic.cycle_peaks(both, 1).worlds == pytest.approx([1015.0 - 1000.0 * 9.81 * 0.0525] * 9)
        told = experiments("water")["prismatic-half-air-finest"].report({"one phase, 25 m/s": water, "with air": both})
        (row,) = (row for row in told.rows if "peak at P2" in row.quantity)
        assert row.ours.startswith(f"{more:g} ± 0") and row.verdict is verdict


def test_the_time_with_water_at_a_gauge_is_told_of_each_cycle():
    """Hits of 40 ms in the first and the last cycle of 1/1.34 s."""
    struck = hit("sloshing/source-p-50", 1.34, 600.0, [90.0, *[0.0] * 7, 90.0])
    shares = prismatic.wet_cycles(struck, 2).worlds
    assert shares == pytest.approx([0.04 * 1.34, *[0.0] * 7, 0.04 * 1.34], rel=0.1)
    assert prismatic.wet_cycles(struck, 3).worlds == (0.0,) * 9
    struck[0].recording.volume *= 0.6
    assert prismatic.wet_cycles(struck, 2).value == 0.0  # 60 mm² are too little


def test_pages_tell_peaks_in_the_upper_chamber():
    told = experiments("water")["prismatic-half"].report(
        {"50 %, roll": hit("sloshing/source-p-50-roll", 1.34, 1015.0, [90.0] * 9)}
    )
    cells = dict(zip(*told.table, strict=True))
    assert [cells[f"mean peak at P{gauge}"] for gauge in (2, 3)] == ["90 ± 0 Pa (s.e.)", "dry"]
    assert cells["mean peak at P1, less at rest"] == "500 ± 0 Pa (s.e.)"


def test_of_a_run_that_was_stopped_its_cost_alone_is_told():
    """Its last nine cycles are those of the start."""
    (one,) = hit("sloshing/source-p-50-roll", 1.34, 1015.0, [90.0] * 9)
    ended = dataclasses.replace(one, status="stopped: world 0: the water is too fast at t = 9 s.")
    ended.__dict__["recording"] = one.recording
    told = experiments("water")["prismatic-half"].report({"50 %, roll": [ended]})
    cells = dict(zip(*told.table, strict=True))
    assert cells["particles"] == "100" and cells["mean peak at P2"] == cells["highest water"] == "stopped"


def test_chamfers_are_told_beside_those_of_50_mm():
    """A greater chamfer lowers the first natural frequency (finite elements): 1.440, 1.435, 1.427 Hz."""
    known = experiments("water")["prismatic-chamfer-half"].batches(False)
    found, hits = {}, {"40 mm": 90.0, "50 mm": 190.0, "60 mm": 0.0}
    for size, high in hits.items():
        batch = known[label := f"50 %, roll, {size}"]
        found[label] = hit(batch.preset, 1.34, 1015.0, [high] * 9, dict(batch.changes))
    told = experiments("water")["prismatic-chamfer-half"].report(found)
    assert [row.ours for row in told.rows] == [
        "+0 ± 0 Pa (s.e.); -100 ± 0 Pa (s.e.); dry",
        "+0 ± 0 Pa (s.e.); dry for 190 Pa; dry",
    ]
    assert told.figure is not None
    assert [row[5] for row in told.table[1:]] == ["1.440 Hz", "1.435 Hz", "1.427 Hz"]


def test_gauges_lie_on_the_walls_of_tanks_with_other_chamfers():
    known = experiments("water")
    both = known["prismatic-chamfer"].batches(False) | known["prismatic-chamfer-half"].batches(False)
    for label, batch in both.items():
        size = float(label.rsplit(", ", 1)[1].split()[0]) / 1e3
        preset = load(batch.preset, batch.changes).resolved
        at = preset.gauges["P3"].place
        assert at == pytest.approx((-0.15 + size / 2, 0.21 - size / 2))  # the middle of the upper chamfer
        assert preset.gauges["P1"].place[1] == pytest.approx(0.0525)


@pytest.mark.parametrize(("highest", "verdict"), [(207.0, Verdict.AGREES), (208.0, Verdict.DIFFERS)])
def test_water_within_a_spacing_of_the_roof_touches_it(highest, verdict):
    found = {"25 %, roll": swayed(2.4, 0.0, highest, "sloshing/source-p-25-roll")}
    told = experiments("water")["prismatic-roof"].report(found)
    assert [row.verdict for row in told.rows] == [verdict]
    assert dict(zip(*told.table, strict=True))["highest water"] == f"{highest:.0f} mm"


def test_all_runs_of_the_study_are_of_presets_that_exist():
    names = {name: one.batches(False) for name, one in experiments("water").items()}
    asked = "sway", "sound", "fine", "cost", "roof", "half", "chamfer", "chamfer-half"
    counted = {one: len(names[f"prismatic-{one}"]) for one in asked}
    assert [*counted.values()] == [3, 4, 4, 3, 2, 2, 2, 6]


@pytest.mark.parametrize(
    ("preset", "hours"), [("sloshing/source-p-25-roll", 9.0), ("sloshing/source-p-25-roll-air", 81.0)]
)
def test_thirty_seconds_are_set_beside_the_sources_hours(preset, hours):
    """A tenth of a second in 12 s is 30 s in an hour; the source has 9 h with water alone, 81 h with air."""
    one = ran(preset, time=np.array([0.0, 0.1]))
    one.cost["seconds"] = {"run": 12.0}
    cells = dict(zip(*prismatic.thirty_seconds({"ours": [one]}).table, strict=True))
    assert cells["30 s would take"] == "60 min" and cells[f"the source's {hours:g} h over that"] == f"{hours:g}"
