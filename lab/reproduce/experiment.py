"""An experiment of the source: the runs it takes, and what is told of them beside what the source states."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from matplotlib.figure import Figure

from lab.measures.value import Value
from lab.reproduce.runs import Batch, Outcome
from lab.summary import number


@dataclass(frozen=True)
class Row:
    """One line of the comparison. `agrees` is None where the source states nothing that could be held against it."""

    quantity: str
    source: str
    ours: str
    difference: str
    agrees: bool | None

    def __post_init__(self) -> None:
        if self.agrees is not None:  # numpy's own truth values cannot be kept in a file
            object.__setattr__(self, "agrees", bool(self.agrees))


@dataclass(frozen=True)
class Told:
    """What came of an experiment: rows and the figure."""

    rows: Sequence[Row]
    figure: Figure | None = None


@dataclass(frozen=True)
class Experiment:
    """`states` says in words what the source (its `section`) reports; `batches(quick)` what is run, by name.

    `tell` compares the outcomes of the batches, each a list by the points of its grid. `lost` says what the quick runs
    leave out; `shown` is the batch of which a `point`, mostly the last, is pictured, at this fraction of its time;
    `remark` what one has to know to read the rows, and why they differ where they do.
    """

    name: str
    title: str
    section: str
    states: str
    batches: Callable[[bool], Mapping[str, Batch]]
    tell: Callable[[Mapping[str, Sequence[Outcome]]], Told]
    lost: str
    shown: tuple[str, float]
    remark: str = ""
    point: int = -1


def stated(quantity: str, source: float, ours: Value | None, within: float) -> Row:
    """A number of the source beside ours; they agree if they differ by at most `within`, in the same unit.

    The difference comes with the standard error of our mean over beds.
    """
    if ours is None or ours.value is None:
        return Row(quantity, f"{source:g}", "not found", "", False)
    difference = ours.value - source
    unit = "" if ours.unit == "1" else f" {ours.unit}"
    said = f"{difference:+.3g}"
    if ours.std:
        error = f"{ours.std / sum(world is not None for world in ours.worlds) ** 0.5:#.2g}".rstrip(".")
        said = f"{difference:+.{len(error.partition('.')[2])}f} ± {error}"
    return Row(quantity, f"{source:g}{unit}", counted(ours), said + unit, abs(difference) <= within)


def observed(quantity: str, source: str, ours: str, agrees: bool | None) -> Row:
    """What the source says in words, beside what we see."""
    return Row(quantity, source, ours, "", agrees)


def counted(value: Value | None) -> str:
    """A value with its error and the number of beds in which it was found."""
    if value is None or value.value is None:
        return "not found"
    found = sum(world is not None for world in value.worlds)
    return f"{number(value)} ({found} bed{'s' if found != 1 else ''})"


def ordered(*values: Value | None) -> bool:
    """Whether the means fall from one to the next."""
    means = [value.value if value else None for value in values]
    return None not in means and all(a > b for a, b in pairwise(means))
