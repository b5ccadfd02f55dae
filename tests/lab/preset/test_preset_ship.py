"""Ships in presets: error messages, the resulting vessel, her waves and her measures."""

import warnings
from dataclasses import replace
from math import inf, pi, radians
from types import SimpleNamespace

import numpy as np
import pytest

from lab.assembly.ship import make_vessel, make_water, make_waves, natural_roll
from lab.assembly.ship_tables import stored_table
from lab.base.errors import LabError
from lab.measures import measure_all, ship_frozen, ship_stability
from lab.paint.page.theme import LIGHT
from lab.paint.painter import Camera
from lab.paint.sea import Sea
from lab.preset.find import load
from lab.preset.recorded import from_table, to_table
from lab.preset.sections.sea import Sea as Seas
from lab.preset.sections.sea import Waves
from lab.preset.sections.ship import Ship, axis_motion
from lab.recording import open_recording
from lab.recording.ship_end import End
from lab.report.plots import figures
from lab.report.ship import describe
from lab.runs.runner import run_preset
from lab.sweeps.sweep import point_folder, run_sweep
from solvers.machine.runtime import initialise
from solvers.ship.hydrostatics import metacentric_height
from solvers.ship.linear import oscillations
from solvers.ship.motion import sail, start
from solvers.ship.potential import radiation
from tests.oracles.presets import error_of
from tests.oracles.synthetic import box, frame, of_a_ship, preset, recorder, sample

BARGE = "ship/barge-roll"
OMEGA = 4.4


def fault(changes: dict, name: str = BARGE) -> str:
    return error_of(load, name, changes)


OUTLINED = {
    "ship.breadth": False,
    "ship.height": False,
    "ship.outline": [[f"{y} mm", f"{z} mm"] for y, z in ((-170, 0), (170, 0), (170, 300), (-170, 300))],
}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"ship": False}, "waves: there is no ship in them"),
        ({"motion.sway.amplitude": "1 mm", "motion.sway.frequency": "1 Hz"}, "motion: a ship moves her hold herself"),
        ({"ship.outline": [["0 mm", "0 mm"], ["1 m", "0 mm"], ["0 mm", "1 m"]]}, "ship.breadth: give breadth"),
        ({"ship.breadth": False}, "ship.breadth: give breadth"),
        ({"ship.gyradius": "1 m", "ship.roll_period": "1 s"}, "ship.gyradius: give exactly one"),
        ({"ship.roll_period": False}, "ship.gyradius: give exactly one"),
        ({"ship.draught": "30 cm"}, "ship.draught: must be less than the hull's height, 300 mm."),
        ({"ship.heel": "5 deg"}, "ship.release: she is heeled until then"),
        ({"waves": False}, 'ship.radiation: "at-frequency" takes the frequency of waves'),
        ({"waves.amplitude": False}, 'waves.amplitude: missing; waves.kind = "regular" needs it.'),
        ({"waves.kind": "jonswap"}, 'waves.height: missing; waves.kind = "jonswap" needs it.'),
        ({"waves.kind": "packet"}, 'waves.spread: missing; waves.kind = "packet" needs it.'),
        ({"waves.frequency": "0.7 Hz"}, 'waves.frequency: "0.7 Hz" is a frequency, but deg/s'),
        ({"ship.freedom": "pitch"}, "ship.freedom: "),
        ({"ship.hatch.breadth": "34 cm", "ship.hatch.coaming": "1 cm"}, "ship.hatch.breadth: must be less than"),
        ({"ship.hatch.breadth": "10 cm"}, "ship.hatch.coaming: missing"),
        (
            {**OUTLINED, "ship.hatch.breadth": "10 cm", "ship.hatch.coaming": "1 cm"},
            "ship.hatch: goes with breadth and",
        ),
        ({"ship.openings": [["0 mm", "110 mm"]]}, "ship.openings: [0 m, 110 mm] is under water at rest"),
        ({"ship.deck": "20 cm"}, "ship.deck: the deck of a box is at its height"),
        ({**OUTLINED, "ship.deck": "10 cm"}, "ship.deck: must be between the waterline and the hull's top"),
        ({"ship.height": "140 mm"}, "ship.hold: the tank stands out of the hull at [150 mm, 280 mm]"),
        ({"ship.hold": ["30 mm", "20 mm"]}, "ship.hold: the tank stands out of the hull at [180 mm, 20 mm]"),
        ({"ship.draft": "1 m"}, "ship.draft: unknown key; did you mean 'draught'?"),
    ],
)
def test_errors_name_the_key(changes, words):
    assert fault(changes).startswith(words)


