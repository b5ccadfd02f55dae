"""Measures of a user's own, from plug-ins and notebooks: functions of a recording."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from lab.base.errors import LabError
from lab.measures.value import NAME, Value, over_worlds
from lab.plugins.guard import told, within
from lab.plugins.loading import owner
from lab.recording import Recording

Found = float | np.ndarray | Value | Mapping[str, Value]


@dataclass(frozen=True)
class OwnMeasure:
    """A measure by its `name`: `function` of a recording returns a number a bed in `unit`, or Values by name.

    `OF`: the matter without which it is not asked, "" of any; `when`: of which recordings it can be made.
    """

    name: str
    function: Callable[[Recording], Found]
    unit: str
    OF: str
    when: Callable[[Recording], bool]
    owner: str
    FIGURES: Mapping[str, Callable] = field(default_factory=dict)

    def applies(self, recording: Recording) -> bool:
        """Whether it can be made; what raises cannot."""
        try:
            with within():
                return bool(self.when(recording))
        except Exception:
            return False

    def measure(self, recording: Recording) -> dict[str, Value]:
        """What it finds by name; one that raises, or takes too long, finds nothing, with the reason."""
        try:
            with within():
                return self._named(self.function(recording), recording.worlds)
        except Exception as error:
            return {self.name: Value(None, self.unit, note=f"{self.owner}: {told(error)}")}

    def _named(self, found: Found, worlds: int) -> dict[str, Value]:
        if isinstance(found, Value):
            return {self.name: found}
        if isinstance(found, Mapping):
            if not all(isinstance(value, Value) and NAME.fullmatch(str(name)) for name, value in found.items()):
                raise TypeError("a measure returns a number a bed, a Value, or Values by name")
            return dict(found)
        numbers = np.asarray(found, dtype=float)
        if numbers.shape not in ((), (worlds,)):
            raise ValueError(f"it returned numbers of shape {numbers.shape}, not one for each of {worlds} beds")
        return {self.name: over_worlds(np.broadcast_to(numbers, (worlds,)), self.unit)}


OWN: dict[str, OwnMeasure] = {}


def register(name: str, function: Callable, unit: str, of: str, when: Callable | None) -> None:
    """Add a measure, or replace one of the same name. Raises LabError for a name that none may have."""
    if not NAME.fullmatch(name):
        raise LabError(f"measure: {name!r} is no name; letters, digits and _ make one.")
    OWN[name] = OwnMeasure(name, function, unit, of, when or (lambda _: True), owner(function))
