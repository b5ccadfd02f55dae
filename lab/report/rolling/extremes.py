"""`cargolab extremes`: the largest roll in some hours from records, runs or tables, by Gumbel and by Weibull."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np

from lab.base.errors import LabError
from lab.naval.rolling import extremes as fits
from lab.naval.rolling.extremes import Gumbel, Level
from lab.naval.rolling.records import read_roll
from lab.naval.tables import Table, write
from lab.recording import open_recording
from lab.recording.ship_end import ends
from lab.report.page import save_figure
from lab.report.plots import BLUE, STYLE, VERMILION, canvas
from solvers.machine.quantity import ROLL

HOUR = 3600.0  # s
SIZE = (6.4, 4.4)


@dataclass(frozen=True, eq=False)
class Record:
    """A record of roll (T,) rad at times (T,) s; `seed` of its sea, if it is a run's."""

    name: str
    time: np.ndarray
    roll: np.ndarray
    seed: int | None = None

    @property
    def length(self) -> float:
        """Duration (s)."""
        return float(self.time[-1] - self.time[0])


@dataclass(frozen=True, eq=False)
class Found:
    """What is told: levels (deg) by name, or in `silent` why there are none."""

    levels: dict[str, Level]
    silent: tuple[str, ...]
    gumbel: Gumbel | None
    block: float
    rolls: float


def read(paths: Sequence[Path]) -> list[Record]:
    """The records of files and of runs. Raises LabError for what is no record, and for two runs in the same sea."""
    records = [_of_table(path) if path.suffix.lower() == ".csv" else _of_run(path) for path in paths]
    seeds = [one.seed for one in records if one.seed is not None]
    if twice := next((seed for seed in seeds if seeds.count(seed) > 1), None):
        raise LabError(f"waves.seed: two of the runs have the sea of seed {twice}; give runs with seeds of their own.")
    return records


def _of_table(path: Path) -> Record:
    return Record(path.name, *read_roll(path))


def _of_run(path: Path) -> Record:
    """The first ship of a run, after the soft start of her random sea."""
    with open_recording(path) as recording:
        preset, time = recording.preset, recording.series["time"]
        if not (preset.ship and preset.waves and preset.waves.height):
            raise LabError(f"{path}: is no run of a ship in a random sea; give runs of one, or tables of roll.")
        if ends(recording.series)[0] is not None:
            raise LabError(f"{path}: she was lost, so the largest roll of a time cannot be told; leave no run out.")
        rows = time >= preset.waves.soft_start
        return Record(path.name, time[rows], recording.series["pose"][rows, 0, ROLL], preset.waves.seed)


def judge(records: Sequence[Record], hours: float, block: float | None) -> Found:
    """Levels of the largest |roll| in some hours, from blocks of a length (s); None: of the shortest record."""
    block = block or min(one.length for one in records)
    peaks = np.concatenate([fits.half_cycles(one.roll) for one in records])
    whole = sum(one.length for one in records)
    period = 2.0 * whole / max(len(peaks), 1)
    maxima = np.degrees(np.concatenate([fits.block_maxima(one.time, one.roll, block) for one in records]))
    levels, silent, gumbel = {}, [], None
    if hours * HOUR > fits.FAR * whole:
        far = f"{hours:g} h are more than {fits.FAR:g} times all records, {whole / HOUR:.3g} h"
        return Found({}, (f"cannot tell: {far}; give more records.",), None, block, block / period)
    if len(maxima) < fits.LEAST:
        silent.append(f"Gumbel: cannot tell from {len(maxima)} blocks; {fits.LEAST} or more are needed.")
    elif block < fits.ROLLS * period:
        silent.append(
            f"Gumbel: cannot tell from blocks of {block / period:.2g} rolls; {fits.ROLLS} or more are needed."
        )
    elif not np.ptp(maxima) > 0.0:
        silent.append("Gumbel: cannot tell; all blocks have the same largest roll.")
    else:
        gumbel, blocks = fits.fit_gumbel(maxima), hours * HOUR / block
        levels |= {"Gumbel, mean": gumbel.mean(blocks), "Gumbel, not exceeded with 95 %": gumbel.sure(blocks)}
    if len(peaks) < fits.PEAKS:
        silent.append(f"Weibull: cannot tell from {len(peaks)} half cycles; {fits.PEAKS} or more are needed.")
    else:
        levels["Weibull, most probable"] = fits.weibull_largest(np.degrees(peaks), 2.0 * hours * HOUR / period)
    return Found(levels, tuple(silent), gumbel, block, block / period)


