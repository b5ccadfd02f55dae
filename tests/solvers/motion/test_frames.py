"""The tank's frame gives the same physics as the earth's: held at an angle, in motion, for a grain in flight."""

from dataclasses import dataclass, replace
from math import pi

import numpy as np
import pytest

from solvers.grains.bed.filling import radii, start_positions
from solvers.motion import Heave, Roll, Sway
from tests.oracles.scenes import box, material, simulation

GRAVITY = 9.81


def rotation(angle: float) -> np.ndarray:
    """The matrix R(φ) that turns counter-clockwise."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


@dataclass(frozen=True)
class Deck:
    """Roll about a distant centre, then sway and heave; independent of the solver's motions."""

    roll: tuple[float, float, float] = (0.2, 2.0, 0.5)  # amplitude (rad, m), frequency (Hz), phase
    sway: tuple[float, float, float] = (0.01, 4.0, -0.8)
    heave: tuple[float, float, float] = (0.008, 5.0, 1.2)
    centre: tuple[float, float] = (0.4, -0.5)

    def motions(self) -> list:
        return [Roll(*self.roll, self.centre), Sway(*self.sway), Heave(*self.heave)]

    def pose(self, t: float) -> tuple[np.ndarray, float, np.ndarray, float]:
        """Position (2,) of the tank's origin, its angle, and the velocities of both."""
        values, rates = [], []
        for amplitude, frequency, phase in (self.roll, self.sway, self.heave):
            values.append(amplitude * np.sin(2 * pi * frequency * t + phase))
            rates.append(amplitude * 2 * pi * frequency * np.cos(2 * pi * frequency * t + phase))
        arm = rotation(values[0]) @ -np.array(self.centre)
        origin = np.array(self.centre) + arm + values[1:]
        return origin, values[0], rates[0] * np.array([-arm[1], arm[0]]) + rates[1:], rates[0]

    def carried(self, t: float, point: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position and velocity in the earth frame of tank points (n, 2) that move in the tank with `velocity`."""
        origin, angle, speed, rate = self.pose(t)
        arm = point @ rotation(angle).T
        return origin + arm, speed + rate * np.column_stack([-arm[:, 1], arm[:, 0]]) + velocity @ rotation(angle).T

    def in_tank(self, t: float, point: np.ndarray) -> np.ndarray:
        """Tank coordinates of earth points (n, 2)."""
        origin, angle, _, _ = self.pose(t)
        return (point - origin) @ rotation(angle)


@dataclass
class Inertial:
    """The same grains in the earth frame between moving walls: plain arrays, every pair looked at, velocity Verlet.

    The tank is a box of `width` and `height` (m) carried by the deck. All materials are elastic solids of one modulus
    E* (Pa) between grains and one at walls; `friction`, `dissipative` (s) and `shear` (N s/m) are (grain, wall).
    """

    radius: np.ndarray
    density: float
    young: tuple[float, float]
    friction: tuple[float, float]
    dissipative: tuple[float, float]
    shear: tuple[float, float]
    width: float
    height: float
    deck: Deck

    def __post_init__(self):
        self.mass = 4 / 3 * pi * self.radius**3 * self.density
        self.inertia = 0.4 * self.mass * self.radius**2
        self.one, self.other = np.triu_indices(len(self.radius), 1)

    def contact(self, kind: int, size, overlap, rate, slip):
        """Normal and tangential force (N) of the viscoelastic Hertz law and of a Coulomb-capped damper."""
        root = np.sqrt(np.maximum(overlap, 0.0))
        stiffness = 4 / 3 * self.young[kind] * np.sqrt(size)
        normal = stiffness * (root * np.maximum(overlap, 0.0) + 1.5 * self.dissipative[kind] * root * rate)
        normal = np.where(overlap > 0, np.maximum(normal, 0.0), 0.0)
        cap = self.friction[kind] * normal
        return normal, -np.clip(self.shear[kind] * slip, -cap, cap)

    def accelerations(self, t, x, v, spin):
        """Accelerations (n, 2) m/s² and of the spins (n,) rad/s²."""
        force, torque = np.zeros_like(x), np.zeros_like(spin)

        i, j = self.one, self.other
        apart = x[i] - x[j]
        distance = np.hypot(*apart.T)
        normal = apart / distance[:, None]
        overlap = self.radius[i] + self.radius[j] - distance
        both = self.radius[i] + self.radius[j]
        lever_i = self.radius[i] - overlap * self.radius[j] / both
        lever_j = self.radius[j] - overlap * self.radius[i] / both
        tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
        relative = v[i] - v[j]
        slip = (relative * tangent).sum(1) - lever_i * spin[i] - lever_j * spin[j]
        size = self.radius[i] * self.radius[j] / (self.radius[i] + self.radius[j])
        pressing, shearing = self.contact(0, size, overlap, -(relative * normal).sum(1), slip)
        pushed = pressing[:, None] * normal + shearing[:, None] * tangent
        for grain, share, lever in ((i, pushed, lever_i), (j, -pushed, lever_j)):
            np.add.at(force, grain, share)
            np.add.at(torque, grain, -lever * shearing)

        # Floor, lid and sides at once, (n, 4): a point of each and its normal into the tank.
        origin, angle, speed, rate = self.deck.pose(t)
        half, turn = self.width / 2, rotation(angle).T
        at = np.array([[0.0, 0.0], [0.0, self.height], [-half, 0.0], [half, 0.0]]) @ turn
        normal = np.array([[0.0, 1.0], [0.0, -1.0], [1.0, 0.0], [-1.0, 0.0]]) @ turn
        tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
        overlap = self.radius[:, None] - ((x - origin) @ normal.T - (at * normal).sum(1))
        lever = self.radius[:, None] - overlap / 2
        arm = (x - origin)[:, None, :] - lever[:, :, None] * normal
        relative = (v - speed)[:, None, :] - rate * np.stack([-arm[..., 1], arm[..., 0]], axis=-1)
        slip = (relative * tangent).sum(2) - lever * spin[:, None]
        pressing, shearing = self.contact(1, self.radius[:, None], overlap, -(relative * normal).sum(2), slip)
        force += pressing @ normal + shearing @ tangent
        torque -= (lever * shearing).sum(1)
        return force / self.mass[:, None] - np.array([0.0, GRAVITY]), torque / self.inertia

    def run(self, start: np.ndarray, dt: float, steps: int) -> tuple[np.ndarray, ...]:
        """Positions, velocities (earth frame), spins and angles after `steps`, from rest in the tank at t = 0."""
        x, v = self.deck.carried(0.0, start, np.zeros_like(start))
        spin, angle = np.full(len(x), self.deck.pose(0.0)[3]), np.full(len(x), self.deck.pose(0.0)[1])
        a, turn = self.accelerations(0.0, x, v, spin)
        for k in range(1, steps + 1):
            middle, spin_middle = v + dt / 2 * a, spin + dt / 2 * turn
            x, angle = x + dt * middle, angle + dt * spin_middle
            a, turn = self.accelerations(k * dt, x, middle + dt / 2 * a, spin_middle + dt / 2 * turn)
            v, spin = middle + dt / 2 * a, spin_middle + dt / 2 * turn
        return x, v, spin, angle


@pytest.mark.slow
def test_a_moving_tank_equals_a_box_of_moving_walls():
    random, outline, deck = np.random.default_rng(8), box(0.02, 0.03), Deck()
    radius = radii(20, 3e-3, 0.1, random)
    start = start_positions(radius, outline, random)
    # Shear dampings below 0.2 m_t/Δt, so that the solver integrates the friction law as it is written.
    grain = material(young=3.2e6, friction=0.3, dissipative_time=2e-4, shear_damping=0.015)
    wall = material(young=5e6, poisson=0.1, friction=0.5, dissipative_time=1e-4, shear_damping=0.03)
    plane_grain, plane_wall = (1 - 0.28**2) / 3.2e6, (1 - 0.1**2) / 5e6
    young = 1 / (2 * plane_grain), 1 / (plane_grain + plane_wall)
    inertial = Inertial(radius, grain.density, young, (0.3, 0.5), (2e-4, 1e-4), (0.015, 0.03), 0.02, 0.03, deck)
    time, errors = 0.02, []
    x, v, spin, angle = inertial.run(start, 1e-6, round(time / 1e-6))
    for dt in (1e-5, 2.5e-6):
        made = simulation(start[None], radius, outline, grain, wall, motions=[deck.motions()], step=dt)
        made.advance(round(time / dt))
        found = {name: value[0] for name, value in made.snapshot().items()}
        made.close()
        earth_x, earth_v = deck.carried(time, found["position"], found["velocity"])
        _, turned, _, rate = deck.pose(time)
        pairs = (earth_x, x), (earth_v, v), (found["angle"] + turned, angle), (found["spin"] + rate, spin)
        errors.append([np.abs(one - other).max() for one, other in pairs])
    assert np.linalg.norm(found["position"] - start, axis=1).min() > 1e-3
    assert np.abs(found["angle"]).max() > 0.5, "grains that do not touch do not turn"
    # Of second order, though not by the same scheme: forces are means over a kick. A quarter of the step, a sixteenth.
    assert np.all(np.array(errors[1]) < [1e-7, 3e-5, 5e-5, 2e-2])
    assert np.all(np.array(errors[1]) < 0.2 * np.array(errors[0]))


def test_free_flight_is_a_parabola_in_the_earth_frame():
    """Under the gravity that the scene was made with, and under another one that it is altered to."""
    decks = [Deck(), Deck(roll=(0.6, 1.0, 0.0)), Deck(roll=(0.4, 1.5, 2.0), sway=(0.05, 1.0, 0.3))]
    start = np.array([[[0.0, 1.0]], [[0.2, 1.3]], [[-0.3, 0.9]]])
    velocity = np.array([[[0.8, 1.0]], [[-1.0, 0.5]], [[0.0, 0.0]]])
    spin, time, dt = np.array([[0.0], [7.0], [-3.0]]), 0.2, 2e-5
    made = simulation(
        start, [1e-2], box(2.0, 2.0), velocity=velocity, spin=spin, motions=[deck.motions() for deck in decks], step=dt
    )
    for gravity in (GRAVITY, 1.62):
        made.alter(replace(made.scene, gravity=gravity))
        made.start_clock()
        made.place(start, velocity, spin)
        made.advance(round(time / dt))
        found = made.snapshot()
        for w, deck in enumerate(decks):
            x, v = deck.carried(0.0, start[w], velocity[w])
            _, turned, _, rate = deck.pose(0.0)
            angle, spun = turned + (spin[w] + rate) * time, spin[w] + rate
            weight = np.array([0.0, -gravity])
            x, v = x + v * time + 0.5 * weight * time**2, v + weight * time
            earth_x, earth_v = deck.carried(time, found["position"][w], found["velocity"][w])
            _, turned, _, rate = deck.pose(time)
            # Ten times what the second-order scheme leaves at this step.
            assert np.allclose(earth_x, x, rtol=0, atol=1e-7)
            assert np.allclose(earth_v, v, rtol=0, atol=1e-6)
            assert np.allclose(found["angle"][w] + turned, angle, rtol=0, atol=3e-8)
            assert np.allclose(found["spin"][w] + rate, spun, rtol=0, atol=5e-7)
    made.close()
