"""The time step derived from a scene's water: sound, acceleration, viscosity, diffusion of density and motion."""

from dataclasses import replace
from math import inf, pi, sqrt

from solvers.fluid.given import Water
from solvers.fluid.terms.end_walls import EndWallFriction
from solvers.fluid.viscosity import LAMINAR
from solvers.grains.timestep import shortest_collision
from solvers.machine.limit import Limit
from solvers.machine.quantity import PLANE

COURANT = 0.8  # of the time in which sound and water cross h; 1.4 is the largest stable one (standing wave)
OF_AIR = 0.5  # likewise of air, which is faster than its sound where water squeezes it out
FORCED = 0.25  # of √(h/a) (Monaghan 1992, eq. 10.2)
SPREAD = 0.125  # of h²/ν (Morris, Fox & Zhu 1997, eq. 21)
END_WALLS = 0.25  # of b²/(12 ν): end-wall friction is explicit
EVENED = 2.0 / 7.0  # of h/(δ c0): the diffusion of density is explicit, with 2 Σ V η = 7/h² over all neighbours
SURFACE = 0.25  # of √((ρ_w + ρ_a) h³/(2 π σ)) (Brackbill, Kothe & Zemach 1992, eq. 61; Hu & Adams 2006, eq. 26)
TRAVELLED = 0.02  # of the shortest period of the tank's motion
# Of the shortest collision t_c of grains in a floating room: the longest step of water and room. A hull on the springs
# of a floor layer of grains of its own mass has ω = π/t_c, and its step is stable up to 2/ω = 0.64 t_c.
SHARE_OF_COLLISION = 0.5
SLOW = 1e-9
MOST_SUBSTEPS = 64  # of grains in a step of the water between them


def limits_of_water(scene, closing: float = 0.0) -> list[Limit]:
    """Bounds on the step of the water of a `solvers.scene.Scene`, for the speeds and accelerations to be expected.

    They do not depend on the speed at which its particles meet. There are none of water that stands level.
    """
    water = scene.fluid.water
    if water.model == "level":
        return []
    length, sound, speed = water.length, water.sound_speed, water_speed(scene)
    bounds = [
        Limit(
            COURANT * length / (sound + speed),
            f"{COURANT:g} of the time in which sound crosses the smoothing length of {length:.3g} m at "
            f"{sound:.3g} + {speed:.3g} m/s",
            firm=True,
        )
    ]
    if water.air:
        longest = OF_AIR * length / (water.air.sound_speed + speed)
        bounds.append(
            Limit(longest, f"{OF_AIR:g} of that of sound in the air, {water.air.sound_speed:.3g} m/s", firm=True)
        )
    pushed = max(scene.gravity, water.pull.rate**2 * scene.span if water.pull else 0.0)
    pushed += sum(_shaken(motion, scene.span) for motion in scene.motions[0])
    if pushed > SLOW:
        bounds.append(Limit(FORCED * sqrt(length / pushed), f"{FORCED:g} √(h/a) at {pushed:.3g} m/s²", firm=True))
    viscosity = max(kinematic(water, scene.axes), kinematic(of_air(water)) if water.air else 0.0)
    if viscosity > 0.0:
        bounds.append(Limit(SPREAD * length**2 / viscosity, f"{SPREAD:g} h²/ν at {viscosity:.3g} m²/s", firm=True))
    if water.gap > 0.0:
        bounds.append(
            Limit(
                END_WALLS / EndWallFriction.rate(water), f"{END_WALLS:g} of the time in which walls stop it", firm=True
            )
        )
    if water.delta > 0.0 and water.diffusion != "none":
        longest = EVENED * length / (water.delta * sound)
        bounds.append(Limit(longest, "the diffusion of density", firm=True))
    if water.air and water.air.tension > 0.0:
        crossed = SURFACE * sqrt((water.density + water.air.density) * length**3 / (2.0 * pi * water.air.tension))
        bounds.append(Limit(crossed, f"{SURFACE:g} of the time of the shortest ripple", firm=True))
    shortest = min((1.0 / motion.frequency for motion in scene.motions[0] if hasattr(motion, "frequency")), default=inf)
    if shortest < inf:
        bounds.append(Limit(TRAVELLED * shortest, f"{TRAVELLED:g} of the shortest period of the motion"))
    return bounds


