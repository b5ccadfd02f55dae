"""Harmonic motions, q(t) = D(t/T) A sin(2πft + phase), with the soft start D of the thesis."""

from dataclasses import dataclass
from math import pi
from typing import Annotated

import taichi as ti

from solvers.machine.marks import Doc, Interval, Unit, Usual

STEEPEST = 2.171  # largest slope of the transition function D(τ)


@ti.func
def soft_start(t, length):
    """Transition function D(τ) = exp(1 − 1/(1 − (τ − 1)²)), τ = t/T in (0, 1) (Spandonidis 2016, eq. F.1).

    Returns D and its first two time derivatives; D = 1 after the start, and at once if the length T is zero.
    """
    value, first, second = 1.0, 0.0, 0.0
    if t < length:
        tau = t / length
        q = tau * (2.0 - tau)  # 1 − (τ − 1)²
        value = 0.0
        if q > 2e-3:  # for smaller q, exp(−1/q) and its derivatives underflow
            value = ti.exp(1.0 - 1.0 / q)
            slope = 2.0 * (1.0 - tau) / (q * q)
            first = value * slope / length
            bend = slope * slope - 2.0 / (q * q) - 8.0 * (1.0 - tau) ** 2 / (q * q * q)
            second = value * bend / (length * length)
    return ti.Vector([value, first, second])


@ti.func
def harmonic(table: ti.template(), w, first, t):
    """Displacement, velocity and acceleration at time t of D(t) A sin(ωt + phase); at rest before t = 0."""
    amplitude, omega = table[w, first], table[w, first + 1]
    phase, length = table[w, first + 2], table[w, first + 3]
    displacement, velocity, acceleration = 0.0, 0.0, 0.0
    if t >= 0.0:
        d = soft_start(t, length)
        s = ti.sin(omega * t + phase)
        c = omega * ti.cos(omega * t + phase)
        displacement = amplitude * d[0] * s
        velocity = amplitude * (d[1] * s + d[0] * c)
        acceleration = amplitude * (d[2] * s + 2.0 * d[1] * c - d[0] * omega * omega * s)
    return ti.Vector([displacement, velocity, acceleration])


class Harmonic:
    """Common base of all harmonic motions."""

    state = staticmethod(harmonic)

    def duration(self) -> float:
        """Zero: a harmonic motion has no end of its own."""
        return 0.0

    def parameters(self, soft_start: float) -> list[float]:
        """The kernel's table: amplitude, angular frequency, phase, length of the soft start (s)."""
        return [self.amplitude, 2 * pi * self.frequency, self.phase, soft_start]

    def fastest(self, soft_start: float) -> float:
        """Upper bound on the speed (m/s or rad/s): Aω plus the contribution of the soft start."""
        return self.amplitude * (2 * pi * self.frequency + (STEEPEST / soft_start if soft_start else 0.0))


@dataclass(frozen=True)
class Sway(Harmonic):
    """y = D(t/T) A sin(2π f t + ε) (Spandonidis 2016, appendix F): harmonic sideways motion of the tank.

    D is the soft start (`soft_start`) of the length T, A the `amplitude`, f the `frequency`, ε the `phase`.

    Limits: none; the motion is prescribed, and the cargo does not act back on it.

    Units: y and A m, f Hz, ε rad, t and T s.
    """

    amplitude: Annotated[float, Unit("m"), Interval(gt=0), Usual(0.0, 0.1, "mm"), Doc("Half the way to and fro.")]
    frequency: Annotated[float, Unit("Hz"), Interval(gt=0), Usual(0.1, 4.0, "Hz"), Doc("Periods a second.")]
    phase: Annotated[float, Unit("rad"), Doc("Phase at the start; 0 starts from the middle.")] = 0.0

    coordinate = "y"


@dataclass(frozen=True)
class Heave(Harmonic):
    """z = D(t/T) A sin(2π f t + ε) (Spandonidis 2016, appendix F): harmonic vertical motion of the tank.

    D is the soft start (`soft_start`) of the length T, A the `amplitude`, f the `frequency`, ε the `phase`.

    Limits: none; the motion is prescribed, and the cargo does not act back on it.

    Units: z and A m, f Hz, ε rad, t and T s.
    """

    amplitude: Annotated[float, Unit("m"), Interval(gt=0), Usual(0.0, 0.1, "mm"), Doc("Half the way to and fro.")]
    frequency: Annotated[float, Unit("Hz"), Interval(gt=0), Usual(0.1, 4.0, "Hz"), Doc("Periods a second.")]
    phase: Annotated[float, Unit("rad"), Doc("Phase at the start; 0 starts from the middle.")] = 0.0

    coordinate = "z"


