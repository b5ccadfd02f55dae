from types import SimpleNamespace

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.measures import measure_all
from lab.measures.critical_angle import find_steps
from lab.measures.spectrum import amplitude_spectrum
from lab.measures.steady import steady_window
from lab.measures.surface_slope import CONFIDENCE, free_surface, inclination, theil_sen
from lab.measures.value import Measures, over_worlds
from lab.measures.wave import column_tops, surface_columns
from lab.recording import open_recording
from lab.recording.layout import series_of
from tests.oracles.synthetic import DEPTH, DIAMETER, WIDTH, box, frame, preset, record, recorder, sample

LIQUID = np.radians(WIDTH**2 / (12 * DEPTH))  # m of shift per deg of give
TILT = preset(tilt={"rate": 0.035, "angle": 0.7})


def ramp(x):
    return np.clip(x, 0, 1)


def give_of(tilt, steps=((21.0, 5.0),), creep=0.03, width=0.3):
    """Give (deg) that creeps and steps at such tilts by so much."""
    return creep * tilt + sum(size * ramp((tilt - onset) / width) for onset, size in steps)


def tilted(folder, gives, tilt=None, sign=1.0, **options):
    """A recording of a tilt (T,), deg, in which each world gives way by (T,), deg."""
    tilt = np.linspace(0, 40, 2001) if tilt is None else tilt
    pose = np.zeros((len(tilt), 3))
    pose[:, 2] = sign * np.radians(tilt)
    centre = np.zeros((len(tilt), len(gives), 2))
    centre[:, :, 0] = 1e-3 - sign * LIQUID * np.stack(gives, axis=1)
    centre[:, :, 1] = DEPTH / 2
    options = {"resolved": TILT, **options}
    record(folder, 0.5 * np.arange(len(tilt)) / 50, pose=pose, centre=centre, **options)
    with open_recording(folder) as recording:
        return measure_all(recording)


# --- values


def test_a_value_is_mean_and_sample_deviation_over_the_worlds_that_have_one():
    value = over_worlds([20.0, np.nan, 24.0], "deg", uncertainties=[0.3, np.nan, 0.4], kind="fit")
    assert value.value == 22.0
    assert value.std == pytest.approx(np.sqrt(8.0))
    assert value.uncertainty == pytest.approx(np.sqrt(0.125))
    assert value.worlds == (20.0, None, 24.0)
    assert value.note == "not found in 1 of 3 worlds"


def test_one_world_has_no_deviation_and_none_has_no_value():
    assert over_worlds([3.0], "mm").std is None
    assert over_worlds([3.0], "mm").note == ""
    assert over_worlds([np.nan], "mm", missing="too short").value is None
    assert over_worlds([np.nan], "mm", missing="too short").note == "too short"


# --- critical angle: the detector


@pytest.mark.parametrize("onset", [6.0, 21.0, 33.3])
@pytest.mark.parametrize("creep", [0.0, 0.05, 0.4])
def test_a_step_is_found_within_its_error(onset, creep):
    tilt = np.linspace(0, 40, 4001)
    (step,) = find_steps(tilt, give_of(tilt, [(onset, 5.0)], creep))
    assert step.onset == pytest.approx(onset, abs=step.error)
    assert step.end == pytest.approx(onset + 0.3, abs=0.1)
    assert step.give == pytest.approx(5.0, abs=0.1)
    assert step.error < 0.3


def test_noise_moves_the_onset_little_and_makes_no_steps():
    random = np.random.default_rng(1)
    tilt = np.linspace(0, 40, 4001)
    onsets = []
    for _ in range(20):
        noisy = give_of(tilt, creep=0.1) + random.normal(0, 0.05, len(tilt))
        (step,) = find_steps(tilt, noisy)
        onsets.append(step.onset)
    assert np.mean(onsets) == pytest.approx(21.0, abs=0.2)
    assert np.std(onsets) < 0.2


@pytest.mark.parametrize("noise", [0.0, 0.05, 0.5])
@pytest.mark.parametrize("creep", [0.0, 0.1, 1.0])
def test_a_bed_that_only_creeps_has_no_step(noise, creep):
    tilt = np.linspace(0, 40, 4001)
    random = np.random.default_rng(2)
    assert find_steps(tilt, creep * tilt + random.normal(0, noise, len(tilt))) == []


def test_the_sampling_rate_does_not_matter():
    onsets = []
    for count in (401, 4001, 40001):
        tilt = np.linspace(0, 40, count)
        (step,) = find_steps(tilt, give_of(tilt, creep=0.05))
        onsets.append(step.onset)
    assert np.ptp(onsets) < 0.11


def test_finer_sampling_averages_noise_away():
    tilt = np.linspace(0, 40, 40001)
    noise = np.random.default_rng(3).normal(0, 0.2, len(tilt))
    (step,) = find_steps(tilt, give_of(tilt, [(21.0, 1.0)]) + noise)
    assert step.onset == pytest.approx(21.0, abs=0.3)