def longest_pace(scene, step: float) -> int:
    """How many base steps of `step` (s) a step of the water may be long: beside grains in a ship, by its own bounds.

    Not where a ship takes its water's added mass on her own side, or takes long steps herself. Beside grains in a room
    of a free body, which then has the water's steps, it is half of their shortest collision at most. Grains in water
    take MOST_SUBSTEPS at most in one of its steps.
    """
    if not (scene.fluid and scene.grains and (scene.vessels or scene.hold or scene.mixture)):
        return 1
    if scene.hold:
        longest = min(*(limit.step for limit in limits_of_water(scene)), SHARE_OF_COLLISION * shortest_collision(scene))
        return max(1, min(MOST_SUBSTEPS, int(longest / step))) if scene.mixture else max(1, int(longest / step))
    if scene.mixture:
        return max(1, min(MOST_SUBSTEPS, int(min(limit.step for limit in limits_of_water(scene)) / step)))
    water = scene.fluid.water
    if water.added_mass == "layer" or water.model == "level" or scene.vessels[0].handover:
        return 1
    return max(1, int(min(limit.step for limit in limits_of_water(scene)) / step))


def soft_limit(scene, longer: float) -> float:
    """The step (s) `longer` times the derived one, within its firm bounds, while the air of a scene is soft."""
    return scene.holding(*(matter.softened for matter in scene.matters)).longest_step(longer)


def stiff_step(scene) -> int:
    """The base step at which the air of a scene becomes stiff: a whole number of the long ones before."""
    fluid = scene.fluid
    return fluid.soft_multiple * max(1, round(fluid.water.air.stiff_from / scene.time_step()) // fluid.soft_multiple)


def steps_of_water(scene, steps: int) -> int:
    """How many steps the water takes in so many base steps of a scene."""
    fluid = scene.fluid
    if fluid is None:
        return steps
    soft = min(steps, stiff_step(scene)) if fluid.soft_multiple > 1 else 0
    return soft // fluid.soft_multiple + (steps - soft) // fluid.substeps


def of_air(water: Water) -> Water:
    """The air beside a water, as if it were one."""
    air = water.air
    return replace(water, density=air.density, sound_speed=air.sound_speed, alpha=air.alpha, kinematic=air.kinematic)


def kinematic(water, axes: int = PLANE) -> float:
    """Kinematic viscosity ν (m²/s): as given, or that of the artificial viscosity, α h c0/(2 (D + 2)), D axes.

    Monaghan (2005), eq. 8.8: the term α h c0 of pairs of neighbours is that of a liquid with this viscosity.
    """
    if water.viscosity in LAMINAR:
        return water.kinematic
    return water.alpha * water.length * water.sound_speed / (2.0 * (axes + 2))


def water_speed(scene) -> float:
    """Highest speed (m/s) of the water to be expected: a fall through the tank, its own start, or the tank's motion."""
    fastest = float(sqrt((scene.fluid.particles["velocity"] ** 2).sum(axis=-1).max(initial=0.0)))
    return max(fastest, scene.credible_speed() if scene.fluid.water.walls else 0.0)


def _shaken(motion, lever: float) -> float:
    """Bound on the acceleration (m/s²) of a harmonic motion; other motions are slow, and bring none."""
    if not hasattr(motion, "frequency"):
        return 0.0
    peak = motion.amplitude * (6.2832 * motion.frequency) ** 2
    return peak * (lever if motion.coordinate == "turn" else 1.0)
