"""Consistency checks of the air in a preset; each error is one sentence that names the key."""

from typing import Protocol

import numpy as np

from lab.base.errors import LabError
from lab.preset.sections.axle import Axle
from lab.preset.sections.water.air import Air
from lab.preset.sections.water.liquid import Wet, depth
from lab.preset.units import needed, show
from solvers.fluid.phases.adiabatic import GAMMA
from solvers.fluid.phases.cohesion import Cohesion
from solvers.fluid.viscosity import LAMINAR

COHERENT = 0.7  # of the air's speed of sound: what its cohesion may take of it
SLOWEST = 0.5  # of the air's speed of sound: what its own weight may lift over its height, √(0.4 g H)


class Whole(Wet, Protocol):
    """The sections of a preset with air, what carries its tank, and how long that takes."""

    axle: Axle | None

    @property
    def duration(self) -> float:
        """How long the run is (s)."""


def check_air(preset: Whole) -> None:
    """Raise LabError for air that cannot be: in an open tank, over water that leaves it no room, beside parts."""
    air, water, tank = preset.air, preset.water, preset.tank
    if air is None:
        return
    if tank.open_edges:
        raise LabError("air: it fills closed tanks; give the tank a lid (tank.lid = true), or leave out [air].")
    if water.full:
        raise LabError("air: the water fills the tank (water.full), so that there is none; leave out either.")
    if preset.parts:
        raise LabError("air: parts in water with air are not computed yet; leave out [parts] or [air].")
    if water.shifting == "delta-plus-momentum":
        raise LabError(
            'water.shifting: "delta-plus-momentum" is for water alone; take "delta-plus", or leave out [air].'
        )
    _check_viscosity(air, preset.liquid.viscosity)
    if air.density > water.density:
        raise LabError(f"air.density: {show(air.density, 'kg/m^3')} is more than that of the water; take less.")
    room = tank.extent[1] - (depth(preset) if water.shape is None else 0.0)
    if room < preset.liquid.spacing:
        raise LabError(
            "air: the water leaves it no room of a particle's height; take less water, or smaller particles."
        )
    if air.stiff_from is not None:
        _check_stiffening(preset)
    _check_sound(preset)


def _check_stiffening(preset: Whole) -> None:
    """Raise LabError for air that cannot become stiff: is so already, never will be, or is not in a tank by itself."""
    air, made, key = preset.air, preset.liquid, f"air.stiff_from: {show(preset.air.stiff_from, 's')}"
    if made.air.sound_speed <= made.sound_speed:
        raise LabError(
            "air.stiff_from: the air is no stiffer then, since its speed of sound is not above the water's, "
            f'{show(made.sound_speed, "m/s")}; set air.sound_speed = "real", or leave out air.stiff_from.'
        )
    if air.stiff_from >= preset.duration:
        raise LabError(f"{key} is not before the end of the run, {show(preset.duration, 's')}; give an earlier time.")
    if made.air.cohesion > 0.0:
        raise LabError(
            'air.stiff_from: air with cohesion has another equation of state; take air.interface = "weighted", or '
            "leave out air.stiff_from."
        )
    if preset.axle is not None:
        raise LabError(
            "air.stiff_from: a tank on an axle answers to its load in steps of one length; leave out air.stiff_from or "
            "[axle]."
        )


def _check_sound(preset: Wet) -> None:
    """Raise LabError for air whose sound is so slow that its own weight or cohesion would compress it to nothing."""
    air, room = preset.air, preset.tank.extent[1] - (depth(preset) if preset.water.shape is None else 0.0)
    slow = float(np.sqrt((GAMMA - 1.0) * preset.run.gravity * room)) / SLOWEST
    made = preset.liquid.softened
    sound, pulled = made.air.sound_speed, Cohesion.slowest(made.air.cohesion, air.density) / COHERENT
    if sound < pulled:
        raise LabError(
            f"air.sound_speed: {show(sound, 'm/s')} is too slow for the cohesion of this air; take at least "
            f"{show(pulled, 'm/s')}, or another air.interface."
        )
    if sound < slow:
        key = "air.sound_speed" if air.stiff_from is None else "water.sound_speed"
        raise LabError(
            f"{key}: air of {show(sound, 'm/s')} would be compressed by its own weight; take at least "
            f"{show(slow, 'm/s')}."
        )


def _check_viscosity(air: Air, viscosity: str) -> None:
    """Raise LabError for air whose viscosity is not told, or not as that of the water is."""
    laminar = viscosity in LAMINAR
    if viscosity == "laminar":
        raise LabError(
            'water.viscosity: "laminar" is for water alone, since it misses a part of the stress where two liquids of '
            'unequal viscosity meet; take "laminar-stress", or leave out [air].'
        )
    if laminar and air.kinematic_viscosity is None:
        raise LabError(f'air.kinematic_viscosity: missing for water.viscosity = "{viscosity}"; {needed("m^2/s")}.')
    if air.kinematic_viscosity is not None and not laminar:
        raise LabError('air.kinematic_viscosity: goes with water.viscosity = "laminar-stress"; leave out either.')
    if laminar and air.alpha is not None:
        raise LabError(f'air.alpha: goes with an artificial viscosity, not with water.viscosity = "{viscosity}".')