def test_uneven_samples_do_not_matter():
    tilt = 40 * np.linspace(0, 1, 4001) ** 2
    (step,) = find_steps(tilt, give_of(tilt))
    assert step.onset == pytest.approx(21.0, abs=0.1)


@pytest.mark.parametrize("onset", [10.0, 22.0, 35.0])
@pytest.mark.parametrize("rate", [0.6, 1.0])
def test_an_even_flow_begins_at_its_kink(onset, rate):
    tilt = np.linspace(0, 40, 4001)
    (step,) = find_steps(tilt, 0.05 * tilt + rate * np.maximum(tilt - onset, 0))
    assert step.onset == pytest.approx(onset, abs=step.error)
    assert step.end == pytest.approx(40.0, abs=0.1)


def test_a_gentle_onset_has_a_larger_error():
    tilt = np.linspace(0, 40, 4001)
    gentle = 0.5 * np.maximum(tilt - 20, 0) ** 2 / 5  # its rate passes FLOW at 21.25
    (sharp,), (soft,) = find_steps(tilt, give_of(tilt)), find_steps(tilt, gentle)
    assert soft.onset == pytest.approx(21.25, abs=0.2)
    assert soft.error > 3 * sharp.error


def test_a_bed_that_flows_from_the_start_has_no_onset():
    tilt = np.linspace(0, 40, 4001)
    assert find_steps(tilt, np.minimum(tilt, 15.0)) == []


def test_close_steps_are_merged_and_distant_ones_are_not():
    tilt = np.linspace(0, 40, 4001)
    assert len(find_steps(tilt, give_of(tilt, [(20.0, 3.0), (20.5, 3.0)]))) == 1
    assert len(find_steps(tilt, give_of(tilt, [(20.0, 3.0), (22.0, 3.0)]))) == 2


def test_a_curve_of_few_points_has_no_steps():
    assert find_steps(np.array([0.0, 0.001]), np.array([0.0, 5.0])) == []


# --- critical angle: of a recording


def test_the_first_main_step_is_the_critical_angle(tmp_path):
    steps = [(8.0, 0.3), (14.0, 1.2), (21.0, 5.0), (29.0, 9.0)]
    values = tilted(tmp_path, [give_of(np.linspace(0, 40, 2001), steps)])
    assert values["critical_angle"].value == pytest.approx(21.0, abs=0.1)
    assert values["critical_angle"].uncertainty < 0.3
    assert values["first_slip_angle"].value == pytest.approx(8.0, abs=0.1)
    assert values["main_steps"].value == 2
    size = 5.0 * LIQUID / DIAMETER
    assert values["critical_step"].value == pytest.approx(size, rel=0.03)
    diameter = DIAMETER / LIQUID - (0.3 + 1.2 + 0.03 * 21.0)  # of give in the third step
    assert values["one_diameter_angle"].value == pytest.approx(21 + 0.3 * diameter / 5, abs=0.02)


def test_a_tilt_to_starboard_gives_the_same_angles(tmp_path):
    give = [give_of(np.linspace(0, 40, 2001))]
    port, starboard = tilted(tmp_path / "a", give), tilted(tmp_path / "b", give, sign=-1.0)
    for name in ("critical_angle", "first_slip_angle", "critical_step", "one_diameter_angle"):
        assert starboard[name].value == pytest.approx(port[name].value, abs=1e-6)
    assert port["final_shift_y"].value < 0 < starboard["final_shift_y"].value


def test_only_the_increasing_tilt_counts(tmp_path):
    out = np.linspace(0, 30, 1501)
    tilt = np.concatenate([out, np.full(200, 30.0), out[::-1]])
    still = give_of(out, [])
    back = np.concatenate([np.full(200, still[-1]), still[-1] + give_of(out, [(10.0, 8.0)])])
    values = tilted(tmp_path, [np.concatenate([still, back])], tilt)
    assert values["critical_angle"].value is None
    assert values["critical_angle"].note == "the bed does not flow up to 30 deg"
    values = tilted(tmp_path / "b", [np.concatenate([give_of(out), back])], tilt)
    assert values["critical_angle"].value == pytest.approx(21.0, abs=0.1)
    assert values["main_steps"].value == 1


def test_worlds_are_averaged_and_one_without_flow_is_named(tmp_path):
    tilt = np.linspace(0, 40, 2001)
    gives = [give_of(tilt, [(20.0, 5.0)]), give_of(tilt, []), give_of(tilt, [(24.0, 5.0)])]
    angle = tilted(tmp_path, gives)["critical_angle"]
    assert angle.value == pytest.approx(22.0, abs=0.1)
    assert angle.std == pytest.approx(np.sqrt(8.0), abs=0.1)
    assert angle.worlds[1] is None
    assert angle.note == "the bed does not flow up to 40 deg in 1 of 3 worlds"


# --- slope of the surface


def bed(slope, count=2000, seed=0):
    """Grains (n, 2) strewn under a surface of such a slope (deg) through (0, DEPTH)."""
    random = np.random.default_rng(seed)
    y = random.uniform(-WIDTH / 2, WIDTH / 2, count)
    top = DEPTH + np.tan(np.radians(slope)) * y
    z = random.uniform(0, 1, count) * (top - DIAMETER / 2)
    return np.stack([y, np.maximum(z, DIAMETER / 2)], axis=1)


