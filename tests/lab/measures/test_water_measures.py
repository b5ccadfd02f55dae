"""Measures of water, on signals whose peaks, impulses, frequencies and energies are known."""

import numpy as np
import pytest

from lab.measures import measure_all
from lab.measures.gauges import cycles
from lab.recording import open_recording
from tests.oracles.recorded_water import DROPS, pool, record_pool

RATE = 200.0
TIME = np.arange(0, 10 * RATE + 1) / RATE
FREQUENCY = 0.5
DRIVEN = {"motion": {"soft_start": "1 s", "sway": {"amplitude": "10 mm", "frequency": "0.5 Hz"}}}


def bump(centre: float, height: float, width: float = 0.02) -> np.ndarray:
    """A pressure that rises and falls like a bell."""
    return height * np.exp(-(((TIME - centre) / width) ** 2))


def of(folder, frames=None, preset=None, **series) -> dict:
    """What is measured on such series (T,) or (T, n)."""
    rows = {name: values.reshape(len(TIME), 1, *values.shape[1:]) for name, values in series.items()}
    with open_recording(record_pool(folder / "run", TIME, rows, frames, preset)) as recording:
        return measure_all(recording)


def test_the_peaks_of_cycles_are_averaged_and_their_scatter_told(tmp_path):
    heights = [9000.0, 3000.0, 4000.0, 2000.0, 5000.0]  # the first, at 1 s, is within the start and its first cycle
    peak = sum(bump(1.0 + 2.0 * k, height) for k, height in enumerate(heights))
    values = of(tmp_path, preset=pool(**DRIVEN), gauge_peak=np.stack([peak, 0 * peak], axis=1))
    found = values["gauge_peak_P1"]
    assert found.value == pytest.approx(np.mean(heights[2:4])) and found.note == "2 cycles"
    scatter = values["gauge_peak_scatter_P1"].value
    assert scatter == pytest.approx(np.std(heights[2:4], ddof=1))
    assert found.uncertainty == pytest.approx(scatter / 2**0.5) and found.kind == "cycles"
    assert values["gauge_largest_P1"].value == pytest.approx(9000.0) and values["gauge_largest_P1"].note == "at 1 s"
    assert values["gauge_peak_P2"].value == 0.0 and values["gauge_largest_P2"].note == "it stays dry"


def test_no_impact_falls_on_a_cut_between_cycles(tmp_path):
    for shift in (0.0, 0.37, 0.99, 1.5):
        peak = sum(bump(shift + 2.0 * k, 1000.0) for k in range(6))
        rows = np.stack([peak, peak], axis=1)[:, None]
        folder = record_pool(tmp_path / f"{shift}", TIME, {"gauge_peak": rows}, preset=pool(**DRIVEN))
        with open_recording(folder) as recording:
            parts = cycles(recording, peak)
        assert len(parts) in (2, 3) and TIME[parts[0].start] >= 3.0
        assert [float(peak[rows].max()) for rows in parts] == pytest.approx([1000.0] * len(parts))
        assert all(peak[rows.start] < 10.0 for rows in parts)


def test_the_impulse_is_the_integral_from_30_ms_before_a_peak_to_200_ms_after_it(tmp_path):
    after = np.where((TIME >= 4.0) & (TIME <= 4.5), 1000.0 * np.exp(-(TIME - 4.0) / 0.1), 0.0)
    pressure = np.stack([after, 0.0 * after], axis=1)
    values = of(tmp_path, gauge_pressure=pressure, gauge_peak=pressure)
    assert values["gauge_impulse_P1"].value == pytest.approx(1000.0 * 0.1 * (1.0 - np.exp(-2.0)), rel=0.03)
    assert "gauge_peak_P1" not in values  # nothing drives this tank
    late = np.roll(pressure, round(5.95 * RATE), axis=0)  # its 200 ms are not all recorded
    assert of(tmp_path / "late", gauge_pressure=late, gauge_peak=late)["gauge_impulse_P1"].value is None


FORCES = {
    "gauges": {
        "F-1": {"kind": "force", "place": ["500 mm", "100 mm"]},
        "F2": {"kind": "force", "place": ["0 mm", "0 mm"]},
    }
}


