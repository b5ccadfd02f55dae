"""The results of a run: summary.md for people, summary.json for programs, and a short text for the terminal."""

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from lab.base.costs import in_words
from lab.base.errors import LabError
from lab.base.files import write_text
from lab.base.text import code, fenced, inline, one_line, paragraphs, printable
from lab.measures.value import Value
from lab.preset.fields import taken_of
from lab.preset.sections.ship import axis_place
from lab.preset.units import show
from lab.recording import Recording, ship_end
from lab.report import ship, water
from lab.report.cargo import bulk, grains, sources
from lab.report.numbers import RULE, count_of, number, own
from solvers.motion import OF_TANK

# The measures that answer the question of an experiment, the most important first; a run has only some of them.
TELLING = (
    *("capsized_at", "flooded_at", "sunk_at"),
    "entered_",
    "roll_amplitude",
    "frozen_amplitude",
    "significant_roll",
    "frozen_significant_roll",
    "roll_period",
    "largest_roll",
    "largest_shifted_share",
    "list_as_it_lay",
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
    *("bulk_half_range", "bulk_shift", "sliding_friction"),
    "first_slip_angle",
    "moment_amplitude",
    "contact_number",
    "heel_",
    "heave_",
    "room_water_",
    "gauge_peak_",
    "gauge_largest_",
    "force_peak_",
    "force_largest_",
    *("sloshing_frequency", "crest_", "run_up_", "highest_water", "gauge_impulse_", "force_impulse_", "water_residual"),
    *("gauge_mean_", "gauge_std_", "trough_"),
    *("gauge_peak_scatter_", "force_peak_scatter_", "crest_scatter_", "trough_scatter_"),
)
HEADLINES, TOLD = 3, 6  # numbers at the head of the page, and in the terminal


def write_summary(
    recording: Recording,
    values: Mapping[str, Value],
    files: Mapping[str, Path],
    folder: Path | str,
    warnings: Sequence[str] = (),
    notes: Sequence[str] = (),
    costs: Mapping[str, float] | None = None,
) -> dict[str, Path]:
    """Write summary.md and summary.json into `folder`, with `costs` (`lab.base.costs`) if told; returns both by name.

    files: the other files of the run, by name; the page shows the pictures among them. warnings: sentences that a
    reader must know, besides those that follow from the recording. notes: sentences of less weight.
    Raises LabError when the folder cannot be written.
    """
    folder = Path(folder)
    warnings = [*warnings, *cautions(recording)]
    links = {name: Path(os.path.relpath(path, folder)).as_posix() for name, path in files.items()}
    page = "\n".join(_page(recording, values, links, warnings, notes, costs))
    data = _data(recording, values, links, warnings) | {"notes": list(notes)}
    data["cost"] |= {"seconds": dict(costs)} if costs else {}
    data = json.dumps(data, indent=2, allow_nan=False)
    written = {"summary": folder / "summary.md", "summary_json": folder / "summary.json"}
    try:
        write_text(written["summary"], page)
        write_text(written["summary_json"], data + "\n")
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror}): make room there.") from error
    return written


def terminal_summary(
    recording: Recording,
    values: Mapping[str, Value],
    files: Mapping[str, Path],
    warnings: Sequence[str] = (),
    costs: Mapping[str, float] | None = None,
) -> str:
    """The summary as plain text of a few lines: the telling numbers, cost, files, warnings."""
    told = headlines(values, TOLD)
    rows = {name.replace("_", " "): f"{number(value)}{_remark(value)}" for name, value in told.items()}
    made = {name.replace("_", " "): os.path.relpath(path) for name, path in files.items()}
    lost = ship_end.losses_sentence(ship_end.ends(recording.series))
    title = f"{recording.preset.title} ({recording.name}): {status_of(recording)}{f'. {lost}' if lost else ''}"
    lines = [one_line(title), *_aligned(rows)]
    if len(told) < len(values):
        lines.append(f"  and {count_of(len(values) - len(told), 'more number')} in the summary")
    lines += ["", f"  {_cost(recording)}", *([f"  {in_words(costs)}"] if costs else [])]
    lines += [*_aligned(made), *(f"  warning: {one_line(text)}" for text in (*warnings, *cautions(recording)))]
    return printable("\n".join(lines))


