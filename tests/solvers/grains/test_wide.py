"""Kernels on real vectors compute what the others do, up to rounding."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from solvers.grains.shapes.given import Shapes
from solvers.machine import wide
from solvers.motion import Roll, Sway, Tilt
from solvers.ship.body import Body
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, RollDamping, Ship
from solvers.ship.section import box as hull
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import regular
from solvers.time import kept
from tests.oracles.outlines import ellipse
from tests.oracles.scenes import box, material, simulation

RADIUS, WIDE, STEPS = 1.5e-3, 24e-3, 1500
EGG = ellipse(1.12, 0.9)
LINING = np.array([[y, 0.0, 1e-3] for y in np.arange(-WIDE / 2, WIDE / 2 + 1e-4, 3e-3)])
OTHERS = [
    {"tangential": "mindlin"},
    {"tangential": "coulomb", "rolling": "constant-torque"},
    {"normal": "linear", "tangential": "cundall-strack", "rolling": "elastic-plastic"},
    {"normal": "hertz-dashpot", "tangential": "haff-werner"},
    {"normal": "hysteretic", "tangential": "viscous", "precision": "f32"},
    {"normal": "hertz", "tangential": "none", "integrator": "symplectic-euler"},
    {"tangential": "mindlin", "integrator": "gear", "precision": "mixed"},
    {"tangential": "mindlin", "cohesion": "bridge"},
    {"tangential": "haff-werner", "cohesion": "humid", "integrator": "symplectic-euler"},
]
WET = {"humidity": 0.7, "bridge_volume": 1e-12, "contact_angle": 0.3, "surface_tension": 0.072}


def thrown(lanes, threads=1, **models):
    """What two worlds of 42 grains thrown at each other and at a rough floor have become."""
    run = throw(lanes, threads, **models)
    assert run.wide == (lanes > 0)
    assert run.grains.lists.pairs.lanes == ((wide.OF_OUTLINES if "rule" in models else lanes) if lanes else 8)
    return ended(run, STEPS)


@pytest.mark.slow  # without the optimiser they are compiled below, and all that is slow is run before a release
def test_without_real_vectors_kernels_compile_as_users_have_them():
    """With Taichi's optimiser, which tests do without: it once ended the process."""
    steps = 'from tests.solvers.grains.test_wide import throw; throw(0, tangential="mindlin").advance(10)'
    outside = {name: value for name, value in os.environ.items() if name != "CARGOLAB_COMPILE"}
    root = Path(__file__).parents[3]
    subprocess.run([sys.executable, "-c", steps], env=outside, cwd=root, check=True, timeout=300)


def ended(run, steps):
    """What is found so many steps later, when the run is closed."""
    run.advance(steps)
    found = {**run.snapshot(), **run.observe()}
    run.close()
    return found


def throw(lanes, threads=1, rule=None, **models):
    """The grains as they are thrown, on a processor for which blocks on real vectors have so many lanes, or none do.

    With a `rule` of contact they are ellipses, else discs.
    """
    patched = pytest.MonkeyPatch()
    patched.setattr(wide, "lanes", lambda: lanes)
    row, column = np.divmod(np.arange(42), 7)
    place = np.column_stack([3.1e-3 * (column - 3) + 0.4e-3 * (row % 2), 3.1e-3 + 2.95e-3 * row])
    rng = np.random.default_rng(1)
    velocity, spin = rng.normal(0.0, 0.2, (2, len(place), 2)), rng.normal(0.0, 30.0, (2, len(place)))
    velocity[..., 1] -= 0.3
    grain = material(rolling_friction=0.1, shear_damping=20.0, **WET)
    radius = RADIUS * rng.uniform(0.9, 1.0, len(place))
    if rule:
        angle = np.full((2, len(place)), rng.uniform(-np.pi, np.pi, len(place)))
        models["shapes"] = Shapes((EGG,), np.zeros((2, len(place)), dtype=int), angle, rule, 120)
        radius = radius / EGG.bounding_radius
    run = simulation(
        np.stack([place, place]), radius, box(WIDE, 40e-3), grain, velocity=velocity, spin=spin, threads=threads,
        fixed=LINING, stiffness_scale=1e-2, gravity=100.0, **models,
    )  # fmt: skip
    patched.undo()
    return run


