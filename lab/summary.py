"""What a run found, on one page: summary.md for people, summary.json for programs, a short text."""

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from math import floor, log10
from pathlib import Path
from typing import get_type_hints

import numpy as np

from lab.errors import LabError
from lab.measures.value import Value
from lab.recording import Recording
from lab.shapes import caution
from lab.units import show
from solvers.motions import MOTIONS
from solvers.quantity import Unit

# What answers the question of an experiment, the most telling first; a recording has only what applies to it.
TELLING = (
    "capsized_at",
    "roll_amplitude",
    "frozen_amplitude",
    "significant_roll",
    "frozen_significant_roll",
    "roll_period",
    "largest_roll",
    "heap_angle",
    "flow_rate",
    "clogged",
    "spill_upturn_angle",
    "spilled_fraction",
    "critical_angle",
    "kept_shift",
    "top_fall",
    "response_amplitude",
    "response_phase",
    "effective_mass",
    "surface_slope",
    "wave_mode",
    "top_altitude_end",
    "final_shift",
    "first_slip_angle",
    "moment_amplitude",
    "contact_number",
)
HEADLINES, TOLD = 3, 6  # measures that the page says first, and that the terminal is told
SMALL = 1e-3  # numbers below are told with a power of ten
ROUNDING = 1e-9  # an error so small beside its value is that of the arithmetic
LARGE_OVERLAP = 0.05  # of a radius
SPREAD = "std of the beds"
ERROR = "error of one bed"


def write_summary(
    recording: Recording,
    values: Mapping[str, Value],
    files: Mapping[str, Path],
    folder: Path | str,
    warnings: Sequence[str] = (),
    notes: Sequence[str] = (),
) -> dict[str, Path]:
    """Write summary.md and summary.json into `folder`; returns both by name.

    files: what else the run made, by name; pictures among them are shown. warnings: sentences that a
    reader must know, beside those that follow from the recording; notes: ones that may interest.
    Raises LabError when the folder cannot be written.
    """
    folder = Path(folder)
    warnings = [*warnings, *_cautions(recording)]
    links = {name: Path(os.path.relpath(path, folder)).as_posix() for name, path in files.items()}
    page = "\n".join(_page(recording, values, links, warnings, notes))
    data = _data(recording, values, links, warnings) | {"notes": list(notes)}
    data = json.dumps(data, indent=2, allow_nan=False)
    written = {"summary": folder / "summary.md", "summary_json": folder / "summary.json"}
    try:
        written["summary"].write_text(page, encoding="utf-8")
        written["summary_json"].write_text(data + "\n", encoding="utf-8")
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror}): make room there.") from error
    return written


def terminal_summary(
    recording: Recording,
    values: Mapping[str, Value],
    files: Mapping[str, Path],
    warnings: Sequence[str] = (),
) -> str:
    """The summary as plain text of a few lines: the telling numbers, cost, files, warnings."""
    told = headlines(values, TOLD)
    rows = {name.replace("_", " "): f"{number(value)}{_remark(value)}" for name, value in told.items()}
    made = {name.replace("_", " "): os.path.relpath(path) for name, path in files.items()}
    lines = [f"{recording.preset['title']} ({recording.name}): {_status(recording)}"]
    lines += _aligned(rows)
    if len(told) < len(values):
        lines.append(f"  and {_count(len(values) - len(told), 'more number')} in the summary")
    lines += ["", f"  {_cost(recording)}"]
    lines += _aligned(made)
    lines += [f"  warning: {text}" for text in (*warnings, *_cautions(recording))]
    return "\n".join(lines)


def headlines(values: Mapping[str, Value], most: int) -> dict[str, Value]:
    """The most telling of the measured values, then others in their order, `most` in all."""
    order = {name: place for place, name in enumerate(TELLING)}
    names = sorted(values, key=lambda name: order.get(name, len(order)))
    return {name: values[name] for name in names[:most]}


def number(value: Value) -> str:
    """A value with its error and unit: 25.0 ± 1.3 deg; the error is the std, else the uncertainty."""
    if value.value is None:
        return "none"
    error = value.uncertainty if value.std is None else value.std
    unit = "" if value.unit == "1" else f" {value.unit}"
    if not error or error < ROUNDING * abs(value.value):
        return f"{value.value:.4g}{unit}"
    digits = max(0, 1 - floor(log10(error)))
    if max(abs(value.value), error) < SMALL:
        power = floor(log10(max(abs(value.value), error)))
        shown, spread, digits = value.value / 10.0**power, error / 10.0**power, digits + power
        return f"({shown:.{digits}f} ± {spread:.{digits}f})e{power:+03d}{unit}"
    return f"{value.value:.{digits}f} ± {error:.{digits}f}{unit}"


def _page(
    recording: Recording,
    values: Mapping[str, Value],
    links: Mapping[str, str],
    warnings: Sequence[str],
    notes: Sequence[str],
) -> Iterator[str]:
    """The lines of summary.md."""
    preset = recording.preset
    yield f"# {preset['title']}\n"
    for name, value in headlines(values, HEADLINES).items():
        yield f"- {name.replace('_', ' ')}: **{number(value)}**{_remark(value)}"
    yield f"\nThe run `{recording.name}` of {recording.created[:10]} is {_status(recording)}."
    yield from (f"\n**Warning:** {text}" for text in warnings)
    yield from (f"\n{text}" for text in notes)
    pictures = {name: link for name, link in links.items() if link.endswith(".png")}
    yield from (f"\n![{name}]({link})" for name, link in pictures.items())
    yield "\n## What was run\n"
    yield from (f"- {line}" for line in _scene(recording))
    if preset.get("source"):
        yield f"\n## What the source reports\n\n{preset['source']}\n\n{preset.get('reports', '')}"
    yield "\n## What was measured\n"
    yield f"| measure | value | {SPREAD} | {ERROR} | unit | note |\n|---|---|---|---|---|---|"
    yield from (_row(name, value) for name, value in values.items())
    yield "\nA value is the mean over the beds; d is the mean grain diameter. `lab/measures` defines each."
    yield f"\n## What it cost\n\n{_cost(recording)}, on {_machine(recording)}."
    yield "\n## Files\n"
    yield from (f"- [{name.replace('_', ' ')}]({link})" for name, link in links.items())
    yield f"\n## The preset\n\n```toml\n{recording.given.strip()}\n```\n"