def headlines(values: Mapping[str, Value], most: int) -> dict[str, Value]:
    """The most important of the measured values, then others in their order, `most` in all."""
    names = sorted(values, key=_place)
    return {name: values[name] for name in names[:most]}


def _place(name: str) -> int:
    """The place of a number among the telling ones; those of gauges begin with a name that ends in _."""
    fitting = [k for k, known in enumerate(TELLING) if name == known or (known[-1] == "_" and name.startswith(known))]
    return max(fitting, key=lambda k: len(TELLING[k]), default=len(TELLING))


def _page(
    recording: Recording,
    values: Mapping[str, Value],
    links: Mapping[str, str],
    warnings: Sequence[str],
    notes: Sequence[str],
    costs: Mapping[str, float] | None,
) -> Iterator[str]:
    """The lines of summary.md."""
    preset = recording.preset
    yield f"# {inline(preset.title)}\n"
    if lost := ship_end.losses_sentence(ship_end.ends(recording.series)):
        yield f"**{lost}**\n"
    for name, value in headlines(values, HEADLINES).items():
        yield f"- {name.replace('_', ' ')}: **{number(value)}**{_remark(value)}"
    yield f"\nThe run {code(recording.name)} of {inline(recording.created[:10])} is {inline(status_of(recording))}."
    yield from (f"\n**Warning:** {inline(text)}" for text in warnings)
    yield from (f"\n{paragraphs(text)}" for text in notes)
    pictures = {name: link for name, link in links.items() if link.endswith(".png")}
    yield from (f"\n![{name}]({link})" for name, link in pictures.items())
    yield "\n## What was run\n"
    yield from (f"- {line}" for line in _scene(recording))
    if preset.source:
        yield "\n## What the source reports\n"
        yield f"{paragraphs(preset.source)}\n\n{paragraphs(preset.reports)}"
    yield "\n## What was measured\n"
    yield "| measure | mean | std over beds | beds | own uncertainty | unit | note |\n|---|---|---|---|---|---|---|"
    yield from (_row(name, value) for name, value in values.items())
    unit = " d is the mean grain diameter." * bool(preset.grains)
    yield f"\n{RULE}{unit} `lab/measures` defines each measure."
    if preset.ship and (preset.grains or preset.bulk):
        yield from ship.criteria(recording)
    yield f"\n## What it cost\n\n{_cost(recording)}, on {inline(machine_of(recording))}."
    yield f"\n{in_words(costs)}." if costs else ""
    yield "\n## Files\n"
    yield from (f"- [{name.replace('_', ' ')}]({link})" for name, link in links.items())
    yield f"\n## The preset\n\n{fenced(recording.given, 'toml')}\n"


def _row(name: str, value: Value) -> str:
    cells = ["" if x is None else f"{x:.4g}" for x in (value.value, value.std)]
    unit = "" if value.unit == "1" else value.unit
    line = [name.replace("_", " "), *cells, str(value.n), own(value), unit, inline(value.note)]
    return f"| {' | '.join(line)} |"


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
        "based_on": recording.preset.based_on,
        "status": recording.status,
        "created": recording.created,
        "version": recording.version,
        "measures": {name: value.as_json() for name, value in values.items()},
        "cost": {
            "wall_s": wall,
            "grain_steps": recording.grain_steps,
            "grain_steps_per_s": recording.grain_steps / wall if wall else None,
            "dt_s": recording.step,
        },
        **({"water": water.facts(recording)} if recording.preset.water else {}),
        "files": dict(links),
        "warnings": list(warnings),
    }


