"""Count trials by their outcome."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field


@dataclass
class Tally:
    """What was tried of one kind: how often, and by outcome how often it went so; `failed` names what must not be."""

    says: str
    tried: int = 0
    outcomes: Counter = field(default_factory=Counter)
    failed: list[str] = field(default_factory=list)

    def count(self, good: bool, outcome: str, otherwise: str) -> None:
        """One more was tried, with this outcome if it went well, else with what is to be told of it."""
        self.tried += 1
        if good:
            self.outcomes[outcome] += 1
        else:
            self.outcomes["FAILED"] += 1
            self.failed.append(otherwise)

    def lines(self) -> Iterator[str]:
        """For people: one line, and one for each failure."""
        outcomes = ", ".join(f"{count} {outcome}" for outcome, count in self.outcomes.items())
        yield f"{self.tried} tried: {outcomes or 'nothing'}"
        yield from self.failed