def sloping(folder, slopes, tilt):
    """A recording of a tilt to `tilt` (deg), with picture frames of such slopes in the tank."""
    turned = np.linspace(0, tilt, len(slopes))
    frames = []
    for k, (slope, angle) in enumerate(zip(slopes, turned, strict=True)):
        pose = [[0.0, 0.0, np.radians(angle)]]
        frames.append(frame(float(k), count=2000, position=bed(slope)[None], pose=pose))
    pose = np.zeros((len(slopes), 3))
    pose[:, 2] = np.radians(turned)
    centre = np.full((len(slopes), 1, 2), DEPTH / 2)
    options = {"frames": frames, "resolved": TILT, "count": 2000}
    record(folder, np.arange(len(slopes)), pose=pose, centre=centre, **options)
    with open_recording(folder) as recording:
        return measure_all(recording)


@pytest.mark.parametrize("slope", [-25.0, 0.0, 12.0])
def test_the_slope_of_a_strewn_bed_is_found_within_its_error(slope):
    radius = np.full(2000, DIAMETER / 2)
    outline = np.array([(-WIDTH / 2, 0), (WIDTH / 2, 0), (WIDTH / 2, 0.2), (-WIDTH / 2, 0.2)])
    grains = bed(slope)
    grains[:2] = [(0.01, 0.19), (0.05, 0.15)]  # in the air
    angle, error = inclination(*free_surface(grains, radius, outline))
    assert 0 < error < np.radians(2)
    assert angle == pytest.approx(np.radians(slope), abs=3 * error)


def test_the_line_through_the_surface_is_that_of_scipy():
    from scipy.stats import theilslopes

    rng = np.random.default_rng(5)
    for count in (5, 6, 31):
        x, y = np.sqrt(rng.permutation(count)), rng.integers(0, 4, count) + 0.5  # many heights are equal
        slope, _, low, high = theilslopes(y, x, alpha=CONFIDENCE)
        assert theil_sen(x, y) == pytest.approx((slope, low, high), rel=1e-12)


def test_a_bare_floor_and_the_walls_do_not_count_as_surface():
    radius = np.full(2000, DIAMETER / 2)
    outline = np.array([(-WIDTH / 2, 0), (WIDTH / 2, 0), (WIDTH / 2, 0.2), (-WIDTH / 2, 0.2)])
    y, z = free_surface(bed(-45.0), radius, outline)
    assert z.min() > 2 * DIAMETER
    assert np.abs(y).max() < 0.4 * WIDTH
    assert np.isnan(inclination(y[:4], z[:4])).all()


@pytest.mark.parametrize("side", [1, -1])
def test_the_inclination_is_counted_against_the_horizontal_with_the_tilt(tmp_path, side):
    slopes = [0.0, 0.0, -15.0 * side, -15.0 * side]  # earth: 0, 12, 9, 21
    values = sloping(tmp_path, slopes, 36.0 * side)
    assert values["surface_slope"].value == pytest.approx(21.0, abs=1.5)
    assert values["surface_slope"].uncertainty < 1.0
    slopes = [0.0, 0.0, -15.0 * side, -30.0 * side]  # earth: 0, 12, 9, 6
    values = sloping(tmp_path / "b", slopes, 36.0 * side)
    assert values["surface_slope"].value == pytest.approx(6.0, abs=1.5)
    assert values["largest_surface_slope"].value == pytest.approx(12.0, abs=1.5)


# --- shaking


def shaken(folder, y, z, motion, time, soft_start=0.0):
    """A recording of a tank that sways or rolls, with centres of mass y, z (T, W), m."""
    (name,) = motion
    settings = motion[name]
    angle = 2 * np.pi * settings["frequency"] * time
    pose = np.zeros((len(time), 3))
    pose[:, {"sway": 0, "heave": 1, "roll": 2}[name]] = settings["amplitude"] * np.sin(angle)
    resolved = preset(**motion)
    resolved["motion"] |= {"soft_start": soft_start, "tilt": None}
    record(folder, time, pose=pose, centre=np.stack([y, z], axis=2), resolved=resolved)
    with open_recording(folder) as recording:
        return measure_all(recording)


SWAY = {"sway": {"amplitude": 0.04, "frequency": 1.5}}


def waves(time, frequency, amplitude, phase):
    return amplitude * np.sin(2 * np.pi * frequency * time + np.radians(phase))


