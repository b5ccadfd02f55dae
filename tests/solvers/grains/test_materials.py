"""Contact properties of two materials, and the restitution of the viscoelastic law both ways."""

from math import sqrt
from typing import get_args, get_type_hints

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from solvers.grains.materials import Material, effective_shear, effective_young, interface
from solvers.grains.restitution import dissipative_time_for, restitution
from solvers.machine.marks import Interval
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

MASS, RADIUS = 1e-5, 7.5e-4
ANY = st.builds(
    material,
    young=st.floats(1e5, 1e12),
    poisson=st.floats(0.0, 0.49),
    friction=st.floats(0.0, 2.0),
    dissipative_time=st.floats(0.0, 1e-3),
)


@given(ANY)
def test_equal_materials_have_closed_forms(substance):
    """E* = Y/(2(1 − ν²)), G* = Y/(4(2 − ν)(1 + ν)), k = 2Y√R_eff/(3(1 − ν²)) (Spandonidis 2016, eq. 4.5)."""
    young, poisson = substance.young, substance.poisson
    assert effective_young(substance, substance) == pytest.approx(young / (2.0 * (1.0 - poisson**2)))
    assert effective_shear(substance, substance) == pytest.approx(young / (4.0 * (2.0 - poisson) * (1.0 + poisson)))
    k = 4.0 / 3.0 * effective_young(substance, substance) * sqrt(RADIUS)
    assert k == pytest.approx(2.0 * young * sqrt(RADIUS) / (3.0 * (1.0 - poisson**2)))


@given(ANY, ANY)
def test_two_materials_act_as_springs_in_series(a, b):
    """Compliances add, so order does not matter and twice the compliance is the sum of those of equal pairs."""
    for effective in (effective_young, effective_shear):
        assert effective(a, b) == effective(b, a)
        halves = 1.0 / effective(a, a) + 1.0 / effective(b, b)
        assert 2.0 / effective(a, b) == pytest.approx(halves, rel=1e-12, abs=0.0)


def test_with_a_rigid_partner_only_the_grain_deforms():
    grain = material()
    rigid = material(young=1e25)
    assert effective_young(grain, rigid) == pytest.approx(grain.young / (1.0 - grain.poisson**2))
    shear = grain.young / (2.0 * (1.0 + grain.poisson))
    assert effective_shear(grain, rigid) == pytest.approx(shear / (2.0 - grain.poisson))


def damping_of(between, speed: float) -> float:
    """x = β v^(1/5), β = (γ_n/m_eff)(m_eff/k)^(3/5), γ_n = (3/2) A k."""
    k = 4.0 / 3.0 * between.young_modulus * sqrt(RADIUS)
    return 1.5 * between.dissipative_time * k / MASS * (MASS / k) ** 0.6 * speed**0.2


@pytest.mark.parametrize("scale", [1.0, 0.1, 1e-4])
@pytest.mark.parametrize("loss", [{"restitution": 0.6, "restitution_speed": 2.5}, {"dissipative_time": 3e-6}])
def test_softening_keeps_restitution(scale, loss):
    """Moduli scale; x, and with it every collision's restitution, does not."""
    grain = material(**loss)
    hard, soft = (interface(grain, grain, MASS, RADIUS, s) for s in (1.0, scale))
    assert soft.young_modulus == pytest.approx(scale * hard.young_modulus)
    assert soft.shear_modulus == pytest.approx(scale * hard.shear_modulus)
    for speed in (1e-3, 2.5):
        assert damping_of(soft, speed) == pytest.approx(damping_of(hard, speed), rel=1e-12)
    if "restitution" in loss:
        assert restitution(damping_of(soft, 2.5)) == pytest.approx(0.6, abs=1e-7)
    else:
        assert hard.dissipative_time == 3e-6


def test_a_wall_contact_has_the_walls_friction_and_restitution():
    grain, wall = material(), material(friction=0.7, dissipative_time=5e-6, shear_damping=3.0)
    between = interface(grain, wall, MASS, RADIUS, 1.0)
    assert (between.friction, between.dissipative_time, between.shear_damping) == (0.7, 5e-6, 3.0)


