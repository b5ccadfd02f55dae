"""The choice of the carrier that moves the tanks of a scene."""

from collections.abc import Sequence

from solvers.machine.state import State
from solvers.motion.afloat import Afloat, steps_an_interval
from solvers.motion.prescribed import Prescribed
from solvers.ship.vessel import Vessel


def carrier_kind(vessels: Sequence[Vessel]) -> type[Prescribed] | type[Afloat]:
    """The carrier's class: `Afloat` if there are vessels, else `Prescribed`."""
    return Afloat if vessels else Prescribed


def make_carrier(arrays: State, scene, dt: float) -> Prescribed | Afloat:
    """The carrier of a scene (`solvers.scene.Scene`) with steps of dt (s)."""
    if scene.vessels:
        every = steps_an_interval(scene.vessels, scene.interval, dt)
        return Afloat(arrays, scene.vessels, scene.gravity, every)
    return Prescribed(arrays, scene.motions, scene.soft_start, scene.gravity)
