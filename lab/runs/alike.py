"""Whether two presets run alike, though one tells what the other derives, or in other words."""

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace

from lab.preset.schema import Preset
from lab.preset.sections.materials import Wall
from lab.preset.sections.video import Video
from lab.preset.sections.water.liquid import interface

WORDS = ("title", "source", "reports", "based_on", "quick")
NAMED = 3  # keys that a sentence names at most


def alike(one: Preset, other: Preset) -> bool:
    """Whether both ask for the same runs: words and films aside, and with what follows from their keys filled in."""
    return _filled(one) == _filled(other)


def apart(one: Preset, other: Preset) -> str:
    """The keys in which two presets ask for other runs, for a sentence: "water.spacing, run.duration and 2 more"."""
    keys = list(_unequal(*(_filled(preset)[0] for preset in (one, other)))) or ["wall"]
    more = len(keys) - NAMED
    return ", ".join(keys[:NAMED]) + (f" and {more} more" if more > 0 else "")


def _unequal(one: object, other: object, key: str = "") -> Iterator[str]:
    """The dotted keys of the values that differ."""
    if is_dataclass(one) and type(one) is type(other):
        parts = [(field.name, getattr(one, field.name), getattr(other, field.name)) for field in fields(one)]
    elif isinstance(one, Mapping) and isinstance(other, Mapping):
        parts = [(str(name), one.get(name), other.get(name)) for name in sorted({*one, *other})]
    else:
        if one != other:
            yield key
        return
    for name, a, b in parts:
        yield from _unequal(a, b, f"{key}.{name}" if key else name)


def _filled(preset: Preset) -> tuple[object, ...]:
    tank = replace(preset.tank, width=None, height=None, outline=preset.tank.corners)
    contact = replace(preset.contact, stiffness_scale=preset.stiffness_scale)
    run = replace(preset.run, duration=preset.duration)
    water = preset.water
    if water and water.background_pressure is None and preset.air is None:
        water = replace(water, background_pressure=0.0)
    air = preset.air
    if air and air.interface is None:
        air = replace(air, interface=interface(preset))
    plain = replace(
        preset,
        tank=tank,
        contact=contact,
        run=run,
        water=water,
        air=air,
        wall=Wall(),
        video=Video(),
        **dict.fromkeys(WORDS, ""),
    )
    return plain, preset.wall_material if preset.grains else None
