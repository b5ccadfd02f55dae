"""Settled beds: their surfaces, stored beds that equal newly settled ones, and the safety of the store."""

import os
from dataclasses import replace
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.preset.find import load
from lab.preset.merge import merged
from lab.runs import beds
from lab.runs.bed_key import bed_key
from lab.runs.beds import BedStore, lay, made, settled, settling
from solvers.machine.state import Axis
from solvers.simulation import Simulation

# Soft, dissipative grains come to rest soon; friction decides on the surface.
SMALL = {
    "tank": {"width": "72 mm", "height": "45 mm"},
    "grains": {"depth": "24 mm", "diameter": "3 mm"},
    "material": {"restitution": 0.3, "friction": 0.5},
    "contact": {"stiffness_scale": 2e-4, "tangential": "mindlin"},
    "motion": {"tilt": {"rate": "30 deg/s", "angle": "30 deg"}},
    "run": {"repeats": 6, "step": "16 us", "force_step": True, "rest": 1e-5},
}


def resolved(**sections):
    """The small preset with keys of its sections over it."""
    return load("tilting/quick", merged(SMALL, sections)).resolved


def make(preset, start=Simulation):
    """A simulation with settled beds, and what was said on the way."""
    scene, position = build(preset)
    progress = Progress(quiet=True)
    return settled(scene, position, settling(preset), start, progress), progress


def top(position: np.ndarray, radius: np.ndarray, width: float) -> np.ndarray:
    """Height (m) of the bed's surface at many places, a diameter off the walls."""
    y = np.linspace(-width / 2 + 3e-3, width / 2 - 3e-3, 801)[:, None]
    square = radius**2 - (y - position[:, 0]) ** 2
    return np.where(square > 0.0, position[:, 1] + np.sqrt(np.maximum(square, 0.0)), 0.0).max(axis=1)


@pytest.fixture(scope="module")
def surfaces():
    """Of each surface: scene, state, observed rows and progress of its beds."""
    found = {}
    for surface in ("undisturbed", "slightly-disturbed", "disturbed"):
        simulation, progress = make(resolved(grains={"surface": surface, "reuse_bed": False}))
        found[surface] = simulation.scene, simulation.snapshot(), simulation.observe(), progress
        simulation.close()
    return found


@pytest.mark.slow
def test_surfaces_have_the_roughness_of_their_names(surfaces):
    """Standard deviation of the surface's height about its level, in diameters, mean of six beds."""
    rough = {
        name: np.mean(
            [top(p, r, 0.072).std() / 3e-3 for p, r in zip(state["position"], scene.grains.radius, strict=True)]
        )
        for name, (scene, state, _, _) in surfaces.items()
    }
    assert rough["undisturbed"] < 0.85 * rough["slightly-disturbed"]
    assert rough["slightly-disturbed"] < 0.75 * rough["disturbed"]


@pytest.mark.slow
def test_an_undisturbed_bed_has_the_least_void(surfaces):
    middle = {name: state["position"][..., 1].mean() for name, (_, state, _, _) in surfaces.items()}
    assert middle["undisturbed"] < 0.98 * min(middle["slightly-disturbed"], middle["disturbed"])


@pytest.mark.slow
def test_beds_of_all_surfaces_rest_in_their_tank_with_all_grains(surfaces):
    given = surfaces["slightly-disturbed"][0].radius
    for scene, state, rows, progress in surfaces.values():
        np.testing.assert_array_equal(scene.grains.radius, given)
        assert not progress.warnings
        assert np.all(rows["escaped"] < 0) and np.all(rows["overlap"] < 0.04)
        mass = 4.0 / 3.0 * np.pi * scene.grains.radius**3 * 1319.0
        still = 1e-5 * (mass * 9.81 * 2.0 * scene.grains.radius).mean(axis=1)
        assert np.all((rows["kinetic"] + rows["rotational"]) / scene.grains.radius.shape[1] < still)
        assert np.all(state["position"][..., 1] + scene.grains.radius < 0.045)


def alike(first, second):
    """Whether two states, or snapshots, are the same to the last bit."""
    return first.keys() == second.keys() and all(np.array_equal(first[name], second[name]) for name in first)


@pytest.mark.slow
def test_a_reused_bed_continues_bit_for_bit_as_the_stored_one():
    """The tangential law remembers, and the tank begins to tilt."""
    (stored, _), (reused, said) = (make(resolved(run={"repeats": 2})) for _ in range(2))
    assert any("was reused" in sentence for sentence in said.notes)
    np.testing.assert_array_equal(reused.snapshot()["position"], stored.snapshot()["position"])
    for one in (stored, reused):
        one.advance(500)
    assert alike(reused.snapshot(), stored.snapshot())
    for one in (stored, reused):
        one.close()


