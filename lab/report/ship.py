"""What is said of a ship: by `cargolab explain` her balance, roll and forces, in reports the sheet of criteria."""

from collections.abc import Iterator
from math import pi

from lab.assembly.ship import flooding_angles, righting
from lab.base.errors import LabError
from lab.measures import ship_grain, ship_unevenness
from lab.measures.ship import has_ship, vessel_of
from lab.naval import sheet
from lab.naval.condition import Condition, condition
from lab.preset.sections import ship as ships
from lab.preset.sections.sea import Waves
from lab.preset.sections.ship import axis_place
from lab.preset.units import show
from lab.recording import Recording
from solvers.ship.naval import trimming
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import froude_factors

OF = {"section": "", "strips": "; by strips of her hull", "hull": "; of her hull in space"}


def describe(
    given: ships.Ship, vessel: Vessel, waves: Waves | None, slab: tuple[float, float] | None, every: float
) -> list[tuple[str, str]]:
    """Rows on a ship, each a name and a text: balance, roll, forces of the water.

    slab: thickness (m) of the slab that her cargo is, and how many of them a metre of her carries (1/m); None if her
    hold is empty. every: the step (s) of the water's forces.
    """
    ship, body = vessel.ship, vessel.ship.body
    water, memory = ship.load.water, ship.radiation.memory
    height = righting(ship.load.section, body, water) / (body.mass * water.gravity)
    floats = f"{body.mass:.4g} kg/m, GM solid {show(height, 'm')}, gyradius {show(body.gyradius, 'm')}"
    rows = [("empty", floats)]
    if slab is not None:
        thick = f"a slab {show(slab[0], 'm')} thick: its load counts {slab[1]:.4g} times a metre"
        rows = [("with her cargo", floats), ("cargo", thick)]
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
        ship, arm = found.condition, found.lying(ship_grain.worst(found))
        return [*sheet.rows(ship, arm), *_trimming(recording, ship)], sheet.facts(ship), list(sheet.unjudged(ship))
    vessel = vessel_of(recording.path)
    if vessel is None:
        return [], [], []
    try:
        alone = condition(recording.preset, vessel)
    except LabError:
        return [], [], []
    return sheet.rows(alone), sheet.facts(alone), list(sheet.unjudged(alone))


def _trimming(recording: Recording, found: Condition) -> list[sheet.Row]:
    """The IMSBC Code's criterion of a cargo that is no grain, as she was loaded and as it lay at the end."""
    if not ship_unevenness.applies(recording):
        return []
    measured = ship_unevenness.measure(recording)
    rows = []
    for shift, name in {"as loaded": "unevenness", "as it lay at the end": "final_unevenness"}.items():
        height = max((world for world in measured[name].worlds if world is not None), default=None)
        if height is not None:
            one = trimming.criterion(height, recording.preset.ship.repose, found.hydrostatics.breadth)
            rows += [sheet.Row(shift, one)] if one else []
    return rows


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
        numbers = f"{one.kind} {one.limit:.4g}", sheet.shown(one.attained, one.unit), one.unit, one.verdict
        yield f"| {' | '.join((one.rule, what, *numbers))} |"
    yield from ("", *notes)
    yield "\nIn calm water; heel is positive starboard down. `cargolab report` puts it on one page for the file."
