"""Check a resolved preset from a file of the lab against the limits for presets that users write.

Such a file may come from an unknown source. The reader of presets checks every number that a user gives; the same
checks are made here on numbers that are in SI already, before memory is allocated for them.
"""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass

from lab.base.errors import LabError
from lab.preset.bed_file import MOST as MOST_LISTED
from lab.preset.outline import simple_polygon
from lab.preset.reader import BOUND, check_interval
from lab.preset.schema import Resolved
from lab.preset.sections.grains import check_grains
from lab.preset.sections.history import check_history
from lab.preset.sections.parts import check_parts
from lab.preset.sections.shapes import MOST_DESCRIPTORS, MOST_DRAWS
from lab.preset.sections.ship_checks import check_ship
from lab.preset.sections.tank import check_lining
from lab.preset.sections.video import check_video
from lab.preset.toml import BARE_KEY

LONGEST_LIST = 1000  # of classes of sizes, of kinds and of shapes


def resolved_from(table: object) -> Resolved:
    """The resolved preset that a file holds. Raises ValueError if no valid preset could have given it."""
    try:
        preset = Resolved.model_validate_json(json.dumps(table))
        _check(preset)
    except (LabError, RecursionError, ArithmeticError) as error:
        raise ValueError(str(error)) from error
    return preset


def _check(preset: Resolved) -> None:
    _check_lengths(preset)
    for name in type(preset).model_fields:
        for key, holder, field, value in _numbers(getattr(preset, name), name):
            if not math.isfinite(value) or abs(value) > BOUND:
                raise LabError(f"{key}: is beyond all measure.")
            if is_dataclass(holder):
                check_interval(type(holder), field, value, key)
    if preset.motion.history:
        check_history(preset.motion.history)
    check_lining(preset.tank)
    if not preset.grains.listed:
        check_grains(preset.grains, preset.tank, "grains.diameter")
    check_parts(preset.parts, preset.tank.outline)
    check_ship(preset.ship, preset.waves, bool(preset.motion.parts), preset.tank.outline)
    check_video(preset.video)


def _check_lengths(preset: Resolved) -> None:
    """Raise LabError for lists that are too long, and for invalid names, outlines or edges."""
    grains = preset.grains
    for outline in filter(None, (preset.tank.outline, grains.region)):
        simple_polygon(outline)
    named = [*preset.kinds, *preset.shapes, *preset.parts]
    lists = [grains.table or (), named]
    if max(map(len, lists)) > LONGEST_LIST or len(grains.listed) > MOST_LISTED:
        raise LabError("grains: more classes than a preset may have.")
    if not all(BARE_KEY.fullmatch(name) for name in named):
        raise LabError("parts, shapes, kinds: names are letters, digits, - and _.")
    if any(len(s.descriptors) > MOST_DESCRIPTORS or not 1 <= s.draws <= MOST_DRAWS for s in preset.shapes.values()):
        raise LabError("shapes: more descriptors or draws than a preset may have.")
    if not all(0 <= edge < len(preset.tank.outline) for edge in preset.tank.open_edges):
        raise LabError("tank.open_edges: there is no such edge.")


def _numbers(value: object, key: str, holder: object = None, field: str = "") -> Iterator[tuple]:
    """Every number of a preset: its key, and the dataclass and the field that hold it."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        yield key, holder, field, value
    elif is_dataclass(value):
        for inner in fields(value):
            yield from _numbers(getattr(value, inner.name), f"{key}.{inner.name}", value, inner.name)
    elif isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _numbers(inner, f"{key}.{name}")
    elif isinstance(value, tuple):
        for place, inner in enumerate(value):
            yield from _numbers(inner, f"{key}[{place}]")
