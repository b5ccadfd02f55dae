"""Contact laws under prescribed overlaps, slips and rotations: the resulting forces and work."""

from functools import cache
from itertools import pairwise
from math import pi

import numpy as np
import pytest
import taichi as ti
from scipy.special import beta

from solvers.grains.laws import COHESION, NORMAL, ROLLING, TANGENTIAL
from solvers.grains.laws.chosen import PAIR, ChosenLaws
from solvers.grains.laws.splitting import NETWORK
from solvers.grains.materials import hertz_stiffness, interface
from solvers.grains.restitution import CONSTANT, FIRST_ORDER, VISCOELASTIC, damping_for, restitution
from solvers.machine import runtime
from solvers.machine.quantity import PLANE, SPACE
from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.space.impact import linear_restitution
from solvers.space.tangent import NO_WAY
from tests.oracles.axes import axes
from tests.oracles.scenes import material

pytestmark = pytest.mark.usefixtures("one_start")

RADIUS = 7.5e-4  # m, effective
MASS = 4 / 3 * pi * (2 * RADIUS) ** 3 * 1319.0 / 2
DT = 4e-7
DEEP = 1e-5  # m
APART = -1e-3  # m, the second lane's overlap
ALONG, ACROSS = (0.6, 0.0, -0.8), (0.8, 0.0, 0.6)  # in space
GRAIN = material(friction=0.4, rolling_friction=0.2)
BETWEEN = interface(GRAIN, GRAIN, MASS, RADIUS, 1.0)


@ti.data_oriented
class Driven:
    """One listed contact of two lanes, only the first of which touches, moved by hand."""

    lanes = 2

    def __init__(
        self, normal="hertz-viscoelastic", tangential="none", rolling="none", between=BETWEEN, dimensions=PLANE
    ):
        runtime.initialise(1)
        self.along, self.across = (ALONG, ACROSS) if dimensions > PLANE else ((1.0,), (0.0,))
        self.arrays = arrays = State()
        laws = NORMAL[normal](), TANGENTIAL[tangential](), ROLLING[rolling](), COHESION["none"]()
        self.laws = ChosenLaws(arrays, Units(1, 1, 1, 1), *laws, [(between, between)], axes=dimensions)
        (self.stiffness,) = arrays.vectors(axes(1, 1, self.lanes), "stiffness")
        self.constants = arrays.vectors(axes(1, 1, self.lanes), *self.laws.constants)
        self.memory = arrays.vectors(axes(1, 1, self.lanes), *self.laws.memory)
        names = *self.laws.constants, *self.laws.memory
        assert len(set(names)) == len(names)
        constants = dict(zip(self.laws.constants, self.constants, strict=True))
        for name, field in (constants | self.laws.by_name(self.memory)).items():
            setattr(self, name, field)
        self.memories = len(self.memory)
        arrays.finish()
        for law in self.laws.laws:
            law.network = NETWORK[PLANE]  # what a step splits is not what is compared here
        self.laws.learn([(between, between)])
        self.stiffness.fill(hertz_stiffness(between.young_modulus, RADIUS))

    def move(self, overlap, slip=0.0, turning=0.0, dt=DT):
        """Forces and torque (T, 3) of lane 0 and its elastic energy (T,) along overlaps (T,) m; memory is cleared.

        In space what is across the normal, or about it, has the direction ALONG, and none of it may be ACROSS.
        """
        overlap = np.asarray(overlap, dtype=float)
        rate = np.gradient(overlap, dt)
        path = np.stack([overlap, rate, *(np.broadcast_to(x, overlap.shape) for x in (slip, turning))], axis=-1)
        result = np.zeros((len(path), 8))
        for field in self.memory:
            field.fill(0.0)
        self._prepare(dt)
        self._move(np.ascontiguousarray(path), result, dt)
        assert np.all(result[:, 4:6] == 0.0)  # the lane that does not touch
        assert np.all(np.abs(result[:, 6:]) <= 1e-12 * np.abs(result[:, 1:3]).max(axis=0))
        return result[:, :3], result[:, 3]

    @ti.kernel
    def _prepare(self, dt: ti.f64):
        for lane in range(self.lanes):
            self.laws.prepare(PAIR, self, 0, 0, lane, MASS, RADIUS, dt)

    @ti.kernel
    def _move(self, path: ti.types.ndarray(), result: ti.types.ndarray(), dt: ti.f64):
        for _ in range(1):
            for k in range(path.shape[0]):
                first = ti.Vector([1.0, 0.0])
                approach, rate = path[k, 0] * first + APART * (1.0 - first), path[k, 1] + 0.0 * first
                slip = [path[k, 2] * one + 0.0 * first for one in ti.static(self.along)]
                turning = [path[k, 3] * one + 0.0 * first for one in ti.static(self.along)]
                fn, ft, torque = self.laws.forces(PAIR, self, 0, 0, approach, rate, slip, turning, NO_WAY, dt)
                result[k, 0] = fn[0]
                for n in ti.static(range(len(self.along))):
                    result[k, 1] += ft[n][0] * self.along[n]
                    result[k, 2] += torque[n][0] * self.along[n]
                    result[k, 6] += ft[n][0] * self.across[n]
                    result[k, 7] += torque[n][0] * self.across[n]
                if path[k, 0] > 0.0:
                    result[k, 3] = self.laws.energy(PAIR, self, 0, 0, path[k, 0])
                result[k, 4] = ti.abs(fn[1])
                for n in ti.static(range(len(self.along))):
                    result[k, 4] += ti.abs(ft[n][1]) + ti.abs(torque[n][1])
                for m in ti.static(range(self.memories)):
                    result[k, 5] += ti.abs(self.memory[m][0, 0][1])