@pytest.fixture(scope="module")
def barge():
    said = load(BARGE).resolved
    return said, make_vessel(said.ship, said.sea, said.waves, said.run.gravity)


def test_the_barge_has_the_given_properties(barge):
    """Displacement by the draught, GM by closed form, natural roll of the given period, alone about the axis."""
    said, vessel = barge
    ship = vessel.ship
    assert ship.body.mass == pytest.approx(1000.0 * 0.34 * 0.11)
    height = 0.055 + 0.34**2 / (12.0 * 0.11) - 0.0926
    assert metacentric_height(ship.load.section, ship.body.loading, ship.load.water) == pytest.approx(height)
    assert (vessel.laden, vessel.hold) == (True, (0.0, 0.02))
    assert vessel.limits == (-0.5 * pi, 0.5 * pi)
    memory = make_vessel(
        Ship(**{**vars(said.ship), "radiation": "memory", "damping": 0.0, "quadratic_damping": 0.0}),
        said.sea,
        None,
        9.81,
    )
    found = oscillations(memory.ship, start(memory.ship, -0.11)).imag
    assert np.abs(found - 2.0 * pi / 1.282).min() < 0.02


def test_damping_is_a_share_of_the_critical(barge):
    said, vessel = barge
    ship, water = vessel.ship, vessel.ship.load.water
    grid = np.linspace(2.0, 8.0, 13)
    table = stored_table(ship.load.section, water, -0.11, grid, ship.about)
    frequency, inertia = natural_roll(ship, -0.11, table)
    assert frequency == pytest.approx(2.0 * pi / 1.282, rel=2e-3)
    assert ship.damping.linear == pytest.approx(2.0 * 0.01 * frequency * inertia, rel=2e-3)
    assert ship.damping.quadratic == pytest.approx(said.ship.quadratic_damping * inertia, rel=2e-3)


def test_the_wave_slope_drives_the_roll(barge):
    """W GM ∂ζ/∂y at the first crossing of the crest by a quarter period, beyond the soft start."""
    _, vessel = barge
    load, k = vessel.ship.load, OMEGA**2 / 9.81
    height = 0.055 + 0.34**2 / (12.0 * 0.11) - 0.0926
    for time in (10.0, 10.3, 11.1):
        pose = np.zeros(3)
        change = load.force(pose, time)[2] - load.still.force(pose, time)[2]
        slope = -0.01 * k * np.sin(-OMEGA * time)
        assert change == pytest.approx(1000.0 * 0.34 * 0.11 * 9.81 * height * slope, rel=0.01, abs=1e-4)


def test_tables_are_stored(barge, monkeypatch):
    """What was solved once is read back, to the bit; another frequency is another table."""
    _, vessel = barge
    section, water, about = vessel.ship.load.section, vessel.ship.load.water, vessel.ship.about
    first = stored_table(section, water, -0.11, np.array([3.0, 4.0]), about)
    monkeypatch.setattr("lab.assembly.ship_tables.hydrodynamics", lambda *a, **b: pytest.fail("solved again"))
    again = stored_table(section, water, -0.11, np.array([3.0, 4.0]), about)
    assert np.array_equal(first.excitation, again.excitation) and np.array_equal(first.damping, again.damping)
    with pytest.raises(pytest.fail.Exception):
        stored_table(section, water, -0.11, np.array([3.0, 4.1]), about)
    assert radiation.hydrodynamics is not None


def test_seas_have_their_given_heights_and_crests():
    """Significant height of random seas; a packet's crest where and when it was asked for."""
    water = make_water(Seas(), 9.81)
    for kind in ("jonswap", "pierson-moskowitz"):
        sea = make_waves(Waves(4.5, kind, height=0.03, seed=3), water)
        assert 4.0 * np.sqrt((np.abs(sea.amplitude) ** 2).sum() / 2.0) == pytest.approx(0.03, rel=0.01)
    crest = make_waves(Waves(4.5, "packet", amplitude=0.02, spread=0.5, time=7.0), water)
    assert crest.elevation(0.0, 7.0) == pytest.approx(0.02, rel=1e-6)


