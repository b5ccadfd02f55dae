"""The parts of a suite (`lab.studies.suite`): cases, and their lines of results."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import isfinite

from matplotlib.figure import Figure


@dataclass(frozen=True)
class Line:
    """One quantity beside its reference, both in `unit`.

    `source` says where the reference comes from: a closed form, an integration apart from the solver, a publication.
    The error is relative to the reference, or where `relative` is false a difference; `reason` says why the
    `tolerance` is what it is. With `at_least` no value above the reference is an error. Raises ValueError for an error
    relative to zero.
    """

    quantity: str
    value: float
    reference: float
    source: str
    tolerance: float
    reason: str
    unit: str = ""
    relative: bool = True
    at_least: bool = False

    def __post_init__(self):
        if self.relative and self.reference == 0.0:
            raise ValueError(f"{self.quantity}: nothing is relative to a reference of zero")

    @classmethod
    def off(cls, quantity: str, source: str, error: float, tolerance: float, reason: str, unit: str = "") -> "Line":
        """A quantity that should be zero by its source; what it is, is the error."""
        return cls(quantity, error, 0.0, source, tolerance, reason, unit, relative=False)

    @property
    def error(self) -> float:
        """Signed error of the value against its reference."""
        found = self.value / self.reference - 1.0 if self.relative else self.value - self.reference
        return min(found, 0.0) if self.at_least else found

    @property
    def passed(self) -> bool:
        """Whether the error is within the tolerance."""
        return isfinite(self.error) and abs(self.error) <= self.tolerance


@dataclass(frozen=True)
class Picture:
    """A figure of the page and what it shows; the page's files are named after it."""

    name: str
    figure: Figure
    caption: str


@dataclass(frozen=True)
class Table:
    """A table of the page: names of its columns, and rows of texts."""

    header: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass
class Found:
    """The results of a case: its lines, and further content for the page."""

    lines: Sequence[Line]
    pictures: Sequence[Picture] = ()
    notes: Sequence[str] = ()
    tables: Sequence[Table] = ()


@dataclass(frozen=True)
class Case:
    """A named comparison under a heading of the page.

    `check(fast)` carries it out, the part that takes seconds if `fast`; a case without such a part is not `quick`.
    """

    name: str
    section: str
    title: str
    check: Callable[[bool], Found]
    quick: bool = True


@dataclass
class Outcome:
    """A case that has run: what it found, or why it was cut short."""

    case: Case
    found: Found = field(default_factory=lambda: Found([]))
    fault: str = ""

    @property
    def passed(self) -> bool:
        """Whether it ran to its end and every line is within its tolerance; a case without lines has shown nothing."""
        return not self.fault and bool(self.found.lines) and all(line.passed for line in self.found.lines)
