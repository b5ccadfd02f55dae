"""Numbers of the report on water in ships: an order of convergence, the tuning of an anti-roll tank."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.measures.sea_response import Transfer
from lab.preset.find import load
from lab.studies.reproduce.ships import coupled
from lab.studies.reproduce.ships.breaking import has_air_below
from lab.studies.reproduce.ships.coupled import limit_and_order
from lab.studies.reproduce.ships.four_ways import swings
from lab.studies.reproduce.ships.tuning import Swing, closed_form, tuned


def test_limit_and_order_of_a_made_convergence():
    spacing = np.array([19.0, 13.4, 8.9])
    assert limit_and_order(spacing, 2.7 - 4e-3 * spacing**1.5) == pytest.approx((2.7, 1.5), rel=1e-6)


def test_a_tanks_tuning_and_damping_are_found_before_it_is_settled():
    """Moments of ẍ + 2 ζ ω ẋ + ω² x = ω² φ by the Runge–Kutta method, driven from rest at two frequencies."""
    own, damping, time, swings = 0.74, 0.03, np.arange(0.0, 60.0, 0.1), []
    for omega in (0.65, 0.8):

        def slope(x, v, t, omega=omega):
            push = np.sin(omega * t) * min(t / 15.0, 1.0)
            return v, own**2 * (push - x) - 2.0 * damping * own * v

        x = v = 0.0
        way = []
        for t in time:
            way.append(x)
            for k in range(10):
                half = slope(x + 0.005 * v, v + 0.005 * slope(x, v, t + 0.01 * k)[1], t + 0.01 * k + 0.005)
                x, v = x + 0.01 * half[0], v + 0.01 * half[1]
        swings.append(Swing(time, np.sin(omega * time) * np.minimum(time / 15.0, 1.0), 5e4 * np.array(way), omega))
    found = tuned(swings, 0.7)
    assert found[:2] == pytest.approx((own, damping), rel=0.02)
    assert found[2] < 1e-4


def test_closed_forms_of_the_tanks():
    """√(2 g/37.2 m) of the U-tube; 0.777 rad/s of the first wave in 13.7 m of water 1.2 m deep."""
    assert closed_form(load("ship/u-tube").resolved) == pytest.approx(0.726, abs=1e-3)
    assert closed_form(load("ship/anti-roll-tank").resolved) == pytest.approx(0.777, abs=1e-3)


def test_water_over_air_is_seen():
    """Of a pool and a drop: 2.5 spacings above the surface it is over air, 1.5 above it is not."""
    y, z = np.meshgrid(np.arange(8) + 0.5, np.arange(3) + 0.5)
    pool = np.stack([y.ravel(), z.ravel()], axis=1)
    assert not has_air_below(0.1 * pool, 0.1)
    assert not has_air_below(0.1 * np.concatenate([pool, [[3.0, 4.0]]]), 0.1)
    assert has_air_below(0.1 * np.concatenate([pool, [[3.0, 5.0]]]), 0.1)


@pytest.mark.parametrize("lasts", [12.0, 25.0])
def test_a_decay_tells_both_swings_and_their_damping(lasts):
    """Of two decaying swings, the faster gone after two periods, on a list; the heel before the release is not seen.

    The record is made of nothing else, so that the pencil is exact, of whole swings or not.
    """
    time = np.arange(0.0, lasts, 0.02)
    late = time - 2.0
    slow, fast = (4.2, 0.05, 0.06), (5.9, 0.1, 0.03)  # rad/s, of the critical, rad
    roll = sum(a * np.exp(-z * w * late) * np.cos(np.sqrt(1.0 - z * z) * w * late) for w, z, a in (slow, fast))
    pose = np.zeros((len(time), 1, 3))
    pose[:, 0, 2] = 0.01 + np.where(late > 0.0, roll, 0.09)
    preset = SimpleNamespace(ship=SimpleNamespace(release=2.0))
    one = SimpleNamespace(recording=SimpleNamespace(series={"time": time, "pose": pose}, preset=preset))
    for (damped, damping), (frequency, share, _) in zip(swings(one), (slow, fast), strict=True):
        assert damped == pytest.approx(frequency * np.sqrt(1.0 - share**2), rel=1e-9)
        assert damping == pytest.approx(share, rel=1e-7)


def test_peaks_in_a_sea_are_looked_for_where_it_is_strong(monkeypatch):
    """Of peaks at 4, 5.25 and 6.5 rad/s and a fourth, where there are hardly any waves, each is found but that one."""
    omega = np.arange(2.5, 9.5, 0.0314)
    roll = sum(np.exp(-(((omega - each) / 0.3) ** 2)) for each in (4.0, 5.25, 6.5, 8.5))
    sea = np.where(omega < 8.0, 1.0, 0.01)
    heard = Transfer(omega, sea, sea * roll**2, roll.astype(complex), np.ones_like(omega), 9.0)
    monkeypatch.setattr(coupled, "met", lambda *_: heard)
    found = [coupled.nearest_sea_peak(SimpleNamespace(recording=None), each) for each in (4.0, 5.25, 7.0, 8.5)]
    assert found == pytest.approx([4.0, 5.25, 6.5, 6.5], abs=0.01)
