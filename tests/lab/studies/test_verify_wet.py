"""Wet cargo in `cargolab verify`: its references against what is known of them otherwise."""

from dataclasses import replace

import numpy as np
import pytest

from lab.studies.verify.wet.consolidation import LINES, Layer, consolidated, excess
from lab.studies.verify.wet.disturbance import Disturbance, alone
from lab.studies.verify.wet.fluidised import WEIGHT, Flow, least
from lab.studies.verify.wet.laws import DENSITY, bed_drop, di_felice, ergun, settling_speed, speed_between
from lab.studies.verify.wet.percolation import fixed_bed
from lab.studies.verify.wet.smearing import lowered
from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS

SIZE, GLASS, GRAVITY = 4e-3, 2500.0, 9.81
WATER = Water(8e-3, 24.0, alpha=0.02)


def test_drag_bears_what_it_is_asked_to():
    for porosity in (0.45, 0.8):
        speed = speed_between(8e3, porosity, SIZE)
        assert di_felice(speed, porosity, SIZE) * speed == pytest.approx(8e3, rel=1e-9)
    # 20 mm/s through a bed of 3 mm, ε = 0.4: 1875 + 2187 Pa/m by Ergun
    assert 1.5 * ergun(0.05, 0.4, 3e-3) * 0.05 == pytest.approx(4062.5, rel=1e-3)


def test_a_suspension_settles_as_a_bed_that_the_flow_bears():
    """The flow per area at which a bed's pressure bears its buoyant weight is that at which it settles."""
    for porosity in (0.42, 0.7):
        flow = settling_speed(GLASS - DENSITY, porosity, SIZE, GRAVITY)
        weight = (1.0 - porosity) * (GLASS - DENSITY) * GRAVITY
        assert bed_drop(flow, porosity, SIZE) == pytest.approx(weight, rel=1e-6)


def test_a_bed_is_lifted_where_its_drop_is_its_weight():
    height = 0.36
    flow = Flow(0.03, 0.0, 0.0, height, 0.0, 0.0)
    borne = bed_drop(flow.speed, flow.porosity, SIZE) * height / WEIGHT
    start, told = least([flow, replace(flow, carried=borne)])
    assert start == pytest.approx(told, rel=1e-3)


def test_a_grain_alone_ends_at_its_last_speed():
    times = np.linspace(0.0, 1.0, 11)
    last = speed_between((GLASS - DENSITY) * GRAVITY, 1.0, SIZE)
    way, speed = alone(times, SIZE, GLASS)
    assert speed[-1] == pytest.approx(last, rel=1e-6)
    assert way[1] < 0.5 * GRAVITY * (1.0 - DENSITY / GLASS) * 0.01


def test_a_grain_disturbs_water_as_its_kernel_says():
    """Its share is that of the kernel squared, by a sum in space; in a thick slab it falls as alone."""
    one = Disturbance(SIZE, GLASS, WATER, SIZE)
    side = np.linspace(-WATER.reach, WATER.reach, 801)
    away = np.hypot(side[:, None], side)
    kernel = np.where(away < WATER.reach, KERNELS[WATER.kernel].printed(away, WATER.length), 0.0)
    area = np.pi / 6.0 * SIZE**2
    assert kernel.sum() * (side[1] - side[0]) ** 2 == pytest.approx(1.0, rel=1e-3)
    assert one.seen == pytest.approx(area * (kernel**2).sum() * (side[1] - side[0]) ** 2, rel=2e-3)
    assert one.displaced == pytest.approx(area * kernel.max(), rel=1e-6)
    times = np.linspace(0.0, 0.1, 3)
    thick = replace(one, thickness=1e4 * SIZE).fallen(times)
    np.testing.assert_allclose(thick, alone(times, SIZE, GLASS), rtol=1e-4)
    assert np.all(one.fallen(times)[1][1:] < 0.999 * thick[1][1:])


def test_the_wake_of_a_force_at_rest_grows_as_its_share_of_momentum():
    """Without viscosity a force that stands gives the water half of what it would have in a flow along it: ½ f t/ρ."""
    one = Disturbance(SIZE, GLASS, replace(WATER, alpha=0.0), SIZE)
    times = np.linspace(0.0, 0.05, 6)
    wake = one.wake(times, np.zeros(6), np.full(6, 1e3))
    np.testing.assert_allclose(wake, 0.5 * one.seen * 1e3 * times / DENSITY, rtol=1e-6)


def test_a_layer_consolidates_from_a_triangle():
    """Nothing at first, half at T = 0.29, all in the end; its mean is that of the pressure over the depth."""
    assert consolidated(0.0) == pytest.approx(0.0, abs=1e-5)
    assert consolidated(0.29) == pytest.approx(0.5, abs=0.01)
    assert consolidated(3.0) == pytest.approx(1.0, abs=1e-3)
    depth = (np.arange(1000) + 0.5) / 1000
    np.testing.assert_allclose(excess(depth, 0.0), depth, atol=2e-3)
    assert 2.0 * excess(depth, 0.2).mean() == pytest.approx(1.0 - consolidated(0.2), abs=1e-4)
    step, at = 1e-3, np.array([0.39, 0.4, 0.41])  # ∂u/∂T = ∂²u/∂z²
    rate = (excess(at, 0.2 + step) - excess(at, 0.2 - step))[1] / (2.0 * step)
    assert rate == pytest.approx(np.diff(excess(at, 0.2), 2)[0] / 0.01**2, rel=1e-3)


def test_a_layer_drains_in_the_time_it_is_made_for():
    layer = Layer(LINES[-1])
    mobility = layer.porosity**3 * (SIZE / layer.finer) ** 2 / (150.0 * DENSITY * 4e-5 * (1.0 - layer.porosity) ** 2)
    assert layer.height**2 / (layer.share * layer.modulus * mobility) == pytest.approx(layer.period)
    slow = ergun(0.0, layer.porosity, SIZE / layer.finer, 4e-5)
    assert layer.porosity**2 / ((1.0 - layer.porosity) * slow) == pytest.approx(mobility)


def test_a_smeared_surface_is_lower_in_proportion_to_the_kernel():
    low = lowered(WATER, 0.476)
    assert 0.5 * WATER.length < low < WATER.length
    assert lowered(Water(4e-3, 24.0), 0.476) == pytest.approx(0.5 * low, rel=1e-3)


def test_a_fixed_bed_fills_its_share_and_goes_on_beyond_its_ends():
    bed = fixed_bed(0.12, 0.16, 3e-3, 0.75)
    assert np.pi / 4.0 * 9e-6 * len(bed) / (0.12 * 0.16) == pytest.approx(0.75, rel=0.03)
    away = bed[:, None, :2] - bed[None, :, :2]
    away[..., 0] -= 0.12 * np.rint(away[..., 0] / 0.12)
    apart = np.hypot(away[..., 0], away[..., 1]) + np.eye(len(bed))
    assert apart.min() > 0.8 * 3e-3
