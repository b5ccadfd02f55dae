"""What is said of a ship: by `cargolab explain` her balance, roll and forces, in reports the sheet of criteria."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import isfinite, nan, pi

import numpy as np

from lab.assembly.ship import flooding_angles, righting
from lab.base.errors import LabError
from lab.measures import ship_grain, ship_unevenness
from lab.measures.ship import has_ship, vessel_of
from lab.measures.value import over_worlds
from lab.naval import sheet
from lab.naval.condition import Condition, condition
from lab.naval.free_surfaces import taken_by_surfaces
from lab.preset.schema import Preset
from lab.preset.sections import ship as ships
from lab.preset.sections.sea import Waves
from lab.preset.sections.ship import axis_place
from lab.preset.units import show
from lab.recording import Recording
from solvers.ship.naval import trimming
from solvers.ship.naval.criteria import Criterion
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import froude_factors

CANNOT_TELL = "cannot tell"
CREPT = 1.05  # times as far aside in the last tenth of a run as before: the cargo still shifts
SAME_MASS = 0.02  # by which the bed may weigh more or less than its volume at the stated stowage factor
OF = {"section": "", "strips": "; by strips of her hull", "hull": "; of her hull in space"}


def describe(preset: Preset, vessel: Vessel, slab: tuple[float, float] | None, every: float) -> list[tuple[str, str]]:
    """Rows on the ship of a preset, each a name and a text: balance, roll, forces of the water.

    slab: thickness (m) of the slab that her cargo is, and how many of them a metre of her carries (1/m); None if her
    hold is empty. every: the step (s) of the water's forces.
    """
    given, waves, ship, body = preset.ship, preset.waves, vessel.ship, vessel.ship.body
    water, memory = ship.load.water, ship.radiation.memory
    height = righting(ship.load.section, body, water) / (body.mass * water.gravity)
    floats = f"{body.mass:.4g} kg/m, GM solid {show(height, 'm')}, gyradius {show(body.gyradius, 'm')}"
    rows = [("empty", floats)]
    if slab is not None:
        thick = f"a slab {show(slab[0], 'm')} thick: its load counts {slab[1]:.4g} times a metre"
        rows = [("with her cargo", floats), ("cargo", thick)]
    if taken := taken_by_surfaces(preset, vessel):
        fluid = f"GM fluid {show(height - taken, 'm')}, as long as they reach from wall to wall"
        rows.append(("free surfaces", f"take {show(taken, 'm')} of her GM: {fluid}"))
    if vessel.rest:
        rows.append(("lolls", _lolls(given, vessel)))
    rows += [
        ("free in", given.freedom.replace("-", ", ") + f", about her axis, {axis_place(given)}"),
        (
            "viscous roll damping",
            f"{ship.damping.linear:.3g} N s φ̇ and {ship.damping.quadratic:.3g} N s^2 φ̇|φ̇|, a metre",
        ),
        ("radiation", _radiated(given, memory) + OF[given.hydrodynamics]),
        ("water's forces", f"every {show(every, 's')}" + "; the cargo's at each step" * (slab is not None)),
    ]
    if waves is not None:
        rows += [("excitation", given.excitation), ("waves", _sea(waves, water))]
    if given.capsize:
        rows.append(("capsized", f"beyond {show(given.capsize, 'rad')}"))
    if vessel.sinks:
        rows.append(("sunk", f"with more than {vessel.reserve:.4g} kg/m of water in her, her reserve buoyancy"))
    rows += [
        (name.replace("_", " "), f"{show(angle, 'rad')}, in calm water at constant displacement")
        for name, angle in flooding_angles(given, vessel).items()
        if angle is not None
    ]
    if slab is not None:
        rows.append(
            ("her cargo's repose", f"{show(given.repose, 'rad')}, for righting levers and the IMSBC Code alone")
        )
    if given.scale:
        rows.append((f"full scale 1:{given.scale:g}", _full_scale(given, waves)))
    return rows


def _lolls(given: ships.Ship, vessel: Vessel) -> str:
    """Where she comes to rest, and how she gets there."""
    to = f"to {show(vessel.rest, 'rad')} in calm water, either side, as her GM is negative"
    return to if given.heel else f"{to}; heeled there, to port, until {show(vessel.release, 's')}"


def _radiated(given: ships.Ship, memory) -> str:
    if memory is None:
        return {"none": "none, added mass alone", "at-frequency": "that of the waves' frequency"}[given.radiation]
    worst = 100.0 * float(memory.error.max())
    return f"memory of {len(memory.matrix)} states, off the tables by {worst:.2g} % at most (rms)"


def _sea(waves: Waves, water: Water) -> str:
    period, number = 2.0 * pi / waves.frequency, float(water.wave_number(waves.frequency))
    size = waves.height if waves.amplitude is None else waves.amplitude
    steep = f", {show(2.0 * pi / number, 'm')} long" if number else ""
    return f"{waves.kind}, {show(size, 'm')}, {show(period, 's')}{steep}"


def _full_scale(given: ships.Ship, waves: Waves | None) -> str:
    """The same run for a ship `scale` times as long, by Froude's law."""
    factor = froude_factors(given.scale)
    words = [f"draught {show(given.draught * factor['length'], 'm')}", f"times {factor['time']:.3g} as long"]
    if waves is not None:
        size = waves.height if waves.amplitude is None else waves.amplitude
        words.append(f"waves of {show(size * factor['length'], 'm')}")
        words.append(f"every {show(2.0 * pi / waves.frequency * factor['time'], 's')}")
    return ", ".join(words)


