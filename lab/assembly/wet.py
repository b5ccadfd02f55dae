"""Wet cargo: the water between the grains of a scene, from a preset."""

from dataclasses import replace

import numpy as np

from lab.preset.schema import Preset
from lab.preset.sections.water.liquid import bounds
from solvers.fluid.given import Fluid
from solvers.mixture.given import Mixture
from solvers.scene import Scene

WATER = 1.0e-6  # m²/s, kinematic viscosity of water at 20 °C
PACKED = 0.84  # share of the plane that settled discs fill


def mixture_of(preset: Preset) -> Mixture | None:
    """How the grains of a preset and the water of their tank act on each other; None where they do not meet."""
    if not preset.wet:
        return None
    finer = preset.mean_diameter / preset.grains.true_size if preset.grains.true_size else 1.0
    drag = preset.water.drag or Mixture.drag
    return Mixture(drag, preset.water.kinematic_viscosity or WATER, finer, float(bounds(preset)[1]))


def soaked(scene: Scene) -> Fluid:
    """The fluid of a scene with about as many particles as there is water between its grains.

    How much water that is follows from the bed, once it has settled; the particles then share it evenly.
    """
    fluid, radius = scene.fluid, scene.grains.radius
    tank, drops = scene.tanks[scene.hold], fluid.particles[0]
    discs = float((np.pi * radius**2).sum(axis=1).mean())
    solid = float((4.0 / 3.0 * np.pi * radius**3).sum(axis=1).mean()) / tank.thickness
    under_water = min(1.0, drops["volume"].sum() * PACKED / discs)
    left = max(drops["volume"].sum() - under_water * solid, 0.1 * drops["volume"].sum())
    count = max(1, round(len(drops) * left / drops["volume"].sum()))
    return replace(fluid, particles=fluid.particles[:, :count])