def test_a_peaked_sea_has_more_of_its_energy_about_the_peak():
    """Within a tenth of it a sea without a peak has e^(−(5/4) 1.1⁻⁴) − e^(−(5/4) 0.9⁻⁴), the spectrum's integral."""

    def near(peakedness):
        sea = make_waves(Waves(4.5, "jonswap", height=0.03, peakedness=peakedness), make_water(Seas(), 9.81))
        energy = np.abs(sea.amplitude) ** 2
        return energy[np.abs(sea.frequency / 4.5 - 1.0) < 0.1].sum() / energy.sum()

    assert near(1.0) == pytest.approx(np.exp(-1.25 / 1.1**4) - np.exp(-1.25 / 0.9**4), abs=0.02)
    assert near(7.0) > near(3.3) + 0.08 > near(1.0) + 0.16


def test_the_motion_of_the_axis_is_found_from_the_tanks(barge):
    """The tank's origin is 90 mm below the axis, in the ship's own axes; at rest the axis is in the calm surface."""
    said, _ = barge
    sway, heave, roll = 0.01, 0.02, 0.3
    tank = np.array([[sway + 0.09 * np.sin(roll), heave - 0.09 * np.cos(roll), roll]])
    assert axis_motion(said.ship, tank) == pytest.approx(np.array([[sway, heave, roll]]))


@pytest.mark.parametrize("about", [None, (0.02, 0.15)])
def test_a_ship_held_by_her_axis_is_heeled_about_it(about):
    """Let go from 8 deg she rolls, and her axis neither sways nor heaves, wherever it is in her."""
    said = load("ship/free-decay").resolved
    given = replace(said.ship, axis=about, radiation="none")
    vessel = make_vessel(given, said.sea, None, 9.81)
    ship = vessel.ship
    state = start(ship, vessel.heave(ship.body, vessel.heel), vessel.heel)
    voyage = sail(ship, state, 0.01, 2.0)
    arm = np.subtract(given.hold, given.about)
    cos, sin = np.cos(voyage.roll), np.sin(voyage.roll)
    tank = voyage.state[:, :3] + np.stack(
        [cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1], 0.0 * cos], axis=-1
    )
    moved = axis_motion(given, tank)
    assert np.ptp(voyage.roll) > radians(12.0)
    assert moved[:, :2] == pytest.approx(0.0, abs=1e-12)


def test_texts_on_a_ship(barge):
    said, vessel = barge
    said = replace(said, ship=Ship(**{**vars(said.ship), "scale": 100.0}))
    rows = dict(describe(said, vessel, (0.003, 1.0 / 0.003), 1e-3))
    assert "GM solid 49.98 mm" in rows["with her cargo"] and rows["capsized"] == "beyond 90 deg"
    assert "333.3 times a metre" in rows["cargo"]
    assert rows["her cargo's repose"].startswith("25 deg")
    full = rows["full scale 1:100"]
    assert "draught 11 m" in full and "times 10 as long" in full and "waves of 1 m" in full and "14.28 s" in full


SHIP = {
    "draught": 0.11,
    "gravity_height": 0.09,
    "breadth": 0.34,
    "height": 0.3,
    "gyradius": 0.12,
    "hold": [0.0, 0.02],
    "release": 0.0,
}


