"""`cargolab.Simulation`: the bits of an ordinary run, functions called in time, states to go back to, changes told."""

import numpy as np
import pytest

import cargolab


@pytest.fixture
def simulation(small, tmp_path):
    with cargolab.Simulation(small, tmp_path / "run", quiet=True) as made:
        yield made


@pytest.fixture(scope="module")
def whole(small, tmp_path_factory):
    """The recording of the same run without a hand in it."""
    folder = tmp_path_factory.mktemp("whole") / "run"
    cargolab.run(small, folder, video=False, plots=False, quiet=True)
    return cargolab.open(folder)


def same(folder, recording) -> bool:
    other = cargolab.open(folder)
    tables = ((one.series, two.series) for one, two in [(other, recording)])
    return all(np.array_equal(a[name], b[name], equal_nan=True) for a, b in tables for name in b.quantities)


def test_in_pieces_it_records_the_bits_of_an_ordinary_run(simulation, whole):
    for span in ("0.1 s", 0.05, None):
        simulation.run(span)
    assert simulation.ended and simulation.time == pytest.approx(simulation.duration, abs=0.01)
    result = simulation.report(video=False, plots=False)
    assert result.recording.complete and same(simulation.folder, whole)
    assert simulation.folder.joinpath("summary.json").exists()
    with pytest.raises(cargolab.Error, match="has ended"):
        simulation.run()


def test_a_closed_one_goes_on_where_it_was(simulation, whole):
    simulation.run("0.2 s").close()
    resumed = cargolab.Simulation.resume(simulation.folder, quiet=True)
    assert resumed.time == pytest.approx(0.2)
    resumed.run()
    resumed.close()
    assert same(resumed.folder, whole)
    with pytest.raises(cargolab.Error, match="is complete"):
        cargolab.Simulation.resume(resumed.folder)


def test_it_goes_back_to_a_saved_state_bit_for_bit(simulation, whole):
    simulation.run("0.2 s")
    moment, place = simulation.save(), simulation.grains.position.copy()
    simulation.run("0.2 s")
    later = simulation.grains.position.copy()
    assert not np.array_equal(place, later)
    simulation.restore(moment)
    assert simulation.time == pytest.approx(0.2) and np.array_equal(simulation.grains.position, place)
    simulation.run("0.2 s")
    assert np.array_equal(simulation.grains.position, later)
    simulation.run()
    simulation.close()
    assert same(simulation.folder, whole)


def test_functions_are_called_in_time_and_may_stop_it(simulation):
    told = []

    @simulation.every("0.1 s")
    def look(running):
        told.append(running.time)
        if running.time > 0.25:
            running.stop()

    simulation.run("0.15 s").run()
    assert told == pytest.approx([0.1, 0.2, 0.3]) and simulation.time == pytest.approx(0.3)
    with pytest.raises(cargolab.Error, match=r"every: 1 ms is shorter .* record\.series_rate"):
        simulation.every("1 ms", look)


def test_what_a_function_raises_stops_it_where_it_can_go_on(simulation):
    def broken(running):
        running.every("0.05 s", lambda _: None)
        raise ZeroDivisionError

    simulation.every("0.1 s", broken)
    with pytest.raises(ZeroDivisionError):
        simulation.run()
    assert simulation.time == pytest.approx(0.1)
    simulation.run("0.05 s")
    assert simulation.time == pytest.approx(0.15)


def test_a_change_acts_is_told_and_is_taken_back_with_the_state(simulation):
    simulation.run("0.2 s")
    moment = simulation.save()
    simulation.set("material.friction", 0.05)
    simulation.run("0.2 s")
    changed = simulation.grains.position.copy()
    assert simulation.preset["material.friction"] == 0.05
    simulation.restore(moment)
    assert simulation.preset["material.friction"] != 0.05
    simulation.run("0.2 s")
    assert not np.array_equal(simulation.grains.position, changed)
    simulation.set({"run.gravity": "5 m/s^2", "wall.friction": 0.1})
    simulation.close()
    found = [(pytest.approx(time), name, value) for time, name, value in cargolab.open(simulation.folder).steering]
    assert found == [(0.4, "run.gravity", 5.0), (0.4, "wall.friction", 0.1)]
    with pytest.raises(cargolab.Error, match="changed while it ran"):
        cargolab.resume(simulation.folder)


@pytest.mark.parametrize("key", ["grains.diameter", "material.density", "motion.tilt.rate", "material.frition"])
def test_a_key_that_cannot_change_is_refused_and_changes_nothing(simulation, key):
    before = simulation.preset.text
    with pytest.raises(cargolab.Error, match=key.replace(".", r"\.")):
        simulation.set(key, "3 mm")
    assert simulation.preset.text == before


def test_matters_are_arrays_with_units(simulation):
    grains = simulation.grains
    assert grains.position.shape == (2, 16, 2) and grains.radius.shape == (2, 16)
    assert grains.units["velocity"] == "m/s" and "position" in dir(grains) and "grains" in dir(simulation)
    assert simulation.now["centre_of_mass"].shape == (2, 2)
    place = (grains.radius**2 * grains.position[..., 1]).sum() / (grains.radius**2).sum()
    assert place == pytest.approx(simulation.now["centre_of_mass"][:, 1].mean(), rel=0.02)
    with pytest.raises(AttributeError, match="its matters are grains"):
        simulation.water  # noqa: B018
    with pytest.raises(AttributeError, match=r"they have .*position"):
        grains.pressure  # noqa: B018


@pytest.mark.slow
def test_another_run_with_other_settings_takes_over_and_the_remedy_is_said(simulation, small, tmp_path):
    simulation.run("0.1 s")
    cargolab.run(small, tmp_path / "other", run__precision="f32", video=False, plots=False, quiet=True)
    with pytest.raises(cargolab.Error, match=r"Simulation\.resume"):
        simulation.run()
    simulation.close()
    resumed = cargolab.Simulation.resume(simulation.folder, quiet=True)
    resumed.run("0.1 s")
    resumed.close()