def test_the_push_on_an_edge_is_what_is_square_to_it_and_outwards(tmp_path):
    """Peaks, their scatter, the impulse, the mean and the standard deviation of forces whose numbers are known."""
    heights = [90.0, 30.0, 40.0, 20.0, 50.0]
    swing = 8.0 * np.sin(2.0 * np.pi * FREQUENCY * TIME)
    side = 200.0 + sum(bump(1.0 + 2.0 * k, height) for k, height in enumerate(heights))
    force = np.stack([np.stack([side, 7.0 + 0.0 * TIME], axis=1), np.stack([swing, -400.0 - swing], axis=1)], axis=1)
    force[0] = 0.0  # the mean of nothing yet
    values = of(tmp_path, preset=pool(**DRIVEN, **FORCES), edge_force=force)
    mean = values["force_peak_F_1"]
    assert mean.value == pytest.approx(200.0 + np.mean(heights[2:4])) and mean.unit == "N" and mean.note == "2 cycles"
    scatter = values["force_peak_scatter_F_1"].value
    assert scatter == pytest.approx(np.std(heights[2:4], ddof=1))
    assert mean.uncertainty == pytest.approx(scatter / 2**0.5) and mean.kind == "cycles"
    assert values["force_largest_F_1"].value == pytest.approx(290.0) and values["force_largest_F_1"].note == "at 1 s"
    whole = 0.230 * 200.0 + 0.02 * np.pi**0.5 * np.mean(heights[2:4])  # of a level push and a bell
    assert values["force_impulse_F_1"].value == pytest.approx(whole, rel=0.03)
    assert values["force_impulse_F_1"].unit == "N s"
    floor, spread = values["gauge_mean_F2"], values["gauge_std_F2"]  # downwards is outwards; sideways is along it
    assert floor.value == pytest.approx(400.0, abs=0.01) and floor.kind == "averaging" and floor.unit == "N"
    assert spread.value == pytest.approx(8.0 / 2**0.5, rel=1e-3) and spread.uncertainty < 0.01
    assert values["force_peak_F2"].value == pytest.approx(408.0, rel=1e-3)


def test_the_largest_push_of_a_run_that_nothing_drives(tmp_path):
    after = np.where((TIME >= 4.0) & (TIME <= 4.5), 50.0 * np.exp(-(TIME - 4.0) / 0.1), 0.0)
    force = np.zeros((len(TIME), 2, 2))
    force[:, 0, 0] = after
    values = of(tmp_path, preset=pool(**FORCES), edge_force=force)
    assert values["force_largest_F_1"].value == pytest.approx(50.0) and values["force_largest_F_1"].note == "at 4 s"
    assert values["force_impulse_F_1"].value == pytest.approx(50.0 * 0.1 * (1.0 - np.exp(-2.0)), rel=0.05)
    assert values["force_largest_F2"].note == "it stays dry" and "force_peak_F_1" not in values


def test_crests_and_troughs_are_those_of_cycles_over_the_level_at_the_start(tmp_path):
    """Of a wave with sharp crests: its second harmonic lifts the trough by as much as the crest."""
    phase = 2.0 * np.pi * FREQUENCY * TIME
    rise = np.where(TIME > 0.0, 0.020 * np.cos(phase) + 0.004 * np.cos(2.0 * phase), 0.0)
    values = of(tmp_path, preset=pool(**DRIVEN), level_depth=(0.2 + rise)[:, None])
    crest, trough = values["crest_L_1"], values["trough_L_1"]
    assert crest.value == pytest.approx(24.0, abs=0.01) and crest.note == "3 cycles" and crest.unit == "mm"
    assert trough.value == pytest.approx(-16.0, abs=0.01) and trough.kind == "cycles"
    assert max(values[f"{end}_scatter_L_1"].value for end in ("crest", "trough")) < 0.01
    assert values["gauge_mean_L_1"].value == pytest.approx(200.0, abs=0.05)
    assert values["gauge_std_L_1"].value == pytest.approx((20.0**2 + 4.0**2) ** 0.5 / 2**0.5, rel=2e-3)
    calm = of(tmp_path / "b", level_depth=np.full((len(TIME), 1), 0.2))
    assert "crest_L_1" not in calm and calm["gauge_std_L_1"].value == 0.0


