"""A criterion of stability: what a rule asks for, what a ship attains, and the verdict."""

from dataclasses import dataclass
from math import isfinite

KINDS = "at least", "at most"
AFLOAT_NO_MORE = "an opening is under water as she lies"  # the note of each criterion of a ship that floods at rest


@dataclass(frozen=True)
class Criterion:
    """One requirement of a code: `rule` names its paragraph, `what` is measured, `limit` and `attained` are in `unit`.

    `attained` is infinite where there is no angle of equilibrium, or where she floods before she reaches it. `note`
    says what a reader must know of the numbers.
    """

    rule: str
    what: str
    kind: str
    limit: float
    attained: float
    unit: str
    note: str = ""

    @property
    def passed(self) -> bool:
        """Whether the requirement is met; a number that is not one does not meet it."""
        if self.kind == "at most":
            return bool(self.attained <= self.limit)
        return bool(isfinite(self.attained) and self.attained >= self.limit)

    @property
    def margin(self) -> float:
        """By how much the limit is kept, in the criterion's unit; negative where it is not."""
        return (self.limit - self.attained) * (1.0 if self.kind == "at most" else -1.0)

    @property
    def verdict(self) -> str:
        """ "pass" or "fail", as sheets of criteria have it."""
        return "pass" if self.passed else "fail"