def test_amplitude_and_phase_of_a_steady_response(tmp_path):
    time = np.linspace(0, 12, 1201)
    transient = 0.02 * np.exp(-time)
    y = waves(time, 1.5, 0.003, 170.0) + 0.0005 * time + transient
    z = waves(time, 3.0, 0.001, 40.0) + waves(time, 1.5, 0.002, 0.0) + DEPTH / 2
    y, z = np.stack([y, 2 * y], axis=1), np.stack([z, z], axis=1)
    values = shaken(tmp_path, y, z, SWAY, time)
    amplitude = values["response_amplitude"]
    assert amplitude.worlds == pytest.approx((3.0, 6.0), rel=0.01)
    assert amplitude.std == pytest.approx(np.sqrt(4.5), rel=0.02)
    assert amplitude.uncertainty < 0.02
    assert values["response_phase"].value == pytest.approx(170.0, abs=0.5)
    assert values["response_amplitude_z"].value == pytest.approx(1.0, rel=0.01)


def test_phases_on_both_sides_of_zero_are_averaged_on_the_circle(tmp_path):
    time = np.linspace(0, 8, 801)
    y = np.stack([waves(time, 1.5, 0.003, phase) for phase in (350.0, 10.0, 12.0)], axis=1)
    phase = shaken(tmp_path, y, np.zeros_like(y), SWAY, time)["response_phase"]
    assert phase.value == pytest.approx(4.0, abs=0.1)
    assert phase.std == pytest.approx(12.17, abs=0.1)


def test_an_unsteady_response_increases_the_error(tmp_path):
    time = np.linspace(0, 8, 801)
    y = (waves(time, 1.5, 0.003, 180.0) * (1 + 0.1 * time))[:, None]
    steady = shaken(tmp_path, y, np.zeros_like(y), SWAY, time)["response_amplitude"]
    assert 0.2 < steady.uncertainty < 0.5


def test_a_rolled_and_a_heaved_bed_are_measured_along_their_motion(tmp_path):
    time = np.linspace(0, 8, 801)
    y, z = waves(time, 1.5, 0.003, 180.0)[:, None], waves(time, 1.5, 0.002, 90.0)[:, None]
    roll = shaken(tmp_path / "a", y, z, {"roll": {"amplitude": 0.3, "frequency": 1.5}}, time)
    heave = shaken(tmp_path / "b", y, z, {"heave": {"amplitude": 0.02, "frequency": 1.5}}, time)
    assert roll["response_amplitude"].value == pytest.approx(3.0, rel=0.01)
    assert roll["response_phase"].value == pytest.approx(180.0, abs=0.1)
    assert heave["response_amplitude"].value == pytest.approx(2.0, rel=0.01)
    assert heave["response_phase"].value == pytest.approx(90.0, abs=0.1)


def test_a_bed_that_follows_the_tank_has_no_phase(tmp_path):
    time = np.linspace(0, 8, 801)
    still = np.zeros((801, 1))
    values = shaken(tmp_path, still, still, SWAY, time)
    assert values["response_amplitude"].value == pytest.approx(0.0, abs=1e-12)
    assert values["response_phase"].value is None
    assert values["response_phase"].note == "the bed follows the tank"


def test_a_run_too_short_has_no_steady_response(tmp_path):
    time = np.linspace(0, 2, 201)
    y = waves(time, 1.5, 0.003, 180.0)[:, None]
    values = shaken(tmp_path, y, np.zeros_like(y), SWAY, time, soft_start=1.0)
    assert values["response_amplitude"].value is None
    assert values["response_amplitude"].note == "the run has less than two steady periods"


@pytest.mark.parametrize(
    ("duration", "begin", "periods"), [(10.0, 0.0, 4), (10.0, 5.0, 2), (2.0, 0.0, 2), (40.0, 0.0, 20)]
)
def test_the_steady_window_has_an_even_number_of_periods(duration, begin, periods):
    time = np.arange(0, duration + 1e-9, 0.01)
    window = steady_window(time, begin, 1.0)
    assert len(time[window]) == pytest.approx(100 * periods, abs=1)
    assert steady_window(time, duration - 1.9, 1.0) is None


# --- the rest


def test_shift_and_energy(tmp_path):
    time = np.arange(3.0)
    centre = np.zeros((3, 2, 2))
    centre[:, 0] = [(0.001, 0.03), (0.007, 0.038), (-0.002, 0.031)]
    centre[:, 1] = [(0.0, 0.03), (0.0, 0.03), (0.003, 0.03)]
    kinetic = np.array([[0.0, 0.0], [5e-6, 1e-6], [1e-6, 3e-6]])
    record(tmp_path, time, pose=np.zeros((3, 3)), centre=centre, kinetic=kinetic)
    with open_recording(tmp_path) as recording:
        values = measure_all(recording)
    assert values["final_shift_y"].worlds == pytest.approx((-3.0, 3.0))
    assert values["final_shift_z"].worlds == pytest.approx((1.0, 0.0))
    assert values["final_shift"].worlds == pytest.approx((-1.0, 1.0))
    assert values["largest_shift"].worlds == pytest.approx((10.0, 3.0))
    assert values["largest_kinetic_energy"].worlds == pytest.approx((5.0, 3.0))
    assert values["final_kinetic_energy"].worlds == pytest.approx((1.0, 3.0))


