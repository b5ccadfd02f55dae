"""Water beside experiments: what is read off a run, measured series from files that are not shipped, and slow runs."""

import tomllib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

import lab
from lab.base.errors import LabError
from lab.preset.find import load
from lab.recording.layout import names_of
from lab.studies.reproduce import experiments
from lab.studies.reproduce.claims import FOLDER, Source, spread
from lab.studies.reproduce.compare import Claim
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.runs import Outcome, carry_out, outcomes
from lab.studies.reproduce.water import dam_break, impact, measured, waves
from lab.studies.reproduce.water.costs import cost

PRESETS = Path(lab.__file__).parents[1] / "presets"
ROLL = "spheric10_lateral_water/roll_motion.csv"
given = pytest.mark.skipif(measured.series(ROLL) is None, reason=f"{measured.FOLDER} names no folder with {ROLL}")


def ran(preset: str, changes: dict | None = None, **series: np.ndarray) -> Outcome:
    """A run with these series and frames."""
    frames = {name[7:]: series.pop(name) for name in [*series] if name.startswith("frames_")}
    resolved = load(preset, changes or {}).resolved
    known = {"preset": resolved, "names": names_of(resolved)}
    recording = SimpleNamespace(**known, series=series, frames=frames, worlds=1)
    recording.volume, recording.air_volume = np.zeros((1, 100)), np.zeros((1, 0))
    one = Outcome({}, None, "complete", {}, {"wall_s": 1.0, "grain_steps": 1e5})
    one.__dict__["recording"] = recording
    return one


def judged(name: str, label: str, one: Outcome) -> dict[str, Verdict]:
    """The verdicts on the rows of an experiment whose only run this is; its figure is drawn and its table made."""
    told = experiments("water")[name].report({label: [one]})
    assert told.figure is not None and len(told.table) == 2 and len(told.table[0]) == len(told.table[1])
    return {row.quantity.removesuffix(f", {label}"): row.verdict for row in told.rows}


def claimed(name: str) -> dict[str, list[Claim]]:
    """The claims of an experiment by the number that they look at."""
    source = Source.model_validate(tomllib.loads((FOLDER / "water.toml").read_text(encoding="utf-8")))
    (stated,) = (one for one in source.experiment if one.name == name)
    found: dict[str, list[Claim]] = {}
    for claim in (Claim.model_validate(row) for raw in stated.rows for row in spread(raw)):
        found.setdefault(claim.of, []).append(claim)
    return found


def test_an_empty_tank_has_no_steps_of_particles():
    one = ran("sloshing/roll-damper-empty", time=np.arange(3.0))
    one.recording.volume = np.zeros((1, 0))
    assert cost("empty", one) == ["empty", "0", "none", "none", "1 s"]


def test_an_impact_has_the_arrival_peak_and_impulse_of_its_pressure():
    """A jump to 5 kPa that falls off linearly within 40 ms, on 0.5 kPa that stays."""
    time = np.arange(0.0, 5.0, 5e-4)
    since = time - 2.4
    pressure = np.where(since >= 0.0, 500.0 + 4500.0 * np.clip(1.0 - since / 0.04, 0.0, 1.0), 0.0)
    found = impact.find_impact(time, pressure, pressure, 2.374)
    assert found.arrival == pytest.approx(2.4, abs=6e-4) and found.peak == 5000.0
    assert found.impulse == pytest.approx(500.0 * 0.2 + 0.5 * 4500.0 * 0.04, rel=0.01)
    assert found.mean == pytest.approx(5000.0 - 4500.0 * 0.125, rel=0.01)
    assert impact.find_impact(time, 0.1 * pressure, 0.1 * pressure, 2.374) is None


def test_an_impulse_is_told_over_that_of_shallow_water_that_rolls_alike():
    """Twice its pressure is twice its impulse; of the same for half as long less."""
    preset = load("sloshing/impact").resolved
    tank = preset.tank.width, preset.water.depth, preset.run.gravity, 0.093
    when, pressed = impact.shallow_pressure(tank, preset.motion.history.history, 2.3738 + impact.LATER)
    time = np.arange(0.0, 2.77, 5e-4)
    shown = 2.0 * preset.water.density * np.interp(time, when, pressed)[:, None, None]
    one = ran("sloshing/impact", time=time, gauge_pressure=shown, gauge_peak=shown)
    assert impact.impulse_over_shallow(one, 2.3738) == pytest.approx(2.0, rel=0.01)
    assert 1000.0 < 0.5 * shown.max() < 1500.0  # a bore that is thrown back, not a jet


