"""Whether two presets run alike, though one tells what the other derives, or in other words."""

from dataclasses import replace

from lab.preset.schema import Preset
from lab.preset.sections.materials import Wall
from lab.preset.sections.video import Video

WORDS = ("title", "source", "reports", "based_on", "quick")


def alike(one: Preset, other: Preset) -> bool:
    """Whether both ask for the same runs: words and films aside, and with what follows from their keys filled in."""
    return _filled(one) == _filled(other)


def _filled(preset: Preset) -> tuple[object, ...]:
    tank = replace(preset.tank, width=None, height=None, outline=preset.tank.corners)
    contact = replace(preset.contact, stiffness_scale=preset.stiffness_scale)
    run = replace(preset.run, duration=preset.duration)
    plain = replace(preset, tank=tank, contact=contact, run=run, wall=Wall(), video=Video(), **dict.fromkeys(WORDS, ""))
    return plain, preset.wall_material if preset.grains else None
