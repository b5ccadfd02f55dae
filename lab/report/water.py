"""What is said of water by `cargolab explain` and in summaries: what it is, its models, its step, how sound it is."""

from collections.abc import Iterator
from dataclasses import asdict, replace

import numpy as np

from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.measures.water_residual import residual
from lab.preset.accuracy import LEVELS
from lab.preset.kept.content import parted
from lab.preset.schema import Preset
from lab.preset.sections.water.air import REAL_SOUND
from lab.preset.sections.water.liquid import centre_of_flow, depth, expected_speed, layers, usual_layers
from lab.preset.units import show
from lab.recording import Recording
from lab.report.numbers import count_of
from solvers.fluid import given
from solvers.fluid.timestep import kinematic, steps_of_water, stiff_step
from solvers.fluid.viscosity import LAMINAR
from solvers.scene import Scene

COMPRESSED = 0.03  # of the density: more is said
EVEN = 1e-6  # of the density: water within it is not compressed
OFF = 0.005  # %: a tank's mass that is off by more is told
SOFT = 1.5  # times: the air's softness from which it is told
UNEXPLAINED = 0.05  # of the energy exchanged: more is said
WITHOUT_PARTICLES = {
    "linear": "masses on springs by linear potential theory",
    "frozen": "frozen: it moves as one with the ship",
    "level": "a weight at its centre, level at any heel",
}
Rows = list[tuple[str, str]]


def described(preset: Preset, scene: Scene) -> Rows:
    """The water and its gauges, each row a name and a text."""
    (pressure, level, force), water = parted(preset.gauges), scene.fluid.water
    of_what, sound = "particles", [("sound", _sound(preset, water))]
    if not scene.fluid.moved:
        of_what, sound = f"marks ({WITHOUT_PARTICLES[water.model]})", []
    rows = [
        ("water", f"{scene.particles} {of_what} in each tank, {_size(preset, water)}"),
        *sound,
        *compression(preset, scene),
    ]
    if water.air:
        rows.append(("air", _air(scene)))
    if preset.water.flow:
        rows.append(("flow", _flow(preset)))
    if water.periodic:
        rows.append(("periodic", f"space repeats itself along {' and '.join(water.periodic)}"))
    for name, inlet in preset.inflow.items():
        ends = " and ".join(f"[{show(y, 'm')}, {show(z, 'm')}]" for y, z in inlet.points)
        along = f", {show(inlet.length, 'm')} long" if inlet.length else ""
        rows.append((f"inflow by {name}", f"into {inlet.room} between {ends}{along}, C_d {inlet.discharge:g}"))
    if preset.gauges:
        kinds = zip(("pressure", "level", "force"), (pressure, level, force), strict=True)
        names = [f"{name} of {kind}" for kind, gauges in kinds for name in gauges]
        rows.append(("gauges", ", ".join(names)))
    return rows


def compression(preset: Preset, scene: Scene) -> Rows:
    """Between which densities the water starts, compressed by its own pressure; none where it is not compressed.

    The mass of all tanks is exact; that of each is told where some are deeper.
    """
    fluid = scene.fluid
    dense = fluid.water.density * (1.0 + fluid.particles["deviation"][0, : fluid.wet])
    if fluid.inlets or not fluid.moved or np.ptp(dense) < EVEN * fluid.water.density:
        return []
    low, high, mean = (show(float(one), "kg/m^3") for one in (dense.min(), dense.max(), preset.water.density))
    text = f"{low} to {high} as it starts, by its own pressure; {mean} in the mean: level and mass are exact"
    of_tanks = np.split(dense, np.cumsum(scene.fills)[:-1]) if len(scene.fills) > 1 else []
    off = [100.0 * (of_tank.mean() / preset.water.density - 1.0) if len(of_tank) else 0.0 for of_tank in of_tanks]
    if np.abs(off).max(initial=0.0) >= OFF:
        told = (f"{name} {more:+.2f} %" for name, more in zip(["tank", *preset.tanks], off, strict=True))
        text += f" in all; the tanks' masses are off by {', '.join(told)}"
    return [("density", text)]


def _flow(preset: Preset) -> str:
    """How the water moves at first, and what pulls at it."""
    flow = preset.water.flow
    told = {
        "strained by": (flow.strain, "1/s"),
        "turns by": (flow.rotation, "rad/s"),
        "vortices of": (flow.vortices, "m/s"),
    }
    parts = [f"{words} {show(value, unit)}" for words, (value, unit) in told.items() if value]
    if flow.pull:
        y, z = (show(round(x, 9), "m") for x in centre_of_flow(preset))
        parts.append(f"pulled by Ω² r, Ω = {flow.pull:g} rad/s, to [{y}, {z}]")
    return ", ".join(parts) or "none"


