"""What is said of wet cargo: how wet it is, what its permeability and stiffness make of it, and what is an artefact."""

from collections.abc import Iterator

import numpy as np

from lab.preset.schema import Preset
from lab.preset.sections.wet.states import SETTLED, State, state
from lab.preset.units import show
from solvers.grains.materials import hertz_stiffness
from solvers.motion.harmonic import Harmonic
from solvers.scene import Scene

HALF = 0.197  # T_v at which half of a layer's pore pressure has gone through its top (Terzaghi 1943)
DRAINED = 0.05  # t50 over the period of the motion, below which water leaves as fast as it is pressed
BORNE = 0.9  # of a sudden load: with less of it in the water, its pressure is that of too soft a water
Rows = list[tuple[str, str]]


def described(preset: Preset, scene: Scene) -> Rows:
    """The state of a wet bed, each row a name and a text; none of dry grains or of water alone."""
    wet = state(preset) if preset.wet else None
    if wet is None:
        return []
    level = f"{show(wet.free, 'm')} of free water on a bed of {show(wet.bed, 'm')}"
    if wet.saturation < 1.0:
        level = f"no free water: its table lies {show(wet.bed - wet.level, 'm')} below the surface of the bed"
    return [
        ("moisture", f"{100.0 * wet.moisture:.3g} % of the mass of both"),
        ("saturation", f"{100.0 * wet.saturation:.3g} % of the pores"),
        ("water", f"{level}, as it is expected to settle"),
        ("bulk density", f"{show(wet.dry, 'kg/m^3')} dry, {show(wet.whole, 'kg/m^3')} with the water in it"),
        *between_grains(preset, scene, wet),
        *_drainage(preset, scene, wet),
    ]


def between_grains(preset: Preset, scene: Scene, wet: State) -> Rows:
    """The law of drag between grains and water, and what it makes of the bed."""
    mixture, gravity = scene.mixture, scene.gravity
    size, permeability = _size(scene), _permeability(scene, wet)
    density = float(np.mean(scene.grains.density)) / preset.water.density
    archimedes = gravity * size**3 * abs(density - 1.0) / mixture.kinematic**2
    stokes = np.sqrt(density * archimedes) / (18.0 * np.sqrt(2.0))  # Courrech du Pont et al. (2003)
    return [
        ("drag", f"{mixture.drag}, on grains of {show(size, 'm')}, at a viscosity of {mixture.kinematic:g} m²/s"),
        (
            "wet bed",
            f"porosity {wet.porosity:.2f} where it fills {SETTLED:g} of the plane, permeability {permeability:.2g} m² "
            f"(Carman): slow water sinks through it at {show(permeability * gravity / mixture.kinematic, 'm/s')}",
        ),
        ("Archimedes number", f"{archimedes:.3g}: gravity over viscosity, of a grain"),
        ("Stokes number", f"{stokes:.3g}: the time in which water slows a grain, over that of its fall past another"),
    ]


def _size(scene: Scene) -> float:
    """Diameter (m) of the grains that drag acts on."""
    return 2.0 * scene.grains.mean_radius / scene.mixture.finer


def _permeability(scene: Scene, wet: State) -> float:
    """k = ε³ d²/(180 (1 − ε)²), m² (Carman 1937)."""
    return wet.porosity**3 * _size(scene) ** 2 / (180.0 * (1.0 - wet.porosity) ** 2)


def modulus(scene: Scene, stress: float, real: bool = False) -> float:
    """The modulus M (Pa) of a bed of Hertz contacts at an effective stress σ' (Pa); `real`: as stiff as its material.

    Own estimate: a column of grains bears F = σ' d b a grain, so that M = (1/b) dF/dξ = (3/2) k^(2/3) F^(1/3)/b with
    F = k ξ^(3/2), k = (4/3) E* √R_eff, in a slab of the thickness b. It tells the order of magnitude.
    """
    grains, thickness = scene.grains, scene.tanks[scene.hold].thickness
    young = grains.interfaces[0].young_modulus / (grains.stiffness_scale if real else 1.0)
    stiffness = hertz_stiffness(young, 0.5 * grains.mean_radius)
    force = max(stress, 0.0) * 2.0 * grains.mean_radius * thickness
    return 1.5 * stiffness ** (2.0 / 3.0) * force ** (1.0 / 3.0) / thickness


