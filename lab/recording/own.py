"""Quantities of a user's own, from plug-ins and notebooks, which are recorded in the series."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from lab.base.errors import LabError
from lab.plugins.guard import told, within
from lab.plugins.loading import owner
from solvers.machine.quantity import Quantity


@dataclass(frozen=True)
class OwnQuantity:
    """A quantity, and its function of the solver's simulation and what it observes, which returns a number a bed."""

    quantity: Quantity
    function: Callable[[object, Mapping[str, np.ndarray]], object]
    owner: str

    def filled(self, simulation: object, rows: Mapping[str, np.ndarray]) -> np.ndarray:
        """Its values (W,) now. Raises LabError, one sentence, for what the function raises, and for another shape."""
        try:
            with within():
                values = np.asarray(self.function(simulation, rows), dtype=float)
        except Exception as error:
            raise LabError(f"{self.owner}: quantity {self.quantity.name}: {told(error)}.") from error
        if values.shape not in ((), (simulation.scene.worlds,)):
            raise LabError(
                f"{self.owner}: quantity {self.quantity.name}: its function returned numbers of shape {values.shape}, "
                f"not one for each of {simulation.scene.worlds} beds."
            )
        return np.broadcast_to(values, (simulation.scene.worlds,))


OWN: dict[str, OwnQuantity] = {}


def register(name: str, function: Callable, unit: str, label: str) -> None:
    """Add a quantity to what is recorded from now on, or replace one. Raises LabError for a name that is no name."""
    if not name.isidentifier() or len(name) > 60:
        raise LabError(f"quantity: {name!r} is no name; letters, digits and _ make one.")
    OWN[name] = OwnQuantity(Quantity(name, unit, label=label, plot=True), function, owner(function))


def with_own(tables: dict[str, tuple[Quantity, ...]]) -> dict[str, tuple[Quantity, ...]]:
    """The tables of a new recording, with the user's quantities in the series. Raises LabError for a name twice."""
    known = {quantity.name for quantity in tables["series"]}
    if twice := known & OWN.keys():
        raise LabError(f"quantity {min(twice)}: the lab records one of this name; choose another.")
    return tables | {"series": (*tables["series"], *(own.quantity for own in OWN.values()))}


def filled(simulation: object, rows: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """What was observed, and the user's quantities."""
    return {**rows, **{name: own.filled(simulation, rows) for name, own in OWN.items()}}
