"""The bench of speed: its pages, the kernels it times, and what it tells other codes. Nothing here is about time."""

import re
from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
import taichi as ti

from benchmarks import gpu
from benchmarks.devices import Device
from benchmarks.gpu import grains as grains_on_gpu
from benchmarks.peers import lammps, liggghts, peer
from benchmarks.speed import beds, curves, grains, parts, processors, run_page, worlds
from benchmarks.speed.beds import ACETATE, DIAMETER, settled_bed
from benchmarks.speed.counts import GRAIN, INTEGER, PAIR, REAL, total
from benchmarks.speed.curves import Curve, Tilting
from benchmarks.speed.kernels import Limits, Parts
from benchmarks.speed.workers import Worker, in_turn, millions, ratio
from lab.base.errors import LabError
from solvers.machine import runtime
from solvers.machine.errors import Unavailable
from solvers.simulation import Simulation

COUNT, WIDTH = 40, 24e-3


@pytest.fixture(scope="module")
def bed(tmp_path_factory):
    return settled_bed(tmp_path_factory.mktemp("beds"), COUNT, WIDTH)


@pytest.fixture
def loose():
    """The bed before it has settled, which takes no kernels."""
    random = np.random.default_rng(1)
    radius = beds.radii(COUNT, DIAMETER, beds.SPREAD, random)
    return beds.Bed(radius, beds.start_positions(radius, beds.tank(WIDTH), random), WIDTH)


@pytest.fixture(scope="module")
def resting(bed):
    run = Simulation(bed.scene(schedule="per-world"), bed.places(), threads=1, arch="cpu")
    run.settle(1e-9, 3.0)  # anew, since the bed has lost its history
    yield run
    run.close()


def test_ratios_are_within_a_round_and_the_first_round_is_a_warm_up():
    told = {"fast": iter([1.0, 8e6, 6e6, 9e6]), "slow": iter([9e9, 2e6, 3e6, 3e6])}
    found = in_turn({name: lambda n=name: next(told[n]) for name in told}, 3)
    assert millions(found["fast"]) == "8.0"
    assert ratio(found["fast"], found["slow"]) == "3.00 (2.00 to 4.00)"


def test_a_bed_is_settled_once(tmp_path, monkeypatch):
    settled = [{"radius": np.ones(COUNT), "position": np.zeros((COUNT, 2))}]
    monkeypatch.setattr(beds, "_settled", lambda *_: settled.pop())
    first = settled_bed(tmp_path, COUNT, WIDTH)
    np.testing.assert_array_equal(settled_bed(tmp_path, COUNT, WIDTH).radius, first.radius)
    assert [path.name for path in tmp_path.iterdir()] == ["bed-40-24-1.npz"]


@pytest.mark.slow
def test_copies_of_a_bed_touch_no_deeper_than_a_wall(bed):
    three = bed.times(3)
    assert (three.count, three.width) == (3 * COUNT, pytest.approx(3 * WIDTH))
    np.testing.assert_allclose(three.position[COUNT : 2 * COUNT], bed.position, atol=1e-15)
    for k in (0, 2):
        copy = three.position[k * COUNT : (k + 1) * COUNT] - bed.position
        np.testing.assert_allclose(copy, np.tile([(k - 1) * WIDTH, 0.0], (COUNT, 1)), atol=1e-15)
    deepest = max((bed.radius - WIDTH / 2 + np.abs(bed.position[:, 0])).max(), 0.0)
    apart = np.linalg.norm(three.position[:, None] - three.position[None], axis=2)
    overlap = three.radius[:, None] + three.radius - apart
    copy = np.arange(3 * COUNT) // COUNT
    assert overlap[copy[:, None] != copy].max() <= 2.0 * deepest + 1e-12


@pytest.mark.slow
def test_a_worker_times_steps_and_reports_what_it_cannot_do(bed):
    worker = Worker(bed, worlds=2, schedule="per-world")
    assert worker.dt == bed.scene().time_step()
    assert worker.speed(0.01) > 0.0
    worker.close()
    with pytest.raises(LabError, match="vulkan computes in 32 bits only"):
        Worker(bed, arch="vulkan", precision="f64")