def test_the_mean_of_a_pressure_has_the_error_of_its_blocks(tmp_path):
    """Of noise it is its standard deviation over the root of the number of samples."""
    noise = np.random.default_rng(1).normal(5000.0, 300.0, (len(TIME), 2))
    values = of(tmp_path, gauge_pressure=noise)
    steady = noise[len(TIME) // 2 :, 0]
    mean, spread = values["gauge_mean_P1"], values["gauge_std_P1"]
    assert mean.value == pytest.approx(steady.mean()) and mean.unit == "Pa"
    assert 0.4 < mean.uncertainty / (300.0 / len(steady) ** 0.5) < 1.6
    assert spread.value == pytest.approx(steady.std()) and spread.kind == "halves"


def test_figures_of_gauges_show_what_was_measured(tmp_path):
    from lab.report.plots import figures

    force = np.zeros((len(TIME), 1, 2, 2))
    force[:, 0, 0, 0] = 200.0 + sum(bump(1.0 + 2.0 * k, 40.0) for k in range(5))
    depth = (0.2 + 0.02 * np.cos(2.0 * np.pi * FREQUENCY * TIME))[:, None, None]
    preset = pool(**DRIVEN, **FORCES)
    folder = record_pool(tmp_path / "run", TIME, {"edge_force": force, "level_depth": depth}, preset=preset)
    with open_recording(folder) as recording:
        drawn = dict(figures(recording, measure_all(recording)))
    for name, said in (("forces", "mean peak at F-1"), ("crests", "mean trough at L-1"), ("gauges", "mean peak at P1")):
        texts = [text.get_text() for text in drawn[name].legends[0].get_texts()]
        assert any(text.startswith(said) for text in texts), texts


def test_the_frequency_and_damping_of_a_free_wave(tmp_path):
    frequency, damping = 0.83, 0.01
    omega = 2 * np.pi * frequency
    depth = 0.2 + 0.02 * np.exp(-damping * omega * TIME) * np.cos(omega * TIME)
    values = of(tmp_path, level_depth=depth[:, None])
    found = values["sloshing_frequency"]
    assert found.value == pytest.approx(frequency, rel=3e-3) and found.kind == "halves"
    assert found.note.startswith("linear theory 0.6593 Hz")
    assert values["sloshing_damping"].value == pytest.approx(100 * damping, rel=0.02)
    assert values["run_up_L_1"].value == pytest.approx(0.0, abs=1e-9)


def test_a_driven_wave_has_the_frequency_of_the_drive_and_no_damping(tmp_path):
    rate = np.stack([np.cos(np.pi * TIME), 0 * TIME, 0 * TIME], axis=1)
    depth = 0.2 + 0.02 * np.sin(2 * np.pi * FREQUENCY * TIME)
    values = of(tmp_path, preset=pool(**DRIVEN), level_depth=depth[:, None], pose_rate=rate)
    found = values["sloshing_frequency"]
    assert abs(found.value - FREQUENCY) < found.uncertainty and found.note.startswith("driven")
    assert "sloshing_damping" not in values
    assert values["run_up_L_1"].value == pytest.approx(20.0, rel=1e-3)


def test_few_free_swings_have_no_frequency(tmp_path):
    depth = 0.2 + 0.02 * np.cos(2 * np.pi * 0.15 * TIME)
    found = of(tmp_path, level_depth=depth[:, None])["sloshing_frequency"]
    assert found.value is None and found.note == "too few swings"


def test_calm_water_in_a_tank_that_moves_has_no_frequency(tmp_path):
    rate = np.stack([0 * TIME, np.cos(np.pi * TIME), 0 * TIME], axis=1)
    values = of(tmp_path, level_depth=np.full((len(TIME), 1), 0.2), pose_rate=rate)
    assert values["sloshing_frequency"].value is None
    assert values["sloshing_frequency"].note.endswith("the water does not swing")


def test_the_highest_water_reaches_half_a_spacing_beyond_a_particle(tmp_path):
    place = np.zeros((3, 1, DROPS, 2))
    place[1, 0, 4, 1] = 0.3
    found = of(tmp_path, {"water_position": place})["highest_water"]
    assert found.value == pytest.approx(310.0) and found.uncertainty == pytest.approx(10.0) and not found.note
    place[2, 0, 0, 1] = 0.48
    assert of(tmp_path / "b", {"water_position": place})["highest_water"].note == "it reaches the lid"


def test_the_account_lacks_what_energies_and_work_do_not_explain(tmp_path):
    work, taken = 4.0 * TIME, 1.0 * TIME
    total = 100.0 + work - taken - 0.5 * TIME
    series = {"water_total": total, "water_work": work, "water_viscous": 0.75 * taken, "water_diffusive": 0.25 * taken}
    values = of(tmp_path, water_kinetic=np.full(len(TIME), 2.0), water_density_deviation=1e-3 * TIME, **series)
    assert values["water_residual"].value == pytest.approx(100.0 * 5.0 / (40.0 + 10.0 + 2.0))
    assert values["water_density_deviation"].value == pytest.approx(1.0)
    whole = of(tmp_path / "b", **{**series, "water_total": 100.0 + work - taken})
    assert whole["water_residual"].value == pytest.approx(0.0, abs=1e-9)


def test_the_summary_tells_what_a_reader_must_know(tmp_path):
    from lab.report.summary import write_summary

    peak = np.stack([bump(4.0, 5000.0), bump(6.0, 100.0)], axis=1)[:, None]
    dense = np.full((len(TIME), 1), 0.05)
    folder = record_pool(tmp_path / "run", TIME, {"gauge_peak": peak, "water_dense": dense})
    with open_recording(folder) as recording:
        page = write_summary(recording, measure_all(recording), {}, folder)["summary"].read_text()
    assert "highest pressure at P1: 5 kPa at 4 s" in page and "highest pressure at P2: 100 Pa at 6 s" in page
    assert "6 particles of water, 20 mm apart, 200 mm deep" in page and "10000 steps of 1 ms" in page
    assert "5 % of the water was off its density" in page and "limit of the step" in page
    assert "grain" not in page.partition("## The preset")[0].replace("mean grain diameter", "")
