"""Measures of wet cargo, on recordings whose pressures, settlements, depths and onsets are known."""

import numpy as np
import pytest

from lab.measures import measure_all
from lab.recording import open_recording
from tests.oracles.recorded_wet import (
    AREA,
    COLUMNS,
    DEPTH,
    GRAINS,
    MOISTURE,
    POROSITY,
    SIZE,
    WATER,
    WIDTH,
    drops,
    lattice,
    record_wet,
    wet,
)

G = 9.81
TIME = np.linspace(0.0, 10.0, 101)
LEVEL = AREA / POROSITY / WIDTH  # of water that would all stand in a bed of that porosity
STRESS = (1.0 - POROSITY) * (GRAINS - WATER) * G * 0.5 * DEPTH
DRIVEN = {"motion": {"soft_start": "1 s", "sway": {"amplitude": "10 mm", "frequency": "0.5 Hz"}}}


def of(folder, frame=lambda now: {}, **options) -> dict:
    """What is measured on such frames."""
    with open_recording(record_wet(folder / "run", TIME, frame, **options)) as recording:
        return measure_all(recording)


def pressed(excess, aside=0.0, gravity=G):
    """Water that is denser at port, with the pressure of rest, an excess, and what presses it to one side (Pa/m)."""
    place = drops(LEVEL)
    place[:, 0] -= 0.25 * (WIDTH - 4.0 * place[:, 0] ** 2 / WIDTH)
    pressure = WATER * gravity * (LEVEL - place[:, 1]) + excess + aside * place[:, 0]
    return {"water_position": place, "water_pressure": pressure}


def test_the_pore_pressure_is_over_that_of_water_at_rest(tmp_path):
    """A rise to 0.6 of what the grains bear that goes off again, and a mean of 0.2, whatever sway adds at the sides."""

    def frame(now):
        ratio = 0.6 * np.exp(-(((now - 3.0) / 0.3) ** 2)) + (0.2 if now > 1.0 else 0.0)
        return pressed(ratio * STRESS, aside=900.0 * np.sin(np.pi * now))

    found = of(tmp_path, frame, preset=wet(**DRIVEN))
    assert found["pore_pressure_ratio_peak"].value == pytest.approx(0.8, abs=2e-3)
    assert found["pore_pressure_peak"].value == pytest.approx(0.8 * STRESS, rel=3e-3)
    assert found["pore_pressure_ratio"].value == pytest.approx(0.2, abs=2e-3)
    assert found["pore_pressure_ratio"].kind == "averaging"
    assert found["pore_pressure_ratio_lowest"].value == pytest.approx(0.0, abs=2e-3)


def test_water_at_rest_in_a_rolled_tank_has_no_pore_pressure(tmp_path):
    """Its weight across the floor is less by cos φ, and along it presses to one side."""
    roll = np.where(TIME > 5.0, 0.3, 0.0)

    def frame(now):
        angle = 0.3 if now > 5.0 else 0.0
        return pressed(0.0, WATER * G * np.sin(angle), G * np.cos(angle))

    pose = np.stack([0.0 * roll, 0.0 * roll, roll], axis=1)
    found = of(tmp_path, frame, series={"pose": pose})
    assert abs(found["pore_pressure_ratio_peak"].value) < 2e-3
    assert abs(found["pore_pressure_ratio_lowest"].value) < 2e-3


def test_a_bed_that_shrinks_settles(tmp_path):
    """By 2 % of the heights of its grains: 0.92 mm of its surface, 0.96 mm of its depth, and its porosity falls."""
    shrunk = lattice() * [1.0, 0.98]

    found = of(tmp_path, lambda now: {"position": shrunk if now > 2.0 else lattice()})
    assert found["settlement"].value == pytest.approx(0.02 * (DEPTH - 0.5 * SIZE) * 1e3, rel=1e-3)
    assert found["settlement_mean"].value == pytest.approx(0.02 * DEPTH * 1e3, rel=1e-3)
    assert found["bed_porosity_start"].value == pytest.approx(POROSITY, rel=1e-4)
    assert found["bed_porosity_end"].value == pytest.approx(1.0 - (1.0 - POROSITY) / 0.98, rel=1e-3)