@pytest.fixture(scope="module")
def driven():
    """Makes contacts of some laws, each once; their arrays are freed in the end."""
    made = cache(Driven)
    known = []

    def make(*laws, **others):
        known.append(made(*laws, **others))
        return known[-1]

    yield make
    for contact in set(known):
        contact.arrays.release()


def slowly(*corners, steps=2000):
    """A path through the corners, so slow that dashpots hardly count."""
    return np.concatenate([np.linspace(a, b, steps) for a, b in pairwise(corners)])


@pytest.mark.parametrize("law", NORMAL)
def test_grains_only_push(driven, law):
    """However fast they part, and at once when they touch; nothing before."""
    contact = driven(law)
    force, energy = contact.move(np.concatenate([[0.0], DEEP * np.abs(np.sin(np.linspace(0.01, 9.0, 400)))]))
    assert np.all(force[:, 0] >= 0.0) and force[:, 0].max() > 0.0
    assert np.all(energy >= 0.0)


@pytest.mark.parametrize("begins", [0.0, 0.3, 0.5, 0.8])
@pytest.mark.parametrize("law, power", [("hertz-viscoelastic", 1.5), ("hertz-dashpot", 1.0)])
def test_a_damper_gives_its_whole_impulse_wherever_in_a_step_a_contact_begins(driven, law, power, begins):
    """Sum of F Δt less the spring's is γ ∫ ξ^(power − 1) dξ from first touch, along a straight path; no error in Δt."""
    contact, k = driven(law), hertz_stiffness(BETWEEN.young_modulus, RADIUS)
    speed, steps, dt = 1e-2, 30, 1e-8  # so small that the lag of Verlet's prediction does not count
    overlap = speed * dt * (np.arange(-3, steps) - begins)
    force, _ = contact.move(overlap, dt=dt)
    found = dt * np.sum(force[:, 0] - k * np.maximum(overlap, 0.0) ** 1.5)
    damper = contact.laws.tables[0].to_numpy()[0, PAIR, 0]
    damper *= k if power == 1.5 else k**0.4 * MASS**0.6
    assert found == pytest.approx(damper / power * (overlap[-1] + 0.5 * speed * dt) ** power, rel=1e-6, abs=0.0)