def _scene(recording: Recording) -> Iterator[str]:
    if base := recording.preset.based_on:
        yield f"based on the preset {code(base)}, whose source and reports are its own"
    if recording.preset.grains:
        yield from grains.in_tank(recording)
    if recording.preset.water:
        yield from water.in_tank(recording)
    if recording.preset.bulk:
        yield from bulk.in_tank(recording)
    yield from map(inline, sources.in_words(recording.preset))
    if not recording.preset.matters:
        yield "nothing in the tank"
    width, height = (show(extent, "m") for extent in np.ptp(recording.outline, axis=0))
    lidless = "".join(f", {said}" for said in recording.preset.tank.in_space)
    lidless += ", open at the top" if recording.open_edges else ""
    rough = ", its walls lined with fixed grains" if len(recording.fixed) else ""
    yield f"tank {width} wide and {height} high{lidless}{rough}"
    if recording.parts:
        yield f"moving parts: {inline(', '.join(recording.parts))}"
    moved = {name: getattr(recording.preset.motion, name) for name in OF_TANK} | recording.preset.motion.own
    for name, motion in moved.items():
        if motion:
            yield f"{name}: {_settings(motion)}"
    if recording.preset.ship:
        yield f"sway, heave and roll of the ship are those of her axis, {axis_place(recording.preset.ship)}"
    time = recording.series["time"]
    if len(time):
        settled = ", after the cargo had settled" * bool(recording.preset.grains)
        yield f"{show(time[-1], 's')} of motion recorded{settled}"


def _settings(motion: object) -> str:
    """Settings of a motion in units for people; settings of zero are left out."""
    shown = [
        f"{name} {show(getattr(motion, name), taken.symbol) if taken.kind is float else ''}".strip()
        for name, taken in taken_of(type(motion)).items()
        if taken.kind in (float, bool) and getattr(motion, name)
    ]
    return ", ".join(shown)


def status_of(recording: Recording) -> str:
    if recording.status == "running":
        return "unfinished: it is still running or was killed"
    return recording.status.rstrip(".")


def cautions(recording: Recording) -> Iterator[str]:
    """What a reader must know about the run and cannot see from the numbers."""
    if recording.preset.quick:
        yield f"A quick variant: {recording.preset.quick}."
    if not recording.complete:
        yield f"The run is {status_of(recording)}; the numbers cover what was recorded until then."
    if recording.preset.grains:
        yield from grains.cautions(recording)
    if recording.preset.water:
        yield from water.cautions(recording)
    if recording.preset.bulk:
        yield from bulk.cautions(recording)


def _cost(recording: Recording) -> str:
    rate = recording.grain_steps / recording.wall_s if recording.wall_s else 0.0
    what = "grain" if recording.preset.grains else "particle"
    steps = f"{recording.grain_steps:.3g} {what}-steps at {rate / 1e6:.1f} million a second, "
    steps *= bool(recording.preset.matters)
    return f"{_duration(recording.wall_s)}: {steps}time step {show(recording.step, 's')}"


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{seconds:.1f} s"


def machine_of(recording: Recording) -> str:
    """The computer that ran it, as far as the recording knows it."""
    machine = recording.machine
    cores, arch = count_of(machine.get("cores") or 0, "core"), machine.get("arch", "cpu")
    if arch != "cpu":
        used = f"a graphics processor ({arch})"
    elif "threads" in machine:
        used = f"{machine['threads']} of {cores}"
    else:  # recordings of earlier versions
        used = f"a machine of {cores}"
    return f"{used}, {machine.get('processor')}, {machine.get('system')}"


def _remark(value: Value) -> str:
    return f" ({value.note})" if value.note else ""


def _aligned(rows: Mapping[str, str]) -> list[str]:
    width = max(map(len, rows), default=0)
    return [f"  {name:<{width}}  {text}" for name, text in rows.items()]