def test_a_thrown_grain_is_not_the_surface(tmp_path):
    """One grain in the air, and the surface stays."""
    thrown = lattice()
    thrown[-1, 1] += 0.05
    found = of(tmp_path, lambda now: {"position": thrown if now > 2.0 else lattice()})
    assert abs(found["settlement"].value) < 1.5 * SIZE / (COLUMNS // 2) * 1e3


def test_water_comes_out_of_the_bed(tmp_path):
    """Two of ten rows of water come out of the bed: a fifth of all water, by its own depth over the width."""
    low = drops(DEPTH)
    high = low.copy()
    high[-2 * 12 :, 1] += 0.05
    free = np.where(np.arange(len(low)) >= len(low) - 24, 1.0, POROSITY)

    def frame(now):
        out = now > 4.0
        return {"water_position": high if out else low, "water_porosity": free if out else 0.0 * free + POROSITY}

    found = of(tmp_path, frame)
    first, fifth = found["free_water_start"].value, 0.2 * AREA / WIDTH * 1e3
    assert first < 0.1 * AREA / WIDTH * 1e3
    assert found["free_water_end"].value == pytest.approx(fifth, rel=1e-3)
    assert found["dewatering"].value == pytest.approx(fifth - first, rel=1e-3)
    assert found["water_table_start"].value == pytest.approx(AREA / POROSITY / WIDTH * 1e3, rel=1e-4)
    table = (0.8 * AREA / POROSITY + 0.2 * AREA) / WIDTH * 1e3
    assert found["water_table_end"].value == pytest.approx(table, rel=1e-4)


def test_the_lever_is_the_water_s_share_of_its_shift(tmp_path):
    """The water goes 20 mm to port; of the whole weight that is MOISTURE times as much."""
    centre = np.stack([-0.02 * np.sin(np.pi * TIME / 20.0), 0.0 * TIME], axis=1)
    found = of(tmp_path, series={"water_centre": centre})
    assert found["water_shift"].value == pytest.approx(20.0)
    assert found["free_water_lever"].value == pytest.approx(20.0 * MOISTURE, rel=1e-3)


def test_the_onset_is_when_the_upper_layer_has_moved_by_a_diameter(tmp_path):
    """At 1 mm/s from 2 s on, a diameter of 4 mm is reached at 6 s; the rest of the bed lies still."""

    def frame(now):
        place = lattice()
        place[-COLUMNS:, 0] += 1e-3 * max(0.0, now - 2.0)
        return {"position": place}

    growing = np.stack([2e-3 * TIME, 0.0 * TIME, 0.0 * TIME], axis=1)
    found = of(tmp_path, frame, series={"pose": growing})
    assert found["onset_time"].value == pytest.approx(6.0, abs=1e-6)
    assert found["onset_time"].uncertainty == pytest.approx(0.05) and found["onset_time"].kind == "resolution"
    assert found["onset_amplitude"].value == pytest.approx(12.0) and found["onset_amplitude"].unit == "mm"
    assert found["layer_shift"].value == pytest.approx(2.0, abs=1e-6)
    still = of(tmp_path / "still")
    assert still["onset_time"].value is None and "never moved" in still["onset_time"].note


def test_beds_without_water_have_none_of_these(tmp_path):
    """A pool has no bed."""
    from tests.oracles.recorded_water import record_pool

    with open_recording(record_pool(tmp_path / "run", TIME, {}, {"water_pressure": np.zeros((5, 1, 6))})) as recording:
        found = measure_all(recording)
    assert not {"onset_time", "settlement", "free_water_start", "pore_pressure_peak"} & found.keys()


def test_each_has_a_figure(tmp_path):
    """With curves that are no flat nothing."""
    from lab.report.plots import figures

    def frame(now):
        place = lattice()
        place[-COLUMNS:, 0] += 1e-3 * now
        return {"position": place} | pressed(100.0 * np.sin(now))

    with open_recording(record_wet(tmp_path / "run", TIME, frame, preset=wet(**DRIVEN))) as recording:
        drawn = dict(figures(recording, measure_all(recording)))
    assert {"upper_layer", "settlement", "pore_pressure", "free_water"} <= drawn.keys()
    for name in ("upper_layer", "pore_pressure"):
        assert any(np.ptp(line.get_ydata()) > 0.1 for axes in drawn[name].axes for line in axes.lines)