def test_energies_of_a_cycle_are_told_over_those_of_shallow_water_that_rolls_alike(monkeypatch):
    """Of water that is given as much, stores twice as much and loses the rest; nothing of a run that ends before."""
    monkeypatch.setattr(impact, "CELLS", 40)
    preset, about = load("sloshing/impact").resolved, 2.3738
    tank, duration = (preset.tank.width, preset.water.depth, preset.run.gravity), 3.3
    time = np.linspace(0.0, duration, 3000)
    when, *courses = impact.shallow_energy(tank, preset.motion.history.history, duration)
    energy, work = (np.interp(time, when, course) for course in courses)
    scale = preset.water.density * preset.tank.thickness
    series = {"water_total": 2.0 * energy, "water_work": work, "water_wall_energy": -0.1 * work}
    one = ran("sloshing/impact", time=time, **{name: scale * course[:, None] for name, course in series.items()})
    found = {name: impact.NUMBERS[name][1](one, about) for name in impact.NUMBERS if not name.startswith("imp")}
    assert (found["given_over_shallow"], found["stored_over_shallow"]) == pytest.approx((1.0, 2.0), rel=1e-4)
    alike = impact.cycle(time, energy, work, about)
    gained = alike["given"] - alike["lost"]
    assert found["lost_over_shallow"] == pytest.approx(1.0 - gained / alike["lost"], rel=1e-4)
    assert found["made_at_walls"] == pytest.approx(0.1, rel=1e-9)
    assert 1.2 < scale * alike["given"] < 1.5 and 0.3 < scale * alike["lost"] < scale * alike["given"]  # J
    later = about + impact.PERIOD
    assert np.isnan([impact.NUMBERS[name][1](one, later) for name in ("lost_over_shallow", "made_at_walls")]).all()


def test_the_scatter_of_repeated_impacts_is_that_of_their_peaks():
    """Twenty peaks of 3.2 or 4.8 kPa scatter by about a fifth, equal ones do not; three of 3, 4 and 5 kPa do not tell.

    No hit is no row.
    """
    time = np.arange(0.0, 2.6, 5e-4)

    def hit(peak: float) -> Outcome:
        shown = np.where(time >= 2.4, peak * np.clip(1.0 - (time - 2.4) / 0.04, 0.0, 1.0), 0.0)[:, None, None]
        return ran("sloshing/impact", time=time, gauge_pressure=shown, gauge_peak=shown)

    of = {"few": (3e3, 4e3, 5e3), "none": (4e3, 4e3, 4e3), "many": (3.2e3, 4.8e3) * 10, "dry": (0.0, 0.0)}
    told = experiments("water")["impact-air"].report(
        {label: [hit(one) for one in peaks] for label, peaks in of.items()}
    )
    assert [row.verdict for row in told.rows] == [Verdict.CANNOT_TELL, Verdict.DIFFERS, Verdict.AGREES]
    assert told.rows[0].ours == "0.25 (0.13 to 1.57) of 3 runs" and told.table[1][-3] == "4.0 ± 1.0"
    assert told.table[4][5:] == ["0 of 2", "", "", "", ""]


def test_both_impacts_are_judged_by_arrival_impulse_and_peak():
    """One that comes 30 ms late, twice as high and with the right impulse differs in two of them."""
    time = np.arange(0.0, 5.0, 5e-4)
    pressure = np.zeros((len(time), 1, 1))
    for arrival, impulse in ((2.3738, 179.0), (4.047, 187.0)):
        since = time - arrival - 0.03
        pressure[:, 0, 0] += np.where((since >= 0.0) & (since < impulse / 8000.0), 8000.0, 0.0)
    one = ran("sloshing/impact", time=time, gauge_pressure=pressure, gauge_peak=pressure)
    verdicts = judged("roll-impact", "15 layers", one)
    for order in ("first", "second"):
        assert verdicts[f"{order} impact arrives at"] is Verdict.DIFFERS
        assert verdicts[f"{order} impact peak"] is Verdict.DIFFERS
        assert verdicts[f"{order} impact impulse"] is Verdict.AGREES