def test_measures_that_do_not_apply_are_absent(tmp_path):
    time = np.linspace(0, 8, 801)
    still = np.zeros((801, 1))
    names = shaken(tmp_path / "a", still, still, SWAY, time).keys()
    assert "response_amplitude" in names
    assert "critical_angle" not in names
    assert "surface_slope" not in names
    assert "response_amplitude" not in tilted(tmp_path / "b", [np.zeros(2001)])
    barely = tilted(tmp_path / "c", [np.zeros(101)], np.linspace(0, 1.5, 101))
    assert "critical_angle" not in barely


def test_a_recording_without_samples_has_no_measures(tmp_path):
    recorder(tmp_path).close("stopped: interrupted by the user")
    with open_recording(tmp_path) as recording:
        assert measure_all(recording) == {}


def test_a_measure_that_is_not_there_is_told_with_those_that_are():
    """A sentence in place of a bare key; by the name that the lab prints it is found."""
    value = over_worlds([20.8], "deg")
    found = Measures(critical_angle=value, surface_slope=value)
    assert found["critical angle"] is value and "critical_angle" in found and "repose" not in found
    assert found.get("repose") is None
    with pytest.raises(KeyError) as raised:
        found["critcal_angle"]
    assert str(raised.value) == "this run has no measure 'critcal_angle'; did you mean critical_angle?"
    with pytest.raises(LabError, match=r"it has critical_angle, surface_slope\."):
        found["x"]


# --- spilling


def written(folder, time, frames=(), **options):
    """Measures of a recording with such series (T, W, ...) and the options of a recorder."""
    series = {name: options.pop(name) for name in (q.name for q in series_of(afloat=False)) if name in options}
    worlds = next(iter(series.values())).shape[1] if series else 1
    with recorder(folder, worlds, **options) as writer:
        for k, now in enumerate(time):
            writer.sample(sample(now, worlds, **{name: values[k] for name, values in series.items()}))
        for row in frames:
            writer.frame(row)
    with open_recording(folder) as recording:
        return measure_all(recording)


def spilling(folder, upturns, rate=0.012, sign=1.0, count=2000):
    """An open tank that creeps by 2 % up to such tilts (deg), one a world, and then loses `rate` per deg."""
    tilt = np.linspace(0, 40, 2001)
    creep = 0.02 * np.clip((tilt - 12) / 8, 0, 1)
    share = np.stack([creep + rate * np.maximum(tilt - upturn, 0) for upturn in upturns], axis=1)
    pose = np.zeros((len(tilt), len(upturns), 3))
    pose[..., 2] = sign * np.radians(tilt)[:, None]
    centre = np.full((*share.shape, 2), DEPTH / 2)
    scene = {"open_edges": (2,), "resolved": TILT, "count": count, "outline": box(height=DEPTH)}
    return written(folder, tilt, pose=pose, centre_of_mass=centre, spilled=np.floor(share * count), **scene)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_creeping_losses_begin_before_the_sharp_upturn(tmp_path, sign):
    values = spilling(tmp_path, [21.0, 25.0], sign=sign)
    assert values["spilled_fraction"].worlds == pytest.approx((2 + 1.2 * 19, 2 + 1.2 * 15), abs=0.05)
    assert values["spill_start_angle"].value == pytest.approx(16.0, abs=0.05)  # half of the creep
    assert 0.1 < values["spill_start_angle"].uncertainty < 0.5  # a grain is worth 0.2 deg
    for upturn, expected in zip(values["spill_upturn_angle"].worlds, (21.0, 25.0), strict=True):
        assert upturn == pytest.approx(expected, abs=values["spill_upturn_angle"].uncertainty)
    assert values["spill_upturn_angle"].uncertainty < 0.7


def test_a_tank_that_only_creeps_has_no_upturn_and_a_shut_one_spills_nothing(tmp_path):
    values = spilling(tmp_path / "a", [50.0])
    assert values["spill_upturn_angle"].value is None
    assert values["spilled_fraction"].value == pytest.approx(2.0, abs=0.05)
    values = spilling(tmp_path / "b", [50.0], count=40)  # not one grain of 40 in hundred
    assert values["spill_start_angle"].value is None
    assert "spilled_fraction" not in tilted(tmp_path / "c", [give_of(np.linspace(0, 40, 2001))])


def test_an_empty_tank_has_no_centre_of_mass_and_the_rest_is_measured(tmp_path):
    time = np.linspace(0, 8, 801)
    y = np.stack([waves(time, 1.5, 0.003, 180.0)] * 2, axis=1)
    centre = np.stack([y, 0 * y], axis=2)
    centre[600:, 1] = np.nan
    pose = np.zeros((801, 2, 3))
    pose[..., 0] = 0.04 * np.sin(2 * np.pi * 1.5 * time)[:, None]
    spilled = np.where(np.isnan(centre[..., 0]), 4.0, 0.0)
    scene = {"pose": pose, "centre_of_mass": centre, "spilled": spilled, "resolved": preset(**SWAY), "open_edges": (2,)}
    values = written(tmp_path, time, contacts=7.0 - spilled, **scene)
    assert values["response_amplitude"].worlds == (pytest.approx(3.0, rel=0.01), None)
    assert values["final_shift_y"].worlds[1] is None
    assert "no grain is left in the tank in 1 of 2 worlds" in values["final_shift_y"].note
    assert values["largest_shift"].worlds == pytest.approx((3.0, 3.0), rel=0.01)
    assert values["contact_number"].worlds == (pytest.approx(3.5), None)