def _row(name: str, value: Value) -> str:
    numbers = (value.value, value.std, value.uncertainty)
    cells = " | ".join("" if x is None else f"{x:.4g}" for x in numbers)
    unit = "" if value.unit == "1" else value.unit
    return f"| {name.replace('_', ' ')} | {cells} | {unit} | {value.note} |"


def _data(
    recording: Recording,
    values: Mapping[str, Value],
    links: Mapping[str, str],
    warnings: Sequence[str],
) -> dict:
    """The content of summary.json."""
    wall = recording.wall_s
    return {
        "preset": recording.name,
        "status": recording.status,
        "measures": {
            name: {
                "value": value.value,
                "unit": value.unit,
                "std": value.std,
                "uncertainty": value.uncertainty,
                "worlds": list(value.worlds),
                "note": value.note,
            }
            for name, value in values.items()
        },
        "cost": {
            "wall_s": wall,
            "grain_steps": recording.grain_steps,
            "grain_steps_per_s": recording.grain_steps / wall if wall else None,
            "dt_s": recording.step,
        },
        "files": dict(links),
        "warnings": list(warnings),
    }


def _scene(recording: Recording) -> Iterator[str]:
    worlds, count = recording.radius.shape
    low, high = show(2 * recording.radius.min(), "m"), show(2 * recording.radius.max(), "m")
    size = low if low == high else f"{low} to {high}"
    yield f"{_count(worlds, 'bed')} of {_count(count, 'grain')}, {size} in diameter"
    shapes = recording.preset.get("shapes") or {}
    if shapes:
        parts = [f"{100 * shape['share']:.3g} % {name}" for name, shape in shapes.items()]
        yield f"irregular grains, diameters those of discs of equal area: {', '.join(parts)}"
    width, height = (show(extent, "m") for extent in np.ptp(recording.outline, axis=0))
    lidless = ", open at the top" if recording.open_edges else ""
    rough = ", its walls lined with fixed grains" if len(recording.fixed) else ""
    yield f"tank {width} wide and {height} high{lidless}{rough}"
    if recording.parts:
        yield f"moving parts: {', '.join(recording.parts)}"
    for name, settings in (recording.preset.get("motion") or {}).items():
        if name in MOTIONS and settings:
            yield f"{name}: {_settings(name, settings)}"
    time = recording.series["time"]
    if len(time):
        yield f"{show(time[-1], 's')} of motion recorded, after the grains had settled"


def _settings(name: str, settings: Mapping) -> str:
    """Settings of a motion in the units people use, those that are zero left out."""
    hints = get_type_hints(MOTIONS[name], include_extras=True)
    units = {key: _unit(hint) for key, hint in hints.items()}
    shown = [
        f"{key} {show(value, units[key]) if units.get(key) else ''}".strip()
        for key, value in settings.items()
        if value and not isinstance(value, list | tuple)
    ]
    return ", ".join(shown)


def _unit(hint: object) -> str | None:
    marks = getattr(hint, "__metadata__", ())
    return next((mark.symbol for mark in marks if isinstance(mark, Unit)), None)


def _status(recording: Recording) -> str:
    if recording.status == "running":
        return "unfinished: it still goes on or was killed"
    return recording.status.rstrip(".")


def _cautions(recording: Recording) -> Iterator[str]:
    """What a reader must know of the run that the numbers do not say."""
    if recording.preset.get("quick"):
        yield f"A quick variant: {recording.preset['quick']}."
    if not recording.complete:
        yield f"The run is {_status(recording)}; the numbers cover what was recorded until then."
    scale = (recording.preset.get("contact") or {}).get("stiffness_scale", 1.0)
    if scale < 1:
        yield f"The grains are softer than their material: Young's moduli times {scale:g}."
    rule = (recording.preset.get("contact") or {}).get("outlines", "continuous")
    if recording.shapes and (rough := caution(recording.shapes.contours, rule)):
        yield rough
    if (recording.preset.get("run") or {}).get("force_step"):
        yield "The step is forced past the derived one: restitution errs by some 2 % at five times that."
    overlap = recording.series["overlap"].max(initial=0.0)
    if overlap > LARGE_OVERLAP:
        yield f"Grains overlapped by up to {100 * overlap:.1f} % of a radius."


def _cost(recording: Recording) -> str:
    rate = recording.grain_steps / recording.wall_s if recording.wall_s else 0.0
    return (
        f"{_duration(recording.wall_s)}: {recording.grain_steps:.3g} grain-steps at "
        f"{rate / 1e6:.1f} million a second, time step {show(recording.step, 's')}"
    )


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{seconds:.1f} s"


def _machine(recording: Recording) -> str:
    machine = recording.machine
    return f"{machine.get('cores')} cores, {machine.get('processor')}, {machine.get('system')}"


def _remark(value: Value) -> str:
    return f" ({value.note})" if value.note else ""


def _count(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def _aligned(rows: Mapping[str, str]) -> list[str]:
    width = max(map(len, rows), default=0)
    return [f"  {name:<{width}}  {text}" for name, text in rows.items()]
