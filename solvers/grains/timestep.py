"""The time step derived from the scene: limits of Rayleigh waves, of the contact laws, and of the speed check."""

from collections.abc import Iterable
from dataclasses import replace
from itertools import product
from math import pi, sqrt

import numpy as np

from solvers.grains.checks import FASTEST_STEP
from solvers.grains.integrators import INTEGRATORS
from solvers.grains.laws.hertz import hertz_duration
from solvers.grains.laws.splitting import NETWORK
from solvers.grains.materials import Interface, Material
from solvers.machine.limit import Limit

RAYLEIGH_SHARE = 0.2
# Times the bounds of the contact laws: some 7 steps a collision. Restitutions of 0.3 and more are right to 1 % there,
# and beds still settle. With 4.1 times springs with history are no longer stable in the most compressed packings
# (`cargolab bench stability`).
FURTHEST = 3.75
SLOWEST = 1e-3  # m/s: steps are derived for closing speeds of at least this
LEAST_SHARE = 0.9  # of the derived step
FASTER = 1.5  # times the highest credible speed: what the speed check must still accept


def watched(smallest: float, speed: float, count: int, shaped: bool) -> Limit:
    """The longest step at which the speed check accepts `count` grains that all move FASTER times `speed` (m/s).

    `smallest` (m) is the smallest radius. The check sees the 16-norm of the speeds; for outlines that is at most √2
    times the norm for their farthest points (`Mover.move`).
    """
    seen = FASTER * count ** (1.0 / 16.0) * (sqrt(2.0) if shaped else 1.0)
    way = (
        f"{FASTEST_STEP:g} of the smallest radius a step, what the watch lets pass, at {FASTER:g} times {speed:.3g} m/s"
    )
    return Limit(FASTEST_STEP * smallest / (seen * speed), way, firm=True)


def closing_speed(velocity: np.ndarray) -> float:
    """Highest closing speed (m/s) of n grains with velocities (n, axes) m/s: of any two, or of one and a wall at rest.

    The two velocities farthest apart are corners of the convex hull of all.
    """
    corners = _corners(np.unique(velocity, axis=0))
    fastest = np.linalg.norm(velocity, axis=1).max()
    return float(max([fastest, *(np.linalg.norm(corners - one, axis=1).max() for one in corners)]))


def _corners(points: np.ndarray) -> np.ndarray:
    """The corners of the convex hull of points (n, axes), which may lie in a plane or on a line."""
    from scipy.spatial import ConvexHull, QhullError  # slow to import, and only listed beds need it

    try:
        return points[ConvexHull(points).vertices]
    except (QhullError, ValueError):  # too few or flat: the same in the plane, or on the line, that they lie in
        away = points - points[0]
        ways = np.linalg.svd(away, full_matrices=False)[2]
        if points.shape[1] == 3 and len(points) > 2 and np.linalg.matrix_rank(away) == 2:
            return points[ConvexHull(away @ ways[:2].T).vertices]
        along = away @ ways[0]
        return points[[along.argmin(), along.argmax()]]


def share_to_lengthen(derived: float, slowest: float, times: float) -> float:
    """What to take of the `derived` step (s) so that, while grains are slow, steps may be `times` as long.

    Those must not exceed the step derived for the `slowest` speeds (s). With a collision of 0.1 % and Rayleigh's bound
    that is 1.8 to 2 times the derived one for many beds at a hundredth of the stiffness: a base step shorter by at most
    a tenth then lets slow beds go up to 1.8 times as fast. The share is 1 where no less is needed, or more would be.
    """
    share = (1.0 - 1e-9) * slowest / (times * derived)
    return share if LEAST_SHARE <= share < 1.0 else 1.0


def rayleigh_time(radius: float, density: float, shear: float, poisson: float) -> float:
    """Time (s) of a Rayleigh wave round half a grain, π R √(ρ/G)/(0.1631 ν + 0.8766) (Thornton and Randall 1988)."""
    return pi * radius * sqrt(density / shear) / (0.1631 * poisson + 0.8766)


