"""The whole numbers of a run that its state keeps by name, beside the arrays: how far it is, and how it is cut."""

from collections.abc import Mapping

import numpy as np

from solvers.machine.state import Axes
from solvers.machine.wide import told_of_outlines
from solvers.time.schedules import SCHEDULES, check_cut, moved

PLAIN = ("steps", "unkicked", "observed", "room", "vectors", "among")  # attributes of a `Simulation`
OF_ARRAYS = ("room", "units", "vectors", "among")  # those that its arrays follow from
ONCE = ("steps", "room", "unkicked", "observed", "units", "schedule", "vectors", "among")  # in states without names


def numbers_of(run) -> dict[str, int]:
    """The numbers of a `solvers.simulation.Simulation`."""
    schedule = list(SCHEDULES).index(run.schedule_name)
    return {name: getattr(run, name) for name in PLAIN} | {"units": run.units_a_world, "schedule": schedule}


def state_of(run) -> dict[str, np.ndarray]:
    """The same as entries of its state."""
    return {f"run.{name}": np.array(number) for name, number in numbers_of(run).items()}


def axes_of(run) -> dict[str, Axes]:
    """The axes of these entries."""
    return {name: () for name in state_of(run)}


def take(run, state: Mapping[str, np.ndarray]) -> bool:
    """Give a run the numbers of a state; returns whether its arrays are to be made anew. Raises ValueError.

    States that tell them without names may lack the last ones. In such a state no matter beside another one is on real
    vectors.
    """
    before = numbers_of(run)
    if "numbers" in state:
        told = dict(zip(ONCE, map(int, state["numbers"]), strict=False))
        told |= {"vectors": 0} if len(run.matters) > 1 else {}
    else:
        told = {name: int(state[f"run.{name}"]) for name in before}
    told = before | told
    if run.scene.shapes:
        told["vectors"] = told_of_outlines(told["vectors"])
    check_cut(told["units"], told["schedule"], told["vectors"], moved(run.scene))
    for name in PLAIN:
        setattr(run, name, told[name])
    anew = any(told[name] != before[name] for name in OF_ARRAYS)
    if anew:
        run.units_a_world, run.schedule_name = told["units"], list(SCHEDULES)[told["schedule"]]
    return anew