def test_the_sea_in_a_picture():
    """Water below the wave that passes, deeper blue farther down, its line on it; the hull stands about the tank."""
    initialise(fields=False)
    waves = {"frequency": OMEGA, "amplitude": 0.02, "kind": "regular"}
    sea = Sea(from_table({**preset(), "ship": SHIP, "waves": waves}))
    assert sea.hull.min(axis=0) == pytest.approx([-0.17, -0.02])
    picture = np.full((200, 300, 3), 255, dtype=np.uint8)
    camera = Camera(500.0, (150.0, 100.0))
    sea.paint(picture, camera, (np.array([-0.3, -0.2]), np.array([0.3, 0.2])), 0.0, 2.0)
    k = OMEGA**2 / 9.81
    for column in (5, 150, 290):
        top = 100.0 - 500.0 * 0.02 * np.cos(k * (column + 0.5 - 150.0) / 500.0)
        near, deep = picture[int(top) + 4, column].astype(int), picture[-1, column].astype(int)
        assert np.abs(near - LIGHT.sea[0]).max() < 40 and np.abs(deep - LIGHT.sea[1]).max() < 3
        assert tuple(picture[int(top) - 4, column]) == (255,) * 3
        assert np.abs(picture[int(top), column].astype(int) - LIGHT.surface).max() < 60
    calm = Sea(from_table({**preset(), "ship": SHIP}))
    assert np.array_equal(calm.elevation(np.zeros(3), 1.0), np.zeros(3))


@pytest.fixture
def rolling(tmp_path):
    """A recording of two ships: one rolls by 10° about a bias of 2°, the other is gone at 30 s."""
    said = {**preset(), "ship": SHIP, "waves": {"frequency": OMEGA, "amplitude": 0.01, "kind": "regular"}}
    time, works = np.arange(0.0, 40.0, 0.02), 1e-3 * np.array([[40.0, 10.0, 5.0, -25.0]] * 2)
    with recorder(tmp_path, 2, resolved=said) as writer:
        for now in time:
            roll = radians(2.0) + radians(10.0) * np.cos(OMEGA * now)
            lost = radians(80.0) * min(1.0, now / 30.0)
            pose = np.array([[0.0, 0.0, roll], [0.0, 0.0, lost]])
            capsized = [-1.0, 30.0 if now >= 30.0 else -1.0]
            writer.sample(sample(now, 2, pose=pose, **of_a_ship(2, ship_works=works * now, capsized=capsized)))
        writer.frame(frame(0.0, 2))
    with open_recording(tmp_path) as recording:
        yield recording


def test_the_curve_of_righting_levers(tmp_path):
    """The barge with a level bed of 3000 grains: as frozen up to its repose, then less, by the shift of its wedge."""
    said = to_table(load(BARGE, {"ship.repose": "20 deg"}).resolved)
    with recorder(
        tmp_path, 1, 3000, resolved=said, radius=np.full((1, 3000), 0.0015), outline=box(0.3, 0.26)
    ) as writer:
        for now in (0.0, 1.0, 2.0):
            writer.sample(sample(now, centre_of_mass=np.array([[0.0, 0.055]]), **of_a_ship()))
        writer.frame(frame(0.0, 1, 3000))
    with open_recording(tmp_path) as recording:
        axes = dict(figures(recording, {}))["lever"].axes[0]
    frozen, relaxed = (line.get_xydata() for line in axes.lines[:2])
    assert axes.lines[1].get_label() == "cargo slid to a repose of 20 deg"
    assert relaxed[:11] == pytest.approx(frozen[:11])  # to 20 deg
    cargo = 3000 * 4.0 / 3.0 * pi * 0.0015**3 * 1319.0 / 0.003
    heel, slope = radians(40.0), np.tan(radians(20.0))
    y, z = -(0.3**2) * slope / (12.0 * 0.11), 0.3**2 * slope**2 / (24.0 * 0.11)
    moved = 1e3 * cargo / 37.4 * (y * np.cos(heel) - z * np.sin(heel))
    assert frozen[20, 0] == pytest.approx(40.0)
    assert relaxed[20, 1] - frozen[20, 1] == pytest.approx(moved, rel=1e-4)


def test_measures_of_roll(rolling, monkeypatch):
    monkeypatch.setattr(ship_frozen, "frozen", lambda _: None)  # for which she would have to be computed once more
    found = measure_all(rolling)
    assert found["roll_amplitude"].worlds == (pytest.approx(10.0, rel=2e-3), None)
    assert found["roll_bias"].worlds == (pytest.approx(2.0, rel=0.01), None)
    assert found["largest_roll"].worlds == (pytest.approx(12.0, rel=1e-3), pytest.approx(80.0))
    assert found["capsized_at"].worlds == (None, 30.0)
    assert found["roll_period"].worlds[0] == pytest.approx(2.0 * pi / OMEGA, rel=1e-3)
    assert found["roll_amplitude"].note.startswith("1 biased, 1 capsized")
    powers = [found[f"{name}_power"].worlds[0] for name in ("wave", "radiated", "viscous", "granular")]
    assert powers == pytest.approx([40.0, 10.0, 5.0, 25.0], rel=1e-6)


