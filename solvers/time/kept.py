"""The whole numbers of a run that its state keeps by name, beside the arrays: how far it is, and how it is cut."""

from collections.abc import Mapping

import numpy as np

from solvers.machine.state import Axes
from solvers.machine.wide import told_of_outlines
from solvers.time.schedules import SCHEDULES, check_cut, moved

PLAIN = ("steps", "unkicked", "observed", "room", "vectors", "among")  # attributes of a `Simulation`
OF_ARRAYS = ("room", "units", "vectors", "among")  # those that its arrays follow from
ONCE = ("steps", "room", "unkicked", "observed", "units", "schedule", "vectors", "among")  # in states without names
RENAMED = {  # arrays and rows that earlier versions kept under other names
    "water.excess": "water.deviation",
    "water.span": "water.eigenvalue",
    **{f"water.slope_{axis}": f"water.gradient_{axis}" for axis in "yz"},
    **{f"water.layer_{n}_{axis}": f"water.end_wall_{n}_{axis}" for n in range(8) for axis in "yz"},
    "water.forces.lost": "water.forces.dissipated",
    "water.forces.held": "water.forces.stored",
    "water.forces.work": "water.forces.wall_work",
    "water.forces.lost_lately": "water.forces.dissipated_lately",
    "water.forces.held_lately": "water.forces.stored_lately",
    "water.forces.work_lately": "water.forces.wall_work_lately",
    "water.continuity.lost": "water.continuity.diffused",
    "water.census.behind": "water.diagnostics.behind",
    "ship.ease": "ship.relaxed_mass",
    "clock.stride": "clock.multiple",
}


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


def numbers_in(state: Mapping[str, np.ndarray]) -> dict[str, int]:
    """The numbers in a state; of those without names the last ones may be missing. Raises ValueError."""
    if "numbers" in state:
        found = dict(zip(ONCE, state["numbers"], strict=False))
    else:
        found = {name: state[f"run.{name}"] for name in ONCE}
    if "room" not in found or any(np.ndim(number) or np.asarray(number).dtype.kind != "i" for number in found.values()):
        raise ValueError("its numbers are invalid")
    return {name: int(number) for name, number in found.items()}


def renamed(state: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """A state with its arrays under the present names."""
    return {RENAMED.get(name, name): values for name, values in state.items()}


def restore_numbers(run, state: Mapping[str, np.ndarray]) -> bool:
    """Give a run the numbers of a state; returns whether its arrays are to be made anew. Raises ValueError.

    In a state that has them without names no matter beside another one is on real vectors.
    """
    before = numbers_of(run)
    numbers = before | numbers_in(state)
    if "numbers" in state and len(run.matters) > 1:
        numbers["vectors"] = 0
    if run.scene.grains and run.scene.grains.shapes:
        numbers["vectors"] = told_of_outlines(numbers["vectors"])
    check_cut(numbers["units"], numbers["schedule"], numbers["vectors"], moved(run.scene))
    for name in PLAIN:
        setattr(run, name, numbers[name])
    anew = any(numbers[name] != before[name] for name in OF_ARRAYS)
    if anew:
        run.units_a_world, run.schedule_name = numbers["units"], list(SCHEDULES)[numbers["schedule"]]
    return anew