def agree(one, other):
    """Whether all that was found is the same but for rounding, which collisions have made grow."""
    assert one["contacts"].min() > 2
    for name, values in one.items():
        np.testing.assert_allclose(other[name], values, atol=1e-6 * np.abs(values).max(), rtol=1e-6, err_msg=name)


# Where the processor has none no run has such kernels; the slow tests compile them all the same.
@pytest.mark.slow
@pytest.mark.skipif(not wide.registers(), reason="kernels are on real vectors where there is AVX2 or AVX-512 only")
def test_real_vectors_move_grains_as_scalars_do():
    agree(thrown(0, tangential="mindlin"), thrown(wide.registers() // 32, tangential="mindlin"))


@pytest.mark.slow
@pytest.mark.parametrize("lanes", [8, 16])
@pytest.mark.parametrize("models", OTHERS, ids=str)
def test_every_law_and_integrator_is_right_on_real_vectors(models, lanes):
    one, other = thrown(0, **models), thrown(lanes, **models)
    if "precision" in models:
        np.testing.assert_allclose(other["position"], one["position"], atol=0.02 * RADIUS)
    else:
        agree(one, other)


def afloat(handover):
    """Two barges in waves, each with such a tank."""
    load = Floating(
        hull(0.34, 0.30), Water(), (0.0, 0.11), regular(0.02, 4.4, Water()), np.array([[-30.0j, -400.0, 2.0j]])
    )
    answers = Radiation(np.diag([40.0, 52.0, 0.2]), np.diag([20.0, 100.0, 0.05]))
    ship = Ship(Body(37.0, (0.004, 0.09), 0.6), load, answers, (0.0, 0.11), RollDamping(0.2, 0.3))
    return [Vessel(ship, (0.0, 0.02), handover=handover)] * 2


@pytest.mark.slow
@pytest.mark.skipif(not wide.registers(), reason="kernels are on real vectors where there is AVX2 or AVX-512 only")
def test_real_vectors_bear_a_ship_in_mixed_precision():
    run = throw(8, tangential="mindlin", precision="mixed", vessels=afloat(None))
    assert np.isfinite(ended(run, 20)["position"]).all()


@pytest.mark.slow
@pytest.mark.parametrize("precision", ["mixed", "f32"])
@pytest.mark.parametrize(
    "carried",
    [
        {"vessels": afloat(None)},
        {"vessels": afloat(0.01)},
        {"motions": [(Roll(0.2, 0.7), Sway(0.01, 1.5))] * 2},
        {"motions": [(Tilt(0.5, 0.1),)] * 2},
        {},
    ],
    ids=["afloat", "afloat in steps", "swayed", "tilted", "at rest"],
)
def test_real_vectors_bear_every_carrier_in_every_precision(carried, precision):
    """Whole vectors may not change their precision: a ship with grains once ended the process."""
    one, other = (thrown(lanes, tangential="mindlin", precision=precision, **carried) for lanes in (0, 8))
    np.testing.assert_allclose(other["position"], one["position"], atol=0.02 * RADIUS)
    np.testing.assert_allclose(other["pose"], one["pose"], atol=1e-5)


@pytest.mark.slow
def test_real_vectors_give_the_same_bits_on_any_number_of_threads():
    one, two = (thrown(8, threads, tangential="mindlin") for threads in (1, 2))
    for name, values in one.items():
        np.testing.assert_array_equal(two[name], values, err_msg=name)


@pytest.mark.slow
@pytest.mark.parametrize("cohesion", ["none", "bridge"])
@pytest.mark.parametrize(("lanes", "others"), [(8, 0), (0, 8), (16, 8), (8, 16)])
def test_a_state_goes_on_with_the_same_bits_on_another_kind_of_processor(lanes, others, cohesion):
    """It tells whether it is of vectors; one that does not, as older ones, is taken for the processor's own."""
    run = throw(lanes, tangential="mindlin", cohesion=cohesion)
    run.advance(STEPS // 2)
    state, rest = run.state(), STEPS - STEPS // 2
    found = ended(run, rest)
    elsewhere = throw(others, tangential="mindlin", cohesion=cohesion)
    elsewhere.restore(state)
    assert elsewhere.wide == (lanes > 0)
    for name, values in ended(elsewhere, rest).items():
        np.testing.assert_array_equal(values, found[name], err_msg=name)
    alike = throw(lanes, tangential="mindlin", cohesion=cohesion)
    unnamed = np.array([state[f"run.{name}"] for name in kept.ONCE[:-1]])
    alike.restore({name: value for name, value in state.items() if "run." not in name} | {"numbers": unnamed})
    np.testing.assert_array_equal(ended(alike, rest)["position"], found["position"])


@pytest.fixture(scope="module", params=["continuous", "nodes"])
def outlined(request):
    """What outlines thrown so have become on real vectors, by which rule, and their state halfway."""
    run = throw(8, rule=request.param, tangential="mindlin")
    assert run.wide
    assert run.grains.lists.pairs.lanes == wide.OF_OUTLINES
    run.advance(STEPS // 2)
    state = run.state()
    return request.param, ended(run, STEPS - STEPS // 2), state


@pytest.mark.slow
def test_real_vectors_move_outlines_as_scalars_do(outlined):
    rule, found, _ = outlined
    agree(thrown(0, rule=rule, tangential="mindlin"), found)


@pytest.mark.slow
def test_real_vectors_of_outlines_give_the_same_bits_on_two_threads(outlined):
    rule, found, _ = outlined
    for name, values in ended(throw(8, 2, rule=rule, tangential="mindlin"), STEPS).items():
        np.testing.assert_array_equal(values, found[name], err_msg=name)


@pytest.mark.slow
def test_a_state_of_outlines_goes_on_with_the_same_bits_where_there_are_no_vectors(outlined):
    rule, found, state = outlined
    elsewhere = throw(0, rule=rule, tangential="mindlin")
    elsewhere.restore(state)
    assert elsewhere.wide
    for name, values in ended(elsewhere, STEPS - STEPS // 2).items():
        np.testing.assert_array_equal(values, found[name], err_msg=name)


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["continuous", "nodes"])
@pytest.mark.parametrize("told", [0, 8, 16])
def test_a_state_of_outlines_on_scalars_goes_on_on_scalars(rule, told):
    """Older ones tell the lanes that discs would have had."""
    run = throw(0, rule=rule, tangential="mindlin")
    run.advance(STEPS // 2)
    state, rest = run.state(), STEPS - STEPS // 2
    found = ended(run, rest)
    state["run.vectors"] = np.array(told)
    elsewhere = throw(8, rule=rule, tangential="mindlin")
    elsewhere.restore(state)
    assert not elsewhere.wide
    for name, values in ended(elsewhere, rest).items():
        np.testing.assert_array_equal(values, found[name], err_msg=name)


@pytest.mark.slow
@pytest.mark.parametrize("models", OTHERS[:4], ids=str)
def test_every_law_between_outlines_is_right_on_real_vectors(models):
    agree(*(thrown(lanes, rule="continuous", **models) for lanes in (0, 8)))


@pytest.mark.slow
@pytest.mark.parametrize(
    "where",
    [
        {"vessels": afloat(None)},
        {"vessels": afloat(0.01)},
        {"motions": [(Roll(0.2, 0.7), Sway(0.01, 1.5))] * 2},
        {"schedule": "per-band", "threads": 4},  # two bands a world
    ],
    ids=["afloat", "afloat in steps", "swayed", "in bands"],
)
def test_real_vectors_bear_outlines_wherever_they_are(where):
    agree(*(thrown(lanes, rule="continuous", tangential="mindlin", **where) for lanes in (0, 8)))


@pytest.mark.slow
@pytest.mark.parametrize("changes", [{"rule": "area"}, {"rule": "continuous", "precision": "mixed"}], ids=str)
def test_other_outlines_are_not_on_real_vectors(changes):
    run = throw(8, tangential="mindlin", **changes)
    assert not run.wide
    assert np.isfinite(ended(run, STEPS)["position"]).all()
