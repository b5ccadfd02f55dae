"""The page: title, player, curves and numbers, in one file with its data."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from lab.base.text import heading, one_line
from lab.export.columns import columns_of
from lab.export.html.scene import Film, first_stride
from lab.measures import measure_all
from lab.report.numbers import RULE, number
from lab.report.summary import headlines

if TYPE_CHECKING:
    from lab.export.stage import Stage

MOST_BYTES = 9_500_000  # of a page
MOST_NUMBERS, MOST_CURVES, MOST_POINTS = 24, 60, 1200
SCRIPTS = "codec.js", "view.js", "plane.js", "space.js", "plot.js", "player.js"
FIRST_CURVES = "pose_roll", "centre_of_mass_y", "gauge_pressure", "water_centre_y"  # the one that is shown first
HERE = Path(__file__).parent


def write_html(stage: Stage, rows: Sequence[int], path: Path, reach: Callable[[int], None]) -> None:
    """Write the page. The scene is in the tank's axes, with its pose: the player shows it in the earth's, too."""
    inside = stage.of_tank()
    first = first_stride(inside, rows)
    rows = rows[::first]
    reel = Film(inside, rows, lambda done: reach(done * first))
    about = {"first": "earth" if stage.earth else "tank", "curves": curves(stage)}
    numbers, stride = _numbers(stage), 1
    while True:
        note = _note(stage, len(rows[::stride]))
        text = _page(stage, reel.scene(stride) | about, note, numbers)
        size = len(text.encode())
        more = min(stride + max(1, round(stride * (size / MOST_BYTES - 1.0))), max(stride, len(rows) - 1))
        if size <= MOST_BYTES or more == stride:
            break
        stride = more
    path.write_text(text, encoding="utf-8")


def curves(stage: Stage) -> list[dict]:
    """The series that vary, thinned to their highest and lowest values in as many pieces of the time."""
    series, found = stage.recording.series, []
    time = series["time"]
    for name, quantity in series.quantities.items():
        if name == "time":
            continue
        for label, values in columns_of(stage, name, quantity):
            known = values[np.isfinite(values)]
            if len(known) < 2 or np.ptp(known) == 0.0:
                continue
            if label.endswith("(rad)"):
                label, values = label.replace("(rad)", "(deg)"), np.degrees(values)
            when, shown = _thinned(time, values)
            rounded = [float(f"{x:.5g}") if np.isfinite(x) else None for x in shown]
            found.append({"label": label, "about": quantity.label, "time": when, "values": rounded})
    found.sort(key=lambda one: _rank(one["label"]))
    return found[:MOST_CURVES]


def _rank(label: str) -> int:
    return next((k for k, name in enumerate(FIRST_CURVES) if label.startswith(name)), len(FIRST_CURVES))


def _thinned(time: np.ndarray, values: np.ndarray) -> tuple[list[float], list[float]]:
    """Times and values; of many, the lowest and the highest of each of as many equal pieces, in their order."""
    keep = np.arange(len(time))
    if len(time) > MOST_POINTS:
        pieces = np.array_split(keep, MOST_POINTS // 2)
        filled = np.nan_to_num(values)
        ends = [sorted((piece[filled[piece].argmin()], piece[filled[piece].argmax()])) for piece in pieces]
        keep = np.unique(np.concatenate(ends))
    return [float(f"{t:.6g}") for t in time[keep]], values[keep].tolist()


def _numbers(stage: Stage) -> list[tuple[str, str, str]]:
    """The most telling numbers: name, value with its error, and what a reader must know of it."""
    values = headlines(measure_all(stage.recording), MOST_NUMBERS)
    return [(name.replace("_", " "), number(one), one_line(one.note)) for name, one in values.items()]


def _note(stage: Stage, count: int) -> str:
    """A sentence on what the page leaves out."""
    whole = len(stage.time)
    said = (
        [f"This page holds {count} of the {whole} recorded pictures, to stay small or as --every asks."]
        if count < whole
        else []
    )
    if stage.recording.worlds > 1:
        said.append(f"It shows repeat {stage.world} of {stage.recording.worlds}.")
    if not stage.recording.complete:
        said.append(f"The run is not complete: {one_line(stage.recording.status)}.")
    return " ".join(said)


def _page(stage: Stage, scene: dict, note: str, numbers: Sequence[tuple[str, str, str]]) -> str:
    recording = stage.recording
    loader = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    data = json.dumps(scene, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    when = one_line(recording.created)[:16].replace("T", " ")
    return loader.get_template("page.html.j2").render(
        title=heading(stage.title),
        about=f"{one_line(recording.name)} · {when} · Cargo Shift Lab {recording.version}",
        note=note,
        numbers=numbers,
        rule=RULE.partition(":")[0].replace("`", "") + ".",
        style=(HERE / "player.css").read_text(encoding="utf-8"),
        script="\n".join((HERE / name).read_text(encoding="utf-8") for name in SCRIPTS),
        data=data,
    )