def test_impacts_of_several_starts_are_judged_by_their_mean_and_its_interval():
    """Impulses of 170 and 180 Pa s, eight times each, do not differ from 179; 100 and 300 of two starts do not tell."""
    time = np.arange(0.0, 5.0, 5e-4)

    def hit(impulse: float) -> Outcome:
        since = time - 2.3738
        shown = np.where((since >= 0.0) & (since < impulse / 4000.0), 4000.0, 0.0)[:, None, None]
        return ran("sloshing/impact", time=time, gauge_pressure=shown, gauge_peak=shown)

    for impulses, verdict in (((170.0, 180.0) * 8, Verdict.AGREES), ((100.0, 300.0), Verdict.CANNOT_TELL)):
        told = experiments("water")["roll-impact"].report({"starts": [hit(one) for one in impulses]})
        row = next(row for row in told.rows if row.quantity == "first impact impulse, starts")
        assert row.verdict is verdict and row.ours.endswith(f"Pa s ({len(impulses)} beds)")
        cell = told.table[1][told.table[0].index("first impulse")]
        assert cell.endswith(" Pa s") and float(cell.split()[0]) == pytest.approx(np.mean(impulses), rel=0.02)


def test_only_the_last_run_is_judged_and_all_are_in_the_table():
    """A run without an impact first: its cells say so, and no row is about it."""
    time = np.arange(0.0, 5.0, 5e-4)
    still = ran(
        "sloshing/impact", time=time, gauge_pressure=np.zeros((len(time), 1, 1)), gauge_peak=np.zeros((len(time), 1, 1))
    )
    told = experiments("water")["roll-impact"].report({"a": [still], "b": [still]})
    assert {row.quantity.rsplit(", ", 1)[1] for row in told.rows} == {"b"}
    assert {row.verdict for row in told.rows} == {Verdict.CANNOT_TELL}
    assert [row[0] for row in told.table] == ["run", "a", "b"] and told.table[1][5:] == ["none"] * 8


def test_a_dam_breaks_front_has_the_speed_of_its_foremost_particle_before_the_wall():
    """It runs 1.7 √(gH) and stops at the wall; the pressure at sensor 1 jumps to 2.5 and stays at 1 ρgH."""
    unit = (0.3 / 9.81) ** 0.5
    frames = np.arange(0.0, 0.8, 0.005)
    place = np.minimum(-0.205 + 1.7 * 0.3 * frames / unit, 0.802)
    time = np.arange(0.0, 0.9, 1e-3)
    star = np.where(time / unit > 2.4, np.where(time / unit < 2.5, 2.5, 1.0), 0.0) * 997.0 * 9.81 * 0.3
    one = ran(
        "validation/dam-break",
        frames_time=frames,
        frames_water_position=np.stack([np.stack([place, place], axis=1)[:, None, :]] * 2, axis=2)[:, 0, :, :][:, None],
        time=time,
        gauge_pressure=np.repeat(star[:, None, None], 4, axis=2),
        gauge_peak=np.repeat(star[:, None, None], 4, axis=2),
    )
    found = dam_break.find_break(one)
    assert found.front == pytest.approx(1.7, rel=0.01)
    assert found.arrival == pytest.approx(2.4, abs=0.01)
    assert (found.peak, found.mean, found.plateau) == pytest.approx((2.5, 2.5, 1.0))
    assert found.wall == pytest.approx((0.999 * 1.01 / 0.3 - 0.02) / 1.7, abs=0.03)
    verdicts = judged("dam-break", "30 layers", one)
    assert verdicts["mean from 3.5 to 4.5 at sensor 1, ρgH"] is Verdict.DIFFERS
    assert verdicts["that mean beside inviscid codes"] is Verdict.AGREES
    assert found.lowest_wall == pytest.approx(1.0)
    assert verdicts["the same of the wall up to 80 mm, ρgH"] is Verdict.DIFFERS


def test_the_mean_of_the_lowest_wall_is_that_of_straight_lines_between_its_sensors():
    """Hydrostatic from 3 mm on, and level below: 1 − z/H over 80 mm, with what the lowest 3 mm lack."""
    pressures = 1.0 - dam_break.HEIGHTS / 300.0
    assert dam_break.over_wall(pressures) == pytest.approx(1.0 - (40.0 + 0.5 * 3.0**2 / 80.0) / 300.0)