@pytest.mark.slow
def test_positions_of_parts_are_not_stored_with_a_bed():
    gate = {"points": [["0 mm", "0 mm"], ["0 mm", "30 mm"]], "move": ["0 mm", "-30 mm"], "start": "1 s"}
    parts = {"gate": {**gate, "speed": "1 m/s", "acceleration": "10 m/s^2"}}
    simulation = Simulation(*build(resolved(run={"repeats": 2}, parts=parts)))
    before = simulation.state()
    simulation.observe()
    beds = made(before, simulation.state(), simulation.axes(), 2)  # of two worlds beside one part
    assert lay(simulation, beds)
    simulation.close()


@pytest.mark.slow
def test_a_reused_bed_continues_bit_for_bit_with_other_worlds_and_motion():
    make(resolved(run={"repeats": 3}))[0].close()
    preset = resolved(run={"repeats": 2, "seed": 2}, motion={"tilt": {"angle": "5 deg"}})
    reused, said = make(preset)
    anew, silent = make(replace(preset, grains=replace(preset.grains, reuse_bed=False)))
    assert any("was reused" in sentence for sentence in said.notes) and not silent.notes
    for one in (reused, anew):
        one.advance(round(0.4 / one.dt))
    states = [one.state() for one in (reused, anew)]
    for state in states:
        for name in [name for name in state if name.startswith("run.")]:
            del state[name]  # steps, among others: those of settling are as many as the slowest of all beds takes
    assert alike(*states)
    np.testing.assert_allclose(reused.observe()["pose"][..., 2], np.radians(5.0), rtol=1e-6)
    for one in (reused, anew):
        one.close()


class Fake:
    """A simulation whose settling lets each grain fall by its world's and its own number, and fills its lists."""

    arch, schedule_name, units_a_world, skin = "cpu", "per-world", 1, 1e-4
    matters: ClassVar = {"grains": None}

    def __init__(self, scene, position):
        self.scene, self.dt = scene, scene.time_step()
        worlds = len(position)
        self.position, self.closed, self.settles = position.copy(), False, 0
        self.fields = {
            "numbers": np.array([0, 1, 0]),
            "origin": np.array(0.0),
            "grains.y": self.position,
            "pairs.mate": np.zeros((2 * worlds, 3), dtype=np.int32),
            "frame.motions": np.array([[m.angle for m in motions] for motions in scene.motions]),
            "walls.edge": np.arange(4.0),
        }

    def settle(self, rest, limit, tell):
        self.settles += 1
        self.position[..., 1] -= 1e-3 * self.scene.grains.radius
        self.fields["pairs.mate"][:] = np.repeat(np.round(self.scene.grains.radius[:, :3] * 1e6), 2, axis=0)
        self.fields["numbers"][2] = -100
        return True

    def state(self):
        return {name: values.copy() for name, values in self.fields.items()}

    def axes(self):
        first = {"grains.y": "world", "pairs.mate": "unit", "frame.motions": "world"}
        return {
            name: tuple(Axis(first.get(name, "number") if k == 0 else "number", n) for k, n in enumerate(values.shape))
            for name, values in self.fields.items()
        }

    def restore(self, state):
        self.fields = {name: values.copy() for name, values in state.items()}
        self.position = self.fields["grains.y"]

    def close(self):
        self.closed = True


def fake(**sections):
    simulation, progress = make(resolved(**sections), Fake)
    return simulation, bool(progress.notes)


@pytest.fixture
def store(tmp_path, monkeypatch):
    monkeypatch.setenv("CARGOLAB_CACHE", str(tmp_path / "deep" / "cache"))
    return BedStore()


def test_beds_are_stored_per_world_and_found_with_any_other_worlds(store):
    four, reused = fake(run={"repeats": 4})
    assert not reused and four.settles == 1 and len(list(store.folder.iterdir())) == 4
    two, reused = fake(run={"repeats": 2, "seed": 3}, motion={"tilt": {"angle": "7 deg"}})
    assert reused and two.settles == 0
    np.testing.assert_array_equal(two.position, four.position[2:])
    np.testing.assert_array_equal(two.fields["pairs.mate"], four.fields["pairs.mate"][4:])
    assert two.fields["numbers"][2] == -100
    np.testing.assert_allclose(two.fields["frame.motions"], np.radians(7.0))  # the motion is the run's own
    _, reused = fake(run={"repeats": 3, "seed": 3})
    assert not reused  # seed 5 is new