@pytest.mark.parametrize("law", NORMAL)
def test_slow_unloading_returns_the_stored_energy(driven, law):
    """Work done on the contact is elastic energy or lost; nothing is made, and an elastic law returns all of it."""
    contact = driven(law, between=interface(material(restitution=0.5), material(restitution=0.5), MASS, RADIUS, 1.0))
    overlap = slowly(0.0, DEEP, 0.3 * DEEP, 0.8 * DEEP, 0.0)
    force, energy = contact.move(overlap, dt=1e-2)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:, 0] + force[:-1, 0]) * np.diff(overlap))])
    tolerance = 2e-3 * energy.max()
    assert np.all(np.diff(work - energy) > -1e-2 * tolerance)
    if law == "hysteretic":
        assert work[-1] == pytest.approx(0.75 * work[:2000].max(), rel=5e-3)  # 1 − e² of the virgin loading
    else:
        assert work[-1] == pytest.approx(0.0, abs=tolerance)


def test_hysteretic_loading_unloading_and_reloading(driven):
    """k₁ ξ, then k₂ (ξ − ξ₀) with k₂ = k₁/e² both ways, k₁ ξ again past the old depth; forgotten once apart."""
    contact = driven("hysteretic")
    k = hertz_stiffness(BETWEEN.young_modulus, RADIUS)
    first = MASS / (1.25 * MASS / k) ** 0.8  # as deep as Hertz's at 1 m/s
    force, _ = contact.move(np.array([0.5, 1.0, 0.9, 0.64, 0.3, 0.9, 1.0, 2.0, 0.0, 0.5]) * DEEP)
    plastic = 1.0 - 0.36
    expected = [0.5, 1.0, (0.9 - plastic) / 0.36, 0.0, 0.0, (0.9 - plastic) / 0.36, 1.0, 2.0, 0.0, 0.5]
    assert force[:, 0] == pytest.approx(first * DEEP * np.array(expected), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("dt", [DT, 0.1 * DT])
@pytest.mark.parametrize("law", ["haff-werner", "mindlin", "cundall-strack", "coulomb"])
def test_friction_slides_at_its_cap_whatever_the_step(driven, law, dt):
    """|F_t| ≤ μ F_n always, μ F_n against the slip in the end, and the turn-round is no exception."""
    contact = driven(tangential=law)
    slip = np.repeat([0.1, -0.1, 1e-3], 4000)
    force, _ = contact.move(np.full(12000, DEEP), slip, dt=dt)
    cap = 0.4 * force[:, 0]
    assert np.all(np.abs(force[:, 1]) <= cap * (1 + 1e-12))
    assert force[[3999, 7999], 1] == pytest.approx([-cap[3999], cap[7999]], rel=1e-9)


def test_shear_without_a_cap_and_without_a_force(driven):
    contact = driven(tangential="viscous")
    force, _ = contact.move(np.full(4000, DEEP), 0.5)
    assert force[-1, 1] == pytest.approx(-20.0 * 0.5, rel=1e-6)
    force, _ = driven(tangential="none").move(np.full(10, DEEP), 0.5)
    assert np.all(force[:, 1] == 0.0)


@pytest.mark.parametrize("law", ["mindlin", "cundall-strack"])
def test_no_closed_path_creates_energy(driven, law):
    """Elata and Berryman (1996): load, shear, unload, shear back and reload, in any order, costs work or nothing.

    At fixed shear a cycle of the load alone leaves no more force than there was. The slip stops within a step here,
    which no grain's does; what the spring makes of that has ended 40 steps later.
    """
    contact = driven("hertz", law, between=interface(material(friction=9.0), material(friction=9.0), MASS, RADIUS, 1.0))
    random = np.random.default_rng(5)
    shift = 2e-7
    square = [(0.3, 0.0), (1.0, 0.0), (1.0, 1.0), (0.3, 1.0), (0.3, 0.0)]
    free = [random.uniform([0.1, -1.0], [1.0, 1.0], (6, 2)) for _ in range(6)]
    paths = [square, square[::-1], *([(0.5, 0.0), *path, (0.5, 0.0)] for path in free)]
    for path in paths:
        corners = np.array([*path, *path[1:], *path[1:]]) * [DEEP, shift]
        overlap, place = (slowly(*corners[:, k], steps=400) for k in (0, 1))
        slip = np.gradient(place, 1e-2)  # at the times of the places, as overlaps are
        force, energy = contact.move(overlap, slip, dt=1e-2)
        sheared = -0.5 * (force[1:, 1] + force[:-1, 1]) * np.diff(place)
        stored = energy - 0.4 * hertz_stiffness(BETWEEN.young_modulus, RADIUS) * overlap**2.5
        assert stored.max() > 0.0
        assert np.min(np.cumsum(sheared) - stored[1:]) > -2e-2 * stored.max()
    held = slowly(DEEP, 0.2 * DEEP, DEEP, 0.2 * DEEP, DEEP)
    slip = np.where(np.arange(len(held)) < 50, shift / 50 / 1e-2, 0.0)
    force, _ = contact.move(held, slip, dt=1e-2)
    assert np.all(np.diff(np.abs(force[90:, 1])) <= 1e-12 * np.abs(force[:, 1]).max())


@pytest.mark.parametrize("law", ["constant-torque", "elastic-plastic"])
@pytest.mark.parametrize("dt", [DT, 0.1 * DT])
def test_rolling_torque_is_friction_times_radius(driven, law, dt):
    """|M| ≤ μ_r R_eff F_n always, and against the turning in the end."""
    contact = driven(rolling=law)
    turning = np.repeat([300.0, -300.0], 20000)
    force, _ = contact.move(np.full(40000, DEEP), 0.0, turning, dt=dt)
    cap = 0.2 * RADIUS * force[:, 0]
    assert np.all(np.abs(force[:, 2]) <= cap * (1 + 1e-12))
    assert force[[19999, 39999], 2] == pytest.approx([-cap[0], cap[0]], rel=1e-9)


@pytest.mark.parametrize(
    ("tangential", "rolling"), [(law, "none") for law in TANGENTIAL] + [("none", law) for law in ROLLING]
)
def test_in_space_a_law_is_that_of_the_plane_along_any_line(driven, tangential, rolling):
    """Where all that slips and turns has one direction: sticking, sliding, turning round, under a changing load."""
    overlap = DEEP * (1.0 + 0.3 * np.sin(np.linspace(0.0, 20.0, 3000)))
    slip, turning = np.repeat([[1e-3, -2e-2, 1e-4]] * 2, 1000, axis=1) * [[1.0], [1e3]]
    (plane, stored), (space, stored_in_space) = (
        driven(tangential=tangential, rolling=rolling, dimensions=axes).move(overlap, slip, turning)
        for axes in (PLANE, SPACE)
    )
    assert np.abs(plane[:, 1:]).max() > 0.0 or (tangential, rolling) == ("none", "none")
    assert np.all(np.abs(space - plane) <= 1e-11 * np.abs(plane).max(axis=0))  # 3000 sums with errors of some 1e-16
    np.testing.assert_allclose(stored_in_space, stored, rtol=1e-11, atol=1e-11 * stored.max())


@pytest.mark.parametrize("dimensions", [PLANE, SPACE])
def test_memory_of_what_turns_round_changes_its_sign_when_grains_are_swapped(driven, dimensions):
    """That of ω_i − ω_j does; that of slip in space alone, since in the plane the tangent turns round with it."""
    contact = driven(normal="hysteretic", tangential="mindlin", rolling="elastic-plastic", dimensions=dimensions)
    kept = []
    for sign in (1.0, -1.0):
        contact.move(np.full(20, DEEP), 1e-3 * (sign if dimensions == SPACE else 1.0), sign)
        kept.append([field.to_numpy()[0, 0, 0] for field in contact.memory])
    assert np.count_nonzero(kept[0]) == len(kept[0]) - (dimensions == SPACE) * 3 * ALONG.count(0.0)
    assert kept[1] == pytest.approx(np.where(contact.laws.odd, -1.0, 1.0) * kept[0], rel=1e-12, abs=0.0)


def test_rolling_spring_is_that_of_ai(driven):
    """k_r = 2.25 k_n (μ_r R_eff)², C_r = 2 η_r √(I_r k_r), I_r = (7/5) m R²: before it yields, M = −k_r θ − C_r ω."""
    contact = driven(rolling="elastic-plastic")
    k = hertz_stiffness(BETWEEN.young_modulus, RADIUS)
    spring = 2.25 * MASS / (1.25 * MASS / k) ** 0.8 * (0.2 * RADIUS) ** 2
    dashpot = 2 * 0.3 * np.sqrt(1.4 * MASS * RADIUS**2 * spring)
    turning = 1.0  # rad/s: what it stores can be told from the rounding of the spring's along the normal
    force, energy = contact.move(np.full(20, DEEP), 0.0, turning)
    angle = turning * DT * (np.arange(1, 21) - 0.5)  # at the times of the forces, between which it turns
    assert force[:, 2] == pytest.approx(-spring * angle - dashpot * turning, rel=1e-9, abs=0.0)
    wound = angle + 0.5 * turning * DT  # the spring is kept half a step ahead
    assert np.diff(energy) == pytest.approx(0.5 * spring * np.diff(wound**2), rel=1e-4, abs=0.0)


def test_restitution_of_a_linear_contact():
    """The three branches of Schwager and Pöschel (2007), β = ζ ω₀, written as they write them, meet and agree."""
    for ratio in (0.05, 0.5, 0.7):
        decay, omega = ratio, np.sqrt(1 - ratio**2)
        published = np.exp(-decay / omega * (pi - np.arctan(2 * decay * omega / (omega**2 - decay**2))))
        assert linear_restitution(ratio) == pytest.approx(published, rel=1e-12)
    decay, omega = 0.9, np.sqrt(1 - 0.81)
    published = np.exp(-decay / omega * np.arctan(2 * decay * omega / (decay**2 - omega**2)))
    assert linear_restitution(0.9) == pytest.approx(published, rel=1e-12)
    decay, omega = 2.0, np.sqrt(3.0)
    published = np.exp(-decay / omega * np.log((decay + omega) / (decay - omega)))
    assert linear_restitution(2.0) == pytest.approx(published, rel=1e-12, abs=0.0)
    assert linear_restitution(1.0) == pytest.approx(linear_restitution(1.0 - 1e-9), rel=1e-6)


@pytest.mark.parametrize("power", [VISCOELASTIC, CONSTANT])
def test_damping_and_restitution_are_inverse_functions(power):
    for e in (0.05, 0.5, 0.95):
        assert restitution(damping_for(e, power), power) == pytest.approx(e, abs=1e-7)
    q = 0.4 * (power + 1)
    assert pytest.approx(2 * 1.25**q * beta(q, 1.5) / 2.5, rel=1e-5) == FIRST_ORDER[power]
    assert (1.0 - restitution(1e-4, power)) / 1e-4 == pytest.approx(FIRST_ORDER[power], rel=2e-3)


def test_restitution_and_dissipative_time_follow_from_each_other():
    """Given one, an interface has the other, at any stiffness scale."""
    given = interface(material(restitution=0.7), material(restitution=0.7), MASS, RADIUS, 1.0)
    timed = material(dissipative_time=given.dissipative_time)
    for scale in (1.0, 1e-3):
        assert interface(timed, timed, MASS, RADIUS, scale).restitution == pytest.approx(0.7, abs=1e-6)
    lossless = material(dissipative_time=0.0)
    assert interface(lossless, lossless, MASS, RADIUS, 1.0).restitution == pytest.approx(1.0, abs=1e-7)