def judged(recording: Recording) -> tuple[list[sheet.Row], list[tuple[str, str]], list[str]]:
    """Sheet and condition of a recording's ship, and what was not judged; all empty without one that can be judged."""
    if not has_ship(recording):
        return [], [], []
    found = ship_grain.shift(recording)
    if found is not None:
        rows = [*_lying(recording, found), *_trimming(recording, found.condition)]
        notes = [*sheet.unjudged(found.condition), *_cautions(recording, found.condition, rows)]
        return rows, sheet.facts(found.condition), notes
    vessel = vessel_of(recording.path)
    if vessel is None:
        return [], [], []
    try:
        alone = condition(recording.preset, vessel)
    except LabError:
        return [], [], []
    return sheet.rows(alone), sheet.facts(alone), list(sheet.unjudged(alone))


def _lying(recording: Recording, found: ship_grain.Shift) -> Iterator[sheet.Row]:
    """The sheet with the cargo as it lay in the worst bed; what rests on the run is judged by all of its beds."""
    beds = [sheet.rows(found.condition, found.lying(way)) for way in found.farthest]
    aside, last = np.abs(found.way[..., 0]), found.last(recording.series["time"]).start
    still = bool((aside.max(axis=0) <= CREPT * aside[: max(last, 1)].max(axis=0)).all())
    for k, row in enumerate(sheet.rows(found.condition, found.lying(ship_grain.worst(found)))):
        if row.shift != sheet.AS_IT_LIES:
            yield row
            continue
        told = verdict_of([bed[k].criterion for bed in beds])
        moving = told == "pass" and not still
        grounds = grounds_of(recording) + "; it still shifted at the end" * moving
        yield replace(row, told=CANNOT_TELL if moving else told, grounds=grounds)


def verdict_of(beds: Sequence[Criterion]) -> str:
    """What beds tell of one criterion: "pass" or "fail" where the 95 % interval of their mean does, else "cannot tell".

    One bed has no interval. A bed in which she finds no equilibrium fails, and leaves the mean unknown.
    """
    attained = over_worlds([one.attained if isfinite(one.attained) else nan for one in beds], "")
    if attained.n < len(beds):
        return "fail" if len(beds) > 1 and not any(one.passed for one in beds) else CANNOT_TELL
    ends = attained.interval
    told = {replace(beds[0], attained=end).verdict for end in ends} if ends else set()
    return told.pop() if len(told) == 1 else CANNOT_TELL


def grounds_of(recording: Recording) -> str:
    """What a verdict of a run rests on: beds, grains and what they stand for, time."""
    preset, count = recording.preset, recording.radius.shape[1]
    time = show(float(recording.series["time"][-1]), "s")
    if preset.bulk:
        return f"bulk of {recording.bulk_volume.shape[1]} points, a continuum; {time}"
    beds = "1 bed" if recording.worlds == 1 else f"{recording.worlds} beds"
    size, real = preset.mean_diameter, preset.grains.stands_for
    coarse = f", {size / real:.3g} times as large as the real ones" if real else ""
    across = f"{preset.tank.extent[0] / size:.0f} across the hold"
    return f"{beds} of {count} grains, {across}{coarse}; {time}"


def _cautions(recording: Recording, ship: Condition, rows: list[sheet.Row]) -> Iterator[str]:
    """What a reader must know of a sheet that rests on a run, a sentence each."""
    if recording.worlds == 1 and recording.preset.grains and any(row.told for row in rows):
        yield (
            "One bed cannot tell whether she passes with the cargo as it lay, since it does not say how far beds "
            "differ: run several (run.repeats), and again with grains of half the size."
        )
    key = "bulk.density" if recording.preset.bulk else "material.density or the number of grains"
    stated = ship.cargo.volume / ship.stowage
    if abs(ship.cargo.mass / stated - 1.0) > SAME_MASS:
        yield (
            f"Two masses of grain: the assumed shift is that of {stated:.5g} t, {ship.cargo.volume:.5g} m3 at the "
            f"stated {ship.stowage:.3f} m3/t, and in the run {ship.cargo.mass:.5g} t shifted, as the bed of model "
            f"grains weighs; change {key} until both agree."
        )


def _trimming(recording: Recording, found: Condition) -> Iterator[sheet.Row]:
    """The IMSBC Code's criterion of a cargo that is no grain, as she was loaded and as it lay at the end."""
    if not (recording.preset.grains and ship_unevenness.applies(recording)):
        return
    measured = ship_unevenness.measure(recording)
    for shift, name in {"as loaded": "unevenness", "as it lay at the end": "final_unevenness"}.items():
        heights = [world for world in measured[name].worlds if world is not None]
        given = recording.preset.ship.repose, found.hydrostatics.breadth
        beds = [one for height in heights if (one := trimming.criterion(height, *given))]
        if beds:
            worst = max(beds, key=lambda one: one.attained)
            yield sheet.Row(shift, worst, verdict_of(beds), grounds_of(recording))


def criteria(recording: Recording) -> Iterator[str]:
    """The sheet of criteria of a recording's ship as a table in Markdown; nothing without one that can be judged."""
    rows, _, notes = judged(recording)
    if not rows:
        return
    yield "\n## Criteria\n"
    yield "| rule | criterion | required | attained | unit | verdict |\n|---|---|---|---|---|---|"
    for row in rows:
        one = row.criterion
        what = f"{one.what} ({row.shift})" if row.shift else one.what
        verdict = f"{row.verdict}: {row.grounds}" if row.grounds else row.verdict
        numbers = f"{one.kind} {one.limit:.4g}", sheet.shown(one.attained, one.unit), one.unit, verdict
        yield f"| {' | '.join((one.rule, what, *numbers))} |"
    yield from ("", *notes)
    yield "\nIn calm water; heel is positive starboard down. `cargolab report` puts it on one page for the file."