@pytest.mark.slow
def test_the_walls_carry_the_bed_in_the_parts_that_are_timed(resting):
    run, kernels = resting, Parts(resting)
    forces = {}
    for name in ("pair_forces", "wall_forces"):
        kernels.move(1, 0.0)  # clears the forces
        getattr(kernels, name)(1, parts.LITTLE * run.dt)
        forces[name] = np.array([field.to_numpy()[0, :COUNT] for field in run.grains.grains.force])
    weight = float(run.grains.mass.sum() * run.scene.gravity)
    scale = np.abs(forces["pair_forces"]).sum()
    assert np.abs(forces["pair_forces"].sum(axis=1)).max() < 1e-12 * scale  # Newton's third law, rounding
    assert forces["wall_forces"][1].sum() == pytest.approx(weight, rel=1e-3)  # at rest up to what settling leaves


@pytest.mark.slow
def test_repeated_parts_leave_the_bed_unchanged(resting):
    """But for what the memory of friction takes in, a millionth of a step at a time."""
    run, kernels, little = resting, Parts(resting), parts.LITTLE * resting.dt
    kernels.move(1, 0.0)
    before, lists = run.snapshot(), run.grains.lists.pairs
    kernels.pair_forces(1, little)
    once = [field.to_numpy() for field in lists.memory]
    assert all(np.abs(memory).max() > 0.0 for memory in once)
    force = run.grains.grains.force[1].to_numpy()
    kernels.pair_forces(3, little)
    near = {"rtol": 0.0, "atol": 1e-6 * np.abs(force).max()}
    np.testing.assert_allclose(run.grains.grains.force[1].to_numpy(), 4.0 * force, **near)
    kernels.scatter(3, little)
    np.testing.assert_allclose(run.grains.grains.force[1].to_numpy(), 4.0 * force, **near)
    for name in ("move", "wall_forces", "gather"):
        getattr(kernels, name)(3, 0.0)
    length = int(lists.length.to_numpy()[0])
    kernels.build(2, run.dt)
    assert int(lists.length.to_numpy()[0]) == length
    for name, values in run.snapshot().items():
        np.testing.assert_array_equal(values, before[name])
    for field, values in zip(lists.memory, once, strict=True):
        now, then = (one.ravel()[:length] for one in (field.to_numpy(), values))
        np.testing.assert_allclose(now, then, rtol=0.0, atol=1e-6 * np.abs(then).max())


@pytest.mark.slow
def test_bytes_are_counted_from_the_sizes_of_lists_and_grains(resting):
    lists = resting.grains.lists.pairs
    reals = 3 + len(lists.constants) + 2 * len(lists.memory)  # stiffness, reach, share; memory is read and written
    assert total(PAIR, "").bytes == 2 * INTEGER + reals * REAL
    named = vars(resting.grains.grains).values()
    fields = [field for value in named for field in (value if isinstance(value, list | tuple) else [value])]
    held = {id(field) for field in fields if isinstance(field, ti.Field)}
    assert len(held) == parts.NUMBERS
    assert total(GRAIN, "").bytes >= len(held) * REAL


def test_the_kernels_that_find_the_limits_do_what_they_count():
    runtime.initialise(1, "cpu", "f64")
    kernels = Limits("f64", 16)
    kernels.triad(3)
    np.testing.assert_allclose(kernels.a.to_numpy(), 1.0 + 2 * 0.5 * 0.5)
    kernels.root_and_divide(3)
    np.testing.assert_allclose(kernels.a.to_numpy(), sqrt(2.0) + 0.5 / 2.0)
    kernels.multiply_add(1)
    x, y = 1.0, 0.5
    for _ in range(8):
        x, y = 0.5 * x + 0.25, 0.5 * y + 0.25
    np.testing.assert_allclose(kernels.a.to_numpy(), x + y)
    kernels.close()


def test_the_parts_are_reported_with_their_shares_and_limits(tmp_path):
    seconds = {"whole step": 4e-6, "pair_forces": 2e-6, "wall_forces": 1e-6, "move": 0.5e-6}
    rest = parts.AtRest(100, 200, 150, {**seconds, "gather": 1e-6, "laws": 0.5e-6, "scatter": 0.5e-6})
    simple, slow, size = parts.per_grain(rest)
    assert simple == 2 * total(PAIR, "").simple + total(GRAIN, "").simple
    bounds = parts.bounds_of(rest, {"simple": 1e10, "slow": 1e9, "near": 1e11, "far": 1e10})
    assert bounds["far"] == pytest.approx(10 * bounds["near"]) == pytest.approx(size / 10)
    assert bounds["slow"] == pytest.approx(slow)
    assert len(parts.plotted(rest, bounds).axes[0].patches) == 11


