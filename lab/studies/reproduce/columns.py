"""The further table of an experiment: a row a run, what it cost, and numbers of it."""

from collections.abc import Mapping, Sequence

from pydantic import BaseModel, ConfigDict

from lab.report.numbers import plus_minus
from lab.studies.reproduce.compare import number_of
from lab.studies.reproduce.registry import OF_ONE_RUN
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.costs import COSTS, cost

STOPPED = "stopped"


class Column(BaseModel):
    """A number of every run under a `head`: which (`of`, `given`) as in a claim, and how it is written.

    `shows` may ask for the number's own `error` and its `note`; `missing` stands for a number that a run has not.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    head: str
    of: str
    given: float | list[float] | None = None
    shows: str = ""
    missing: str = "none"


def table(columns: Sequence[Column], found: Mapping[str, Sequence[Outcome]]) -> list[list[str]]:
    """The table of runs of water, its heads first.

    Of a run that was stopped its cost alone is told: its last cycles, or its highest water, are not the whole run's.
    """
    made = [[*COSTS, *(one.head for one in columns)]]
    for run, outcomes in found.items():
        whole = all(one.status == "complete" for one in outcomes)
        made.append([*cost(run, outcomes[0]), *(_cell(one, run, outcomes) if whole else STOPPED for one in columns)])
    return made


def _cell(column: Column, run: str, outcomes: Sequence[Outcome]) -> str:
    number = number_of(run, column.of, outcomes, column.given)
    value = number.value
    if value is None or value.value is None:
        return column.missing
    if number.of in OF_ONE_RUN and value.std is not None:
        return f"{plus_minus(value.value, value.std)} {value.unit}"
    if not column.shows:
        return number.text()
    return column.shows.format(value.value, error=value.uncertainty, note=value.note)
