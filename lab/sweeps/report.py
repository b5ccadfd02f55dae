"""The results of a sweep: a table for programs, figures, a video of the points side by side, and a page for readers."""

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from lab.base.errors import LabError
from lab.base.files import replacing, write_text
from lab.base.progress import Progress
from lab.base.text import cell, code, inline, one_line, printable
from lab.measures.value import Value
from lab.paint.video import MOST_IN_GRID, render_grid
from lab.recording import open_recording
from lab.report.numbers import BARS, RULE, number
from lab.report.plots import STYLE
from lab.report.summary import headlines
from lab.sweeps.point import Point
from lab.sweeps.result import Row, numeric, table

FIGURES = 3  # number of measures with a figure
FAMILIES = 6  # curves in one figure; more are drawn as a map


def write_report(
    name: str,
    axes: Mapping[str, Sequence],
    settings: Sequence[Mapping[str, object]],
    folder: Path,
    folders: Sequence[Path],
    progress: Progress,
    *,
    video: bool,
    plots: bool = True,
) -> tuple[list[Row], str]:
    """Write results.csv, summary.md, figures and sweep.mp4 of a sweep; returns the table's rows and a short text.

    settings: the values of the swept keys at each point; folders: of the points' runs, which may not exist yet. Raises
    LabError if the folder cannot be written.
    """
    points = [Point(setting, where) for setting, where in zip(settings, folders, strict=True)]
    rows = table(axes, points, folder)
    shown = headlines({key: value for point in points for key, value in point.measures.items()}, FIGURES)
    files = {"results": folder / "results.csv"}
    try:
        _write_table(rows, files["results"])
        if plots:
            files |= _figures(name, axes, points, shown, folder)
        if video and (film := _film(name, points, folder, progress)):
            files["video"] = film
        page = folder / "summary.md"
        write_text(page, "\n".join(_page(name, axes, points, list(shown), files, folder)))
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror or error}): make room there.") from error
    files["summary"] = page
    return rows, in_words(name, points, files)


def _write_table(rows: Sequence[Row], path: Path) -> None:
    with replacing(path) as part, part.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writerow({key: cell(key) for key in rows[0]})
        writer.writerows({key: cell(value) for key, value in row.items()} for row in rows)


def _figures(
    name: str, axes: Mapping[str, Sequence], points: Sequence[Point], shown: Mapping[str, Value], folder: Path
) -> dict[str, Path]:
    drawn = {}
    with matplotlib.rc_context(STYLE | {"text.parse_math": False}):  # labels are texts of users, and may hold a $
        for key, value in shown.items():
            means = np.array([point.measures[key].value if key in point.measures else None for point in points], float)
            if not np.isfinite(means).any():
                continue
            stds = np.array([getattr(point.measures.get(key), "std", None) for point in points], float)
            figure = Figure(figsize=(6.4, 4.2), layout="constrained")
            figure.suptitle(f"Sweep of {name}", x=0.02, ha="left", fontsize=9.5)
            unit = "" if value.unit == "1" else f" ({value.unit})"
            _draw(figure, axes, means, stds, key.replace("_", " ") + unit, _bars(points, key))
            drawn[key] = folder / f"{key}.png"
            with replacing(drawn[key]) as part:
                figure.savefig(part)
    return drawn


def _draw(
    figure: Figure, axes: Mapping[str, Sequence], means: np.ndarray, stds: np.ndarray, label: str, bars: str
) -> None:
    """Draw a measure over the first key: one curve per setting of the other keys, or a map for one key of many values.

    bars: label of the error bars, "" if there are none.
    """
    (key, values), *others = axes.items()
    shape = tuple(map(len, axes.values()))
    means, stds = means.reshape(shape[0], -1), stds.reshape(shape[0], -1)
    panel = figure.subplots()
    if len(others) == 1 and shape[1] > FAMILIES:
        (other, levels), = others  # fmt: skip
        mesh = panel.pcolormesh(np.arange(shape[0]), np.arange(shape[1]), means.T, shading="nearest", cmap="viridis")
        panel.set_yticks(range(shape[1]), [str(level) for level in levels])
        panel.set_xticks(range(shape[0]), [str(value) for value in values], rotation=30, ha="right")
        panel.set_xlabel(key)
        panel.set_ylabel(other)
        panel.grid(False)
        figure.colorbar(mesh, label=label)
        return
    scale = numeric(values)
    across = scale[0] if scale else np.arange(shape[0])
    order = np.argsort(across)
    colours = matplotlib.colormaps["viridis"](np.linspace(0, 0.85, means.shape[1]))
    for k, named in enumerate(_family_names(others)):
        errors = np.nan_to_num(stds[order, k]) if np.isfinite(stds[:, k]).any() else None
        panel.errorbar(
            across[order], means[order, k], errors, fmt="o-", ms=4, capsize=2.5, color=colours[k], label=named
        )
    panel.set_xlabel(f"{key} ({scale[1]})" if scale and scale[1] else key)
    if not scale:
        panel.set_xticks(across, [str(value) for value in values])
    elif _even_in_logarithm(scale[0]):
        panel.set_xscale("log")
        panel.xaxis.set_major_formatter("{x:g}")
    panel.set_ylabel(f"{label}\n{bars}" if bars else label)
    if 1 < means.shape[1] <= 2 * FAMILIES:
        figure.legend(loc="outside lower center", ncols=3)