def examine(paths: Sequence[Path], hours: float, block: float | None, folder: Path) -> tuple[str, dict[str, Table]]:
    """Write the table and figure of the largest roll; returns text and tables. Raises LabError as `read` does."""
    records = read(paths)
    shortest = min(one.length for one in records)
    if block is not None and block > shortest:
        raise LabError(f"--block: {block:g} s are longer than the shortest record, {shortest:.4g} s.")
    found = judge(records, hours, block)
    header = "largest roll", "value deg", "low deg", "high deg", "n"
    count = len(found.gumbel.maxima) if found.gumbel else 0
    rows = [
        (name, *(f"{value:.4g}" for value in (one.value, one.low, one.high)), count if "Gumbel" in name else "")
        for name, one in found.levels.items()
    ]
    tables = {"extremes": (header, rows)}
    write(tables, folder)
    if found.gumbel:
        _draw(folder / "extremes.png", found, hours)
    largest = max(float(np.degrees(np.abs(one.roll).max())) for one in records)
    hours_of_all = sum(one.length for one in records) / HOUR
    lines = [
        f"records: {len(records)}, {hours_of_all:.3g} h; largest roll {largest:.3g} deg; "
        f"blocks of {found.block:.4g} s, {found.rolls:.3g} rolls each",
        f"largest roll in {hours:g} h, with intervals of 95 %:",
    ]
    lines += [
        f"  {name:<32}{one.value:.3g} deg ({one.low:.3g} to {one.high:.3g})" for name, one in found.levels.items()
    ]
    return "\n".join([*lines, *(f"  {why}" for why in found.silent)]), tables


def _draw(path: Path, found: Found, hours: float) -> Path:
    """Maxima of blocks on Gumbel's paper, with the fitted line and its band."""
    gumbel = found.gumbel
    count = len(gumbel.maxima)
    share = (np.arange(1, count + 1) - 0.44) / (count + 0.12)  # Gringorten (1963)
    blocks = hours * HOUR / found.block
    at = float(np.log(blocks) + fits.EULER)
    line = np.linspace(-1.5, max(at, 4.0) + 0.5, 60)
    levels = [gumbel.at(float(y)) for y in line]
    with matplotlib.rc_context(STYLE):
        figure, axes = canvas(SIZE)
        axes.plot(-np.log(-np.log(share)), np.sort(gumbel.maxima), "o", ms=4, color=BLUE, label="largest of a block")
        axes.plot(line, [one.value for one in levels], color=VERMILION, label="Gumbel, maximum likelihood")
        band = [one.low for one in levels], [one.high for one in levels]
        axes.fill_between(line, *band, color=VERMILION, alpha=0.2, lw=0, label="95 % interval")
        mean = gumbel.mean(blocks)
        error = [[mean.value - mean.low], [mean.high - mean.value]]
        axes.errorbar([at], [mean.value], error, fmt="ks", ms=5, capsize=3, label=f"mean of the largest in {hours:g} h")
        axes.set_xlabel("reduced variate −ln(−ln F)")
        axes.set_ylabel("largest roll (deg)")
        axes.set_ylim(0.0)
        axes.legend(loc="upper left")
        axes.set_title(f"{count} blocks of {found.block:.4g} s")
        return save_figure(path, figure)