def limits(
    smallest: float,
    grain: Material,
    interfaces: tuple[Interface, Interface],
    scale: float,
    speed: float,
    laws: Iterable,
    share: float = 1.0,
    network: float = 1.0,
) -> list[Limit]:
    """All bounds on the step for grains of at least the radius `smallest` (m) with closing speeds up to `speed` (m/s).

    `laws` are the contact laws of the scene; each gives its own limits (`limits`), of which firm ones are of stability,
    and may not be forced. `share` is the smallest share of its mass with which a grain resists a push on its outline:
    less than 1 if the push also turns it. `network` is what packings bear, as the laws take it.
    """
    mass = share * 4.0 / 3.0 * pi * smallest**3 * grain.density
    shear = grain.young * scale / (2.0 * (1.0 + grain.poisson))
    found = [
        Limit(
            RAYLEIGH_SHARE * rayleigh_time(smallest, grain.density, shear, grain.poisson),
            f"{RAYLEIGH_SHARE:g} of the Rayleigh time of the smallest grain",
        )
    ]
    for between, m_eff, r_eff, name in (
        (interfaces[0], mass / 2.0, smallest / 2.0, "two of the smallest grains"),
        (interfaces[1], mass, smallest, "the smallest grain and a wall"),
    ):
        for law in laws:
            law.network = network
            for limit in law.limits(between, m_eff, r_eff, speed):
                reason = f"{limit.reason} of {name} at {speed:.3g} m/s"
                found.append(replace(limit, reason=reason, forced=1.0 if limit.firm else sqrt(network) * FURTHEST))
    return sorted(found, key=lambda limit: limit.step)


def shortest_collision(scene) -> float:
    """Duration (s) of a Hertz collision of two of the smallest grains of a scene at the highest credible speed."""
    grains, (smallest, _) = scene.grains, scene.grains.sizes
    mass = 4.0 / 3.0 * pi * smallest**3 * float(grains.density.min())
    young = max(between.young_modulus for world in grains.interfaces_of for between in world)
    return hertz_duration(0.5 * mass, 0.5 * smallest, young, max(scene.credible_speed(), SLOWEST))


def calm_speed(scene, times: float) -> float:
    """The highest closing speed (m/s) at which the step may be so many `times` as long, by its bounds; 0: never.

    `scene` is a `solvers.scene.Scene`. A collision lasts as v^(−1/5); other bounds do not depend on the speed.
    """
    wanted = times * scene.grains.base_share * scene.step_limits()[0].step
    speeds = np.geomspace(SLOWEST, max(scene.credible_speed(), SLOWEST), 60)
    allowed = [scene.step_limits(speed)[0].step >= wanted for speed in speeds]
    return float(speeds[allowed].max(initial=0.0))


def limits_of_grains(scene, speed: float) -> list[Limit]:
    """Bounds on the step of a scene's grains that meet at a speed (m/s): those of Verlet's scheme times the `reach`.

    `scene` is a `solvers.scene.Scene`; of its worlds the tightest counts.
    """
    grains = scene.grains
    share, network = grains.shapes.least_mass if grains.shapes else 1.0, NETWORK[scene.axes]
    found: dict[tuple, list[Limit]] = {}
    for grain, rows in zip(grains.grain, grains.interfaces_of, strict=True):
        for a, b in product(range(grains.kinds), repeat=2):
            # The lighter of two kinds of grains stands for both, since its collisions are shorter.
            lighter = min((grain, *grains.others)[a], (grain, *grains.others)[b], key=lambda kind: kind.density)
            key = lighter, (rows[a * grains.kinds + b], rows[grains.kinds**2 + a])
            if key not in found:
                found[key] = limits(grains.sizes[0], *key, grains.stiffness_scale, speed, grains.laws, share, network)
    integrator = INTEGRATORS[grains.integrator]
    reach, bearing = integrator.reach, integrator.bearing
    of = "" if reach == 1.0 else f"{reach:g} of "
    tightest = min(found.values(), key=lambda bounds: bounds[0].step)
    bounds = [
        replace(
            limit,
            step=reach * limit.step * (bearing if limit.firm else 1.0),
            forced=min(limit.forced, bearing * sqrt(network) * FURTHEST),
            reason=of + limit.reason,
        )
        for limit in tightest
    ]
    return [*bounds, watched(grains.sizes[0], speed, grains.count, grains.shapes is not None)]