def test_the_significant_roll_is_that_of_the_highest_third_of_swings(tmp_path, monkeypatch):
    """Swings of 1 to 9° after a start that does not count; a second ship capsizes, a frozen one swings half as far."""
    period, swings = 2.0, np.array([20.0, 20.0, 20.0, 0.5, 3.0, 9.0, 1.0, 7.0, 2.0, 8.0, 4.0, 5.0, 6.0, 0.5])
    time = np.arange(0.0, period * len(swings) - 1e-6, 0.02)
    roll = np.radians(swings[(time / period + 1e-6).astype(int)]) * np.sin(2.0 * pi / period * time)
    waves = {"kind": "jonswap", "height": 0.03, "frequency": 4.5, "soft_start": 3.0 * period}
    with recorder(tmp_path, 2, resolved={**preset(), "ship": SHIP, "waves": waves}) as writer:
        for now, turned in zip(time, roll, strict=True):
            capsized = [-1.0, 5.0 if now >= 5.0 else -1.0]
            pose = np.array([[0.0, 0.0, turned]] * 2)
            writer.sample(sample(now, 2, pose=pose, **of_a_ship(2, capsized=capsized)))
        writer.frame(frame(0.0, 2))
    monkeypatch.setattr(ship_frozen, "frozen", lambda _: (time, 0.5 * roll, None))
    with open_recording(tmp_path) as recording, warnings.catch_warnings():
        warnings.simplefilter("error")
        found = measure_all(recording)
        waves = replace(recording.preset.waves, soft_start=100.0)  # longer than the run
        recording.preset = replace(recording.preset, waves=waves)
        assert measure_all(recording)["significant_roll"].value is None
    assert found["significant_roll"].worlds == (pytest.approx(8.0, rel=2e-3), None)
    assert 0.0 < found["significant_roll"].uncertainty < 2.0
    assert found["frozen_significant_roll"].value == pytest.approx(4.0, rel=2e-3)
    assert "roll_amplitude" not in found


def test_measures_of_frozen_cargo(rolling, monkeypatch):
    """By herself: 7° about a bias of 1°; capsized, she has a time of it and no amplitude."""
    time = np.arange(0.0, 40.0, 0.02)
    roll = radians(1.0) + radians(7.0) * np.cos(OMEGA * time)
    monkeypatch.setattr(ship_frozen, "frozen", lambda _: (time, roll, None))
    found = measure_all(rolling)
    assert found["frozen_amplitude"].value == pytest.approx(7.0, rel=2e-3)
    assert found["frozen_largest_roll"].value == pytest.approx(8.0, rel=1e-3)
    assert found["frozen_capsized_at"].value is None
    monkeypatch.setattr(ship_frozen, "frozen", lambda _: (time[:500], 9.0 * roll[:500], End("capsized", 10.0, 1.3)))
    lost = measure_all(rolling)
    assert (lost["frozen_amplitude"].value, lost["frozen_capsized_at"].value) == (None, 10.0)
    assert lost["frozen_largest_roll"].value == pytest.approx(72.0, rel=1e-3)


def test_the_run_with_frozen_cargo_continues_after_the_ship_has_capsized(monkeypatch):
    """To the end that the run was to have; beside a run that was broken off, no longer than that."""
    said = load(BARGE).resolved
    vessel = make_vessel(said.ship, said.sea, said.waves, said.run.gravity)
    monkeypatch.setattr(ship_frozen, "vessel_of", lambda _: vessel)

    def sailed(name: str, capsized: float) -> float:
        series = {"time": np.array([0.0, 0.5]), "pose": np.zeros((2, 1, 3)), "flooded": np.full((2, 1), -1.0)}
        series["capsized"] = np.array([[-1.0], [capsized]])
        found = ship_frozen.frozen(
            SimpleNamespace(path=name, series=series, preset=SimpleNamespace(duration=2.0, matters=("grains",)))
        )
        return found[0][-1]

    assert sailed("lost", 0.5) == pytest.approx(2.0, abs=ship_frozen.INTERVAL)
    assert sailed("broken off", -1.0) == pytest.approx(0.5, abs=ship_frozen.INTERVAL)