@dataclass(frozen=True)
class Surge(Harmonic):
    """x = D(t/T) A sin(2π f t + ε) (Spandonidis 2016, appendix F): harmonic motion of a tank in space along x, astern.

    D is the soft start (`soft_start`) of the length T, A the `amplitude`, f the `frequency`, ε the `phase`.

    Limits: none; the motion is prescribed, and the cargo does not act back on it.

    Units: x and A m, f Hz, ε rad, t and T s.
    """

    amplitude: Annotated[float, Unit("m"), Interval(gt=0), Usual(0.0, 0.1, "mm"), Doc("Half the way to and fro.")]
    frequency: Annotated[float, Unit("Hz"), Interval(gt=0), Usual(0.1, 4.0, "Hz"), Doc("Periods a second.")]
    phase: Annotated[float, Unit("rad"), Doc("Phase at the start; 0 starts from the middle.")] = 0.0

    coordinate = "x"


@dataclass(frozen=True)
class Roll(Harmonic):
    """φ = D(t/T) A sin(2π f t + ε) (Spandonidis 2016, appendix F): harmonic turning of the tank about a fixed point.

    D is the soft start (`soft_start`) of the length T, A the `amplitude`, f the `frequency`, ε the `phase`.

    Limits: none; the motion is prescribed, and the cargo does not act back on it.

    Units: φ and A rad, f Hz, ε rad, t and T s.
    """

    amplitude: Annotated[float, Unit("rad"), Interval(gt=0), Usual(0.0, pi / 4, "deg"), Doc("Largest angle.")]
    frequency: Annotated[float, Unit("Hz"), Interval(gt=0), Usual(0.1, 3.0, "Hz"), Doc("Periods a second.")]
    phase: Annotated[float, Unit("rad"), Doc("Phase at the start; 0 starts from the middle.")] = 0.0
    centre: Annotated[tuple[float, float], Unit("m"), Doc("The fixed point, y and z, about which the tank turns.")] = (
        0.0,
        0.0,
    )

    coordinate = "turn"


@dataclass(frozen=True)
class Pitch(Harmonic):
    """θ = D(t/T) A sin(2π f t + ε) (Spandonidis 2016, appendix F): turning of a tank in space about y, bow up.

    The axis goes through a fixed point. D is the soft start (`soft_start`) of the length T, A the `amplitude`, f the
    `frequency`, ε the `phase`.

    Limits: none; the motion is prescribed, and the cargo does not act back on it.

    Units: θ and A rad, f Hz, ε rad, t and T s.
    """

    amplitude: Annotated[float, Unit("rad"), Interval(gt=0), Usual(0.0, pi / 4, "deg"), Doc("Largest angle.")]
    frequency: Annotated[float, Unit("Hz"), Interval(gt=0), Usual(0.1, 3.0, "Hz"), Doc("Periods a second.")]
    phase: Annotated[float, Unit("rad"), Doc("Phase at the start; 0 starts from the middle.")] = 0.0
    centre: Annotated[tuple[float, float], Unit("m"), Doc("The fixed point, z and x, about which the tank turns.")] = (
        0.0,
        0.0,
    )

    coordinate = "pitch"


@dataclass(frozen=True)
class Yaw(Harmonic):
    """ψ = D(t/T) A sin(2π f t + ε) (Spandonidis 2016, appendix F): turning of a tank in space about z, bow to port.

    The axis goes through a fixed point. D is the soft start (`soft_start`) of the length T, A the `amplitude`, f the
    `frequency`, ε the `phase`.

    Limits: none; the motion is prescribed, and the cargo does not act back on it.

    Units: ψ and A rad, f Hz, ε rad, t and T s.
    """

    amplitude: Annotated[float, Unit("rad"), Interval(gt=0), Usual(0.0, pi / 4, "deg"), Doc("Largest angle.")]
    frequency: Annotated[float, Unit("Hz"), Interval(gt=0), Usual(0.1, 3.0, "Hz"), Doc("Periods a second.")]
    phase: Annotated[float, Unit("rad"), Doc("Phase at the start; 0 starts from the middle.")] = 0.0
    centre: Annotated[tuple[float, float], Unit("m"), Doc("The fixed point, y and x, about which the tank turns.")] = (
        0.0,
        0.0,
    )

    coordinate = "yaw"
