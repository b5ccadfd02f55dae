"""The results of experiments, kept in a file beside the report's page, so that it can do without their runs."""

import hashlib
import json
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from lab.base.data import data_file
from lab.base.errors import LabError
from lab.preset.find import load
from lab.report.kept import Made, write
from lab.studies.reproduce.experiment import Experiment, Row
from lab.studies.reproduce.runs import Batch


@dataclass(frozen=True)
class CachedResult:
    """An experiment as the page tells it.

    `asked` is a hash of its runs (see `asked`); `stopped` names runs that did not reach their end, and why; `figure`
    and `picture` are files beside the page, "" for none; `table` is a further one, its header first; `made` says what
    made the runs.
    """

    asked: str
    rows: Sequence[Row]
    stopped: Sequence[tuple[str, str]]
    grain_steps: float
    wall_s: float
    figure: str
    picture: str
    made: Made
    table: Sequence[Sequence[str]] = ()


# Keys of a preset that do not affect a run.
WORDS = ("format", "title", "source", "reports", "based_on", "quick", "video")
# Tables by what a hash calls them: the sea was named water before presets had a format, and results are kept from then.
CALLED = {"sea": "water", "water": "water in the tank"}
CACHED = TypeAdapter(dict[str, CachedResult])


def read_cached(path: Path, experiments: Mapping[str, Experiment], quick: bool) -> dict[str, CachedResult]:
    """Read the findings of these experiments, except those whose runs have changed since. Raises LabError.

    One whose measured series is not here is kept: its runs can be neither compared nor made again.
    """
    try:
        found = CACHED.validate_json(path.read_bytes())
    except FileNotFoundError:
        return {}
    except (OSError, ValidationError) as error:
        raise LabError(f"{path} cannot be read: remove it, and what it told of is run again.") from error
    return {
        name: finding
        for name, finding in found.items()
        if name in experiments and _still_asked(experiments[name], finding, quick)
    }


def _still_asked(one: Experiment, finding: CachedResult, quick: bool) -> bool:
    return (bool(one.needs) and not data_file(one.needs)) or finding.asked == asked(one.batches(quick))


def write_cached(path: Path, findings: Mapping[str, CachedResult]) -> None:
    """Write the findings, atomically."""
    write(path, {name: asdict(finding) for name, finding in findings.items()})


def asked(batches: Mapping[str, Batch]) -> str:
    """A hash of what the batches run: the keys of their presets that affect a run, and the varied keys."""
    told = [
        (
            key,
            _of_the_experiment(load(batch.preset, batch.changes).given_text),
            {axis: list(values) for axis, values in batch.axes.items()},
        )
        for key, batch in batches.items()
    ]
    return hashlib.sha256(repr(told).encode()).hexdigest()[:16]


def _of_the_experiment(given: str) -> str:
    """A preset's keys without its format, texts and video settings, which change no number."""
    table = {CALLED.get(key, key): value for key, value in tomllib.loads(given).items() if key not in WORDS}
    return json.dumps(table, sort_keys=True)