def models(scene: Scene) -> Rows:
    """What is compiled in for the water, each row a name and a text."""
    water = scene.fluid.water
    if not scene.fluid.moved:
        return [("water", WITHOUT_PARTICLES[water.model])]
    strength = "" if water.viscosity in LAMINAR else f", α {water.alpha:g}"
    return [
        ("kernel", f"{water.kernel}, h = {water.smoothing:g} spacings"),
        ("state", water.state),
        ("diffusion", f"{water.diffusion}, δ {water.delta:g}" if water.diffusion != "none" else "none"),
        ("viscosity", f"{water.viscosity}{strength}: that of {kinematic(water):.3g} m²/s"),
        ("shifting", water.shifting),
        *([("surface", surface(water.air))] if water.air else []),
        ("at walls", f"{'free slip' if water.slip else 'no slip'}{', no free surface' if water.full else ''}"),
        *([("end walls, before and behind", f"{show(water.gap, 'm')} apart")] if water.gap else []),
    ]


def surface(air: given.Air) -> str:
    """What acts between water and air."""
    return f"{air.interface}, X = {show(air.cohesion, 'Pa')}" if air.cohesion else air.interface


def accuracy(preset: Preset) -> Rows:
    """The level of accuracy, the spacing that follows from it unless the preset has its own, and what error that is."""
    if preset.water.model != "sph":
        return []
    own = "; the preset's own" if preset.water.spacing != "auto" else ""
    count = layers(preset)
    found = f"{_error(count)}; of water that breaks only finer runs of the same tank tell"
    if preset.tank.solid:
        found = "in space not measured by layers; `cargolab verify water-space-wave` has a wave of 20 and of 40"
    return [
        ("level", f"{preset.run.accuracy}: {usual_layers(preset)} particles over the depth"),
        ("spacing", f"{count} particles over {show(depth(preset), 'm')}{own}"),
        ("error", found),
    ]


def _error(count: int) -> str:
    """The error of gentle water with so many layers of particles: that of the finest level that has no more."""
    known = [level for level in LEVELS.values() if level.layers <= count]
    if not known:
        return f"larger than with {LEVELS['draft'].layers} layers, where gentle water has {LEVELS['draft'].of_water}"
    best = max(known, key=lambda level: level.layers)
    return f"gentle water with {best.layers} layers has {best.of_water}"


def in_tank(recording: Recording) -> Iterator[str]:
    """What a summary says of the water, a line each."""
    preset, water = recording.preset, recording.preset.liquid
    worlds, count = recording.volume.shape
    if water.model == "sph":
        yield f"{count_of(worlds, 'tank')} with {count} particles of water, {_size(preset, water)}"
        yield _sound(preset, water)
    else:
        yield f"{count_of(worlds, 'tank')} with water, {WITHOUT_PARTICLES[water.model]}; {count} marks in pictures"
    if water.air:
        yield f"over it {recording.air_volume.shape[1]} particles of air, as far apart"
    scene = _scene(preset)
    yield f"{_steps(recording, scene)} steps of {show(recording.step, 's')}"
    if scene and scene.fluid.soft_multiple > 1:
        yield f"longer steps while the air is soft: {soft_step(scene, scene.fluid.soft_multiple)}"
    limits = scene.step_limits() if scene else []
    yield from (f"limit of the step, {show(limit.step, 's')}: {limit.reason}" for limit in limits)
    if preset.water.scheme != "lab":
        yield f"models as {preset.water.scheme} has them, as far as the solver does"
    time = recording.series["time"]
    for k, name in enumerate(recording.names["gauge"] if len(time) else ()):
        value, when = _peak(recording, k)
        yield f"highest pressure at {name}: {show(value, 'Pa')} at {show(when, 's')}" if value else f"{name} stays dry"