def test_what_a_run_that_was_stopped_did_not_reach_is_not_judged():
    """A dam break that ends at 3.1 √(H/g) and has not left its place."""
    time, still = np.arange(0.0, 0.55, 1e-3), np.zeros((550, 1, 4))
    places = np.full((110, 1, 2, 2), -0.21)
    frames = {"frames_time": np.arange(0.0, 0.55, 0.005), "frames_water_position": places}
    one = ran("validation/dam-break", time=time, gauge_pressure=still, gauge_peak=still, **frames)
    rows = experiments("water")["dam-break"].report({"30 layers": [one]}).rows
    assert {(row.ours, row.verdict) for row in rows} == {("not found", Verdict.CANNOT_TELL)}


@pytest.mark.slow
def test_turns_of_a_wave_are_found_near_the_measured_ones(monkeypatch):
    """A curve through the measured turns, 0.05 s late and 1.2 times as high; and that of potential flow."""
    monkeypatch.setattr(waves, "NODES", 41)
    sizes = {1.93: -88.0, 2.57: 142.1, 3.27: -92.5, 4.04: 109.3, 7.0: -66.8, 7.71: 124.8, 8.3: -82.5, 9.16: 141.4}
    times = np.array([0.0, *sizes, 10.0])
    time = np.arange(0.0, 10.0, 0.002)
    rise = PchipInterpolator(times + 0.05, 1.2 * np.array([0.0, *sizes.values(), 0.0]), extrapolate=True)(time)
    depth = np.zeros((len(time), 1, 2))
    depth[..., waves.GAUGE] = 0.6 + 1e-3 * rise[:, None]
    one = ran("sloshing/sway-quick", time=time, level_depth=depth)
    found = [waves.turn(one, when, size) for when, size in sizes.items()]
    assert [late for late, _ in found] == pytest.approx([0.05] * len(found), abs=0.003)
    verdicts = [*judged("sway-beat", "20 layers", one).values()]
    assert verdicts == [Verdict.DIFFERS] * 8 + [Verdict.AGREES, Verdict.DIFFERS]
    depth[:, 0, waves.GAUGE] = 0.6 + 0.97e-3 * waves.nonlinear(one)[1]
    one = ran("sloshing/sway-quick", time=time, level_depth=depth)
    assert [*judged("sway-beat", "20 layers", one).values()][4:8] == [Verdict.AGREES] * 4


def test_the_swing_of_a_pressure_is_that_of_its_sine():
    """3.2 kPa and a sine of 0.36 kPa, 6 deg behind the tank, at the wall that rises first."""
    time = np.arange(0.0, 10.0, 0.005)
    sine = 0.36 * np.sin(2.0 * time - np.radians(6.0))
    pressure = 1e3 * np.stack([3.2 + sine, 3.2 - sine], axis=-1)[:, None, :]
    one = ran("sloshing/pitch", time=time, gauge_pressure=pressure)
    assert waves.swing(one) == pytest.approx((0.36, -6.0, 3.2), rel=2e-3)
    verdicts = [*judged("pitch", "30 layers", one).values()]
    assert verdicts == [Verdict.AGREES, Verdict.DIFFERS, None]  # it is not linear theory's; the swing alone is judged


def test_a_measured_series_is_drawn_where_it_is_and_missed_in_a_sentence(tmp_path, monkeypatch):
    monkeypatch.delenv(measured.FOLDER, raising=False)
    axes = Figure().add_subplot()
    assert measured.drawn(axes, "a/b.csv") is None
    assert "CARGOLAB_DATA names no folder with a/b.csv." in " ".join(axes.texts[0].get_text().split())
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "b.csv").write_text("time_s,rise_m\n0.0,1.0\n0.5,2.0\n")
    monkeypatch.setenv(measured.FOLDER, str(tmp_path))
    axes = Figure().add_subplot()
    assert measured.drawn(axes, "a/b.csv").tolist() == [[0.0, 0.5], [1.0, 2.0]] and not axes.texts
    (tmp_path / "a" / "b.csv").write_text("time_s,rise_m\n0.0,none\n")
    with pytest.raises(LabError, match="is not a table of numbers"):
        measured.series("a/b.csv")


