"""An experiment of the source: its runs, and the comparison of their results with the source's statements."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from matplotlib.figure import Figure

from lab.measures.value import Value
from lab.report.numbers import number
from lab.studies.reproduce.estimates import Estimate, Verdict, mean
from lab.studies.reproduce.runs import Batch, Outcome

Found = Mapping[str, Sequence[Outcome]]  # outcomes of runs by name, one for each point of a grid


class Kind(StrEnum):
    """What a statement is held against, the strongest evidence first.

    A `sign` is a direction, an order, a bound or whether something happens: much wrong can hide behind one that agrees.
    """

    MEASURED = "measured"
    OTHER_CODE = "other code"
    OWN_REFERENCE = "own reference"
    SIGN = "sign"


@dataclass(frozen=True)
class Row:
    """One line of the comparison.

    `apart` is our number minus the source's, with its interval; `tolerance` the allowed difference and its origin;
    `verdict` is None if the source states nothing comparable, or nothing that could fail; `kind`: what it is held
    against, None of a row without a verdict.
    """

    quantity: str
    source: str
    ours: str
    apart: str
    tolerance: str
    verdict: Verdict | None
    kind: Kind | None = None

    def against(self, kind: Kind | None) -> "Row":
        """The row with its kind, or this one where it has none and a verdict."""
        return replace(self, kind=(self.kind or kind) if self.verdict else None)


def all_against(rows: Iterable[Row], kind: Kind | None) -> list[Row]:
    """Rows that are of one kind, but for those that have their own."""
    return [row.against(kind) for row in rows]


@dataclass(frozen=True)
class ReportSection:
    """The results of an experiment: rows, the figure, and a further table, its header first."""

    rows: Sequence[Row]
    figure: Figure | None = None
    table: Sequence[Sequence[str]] = ()


@dataclass(frozen=True)
class Experiment:
    """`states` says in words what the source (its `section`) reports; `batches(quick)` what is run, by name.

    `report` compares the outcomes of the batches, each a list by the points of its grid. `lost` says what the quick
    runs leave out; `shown` is the batch of which a `point`, by its number, mostly the last, or by a value of the grid,
    is pictured, at this fraction of its time; `why` explains how to read the rows, and why they differ from the source
    where they do; `question` says what is not known of that; `needs` names the measured series without which it cannot
    be run (`lab.base.data`).
    """

    name: str
    title: str
    section: str
    states: str
    batches: Callable[[bool], Mapping[str, Batch]]
    report: Callable[[Found], ReportSection]
    lost: str
    shown: tuple[str, float]
    why: str = ""
    question: str = ""
    needs: str = ""
    point: int | str = -1


@dataclass(frozen=True)
class Tolerance:
    """The allowed difference from a number, and its origin."""

    within: float
    origin: str

    def words(self, unit: str = "") -> str:
        """For a reader."""
        return f"{self.within:.3g}{f' {unit}' if unit not in ('', '1') else ''}: {self.origin}"


ANY = "none: any difference counts"
EXACT = "exact: nothing in it varies from bed to bed"


def stated(quantity: str, source: float, ours: Value | None, tolerance: Tolerance, exact: bool = False) -> Row:
    """A row that compares a number of the source with ours, in the same unit; `exact`: ours has no scatter of beds."""
    unit = "" if ours is None or ours.unit == "1" else ours.unit
    said, allowed = f"{source:g} {unit}".rstrip(), tolerance.words(unit)
    found = mean(ours, exact)
    if found is None:
        return Row(quantity, said, "not found", "", allowed, Verdict.CANNOT_TELL)
    apart = found.less(source)
    verdict = apart.lies(-tolerance.within, tolerance.within)
    return Row(quantity, said, alone(ours) if exact else number(ours), less(apart, unit), allowed, verdict)


def less(apart: Estimate, unit: str) -> str:
    """A difference as text, with its interval if known: "+3.3, [0.9, 5.6] deg (95 %)"."""
    known = apart.interval(unit)
    return f"{apart.value:+.3g}, {known}" if known else f"{apart.value:+.3g} {unit}".rstrip()


def observed(quantity: str, source: str, ours: str, verdict: Verdict | None, tolerance: str = "") -> Row:
    """A row that compares a statement of the source in words with our result; `tolerance`: how we read its words."""
    return Row(quantity, source, ours, "", tolerance, verdict)


def held(
    quantity: str, source: str, found: Estimate | None, between: tuple[float, float], tolerance: str, unit: str = ""
) -> Row:
    """A row for a difference or ratio with its standard error and interval; the source's range is `between`."""
    if found is None:
        return Row(quantity, source, "not found", "", tolerance, Verdict.CANNOT_TELL)
    return Row(quantity, source, found.told(unit), found.interval(unit), tolerance, found.lies(*between))


def counted(value: Value | None) -> str:
    """A value with its scatter and the number of beds in which it was found."""
    return "not found" if value is None or value.value is None else number(value)


def alone(value: Value | None) -> str:
    """A value that does not vary from bed to bed."""
    return "not found" if value is None or value.value is None else f"{value.value:.4g} {value.unit}".removesuffix(" 1")