# --- contacts and forces


def test_the_contact_number_is_twice_the_contacts_over_the_grains_still_in_the_tank(tmp_path):
    time, random = np.linspace(0, 10, 1001), np.random.default_rng(1)
    contacts = np.where(time < 5, 190.0, 160.0)[:, None] + random.normal(0, 8, (1001, 2))
    contacts[0] = 195.0
    spilled = np.where(time < 5, 0.0, 20.0)[:, None] * np.array([1.0, 0.0])
    values = written(tmp_path, time, contacts=contacts, spilled=spilled, count=100, open_edges=(2,))
    assert values["contact_number_start"].value == pytest.approx(3.9)
    number = values["contact_number"]
    errors = np.array([16 / 80, 16 / 100]) / np.sqrt(500)
    assert number.worlds == pytest.approx((4.0, 3.2), abs=4 * errors.max())
    assert number.uncertainty == pytest.approx(np.sqrt(np.mean(errors**2)), rel=0.5)


MASS = 4 * 1000.0 * 4 / 3 * np.pi * (DIAMETER / 2) ** 3  # of four grains
WEIGHED = {"material": {"density": 1000.0}, "run": {"gravity": 9.81}}


@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_the_load_of_a_bed_at_rest_is_its_weight_in_any_tank(tmp_path, angle):
    pose = np.tile([0.0, 0.0, angle], (101, 1, 1))
    weight = MASS * 9.81
    force = np.tile([-weight * np.sin(angle), -weight * np.cos(angle), 1e-6], (101, 1, 1))
    values = written(tmp_path, np.linspace(0, 1, 101), pose=pose, wall_force=force, resolved={**preset(), **WEIGHED})
    assert values["carried_weight"].value == pytest.approx(1.0, rel=1e-9)
    assert values["largest_force"].value == pytest.approx(1e3 * weight)
    assert values["mean_force_y"].value == pytest.approx(-1e3 * weight * np.sin(angle))
    assert values["mean_moment"].value == pytest.approx(1e-3)
    assert "one grain thick" in values["mean_force_y"].note


@pytest.mark.parametrize(("name", "along", "axis"), [("sway", 0, 0), ("heave", 1, 1), ("roll", 2, 2)])
def test_the_load_on_a_ship_is_separated_into_mass_and_damping(tmp_path, name, along, axis):
    frequency, amplitude, share, damping = 1.5, 0.04, 0.7, 0.02
    inertia = share * MASS
    time, omega = np.linspace(0, 12, 241), 2 * np.pi * frequency  # 13 samples a period
    pose, force = np.zeros((241, 1, 3)), np.zeros((241, 1, 3))
    pose[:, 0, axis] = amplitude * np.sin(omega * time)
    # F = -A Y'' - B Y', averaged exactly since the sample before: -A (Y' - Y'_before)/dt - B (Y - Y_before)/dt
    rate, dt = amplitude * omega * np.cos(omega * time), time[1]
    force[1:, 0, along] = -inertia * np.diff(rate) / dt - damping * np.diff(pose[:, 0, axis]) / dt
    force[:, 0, 1] -= MASS * 9.81
    centre = (0.02, 0.5)
    if name == "roll":  # work is done by the moment about the centre, the recorded one is about the floor
        force[:, 0, 0] += 0.3 * np.sin(omega * time + 1)
        force[:, 0, 2] -= centre[1] * force[:, 0, 0] - centre[0] * force[:, 0, 1]
    resolved = {**preset(**{name: {"amplitude": amplitude, "frequency": frequency, "centre": centre}}), **WEIGHED}
    values = written(tmp_path, time, pose=pose, wall_force=force, resolved=resolved)
    averaging = np.sinc(frequency * dt)  # a mean over dt takes so much of an oscillation
    assert values["cargo_damping"].value == pytest.approx(damping * averaging, rel=1e-4)
    kind = "moment" if name == "roll" else "force"
    expected = -(inertia * (1j * omega) ** 2 + damping * 1j * omega) * amplitude * averaging
    assert values[f"{kind}_amplitude"].value == pytest.approx(1e3 * abs(expected), rel=1e-4)
    assert values[f"{kind}_phase"].value == pytest.approx(np.degrees(np.angle(expected)) % 360, abs=0.01)
    if name == "roll":
        assert "effective_mass" not in values
    else:
        assert values["effective_mass"].value == pytest.approx(share * averaging, rel=1e-4)