def test_figures_show_every_size_and_every_number_of_worlds():
    speeds = {name: np.array([1e6, 2e6, 4e6]) for name in grains.COLOURS}
    axes = grains.plotted({500: speeds, 1000: speeds}).axes[0]
    assert list(axes.containers[0].lines[0].get_ydata()) == [2.0, 2.0]
    batch = {n: np.array([1e6, 2e6, 4e6]) for n in worlds.THREADS}
    assert len(worlds.plotted({500: {1: batch}, 2000: {1: batch}}).axes) == 2


def test_without_the_other_codes_the_page_says_so(tmp_path, monkeypatch):
    for code in (liggghts, lammps):
        monkeypatch.setattr(code, "EXECUTABLE", "no-such-peer")
    text = run_page(["peers"], tmp_path, fast=True).read_text()
    for name in ("LIGGGHTS", "LAMMPS"):
        assert f"{name} is not installed here: the comparison with it is left out." in text
    assert "times as fast" not in text


def test_an_unknown_study_is_reported(tmp_path):
    with pytest.raises(LabError, match=r"there is no study colour; there are grains, .*curves, slow-tilts\.$"):
        run_page(["colour"], tmp_path, fast=True)


def test_curves_report_the_first_diameter_and_where_they_diverge():
    tilt = np.linspace(0.0, 10.0, 101)
    one, other = Curve(tilt, 0.2 * tilt), Curve(tilt, np.where(tilt > 6.0, 0.5, 0.2) * tilt)
    assert one.first_diameter() == pytest.approx(5.0, abs=0.11)
    assert np.isnan(Curve(tilt, 0.05 * tilt).first_diameter())
    assert other.parts_from(one) == pytest.approx(6.1)
    assert one.parts_from(one) == 10.0
    rows = curves._rows({curves.LAB: [one, other], "LAMMPS": [other, one]})
    assert rows[0] == ["1", "5.00", "5.00", "6.10"] and rows[1][-1] == "6.10"
    assert len(curves.plotted({curves.LAB: [one, other]}).axes) == 2


def test_shifts_of_slow_tilts_are_compared_bed_by_bed():
    tilt = np.linspace(0.0, 26.0, 261)
    beds = [Curve(tilt, slope * tilt) for slope in (0.01, 0.03)]
    others = [Curve(one.tilt, one.shift + 0.004) for one in beds]
    rows = curves._apart({curves.LAB: beds, "LAMMPS": others})
    assert [row[0] for row in rows] == ["5", "15", "25"]
    assert rows[0][1].startswith("100.0 [") and rows[0][2] == "4.0 [4.0, 4.0]"  # beds differ, the codes alike in each


@pytest.mark.slow
def test_a_tilted_bed_shifts_downhill_and_its_curve_is_kept(tmp_path, bed):
    how = Tilting(beds=1, count=COUNT, width=WIDTH, rate=200.0, angle=45.0)
    curve = curves.kept(tmp_path, curves.LAB, how, bed, 1, curves.followed_here)
    assert curve.tilt[-1] == pytest.approx(how.angle, abs=1.0)
    assert curve.shift[0] == 0.0 and curve.shift[-1] > 0.2
    np.testing.assert_array_equal(curves.kept(tmp_path, curves.LAB, how, bed, 1, None).shift, curve.shift)


def told_to_lammps(monkeypatch, bed, **how) -> str:
    """The deck that a run would be given."""
    decks = []

    def stop(name, executable, arguments, folder, processes):
        decks.append((folder / arguments[-1]).read_text())
        raise LabError("stop")

    monkeypatch.setattr(peer, "execute", stop)
    with pytest.raises(LabError, match="stop"):
        lammps.run_lammps(peer.Task(bed.position, bed.radius, bed.width, 0.2, ACETATE, 1e-6, 10, **how))
    return decks[0]


@pytest.mark.slow
def test_the_lammps_input_has_the_equivalent_viscoelastic_law(bed, monkeypatch):
    """γ_n m_eff √R_eff = (3/2) A k of the lab's law, for two mean grains and for one and a wall."""
    deck = told_to_lammps(monkeypatch, bed)
    scene = replace(bed.scene(), stiffness_scale=1.0)
    radius = float(bed.radius.mean())
    mass = 4.0 / 3.0 * pi * radius**3 * ACETATE.density
    for line, between, m_eff in zip(
        ("pair_style gran/hertz/history", "fix sides all wall/gran hertz/history"),
        scene.grains.interfaces,
        (mass / 2, mass),
        strict=True,
    ):
        told = [float(x) for x in deck.split(line)[1].split()[:5]]
        assert told[0] == pytest.approx(4.0 / 3.0 * between.young_modulus)
        assert told[1] == pytest.approx(8.0 * between.shear_modulus)
        assert told[4] == ACETATE.friction
        # The scene's mean radius is the middle of its range, the deck's that of the grains: 1 % of A apart.
        assert told[2] * m_eff == pytest.approx(1.5 * between.dissipative_time * told[0], rel=0.02)