def test_a_scene_takes_the_masses_of_the_mean_grain():
    """Restitution 0.6 is that of two equal grains, and of a grain and a wall, of the mean diameter."""
    grain = material()
    scene = scene_of(np.array([[1e-3, 2e-3]]), box(0.1, 0.1), grain, grain)
    mass = 4.0 / 3.0 * np.pi * 1.5e-3**3 * grain.density
    for between, m_eff, r_eff in zip(scene.grains.interfaces, (mass / 2.0, mass), (0.75e-3, 1.5e-3), strict=True):
        k = 4.0 / 3.0 * between.young_modulus * sqrt(r_eff)
        assert restitution(1.5 * between.dissipative_time * (k / m_eff) ** 0.4) == pytest.approx(0.6, abs=1e-7)


def collision(x: float, ends) -> float:
    """Restitution of ξ̈ = −ξ^(3/2) − x ξ^(1/2) ξ̇ from ξ = 0, ξ̇ = 1 by LSODA, until `ends(ξ, ξ̇)` falls through zero."""

    def end(t, s):
        return ends(*s) if t > 1e-3 else 1.0

    end.terminal, end.direction = True, -1
    path = solve_ivp(
        lambda _, s: [s[1], -sqrt(max(s[0], 0.0)) * (s[0] + x * s[1])],
        (0.0, 1e4),
        [0.0, 1.0],
        "LSODA",
        events=end,
        rtol=1e-10,
        atol=1e-13,
    )
    return -path.y_events[0][0][1]


def test_restitution_where_contact_ends_with_the_force():
    """0.394 at x = 1, where the force ends; 0.331, where the overlap ends, is the other convention's."""
    assert restitution(1.0) == pytest.approx(0.394, abs=5e-4)
    assert collision(1.0, lambda overlap, _: overlap - 1e-9) == pytest.approx(0.331, abs=1e-3)
    for x in (0.03, 0.3, 1.0, 3.0, 10.0):
        assert restitution(x) == pytest.approx(collision(x, lambda overlap, rate, x=x: overlap + x * rate), rel=1e-6)


def test_restitution_limits():
    """No loss without damping, 1 − C₁x for a little (C₁ = 1.153449, Ramírez et al. 1999), and falling throughout."""
    assert restitution(0.0) == pytest.approx(1.0, abs=1e-8)
    assert (1.0 - restitution(1e-3)) / 1e-3 == pytest.approx(1.153449, rel=2e-3)
    values = [restitution(x) for x in (0.0, 0.01, 0.1, 0.5, 1.0, 2.0, 5.0, 20.0, 60.0)]
    assert np.all(np.diff(values) < 0.0)
    assert 0.0 < values[-1] < 0.01


@pytest.mark.parametrize("e", [0.02, 0.1, 0.394, 0.6, 0.9, 0.99, 0.9999])
@pytest.mark.parametrize("speed", [0.01, 5.0])
def test_dissipative_time_gives_the_requested_restitution(e, speed):
    k = 3e6
    time = dissipative_time_for(e, speed, k, MASS)
    assert restitution(1.5 * time * (k / MASS) ** 0.4 * speed**0.2) == pytest.approx(e, abs=1e-7)


def test_restitution_up_to_one_is_possible():
    """Very little loss is a very small dissipative time, and none is none."""
    k = 3e6
    assert dissipative_time_for(1.0, 1.0, k, MASS) == 0.0
    times = [dissipative_time_for(e, 1.0, k, MASS) for e in (0.9999, 0.999999, 0.99999999, 1.0)]
    assert np.all(np.diff(times) < 0.0)


def test_impossible_restitution_is_out_of_the_range_given():
    """Whoever reads materials from people checks them against the field's own range."""
    _, *markers = get_args(get_type_hints(Material, include_extras=True)["restitution"])
    assert Interval(gt=0, le=1) in markers