def test_a_frozen_cargo_in_sway_has_all_its_mass_and_no_damping(tmp_path):
    time, omega = np.linspace(0, 10, 1001), 3 * np.pi
    pose, force = np.zeros((1001, 1, 3)), np.zeros((1001, 1, 3))
    pose[:, 0, 0] = 0.04 * np.sin(omega * time)
    force[1:, 0, 0] = -MASS * 0.04 * omega * np.diff(np.cos(omega * time)) / time[1]
    values = written(tmp_path, time, pose=pose, wall_force=force, resolved={**preset(**SWAY), **WEIGHED})
    assert values["effective_mass"].value == pytest.approx(1.0, rel=1e-3)
    assert values["cargo_damping"].value == pytest.approx(0.0, abs=1e-5 * MASS * omega)


# --- wave, spectrum, top, hysteresis


def test_the_wave_of_the_first_mode_is_found(tmp_path):
    time, height = np.arange(0, 8.001, 0.04), 0.006
    y, layer = np.meshgrid(np.arange(-WIDTH / 2 + DIAMETER / 2, WIDTH / 2, DIAMETER), np.arange(21.0))
    y, layer = y.ravel(), layer.ravel()
    mode = np.cos(np.pi * (y / WIDTH + 0.5))
    radius = np.full((1, len(y)), DIAMETER / 2)
    pose = np.zeros((1, 3))
    frames = []
    for now in time:
        rise = height * mode * np.sin(2 * np.pi * 1.5 * now)
        z = DIAMETER / 2 + layer / 20 * (DEPTH - DIAMETER + rise)
        position = np.stack([y, z], axis=1)[None]
        position[0, :2] = (0.0, 0.1), (-WIDTH / 2 + DIAMETER, 0.14 + 0.005 * np.sin(30 * now))  # in the air
        frames.append(frame(now, count=len(y), position=position, pose=pose))
    move = np.zeros((801, 1, 3))
    move[:, 0, 0] = 0.04 * np.sin(3 * np.pi * np.linspace(0, 8, 801))
    values = written(tmp_path, np.linspace(0, 8, 801), frames, pose=move, radius=radius, resolved=preset(**SWAY))
    assert values["wave_mode"].value == pytest.approx(6.0, rel=0.05)
    wall = 6.0 * np.sin(np.pi * 0.1) / (np.pi * 0.1)  # mean of the cosine over a tenth of the width
    for name in ("wave_port", "wave_starboard"):
        assert values[name].value == pytest.approx(wall, rel=0.05)
    assert values["wave_middle"].value < 0.5
    assert values["wave_frequency"].value == pytest.approx(1.5, abs=values["wave_frequency"].uncertainty)
    assert values["wave_frequency"].uncertainty < 0.2


def test_the_middle_of_the_surface_swells_at_a_frequency_of_its_own(tmp_path):
    time = np.arange(0, 12.001, 0.04)
    y, layer = np.meshgrid(np.arange(-WIDTH / 2 + DIAMETER / 2, WIDTH / 2, DIAMETER), np.arange(21.0))
    y, layer = y.ravel(), layer.ravel()
    frames = []
    for now in time:
        middle = 0.004 * np.sin(2 * np.pi * 0.7 * now) + 0.001 * np.sin(2 * np.pi * 3.0 * now)
        rise = np.where(np.abs(y) < 0.2 * WIDTH, middle, 0.02 * np.sin(2 * np.pi * 1.5 * now))
        z = DIAMETER / 2 + layer / 20 * (DEPTH - DIAMETER + rise)
        frames.append(frame(now, count=len(y), position=np.stack([y, z], axis=1)[None], pose=np.zeros((1, 3))))
    move = np.zeros((1201, 1, 3))
    move[:, 0, 0] = 0.04 * np.sin(3 * np.pi * np.linspace(0, 12, 1201))
    radius = np.full((1, len(y)), DIAMETER / 2)
    values = written(tmp_path, np.linspace(0, 12, 1201), frames, pose=move, radius=radius, resolved=preset(**SWAY))
    found = values["swelling_frequency"]
    assert found.uncertainty < 0.1 and found.value == pytest.approx(0.7, abs=found.uncertainty)
    assert values["swelling_ratio"].value == pytest.approx(found.value / 1.5)
    assert values["swelling_amplitude"].value == pytest.approx(4.0, rel=0.1)
    assert values["fill_height"].value == pytest.approx(1e3 * DEPTH, abs=1.0)


def test_harmonics_and_distortion_of_a_known_sum(tmp_path):
    time = np.linspace(0, 24, 2401)
    parts = {0.5: 0.2, 1.0: 3.0, 2.0: 0.4, 3.0: 0.3, 4.0: 0.1, 5.0: 0.05}
    y = sum(waves(time, 1.5 * order, 1e-3 * size, 70 * order) for order, size in parts.items()) + 1e-4 * time
    values = shaken(tmp_path, y[:, None], np.zeros((2401, 1)), SWAY, time)
    assert values["subharmonic"].value == pytest.approx(0.2, rel=0.02)
    assert values["second_harmonic"].value == pytest.approx(0.4, rel=0.01)
    assert values["third_harmonic"].value == pytest.approx(0.3, rel=0.01)
    assert values["distortion"].value == pytest.approx(np.sqrt(0.16 + 0.09 + 0.01 + 0.0025) / 3, rel=0.01)


