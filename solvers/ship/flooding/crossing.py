"""Cross-flooding: how long a duct takes to fill the room on the other side (IMO resolution MSC.362(92)).

    T = (2 W_f)/(S F √(2 g H_0)) (1 − √(h_f/H_0))/(1 − h_f/H_0)

W_f is the volume that fills the room, S the area of the duct, H_0 the head when it begins and h_f that when it ends,
F = 1/√Σk ≤ 1 how much friction slows the flow, k its coefficients. It is the integral of dW/dt = S F √(2 g H) with a
head H that falls evenly with W. From a heel on the way, with W and H left there in place of W_f and H_0, it is the
time that is left.

Several devices that the same flow passes: Σk = k_1 + k_2 (S_1/S_2)² (W_2/W_1)² + …, W the volume through each.
Devices side by side to one room: S F = Σ S_i F_i.

Limits: water alone; the air of the room must leave it freely. It must end within 10 min (SOLAS II-1/7-2).
Units: m, m³, s.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

LONGEST = 600.0  # s
ENDED = 1e-10  # of the first head: a head that counts as none
OUTLET = 1.0  # k of the outlet of a row of girders, added once
SHORT, LONG = 1.0, 4.0  # m, between girders
ONE_MANHOLE = (0.2748, 0.0313), (-0.0986, 0.6873, -1.0212, 0.7386), 1.34
TWO_MANHOLES = (0.4045, 0.0627), (0.0424, -0.3593, 1.1401, -0.356), 1.17


@dataclass(frozen=True)
class Device:
    """A duct, pipe or valve: area (m²), Σk, and the volume (m³) through it over that through the first one."""

    area: float
    friction: float
    volume: float = 1.0

    @property
    def factor(self) -> float:
        """F = 1/√Σk, at most 1."""
        return slowing(self.friction)


def slowing(friction: float) -> float:
    """F = 1/√Σk, at most 1 (MSC.362(92), 2.4)."""
    return min(1.0, 1.0 / np.sqrt(friction)) if friction > 0.0 else 1.0


def in_series(devices: Sequence[Device]) -> Device:
    """One device with the area of the first that slows as all of them do, one behind the other (2.5 and 2.6)."""
    first = devices[0]
    return Device(first.area, sum(one.friction * (first.area / one.area * one.volume) ** 2 for one in devices))


def side_by_side(devices: Sequence[Device]) -> float:
    """S F (m²) of devices that lead to one room (2.7)."""
    return sum(one.area * one.factor for one in devices)


def girders(length: float, manholes: int = 1) -> float:
    """k of the space between two girders of a double bottom, `length` (m) apart, with one or two manholes (appendix 2).

    For a row of them the k of the spaces are added, and OUTLET once.
    """
    short, middle, beyond = ONE_MANHOLE if manholes == 1 else TWO_MANHOLES
    if length > LONG:
        return beyond
    return float(np.polyval(short if length < SHORT else middle, length))


def time_needed(volume: float, effective: float, head: float, last: float, gravity: float = 9.81) -> float:
    """Time (s) in which a volume (m³) passes S F (m²), `effective`, while the head falls from one to another (m)."""
    left = last / head
    return float(2.0 * volume / (effective * np.sqrt(2.0 * gravity * head)) / (1.0 + np.sqrt(left)))


def time_by_steps(volume: float, effective: float, head: float, last: float, gravity: float = 9.81) -> float:
    """The same by integrating dW/dt = S F √(2 g H), H = H_0 − (H_0 − h_f) W/W_f, in time."""
    from scipy.integrate import solve_ivp  # slow to import

    def left(passed: float) -> float:
        return head - (head - last) * passed / volume

    def rate(_time: float, passed: np.ndarray) -> np.ndarray:
        return effective * np.sqrt(2.0 * gravity * np.maximum(left(passed), 0.0))

    def ended(_time: float, passed: np.ndarray) -> float:
        return float(left(passed[0]) - max(last, ENDED * head))

    ended.terminal = True
    longest = 10.0 * time_needed(volume, effective, head, last, gravity)
    found = solve_ivp(rate, (0.0, longest), [0.0], "DOP853", rtol=1e-10, atol=1e-12 * volume, events=ended)
    return float(found.t_events[0][0])