def _bars(points: Sequence[Point], key: str) -> str:
    """Label of the error bars of a measure's figure, with the numbers of beds; "" if no point has two."""
    counts = {point.measures[key].n for point in points if key in point.measures and point.measures[key].n > 1}
    if not counts:
        return ""
    beds = f"{min(counts)}" if len(counts) == 1 else f"{min(counts)} to {max(counts)}"
    return f"{BARS} (n = {beds})"


def _family_names(others: Sequence[tuple[str, Sequence]]) -> list[str]:
    names = [""]
    for key, values in others:
        short = key.split(".")[-1]
        names = [f"{before}, {short} {value}".removeprefix(", ") for before in names for value in values]
    return names


def _even_in_logarithm(numbers: np.ndarray) -> bool:
    if len(numbers) < 3 or np.any(numbers <= 0):
        return False
    ratios = numbers[1:] / numbers[:-1]
    return bool(np.ptp(ratios) < 1e-3 * ratios[0] and abs(ratios[0] - 1) > 1e-3)


def _film(name: str, points: Sequence[Point], folder: Path, progress: Progress) -> Path | None:
    """Film the points side by side, an even selection if there are too many; None if nothing was filmed."""
    filmed = [point for point in points if _has_frames(point.folder)]
    if not filmed:
        return None
    chosen = np.unique(np.linspace(0, len(filmed) - 1, min(len(filmed), MOST_IN_GRID)).round().astype(int))
    shown = [filmed[k] for k in chosen]
    progress.start("painting", None)
    path = render_grid(
        [point.folder for point in shown],
        [point.caption for point in shown],
        folder / "sweep.mp4",
        title=f"Sweep of {name}",
        progress=progress.count,
    )
    progress.finish()
    return path


def _has_frames(folder: Path) -> bool:
    try:
        with open_recording(folder) as recording:
            return bool(len(recording.frames["time"]))
    except LabError:
        return False


def _page(
    name: str,
    axes: Mapping[str, Sequence],
    points: Sequence[Point],
    shown: Sequence[str],
    files: Mapping[str, Path],
    folder: Path,
):
    """The lines of summary.md."""
    yield f"# Sweep of {inline(name)}\n"
    yield from (f"- {code(key)}: {inline(', '.join(str(value) for value in values))}" for key, values in axes.items())
    yield f"\n{_progress(points)}"
    yield from (f"\n![{key}]({path.name})" for key, path in files.items() if path.suffix == ".png")
    yield "\n## Points\n"
    heads = ["point", *axes, *(key.replace("_", " ") for key in shown), "status"]
    yield f"| {' | '.join(map(inline, heads))} |\n|{'---|' * len(heads)}"
    for k, point in enumerate(points):
        where = point.folder.relative_to(folder).as_posix()
        cells = [f"[{k}]({where}/summary.md)", *map(inline, point.setting.values())]
        cells += [inline(number(point.measures[key])) if key in point.measures else "" for key in shown]
        yield f"| {' | '.join([*cells, inline(point.status)])} |"
    yield f"\n{RULE}"
    warned = {warning: [] for point in points for warning in point.warnings}
    for k, point in enumerate(points):
        for warning in point.warnings:
            warned[warning].append(str(k))
    versions = sorted({point.version for point in points} - {""})
    if len(versions) > 1:
        yield f"\n**Warning**: the points were run by different versions of the lab: {inline(', '.join(versions))}."
    yield from (f"\n**Warning** (points {', '.join(where)}): {inline(warning)}" for warning, where in warned.items())
    yield "\n## Files\n"
    yield from (f"- [{key.replace('_', ' ')}]({path.name})" for key, path in files.items())
    yield ""


def _progress(points: Sequence[Point]) -> str:
    complete = sum(point.status == "complete" for point in points)
    stopped = [str(k) for k, point in enumerate(points) if point.status.startswith("stopped: world")]
    text = f"{complete} of {len(points)} points are complete"
    return f"{text}; stopped: {', '.join(stopped)}." if stopped else f"{text}."


def in_words(name: str, points: Sequence[Point], files: Mapping[str, Path]) -> str:
    """The points and the files in plain text, a line each."""
    lines = [f"Sweep of {one_line(name)}: {_progress(points)}"]
    width = max(len(point.caption) for point in points)
    for point in points:
        values = [f"{key.replace('_', ' ')} {number(value)}" for key, value in headlines(point.measures, 2).items()]
        lines.append(f"  {point.caption:<{width}}  {', '.join(values) or one_line(point.status)}")
    width = max(map(len, files), default=0)
    made = [f"  {key.replace('_', ' '):<{width}}  {path}" for key, path in files.items()]
    return printable("\n".join([*lines, "", *made]))
