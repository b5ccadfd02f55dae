"""The ratios to other codes for each processor measured: kept records, and the page made from them.

Records that come with the lab are in `measured.json`; a run of the bench adds that of its own processor in its folder,
in place of an older one.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import date
from pathlib import Path

import numpy as np
from pydantic import TypeAdapter

from lab.report.kept import Made, processor, read, write
from lab.report.page import render, table

MEASURED = Path(__file__).with_name("measured.json")
SPRINGS = "history", "history (Mindlin)"  # the other code's law and the lab's
GRAIN_STEPS = "grain-steps"
HEADER = ("code", "law", "the lab's law", "bed", "counted in", "the lab: times as fast", "processor", "measured by")


@dataclass(frozen=True)
class Ratio:
    """How many times as fast as a code the lab is: the median of turns, None where only the range is known.

    `law` is the other code's, `ours` the lab's; `bed` says whether the grains rest or flow, `unit` what is counted.
    """

    code: str
    law: str
    ours: str
    bed: str
    unit: str
    least: float
    most: float
    median: float | None = None

    @property
    def what(self) -> tuple[str, ...]:
        """All but the numbers."""
        return self.code, self.law, self.ours, self.bed, self.unit

    @property
    def words(self) -> str:
        """For a reader: "5.32 (4.82 to 6.04)"."""
        low, high = f"{self.least:g}", f"{self.most:g}"
        return f"{low} to {high}" if self.median is None else f"{self.median:g} ({low} to {high})"


@dataclass(frozen=True)
class Record:
    """The ratios on a processor and what made them; `independent` if by others, with decks of their own."""

    made: Made
    ratios: Sequence[Ratio]
    independent: bool = False


RECORDS = TypeAdapter(dict[str, Record])


def ratio(code: str, law: str, ours: str, speeds: np.ndarray, others: np.ndarray) -> Ratio:
    """The ratio of grain-steps a second (turns,) on a bed at rest."""
    found = speeds / others
    least, most, median = (float(f"{pick(found):.3g}") for pick in (np.min, np.max, np.median))
    return Ratio(code, law, ours, "at rest", GRAIN_STEPS, least, most, median)


def keep(folder: Path, ratios: Sequence[Ratio]) -> None:
    """Put the ratios on this processor into the folder's records, in place of older ones of the same things."""
    path = folder / "speed-peers.json"
    records = RECORDS.validate_python(read(path))
    older = records[processor()].ratios if processor() in records else ()
    new = {one.what for one in ratios}
    record = Record(Made.now("bench speed"), [*(one for one in older if one.what not in new), *ratios])
    write(path, {**read(path), processor(): asdict(record)})


def known(folder: Path) -> dict[str, Record]:
    """The records by processor: those that come with the lab, and the folder's own in their place."""
    return RECORDS.validate_python({**read(MEASURED), **read(folder / "speed-peers.json")})


def overview(folder: Path) -> str:
    """A table in Markdown of springs with history in both codes: a row a processor, bed and unit, grain-steps first."""
    found: dict[tuple[str, str, str], dict[str, Ratio]] = {}
    records = known(folder)
    for name, record in records.items():
        for one in record.ratios:
            if (one.law, one.ours) == SPRINGS:
                found.setdefault((name, one.unit, one.bed), {})[one.code] = one
    codes = sorted({code for ratios in found.values() for code in ratios})
    order = sorted(found, key=lambda what: (what[1] != GRAIN_STEPS, what[1], what[0], what[2]))
    rows = [
        [*what, *(found[what][one].words if one in found[what] else "" for one in codes), who(records[what[0]])]
        for what in order
    ]
    return table(["processor", "counted in", "bed", *codes, "measured by"], rows)


def write_page(folder: Path) -> Path:
    """Write the page from the records; returns its file."""
    rows = [(one, name, record) for name, record in known(folder).items() for one in record.ratios]
    rows.sort(key=lambda row: row[0].least)
    cells = [_row(*row) for row in rows]
    return render(folder / "speed-peers.md", "speed_peers.md.j2", date=date.today(), header=HEADER, rows=cells)


def _row(one: Ratio, name: str, record: Record) -> Sequence[str]:
    return one.code, one.law, one.ours, one.bed, one.unit, one.words, name, who(record)


def who(record: Record) -> str:
    """Who measured, and with which version when."""
    if record.independent:
        return "others, with decks of their own"
    return f"the lab, {record.made.when}"


def ratios_of(found: Mapping[str, np.ndarray], theirs: Sequence[str], ours: Sequence[str]) -> list[Ratio]:
    """The ratios of each of our timings to each of theirs, whose names are "CODE, LAW"."""
    laws = {own: own.split(", ", 1)[1] for own in ours}
    return [ratio(*name.split(", ", 1), laws[own], found[own], found[name]) for name in theirs for own in ours]