def test_vessels_without_a_limit():
    said = load("ship/model-test").resolved
    assert said.ship.capsize is None
    vessel = make_vessel(said.ship, said.sea, said.waves, said.run.gravity)
    assert vessel.limits == (-inf, inf)
    assert vessel.ship.load.water.depth == 1.0
    assert vessel.ship.body.mass == pytest.approx(46.8 / 0.586, rel=0.02)


FEW = {
    "grains.diameter": "20 mm",
    "grains.depth": "60 mm",
    "run.accuracy": "draft",
    "run.duration": "3 s",
    "ship.capsize": "1 deg",
    "waves.frequency": "4.8 rad/s",
    "waves.soft_start": "0 s",
}  # a ship that is soon past her limit in waves of 40 mm, and not in those of 1 mm


@pytest.fixture(scope="module")
def lost(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lost")
    run_preset(BARGE, {**FEW, "waves.amplitude": "40 mm"}, folder, video=False, plots=False, quiet=True)
    with open_recording(folder) as recording:
        yield recording


def check_lost(recording):
    """She capsized before the end, at the limit, and the last picture is of that."""
    when = recording.series["capsized"][-1, 0]
    assert recording.complete
    assert 0.0 < when <= recording.series["time"][-1] < min(when + 0.011, 3.0)
    assert recording.frames["time"][-1] == recording.series["time"][-1]
    assert abs(recording.series["pose"][-1, 0, 2]) == pytest.approx(radians(1.0), rel=0.02)


@pytest.mark.slow
def test_a_run_ends_when_its_ship_has_capsized(lost):
    check_lost(lost)


@pytest.mark.slow
def test_a_recorded_ship_floats_and_rolls(lost):
    """Her tank stands 20 mm above the keel; frozen by herself she rolls as with grains that hardly move."""
    assert lost.series["pose"][0, 0] == pytest.approx([0.0, -0.09, 0.0], abs=2e-4)
    time, roll, _ = ship_frozen.frozen(lost)
    loose = np.interp(time, lost.series["time"], lost.series["pose"][:, 0, 2])
    assert np.abs(roll).max() > radians(0.5)
    assert np.abs(loose - roll).max() < 0.2 * np.abs(roll).max()
    assert lost.series["ship_works"][-1, 0, 0] > 0.0
    heel, lever, relaxed = ship_stability.levers(lost)
    height = 0.055 + 0.34**2 / (12.0 * 0.11) - 0.0926
    small = slice(1, 12)  # until the bilge emerges: sin φ (GM + ½ BM tan² φ)
    wall = np.sin(heel) * (height + 0.5 * 0.34**2 / (12.0 * 0.11) * np.tan(heel) ** 2)
    assert lever[small] == pytest.approx(wall[small], abs=1e-6)
    assert relaxed[small] == pytest.approx(lever[small])
    assert np.all(relaxed[16:40] < lever[16:40])  # from 32 to 78 deg, the cargo's repose being 25


@pytest.mark.slow
def test_other_runs_continue_after_a_ship_has_capsized(tmp_path):
    """Two in one launch."""
    run_sweep(BARGE, {"waves.amplitude": ["1 mm", "40 mm"]}, FEW, tmp_path, video=False, quiet=True)
    with open_recording(point_folder(tmp_path, 0)) as calm, open_recording(point_folder(tmp_path, 1)) as rough:
        assert calm.complete and calm.series["time"][-1] == pytest.approx(3.0)
        assert (calm.series["capsized"] < 0.0).all()
        check_lost(rough)


def test_the_former_key_of_the_cargos_thickness_names_the_present_one():
    with pytest.raises(LabError, match=r"^ship\.sheet: this key is tank\.thickness now\.$"):
        load("ship/barge-roll", {"ship.sheet": "3 mm"})