def test_the_rolled_tanks_motion_is_the_sine_that_its_preset_tells():
    time, roll = np.loadtxt(PRESETS / "sloshing" / "impact.csv", delimiter=",", skiprows=1).T
    later = time >= 1.0
    sine = -0.07 - 3.975 * np.sin(2.0 * np.pi / 1.6365 * (time[later] - 0.9884))
    assert np.abs(roll[later] - sine).max() < 1e-3
    assert load("sloshing/impact").resolved.motion.history.history.motions["roll"].rests[0]


@given
def test_the_rolled_tanks_motion_follows_the_measured_one():
    time, roll = measured.series(ROLL)
    apart = np.degrees(load("sloshing/impact").resolved.motion.history.history.motions["roll"].curve(time)) - roll
    assert np.abs(apart).max() < 0.09 and np.sqrt(np.mean(apart**2)) < 0.05


@given
def test_the_numbers_of_the_impacts_are_those_of_the_record():
    time, pressure = measured.series(impact.MEASURED)
    often = np.arange(0.0, 5.0, 1e-4)
    even = np.interp(often, time, pressure)
    parts = {"impact_arrival": 1.0, "impact_peak": 1e-3, "impact_mean": 1e-3, "impact_impulse": 1.0}
    for order in (0, 1):
        wanted = {of: claims[order] for of, claims in claimed("roll-impact").items()}
        found = impact.find_impact(often, even, even, wanted["impact_arrival"].given)
        ours = [factor * getattr(found, of.removeprefix("impact_")) for of, factor in parts.items()]
        stated = [wanted[of].value or float(wanted[of].source.split()[0]) for of in parts]
        assert ours[0] == pytest.approx(stated[0], abs=1e-3) and ours[1:] == pytest.approx(stated[1:], rel=0.015)


@given
def test_the_numbers_of_the_waves_are_those_of_the_read_off_series():
    time, rise = measured.series(waves.SWAY)
    crests = {claim.given: claim.value for claim in claimed("sway-beat")["crest"]}
    turned = [float(np.interp(when, time, 1e3 * rise)) for when in crests]
    assert turned == pytest.approx([*crests.values()], abs=3.0)
    time, pressure = measured.series(waves.PITCH)
    terms = np.stack([np.ones_like(time), np.sin(2.0 * time), np.cos(2.0 * time)], axis=1)
    mean, ahead, across = np.linalg.lstsq(terms, pressure, rcond=None)[0]
    stated = claimed("pitch")
    assert np.hypot(ahead, across) == pytest.approx(stated["pressure_swing"][0].value, rel=0.01)
    assert mean == pytest.approx(stated["pressure_mean"][0].value, rel=0.01)
    assert np.degrees(np.arctan2(across, ahead)) == pytest.approx(-6.2, rel=0.01)


@given
def test_the_band_of_the_dam_breaks_pressure_is_that_of_the_repeats():
    time, low, middle, high = measured.series(dam_break.PRESSURES.format(1))
    late = (time > dam_break.PLATEAU[0]) & (time < dam_break.PLATEAU[1])
    stated = {of: claims[0] for of, claims in claimed("dam-break").items()}
    assert (low[late].mean(), high[late].mean()) == pytest.approx(stated["break_plateau"].between, abs=0.01)
    assert (low.max(), high.max()) == pytest.approx(stated["break_peak"].between, abs=0.01)
    assert middle.max() == pytest.approx(float(stated["break_peak"].source), abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["dam-break", "sway-beat", "pitch", "roll-impact"])
def test_the_quick_run_is_judged_as_the_report_says(name, tmp_path):
    """What agrees in the full report agrees here, apart from what few particles cannot show."""
    one = experiments("water")[name]
    ((label, batch),) = one.batches(True).items()
    carry_out(batch, tmp_path / "run", quiet=True)
    verdicts = {row.quantity: row.verdict for row in one.report({label: outcomes(tmp_path / "run")}).rows}
    for says in SOUND[name]:
        assert verdicts[f"{says}, {label}"] is Verdict.AGREES, (says, verdicts)


SOUND = {
    "roll-impact": ("first impact arrives at", "first impact impulse", "second impact impulse"),
    "dam-break": ("front's speed, √(gH)", "front at the wall at, √(H/g)", "that mean beside inviscid codes"),
    "sway-beat": ("farthest of eight crests and troughs from its time", "first trough"),
    "pitch": ("the same", "ahead of the tank", "mean"),
}
