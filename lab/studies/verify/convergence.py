"""Order of the integrators where the force is smooth: grains on a heaving floor that they never leave."""

from functools import cache
from math import exp, pi, sin, sqrt

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.case import Case, Found, Line, Picture
from lab.studies.verify.references import hertz_stiffness, resting_overlap, sphere_mass
from lab.studies.verify.scenes import G, Setup, again, grain, simulated, track

SECTION = "Integrators"
RADIUS = 3e-3
# Soft, so that ξ₀, the overlap that carries the weight, is 0.7 % of the radius.
MATERIAL = {"young": 4e5, "poisson": 0.28, "density": 1319.0, "friction": 0.0, "dissipative_time": 0.0}
MASS = sphere_mass(RADIUS, MATERIAL["density"])
STIFFNESS = hertz_stiffness(MATERIAL["young"], MATERIAL["poisson"], RADIUS)
OVERLAP = resting_overlap(MASS * G, STIFFNESS)
PERIOD = 2.0 * pi * sqrt(OVERLAP / (1.5 * G))  # of small swings
HEAVE = {"amplitude": 0.2 * OVERLAP, "frequency": 0.6 / PERIOD}
# Periods: all within the soft start, at whose end its second derivative jumps.
SOFT_START, LOOKS = 8.0, 0.25 * np.arange(1, 26)
# Overlaps (ξ₀) and speeds (m/s) at the start, of a grain that rests until the floor moves it, and of one set going.
STARTS = {"at rest": (1.0, 0.0), "set going": (1.15, 0.3 * sqrt(G * OVERLAP))}
SHARES = (20, 40, 80, 160, 320)  # steps a period
# Of both grains. Symplectic Euler's places are Verlet's but for the first kick, which is nothing to a grain at rest.
ORDERS = {"verlet": (2, 2), "symplectic-euler": (2, 1), "gear": (5, 2)}
COLOURS = dict(zip(ORDERS, (BLUE, GREEN, VERMILION), strict=True))
MARKERS = dict(zip(ORDERS, ("o", "x", "s"), strict=True))


def floor(time: float) -> float:
    """Height (m) of the floor, D(t/T) A sin ωt, D(τ) = exp(1 − 1/(1 − (τ − 1)²)) (Spandonidis 2016, eq. F.1)."""
    tau = time / (SOFT_START * PERIOD)
    if tau <= 0.0:
        return 0.0
    begun = exp(1.0 - 1.0 / max(tau * (2.0 - tau), 1e-3))
    return begun * HEAVE["amplitude"] * sin(2.0 * pi * HEAVE["frequency"] * time)


@cache
def swung(depth: float, kick: float) -> np.ndarray:
    """The overlaps at the LOOKS in ξ₀, from an overlap (ξ₀) and a kick down (m/s), seen from the earth.

    There z̈ = (k/m) ξ^(3/2) − g; by DOP853 at 1e-13.
    """
    unit = sqrt(OVERLAP / G)

    def overlap(time, height):
        return 1.0 - height + floor(time * unit) / OVERLAP

    def motion(time, state):
        return [state[1], max(overlap(time, state[0]), 0.0) ** 1.5 - 1.0]

    times, start = LOOKS * PERIOD / unit, [1.0 - depth, -kick * unit / OVERLAP]
    accuracy = {"rtol": 1e-13, "atol": 1e-14, "max_step": 0.2}
    path = solve_ivp(motion, (0.0, times[-1]), start, "DOP853", t_eval=times, **accuracy)
    return np.array([overlap(*point) for point in zip(times, path.y[0], strict=True)])


@cache
def errors(integrator: str) -> np.ndarray:
    """Largest errors (SHARES, 2) at any of the LOOKS of the overlaps of both grains, in ξ₀."""
    rows = [
        grain(0.03 * k, RADIUS - depth * OVERLAP, RADIUS, 0.0, -kick) for k, (depth, kick) in enumerate(STARTS.values())
    ]
    setup = Setup(
        np.array(rows),
        MATERIAL,
        {"width": 0.2, "height": 0.05},
        contact={"normal": "hertz", "tangential": "none"},
        motion={"soft_start": SOFT_START * PERIOD, "heave": HEAVE},
        run={"integrator": integrator},
    )
    found = []
    with simulated(setup) as run:
        begun = run.snapshot()
        for share in SHARES:
            again(run, begun["position"], PERIOD / share, begun["velocity"])
            places = track(run, len(LOOKS), share // 4).position[1:, 0, :, 1]
            wanted = np.stack([swung(*start) for start in STARTS.values()], axis=1)
            found.append(np.abs((RADIUS - places) / OVERLAP - wanted).max(axis=0))
    return np.array(found)


def orders(fast: bool) -> Found:
    """Halving the step divides the error by two to the order."""
    chosen = [*ORDERS][:1] if fast else [*ORDERS]
    lines = []
    for integrator in chosen:
        found = errors(integrator)
        for name, (coarse, fine), theory in zip(STARTS, found[-2:].T, ORDERS[integrator], strict=True):
            value, where = np.log2(coarse / fine), f"{SHARES[-2]} to {SHARES[-1]} steps a period"
            quantity, source = f"order of {integrator}, {name}", "theory; errors by DOP853 at 1e-13"
            lines.append(Line(quantity, value, theory, source, 0.2, f"next order, {where}", relative=False))
    note = """The grain that rests is set in motion by a floor that starts smoothly; the other one is set going, off its
    equilibrium, at the first step. Gear's scheme is of fifth order, but it begins with derivatives above the second of
    zero. That is right for a grain at rest. Of one that is set going they are not zero at once: the error of that start
    stays, and is of second order. So is every contact that begins or ends within a step. The soft start's own end is
    left out: there the second derivative of the source's D jumps, and every scheme is of first order."""
    caption = "Largest error of the place over six periods; solid: at rest at first; dashed: set going"
    return Found(lines, [Picture("orders", orders_figure(chosen), caption)], [note])


def orders_figure(integrators: list[str]) -> Figure:
    """Errors over the steps a period."""
    figure, axes = canvas((6.4, 4.0))
    for integrator in integrators:
        found = errors(integrator)
        for k, (name, style) in enumerate(zip(STARTS, ("-", "--"), strict=True)):
            label = f"{integrator}, {name}: order {ORDERS[integrator][k]}"
            axes.plot(SHARES, found[:, k], MARKERS[integrator], ls=style, color=COLOURS[integrator], ms=5, label=label)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xticks(SHARES, [str(share) for share in SHARES])
    axes.set(xlabel="steps a period of the swing", ylabel="error of the place\n(overlaps at rest)")
    figure.legend(loc=BELOW, ncols=2)
    return figure


CASES = (Case("integrator-order", SECTION, "Order of the integrators on a lasting contact", orders),)