OTHERS = [
    {"tank": {"width": "73 mm"}},
    {"tank": {"roughness": "2 mm"}},
    {"grains": {"depth": "25 mm"}},
    {"grains": {"spread": 0.11}},
    {"material": {"friction": 0.51}},
    {"wall": {"friction": 0.3}},
    {"contact": {"tangential": "haff-werner"}},
    {"contact": {"stiffness_scale": 2.1e-4}},
    {"run": {"gravity": "9.8 m/s^2"}},
    {"run": {"seed": 2}},
    {"run": {"step": "15 us"}},
    {"run": {"rest": 2e-5}},
    {"run": {"settle_limit": "4 s"}},
    {"run": {"precision": "f32"}},
    {"run": {"integrator": "symplectic-euler"}},
]


def test_the_key_of_a_bed_depends_on_all_that_determines_it(monkeypatch):
    """Whatever a bed follows from changes its key, whatever it does not follow from leaves it."""

    def key(**sections):
        preset = resolved(**sections)
        scene, position = build(preset)
        return bed_key(Fake(scene, position), 0, position[0], settling(preset))

    own = key()
    assert own == key()
    assert own == key(run={"repeats": 2, "threads": 3, "duration": "2 s"}, motion={"tilt": {"angle": "5 deg"}})
    assert own == key(video={"speed": 2.0}, grains={"reuse_bed": True})
    keys = [key(**other) for other in OTHERS]
    monkeypatch.setattr(Fake, "schedule_name", "per-band")
    keys.append(key())
    monkeypatch.setattr("lab.runs.bed_key.FORMAT", "cargo-shift-lab bed 0")
    keys.append(key())
    assert len({own, *keys}) == len(keys) + 1


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 not a zip", b"\x93NUMPY", None])
def test_an_invalid_bed_file_is_ignored_and_replaced(store, content):
    first, _ = fake(run={"repeats": 1})
    (path,) = store.folder.iterdir()
    whole = path.read_bytes()
    damaged = whole[: len(whole) // 2] if content is None else content
    path.write_bytes(damaged)
    again, reused = fake(run={"repeats": 1})
    assert not reused
    np.testing.assert_array_equal(again.position, first.position)
    assert fake(run={"repeats": 1})[1]


def test_a_flipped_bit_or_another_beds_file_is_detected(store):
    fake(run={"repeats": 1})
    (path,) = store.folder.iterdir()
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    assert store.load(path.stem) is None
    store.save("other", {"grains.y": np.zeros(3)})
    (store.folder / "other.npz").replace(path)
    assert store.load(path.stem) is None


def test_a_bed_of_another_shape_is_settled_again(store):
    fake(run={"repeats": 1})
    (path,) = store.folder.iterdir()
    store.save(path.stem, {"grains.y": np.zeros((1, 3, 2)), "numbers": np.zeros(3)})
    again, reused = fake(run={"repeats": 1})
    assert not reused and again.settles == 1
    store.save(path.stem, {"of the future": np.zeros((1, 3, 2))})
    assert not fake(run={"repeats": 1})[1]


def test_reuse_may_be_disabled_and_the_folder_may_be_unwritable(store, tmp_path, monkeypatch):
    assert not fake(grains={"reuse_bed": False})[1]
    assert not store.folder.exists()
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("CARGOLAB_CACHE", str(tmp_path / "file"))
    assert fake()[0].settles == 1


def test_a_bed_that_does_not_rest_is_not_kept(store, monkeypatch):
    monkeypatch.setattr(Fake, "settle", lambda *_: False)
    _, progress = make(resolved(), Fake)
    assert not store.folder.exists() and "still moved after 5 s" in progress.warnings[0]


def test_a_simulation_that_fails_is_closed(store, monkeypatch):
    opened = []

    def start(*arguments):
        opened.append(Fake(*arguments))
        return opened[-1]

    def fail(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(Fake, "settle", fail)
    for surface in ("slightly-disturbed", "disturbed"):
        with pytest.raises(KeyboardInterrupt):
            make(resolved(grains={"surface": surface}), start)
    assert all(simulation.closed for simulation in opened)


def test_without_settling_the_grains_start_where_they_are_placed(store):
    preset = resolved(run={"settle": False})
    simulation, progress = make(preset, Fake)
    np.testing.assert_array_equal(simulation.position, build(preset)[1])
    assert simulation.settles == 0 and "without settling" in progress.notes[0]


def test_a_bed_too_high_for_its_tank_is_refused(store):
    """The fake's grains hardly fall, so those thrown into the raised tank stay above the lid."""
    with pytest.raises(LabError, match=r"^grains: the bed is up to .* mm high, too high for the tank"):
        make(resolved(grains={"surface": "disturbed"}), lambda *a: SimpleNamespace(**vars_of(Fake(*a))))


def vars_of(simulation: Fake) -> dict:
    """What pouring asks of a simulation, its grains lying where they were put."""
    return {
        "settle": lambda *_: True,
        "snapshot": lambda: {"position": simulation.position},
        "close": simulation.close,
        "state": simulation.state,
        "axes": simulation.axes,
        "scene": simulation.scene,
        "matters": simulation.matters,
        "dt": simulation.dt,
        **{name: getattr(Fake, name) for name in ("arch", "schedule_name", "units_a_world", "skin")},
    }


def test_values_unchanged_by_settling_are_not_stored():
    before = {
        "numbers": np.zeros(2),
        "origin": np.zeros(()),
        "grains.y": np.zeros((4, 3)),
        "pairs.mate": np.arange(2.0),
    }
    after = {**before, "grains.y": np.arange(12.0).reshape(4, 3), "numbers": np.ones(2)}
    axes = {"numbers": (Axis("number", 2),), "grains.y": (Axis("unit", 4), Axis("place", 3))}
    first, second = made(before, after, axes, 2)
    assert first.keys() == {"numbers", "grains.y"}
    np.testing.assert_array_equal(first["grains.y"], [[0, 1, 2], [3, 4, 5]])
    restored = {}
    simulation = SimpleNamespace(state=lambda: before, axes=lambda: axes, restore=restored.update)
    assert lay(simulation, [second, first])
    np.testing.assert_array_equal(restored["grains.y"], after["grains.y"][[2, 3, 0, 1]])
    np.testing.assert_array_equal(restored["pairs.mate"], before["pairs.mate"])
    np.testing.assert_array_equal(restored["numbers"], [1, 1])
    assert not lay(simulation, [first, None]) and not lay(simulation, [first])


def test_the_store_stays_small_and_deletes_the_least_recently_used(store, monkeypatch):
    bed = {"grains.y": np.random.default_rng(1).random(1000)}  # does not compress
    for k, key in enumerate(("a", "b", "c")):
        store.save(key, bed)
        os.utime(store.folder / f"{key}.npz", (k, k))
    left = store.folder / "left.part"
    left.write_bytes(b"half")
    size = (store.folder / "a.npz").stat().st_size
    monkeypatch.setattr(beds, "LARGEST_STORE", 3.5 * size)
    assert store.load("a") is not None  # used now
    store.save("d", bed)
    assert {path.stem for path in store.folder.glob("*.npz")} == {"a", "c", "d"}
    assert left.exists()
    os.utime(left, (0, 0))
    store.save("e", bed)
    assert not left.exists() and store.load("d") is not None


def test_a_bed_is_replaced_atomically(store, monkeypatch):
    """A reader that has the old file open goes on with it; a writer that fails leaves nothing behind."""
    store.save("a", {"grains.y": np.zeros(9)})
    with np.load(store.folder / "a.npz") as old:
        store.save("a", {"grains.y": np.ones(9)})
        assert not old["grains.y"].any()
    assert store.load("a")["grains.y"].all()

    def fail(file, **_):
        file.write(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez_compressed", fail)
    store.save("b", {"grains.y": np.ones(9)})
    assert [path.name for path in store.folder.iterdir()] == ["a.npz"]


def test_the_cache_is_in_the_users_folder_unless_set(monkeypatch, tmp_path):
    monkeypatch.delenv("CARGOLAB_CACHE")
    assert "cargo-shift-lab" in str(BedStore().folder)
    monkeypatch.setenv("CARGOLAB_CACHE", str(tmp_path))
    assert BedStore().folder == tmp_path / "beds"


@pytest.mark.slow
def test_round_outlines_settle_in_the_bed_of_discs(store):
    small = {"tank.width": "40 mm", "tank.height": "60 mm", "tank.roughness": False, "grains.depth": "20 mm"}
    small |= {"run.accuracy": "draft", "run.repeats": 2}
    discs, _ = make(load("shapes/box", {**small, "shapes.grain": False}).resolved)
    bed = discs.snapshot()["position"]
    discs.close()
    circles = {"shapes.grain.descriptors": [], "grains.settled_as": "discs"}
    outlined, _ = make(load("shapes/box", {**small, **circles}).resolved)
    moved = np.abs(outlined.snapshot()["position"] - bed).max(axis=2) / 6e-3
    assert np.median(moved) < 3e-4 and moved.max() < 2e-3  # discs creep by 5e-3 in half a second
    outlined.close()
    assert len(list(store.folder.iterdir())) == 4  # the discs' own were used, and not settled anew


def test_other_outlines_do_not_settle_as_discs():
    with pytest.raises(LabError, match="round outlines only"):
        load("shapes/box", {"grains.settled_as": "discs"})
    with pytest.raises(LabError, match="goes with irregular grains"):
        load("tilting/quick", {"grains.settled_as": "discs"})
    circles = {"shapes.grain.descriptors": [], "grains.settled_as": "discs"}
    with pytest.raises(LabError, match="no bed is settled"):
        load("shapes/box", {**circles, "run.settle": False})