def test_a_run_sampled_too_coarsely_has_no_harmonics(tmp_path):
    time = np.linspace(0, 24, 241)
    y = waves(time, 1.5, 0.003, 0.0)[:, None]
    assert "distortion" not in shaken(tmp_path, y, np.zeros_like(y), SWAY, time)


def test_a_spectrum_shows_the_amplitudes_of_its_oscillations():
    time = np.linspace(0, 20, 2001)
    frequencies, amplitudes = amplitude_spectrum(time, (waves(time, 1.5, 2.0, 30.0) + 5 + 3 * time)[:, None])
    peak = amplitudes[:, 0].argmax()
    assert frequencies[peak] == pytest.approx(1.5, abs=0.02)
    assert amplitudes[peak, 0] == pytest.approx(2.0, rel=0.01)


def test_a_motion_from_a_file_has_no_frequency_but_a_wave(tmp_path):
    time = np.linspace(0, 8, 801)
    pose = np.zeros((801, 1, 3))
    pose[:, 0, 2] = 0.3 * np.sin(time)
    frames = [frame(now, pose=pose[0]) for now in np.linspace(0, 8, 101)]
    record = {"name": "x.csv", "columns": {"time": [0.0], "roll": [0.0]}}
    resolved = preset(history={"file": record}, roll={"amplitude": 0.3, "frequency": 1.0})
    values = written(tmp_path, time, frames, pose=pose, resolved=resolved)
    assert "wave_mode" in values
    assert not {"response_amplitude", "distortion", "force_amplitude"} & set(values)


def test_the_top_is_that_of_the_highest_grain(tmp_path):
    radius = np.array([[1e-3, 2e-3, 1e-3, 1e-3]])
    first = [[(0, 0.01), (0, 0.05), (0, 0.0505), (0, 0.02)]]
    last = [[(0, 0.01), (0, 0.03), (np.nan, np.nan), (0, 0.031)]]
    parts = np.zeros((1, 1, 2))
    frames = [frame(0.0, position=first, part=parts), frame(1.0, position=last, part=parts)]
    values = written(tmp_path, [0.0, 1.0], frames, radius=radius, parts={"floor": np.zeros((2, 2))})
    assert values["top_altitude_start"].value == pytest.approx(52.0)
    assert values["top_altitude_end"].value == pytest.approx(32.0)
    assert values["top_fall"].value == pytest.approx(20.0)
    assert values["bulk_altitude_end"].value < 32.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_remaining_shift_is_measured_when_the_tank_is_upright_again(tmp_path, sign):
    out = np.linspace(0, 40, 801)
    tilt = np.concatenate([out, np.full(50, 40.0), out[::-1], -out[:401]])  # and on to the other side
    give = np.concatenate([0.5 * out, np.full(50, 20.0), 15.0 + 5 * out[::-1] / 40, 15.0 - out[:401] / 2])
    values = tilted(tmp_path, [give, 2 * give], tilt, sign=sign)
    assert values["kept_shift"].worlds == pytest.approx((75.0, 75.0), abs=0.01)
    shift = 15 * LIQUID / DIAMETER
    assert values["remaining_shift"].worlds == pytest.approx((shift, 2 * shift), rel=1e-3)
    last = 0.125 / 2 * LIQUID / DIAMETER  # half the change over the last degree
    assert values["remaining_shift"].uncertainty == pytest.approx(last * np.sqrt(2.5), rel=0.01)


def test_a_tilt_that_does_not_come_back_has_no_hysteresis(tmp_path):
    out = np.linspace(0, 40, 801)
    tilt = np.concatenate([out, np.linspace(40, 5, 200)])
    assert "kept_shift" not in tilted(tmp_path, [0.5 * tilt], tilt)


def test_grains_beside_an_open_tank_do_not_count_as_surface():
    radius = np.full(2000, DIAMETER / 2)
    outline = box(height=0.2)
    grains = bed(10.0)
    fallen = grains.copy()
    fallen[:50] = np.nan
    fallen[50:100] = (-0.15, 0.05)
    fallen[100:150] = (0.03, -0.02)
    rest = np.delete(np.arange(2000), np.arange(150))
    np.testing.assert_array_equal(
        free_surface(fallen, radius, outline), free_surface(grains[rest], radius[rest], outline)
    )
    assert np.isfinite(column_tops(fallen, radius, outline, DIAMETER)).all()


def test_waves_of_beds_with_unequal_grains_have_equal_columns():
    """Beds of one run differ a little in their mean diameter; in a narrow tank that must not change their columns."""
    rng = np.random.default_rng(4)
    radius = np.stack([np.full(60, 1.4e-3), np.full(60, 1.7e-3)])
    position = rng.uniform((-0.03, 0.0), (0.03, 0.01), (1, 2, 60, 2))
    recording = SimpleNamespace(
        frames={"position": position}, radius=radius, mean_diameter=2 * radius.mean(axis=1), outline=box(0.06, 0.05)
    )
    recording.preset = SimpleNamespace(tank=SimpleNamespace(solid=None))
    assert surface_columns(recording, 0).shape == (2, 9)