def half_time(high: float, viscosity: float, permeability: float, modulus: float, bulk: float = np.inf) -> float:
    """t50 = 0.197 H² μ (1/M + 1/K)/k, s, in which half of a layer's excess pressure has gone (Terzaghi 1943).

    Its water has the modulus K = ρ c0²/ε in the bed, which is not that of stiff water; H in m, μ in Pa s, k in m².
    """
    return HALF * high**2 * viscosity * (1.0 / modulus + 1.0 / bulk) / permeability


def period(preset: Preset) -> float | None:
    """The period (s) of the tank's quickest harmonic motion; None without one."""
    found = [motion.frequency for motion in preset.motion.parts.values() if isinstance(motion, Harmonic)]
    return 1.0 / max(found) if found else None


def half_times(preset: Preset, scene: Scene, wet: State) -> tuple[float, float, float] | None:
    """t50 (s) of a bed as it is computed, with stiff water, and with grains as stiff as their material besides.

    None of a bed that the water bears, or that has none.
    """
    high, borne = _loaded(preset, scene, wet)
    if not (high > 0.0 and borne > 0.0):
        return None
    layer = high, scene.mixture.kinematic * scene.fluid.water.density, _permeability(scene, wet)
    skeleton, real = modulus(scene, borne), modulus(scene, borne, real=True)
    return half_time(*layer, skeleton, _bulk(scene, wet)), half_time(*layer, skeleton), half_time(*layer, real)


def _loaded(preset: Preset, scene: Scene, wet: State) -> tuple[float, float]:
    """How deep (m) the soaked part of a bed is, and the effective stress (Pa) at half of that."""
    high = min(wet.bed, wet.level)
    return high, (wet.dry - (1.0 - wet.porosity) * preset.water.density) * scene.gravity * 0.5 * high


def _bulk(scene: Scene, wet: State) -> float:
    """The modulus (Pa) of the water in a bed, K = ρ c0²/ε."""
    water = scene.fluid.water
    return water.density * water.sound_speed**2 / wet.porosity


def _drainage(preset: Preset, scene: Scene, wet: State) -> Rows:
    """How stiff water and skeleton are, and how fast the bed drains."""
    times = half_times(preset, scene, wet)
    if times is None:
        return []
    bulk, skeleton = _bulk(scene, wet), modulus(scene, _loaded(preset, scene, wet)[1])
    taken = bulk / (bulk + skeleton)
    rows = [
        (
            "stiffness",
            f"water over skeleton {bulk / skeleton:.2g} ({show(bulk, 'Pa')} over some {show(skeleton, 'Pa')} at half "
            f"its depth): of a sudden load the water bears {100.0 * taken:.2g} %",
        ),
        (
            "drains by half",
            f"in {show(times[0], 's')} ({show(times[1], 's')} with stiff water; with grains as stiff as their "
            f"material and stiff water {show(times[2], 's')})" + _over(times[0], period(preset)),
        ),
    ]
    return rows + [("caution", text) for text in _cautions(times, taken, period(preset))]


def _over(time: float, motion: float | None) -> str:
    """That time (s) over a period of the motion (s), in words."""
    if motion is None:
        return ""
    share = time / motion
    state = "drained" if share < DRAINED else "undrained" if share > 1.0 else "between drained and undrained"
    return f": {share:.2g} of a period of the motion, {state}"


def _cautions(times: list[float], taken: float, motion: float | None) -> Iterator[str]:
    """What of a result would be an artefact, a sentence each."""
    if motion is None:
        return
    soft, own, _ = (time / motion for time in times)
    if soft > DRAINED >= own:
        yield (
            "the bed is undrained only since its water is softer than its skeleton: raise water.sound_speed, or do "
            "not trust its pore pressure."
        )
    elif soft > DRAINED and taken < BORNE:
        yield (
            f"the bed is undrained, but its skeleton bears {100.0 * (1.0 - taken):.2g} % of a sudden load, which stiff "
            "water would bear: pore pressures are too low; raise water.sound_speed, or lower contact.stiffness_scale."
        )
