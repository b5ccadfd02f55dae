"""Sections of `cargolab explain` on what moves freely: a tank on its axle, bodies that float, hulls and their rooms."""

from math import inf, pi, sqrt, tanh

import numpy as np

from lab.assembly.grains import cargo_of
from lab.preset.schema import Preset
from lab.preset.sections.axle import Axle
from lab.preset.sections.bodies.checks import is_in
from lab.preset.sections.bodies.floating import draught
from lab.preset.sections.bodies.hulls import rooms_of
from lab.preset.units import show
from solvers.scene import Scene


def described(preset: Preset) -> list[tuple[str, str]]:
    """Rows on the axle, each a name and a text."""
    axle, gravity = preset.axle, preset.run.gravity
    y, z = axle.place
    rows = [
        ("place", f"[{show(y, 'm')}, {show(z, 'm')}] in the tank's axes"),
        ("empty tank", f"{axle.inertia:.4g} kg m^2 about the axle, static moment {axle.moment:.4g} kg m"),
        ("natural period", _period(axle, gravity)),
    ]
    if (first := sloshing_period(preset)) is not None:
        rows.append(("first sloshing period", f"{show(first, 's')} by linear theory, in a tank at rest"))
    if axle.friction or axle.damping:
        rows.append(("losses", f"{axle.friction:.3g} N m of dry friction, {axle.damping:.3g} N m s of damping"))
    if axle.slide:
        rows.append(("slide", f"{show(axle.slide.mass, 'kg')}, {_slide(axle)}"))
    if axle.heel:
        rows.append(("let go", f"at {show(axle.heel, 'rad')}, {show(axle.release, 's')} after the start"))
    length = axle.length or preset.thickness
    return [*rows, ("load", f"that of {show(length, 'm')} of tank, {length / preset.thickness:.4g} times the slab's")]


def _period(axle: Axle, gravity: float) -> str:
    period = axle.solved.natural_period(gravity)
    return (
        f"{show(period, 's')}, empty and undamped, of small rolls" if period else "none: empty it does not hang upright"
    )


def sloshing_period(preset: Preset) -> float | None:
    """First period (s) of water in a rectangular tank, ω² = (π g/l) tanh(π d/l) (Faltinsen & Timokha 2009), or None."""
    water, tank = preset.water, preset.tank
    if water is None or tank.outline is not None or water.depth is None or water.full:
        return None
    number = pi / tank.width
    return 2.0 * pi / sqrt(number * preset.run.gravity * tanh(number * water.depth))


def _slide(axle: Axle) -> str:
    slide = axle.slide
    if slide.file is not None:
        fastest, hardest = slide.motion.fastest(slide.soft_start), slide.motion.hardest()
        return f"as {slide.file.name} has it, up to {show(fastest, 'm/s')} and {hardest:.3g} m/s²"
    return f"by {show(slide.amplitude, 'm')} with a period of {show(slide.period, 's')}"


def bodies(preset: Preset, scene: Scene) -> list[tuple[str, str]]:
    """Rows on each body that floats and each hull, each a name and a text."""
    rows = []
    for name, part in preset.parts.items():
        free = part.solved(0, preset.thickness).free
        if free is not None:
            middle = ", ".join(show(place, "m") for place in free.centre)
            cargo = cargo_of(scene) if preset.grains and is_in(preset.grains.room, name) else 0.0
            deep = draught(part, (free.mass + cargo) / preset.water.density, preset.thickness)
            sinks = "sinks" if deep == inf else f"floats {show(deep, 'm')} deep, upright as drawn"
            with_it = f", and {cargo:.4g} kg of grains" if cargo else ""
            moments = ", ".join(f"{moment:.4g}" for moment in np.diag(np.atleast_2d(free.inertia)))
            about = f"{moments} kg m^2 about [{middle}]"
            what = f"{free.mass:.4g} kg and {about}{with_it}; {sinks}"
            rows.append((name, what + (f"; let go after {show(free.release, 's')}" if free.release else "")))
        if part.wall is not None:
            openings = [f"{hole} opens {_when(one.opens)}" for hole, one in part.openings.items()]
            what = f"walls of {show(part.wall, 'm')}; rooms: {', '.join(rooms_of(part))}"
            rows.append((f"hull of {name}", "; ".join([what, *openings])))
    return rows


def _when(opens: float) -> str:
    return f"after {show(opens, 's')}" if opens else "at once"