def test_the_lammps_input_without_history_has_a_spring_and_a_stable_dashpot(loose, monkeypatch):
    deck = told_to_lammps(monkeypatch, loose, tangential="no_history", processes=2)
    spring, _, _, damping, friction = (float(x) for x in deck.split("pair_style gran/hooke")[1].split()[:5])
    assert spring > 0.0 and friction == ACETATE.friction
    assert damping * 1e-6 < 2.0 / 7.0


def test_gpu_pages_name_what_was_not_measured(tmp_path, monkeypatch):
    def none(arch, precision):
        raise Unavailable(f"run.arch: there is no {arch} here.")

    monkeypatch.setattr(runtime, "choose_arch", none)
    text = gpu.BENCH.run((), tmp_path, fast=True).read_text()
    for arch in gpu.ARCHES:
        assert f"Not run: run.arch: there is no {arch} here." in text


def test_software_devices_are_named_and_run_only_small_beds(tmp_path, monkeypatch):
    monkeypatch.setattr(runtime, "choose_arch", lambda arch, precision: arch)
    monkeypatch.setattr(gpu, "device", lambda arch: Device("a painter", software=True))
    text = gpu.BENCH.run((), tmp_path, fast=False).read_text()
    assert text.count("Device: a painter, which is software on the processor.") == len(gpu.STUDIES)
    assert text.count("Not run: there is no graphics processor here, and software is none") == len(gpu.STUDIES)


def test_a_deviating_grain_is_reported_in_diameters():
    found = np.array([[0.0, 0.0], [4.0, 3.0]])
    assert grains_on_gpu.farthest(found, np.zeros((2, 2))) == pytest.approx(5.0 / DIAMETER)


def test_ratios_to_other_codes_stand_by_processor_the_smallest_first(tmp_path, monkeypatch):
    """Twice and 2.5 times as fast in two turns, on a processor of its own beside those that come with the lab."""
    monkeypatch.setattr(processors, "processor", lambda: "a trial processor")
    found = {"LAMMPS, history": np.array([2e6, 2e6]), "the lab, history (Mindlin)": np.array([4e6, 5e6])}
    ours = processors.ratios_of(found, ["LAMMPS, history"], ["the lab, history (Mindlin)"])
    processors.keep(tmp_path, ours)
    lines = processors.write_page(tmp_path).read_text().splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("| L")]
    assert rows[0][:7] == [
        "LAMMPS", "history", "history (Mindlin)", "at rest", "grain-steps", "2.25 (2 to 2.5)", "a trial processor"
    ]  # fmt: skip
    least = [float(re.search(r"\(?([\d.]+) to", row[5])[1]) for row in rows]
    assert least == sorted(least) and len(rows) > 2
    assert all(row[6] and row[7] for row in rows)
    manual = [line for line in processors.overview(tmp_path).splitlines() if "a trial processor" in line]
    assert len(manual) == 1
    assert manual[0].startswith("| a trial processor | grain-steps | at rest | 2.25 (2 to 2.5) |  | the lab, ")


def test_simulated_seconds_stand_after_grain_steps_a_row_a_bed(tmp_path, monkeypatch):
    """At one error of the restitution, at rest and in flow, beside grain-steps."""
    monkeypatch.setattr(processors, "processor", lambda: "a trial processor")
    unit = "simulated seconds at 1 % of restitution"
    what = [("in flow", unit, 2.5), ("at rest", unit, 6.0), ("at rest", processors.GRAIN_STEPS, 5.0)]
    ratios = [processors.Ratio("LAMMPS", *processors.SPRINGS, bed, how, x, x, x) for bed, how, x in what]
    processors.keep(tmp_path, ratios)
    rows = [line for line in processors.overview(tmp_path).splitlines() if "a trial processor" in line]
    assert [row.split(" | ")[1:3] for row in rows] == [
        ["grain-steps", "at rest"], [unit, "at rest"], [unit, "in flow"]
    ]  # fmt: skip