def facts(recording: Recording) -> dict[str, object]:
    """The numbers of a summary for programs, in SI."""
    water, names, scene = recording.preset.liquid, recording.names["gauge"], _scene(recording.preset)
    found = len(recording.series["time"])
    peaks = {name: _peak(recording, k) for k, name in enumerate(names)} if found else {}
    return {
        "particles": recording.volume.shape[1],
        "spacing_m": water.spacing,
        "sound_speed_m_s": water.sound_speed,
        "steps": _steps(recording, scene),
        "limits": [asdict(limit) for limit in scene.step_limits()] if scene else [],
        "largest_density_deviation": float(recording.series["water_density_deviation"].max(initial=0.0)),
        "energy_residual_J": float(np.abs(residual(recording)).max(initial=0.0)) if found else 0.0,
        "peaks": {name: {"pressure_Pa": value, "time_s": when} for name, (value, when) in peaks.items()},
    }


def cautions(recording: Recording) -> Iterator[str]:
    """What a reader must know about how the water was computed."""
    series = recording.series
    dense = series["water_dense"].max(initial=0.0)
    water = recording.preset.liquid
    softer = (REAL_SOUND / water.air.sound_speed) ** 2 if water.air else 1.0
    if softer > SOFT:
        yield (
            f"The air is {softer:.0f} times softer than real air: pressures of trapped air, and of impacts on it, are "
            'not those of real air; set air.sound_speed = "real" for these.'
        )
    if dense > COMPRESSED:
        yield (
            f"Up to {100.0 * dense:.2g} % of the water was off its density by more than 3 %; raise water.sound_speed, "
            "and see whether the result stays."
        )
    if not len(series["time"]):
        return
    exchanged = sum(np.abs(series[f"water_{name}"]) for name in ("work", "viscous", "diffusive"))
    exchanged = (exchanged + series["water_kinetic"]).max()
    missing = np.abs(residual(recording)).max()
    if recording.preset.wet or recording.preset.soaks:
        yield "What water and grains exchange is not in the water's account of its energy."
    elif missing > UNEXPLAINED * exchanged:
        yield f"The water's account lacks {100.0 * missing / exchanged:.2g} % of the energy exchanged."


def _size(preset: Preset, water: given.Water) -> str:
    deep = "deep" if preset.pools[0].depth else "at most, none at first"
    of_all = f"{show(depth(preset), 'm')} {deep}, {show(preset.water.density, 'kg/m^3')}"
    return f"{show(water.spacing, 'm')} apart, {of_all}"


def _sound(preset: Preset, water: given.Water) -> str:
    fast = expected_speed(preset)
    times = f"{water.sound_speed / fast:.3g} times the expected {show(fast, 'm/s')}"
    return f"speed of sound {show(water.sound_speed, 'm/s')}, {times}"


def _air(scene: Scene) -> str:
    """The air of a scene in words, with how much softer than real air it is, and what it costs in steps."""
    air, water = scene.fluid.water.air, scene.fluid.water
    count = scene.fluid.count - scene.fluid.wet
    text = f"{count} of these particles, {show(air.density, 'kg/m^3')}, speed of sound {show(air.sound_speed, 'm/s')}"
    softer = (REAL_SOUND / air.sound_speed) ** 2
    if softer > SOFT:
        text += f": {softer:.0f} times softer than real air where it is trapped"
    if air.sound_speed > water.sound_speed:
        text += f", for which steps are {air.sound_speed / water.sound_speed:.3g} times shorter than the water's"
    if air.stiff_from > 0.0:
        times = (REAL_SOUND / air.soft_speed) ** 2
        text += (
            f"; until {show(air.stiff_from, 's')} {show(air.soft_speed, 'm/s')}: {times:.0f} times softer than real air"
        )
    return text


def soft_step(scene: Scene, multiple: int) -> str:
    """The step while the air is soft, of so many base steps, and until when that is."""
    until = show(stiff_step(scene) * scene.step, "s")
    return f"{show(multiple * scene.step, 's')} until {until}" + f", {multiple} steps in one" * (multiple > 1)


def _steps(recording: Recording, scene: Scene | None) -> int:
    """How many steps the water has taken; long ones of soft air are one."""
    time = recording.series["time"]
    steps = round(float(time[-1]) / recording.step) if len(time) else 0
    return steps_of_water(scene, steps) if scene and scene.fluid.soft_multiple > 1 else steps


def _scene(preset: Preset) -> Scene | None:
    """The scene of a tank of a preset's; None if this machine cannot hold it."""
    try:
        return build(replace(preset, run=replace(preset.run, repeats=1)))[0]
    except LabError:
        return None


def _peak(recording: Recording, gauge: int) -> tuple[float, float]:
    """The highest pressure (Pa) at a gauge in any tank, and its time (s)."""
    peak = recording.series["gauge_peak"][..., gauge].max(axis=1)
    return float(peak.max()), float(recording.series["time"][peak.argmax()])
