"""Write a preset to a file of the lab, and read it back.

Such a file may come from an unknown source. The reader of presets checks every number that a user gives; the same
checks are made here on numbers that are in SI already, before memory is allocated for them.
"""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, is_dataclass
from functools import cache
from typing import TYPE_CHECKING

from lab.base.errors import LabError
from lab.base.toml import BARE_KEY
from lab.plugins.loading import admit
from lab.preset import formats
from lab.preset.fields import ANY, Table, Taken, taken_of
from lab.preset.reader import BOUND, check_interval

if TYPE_CHECKING:
    from pydantic import TypeAdapter

    from lab.preset.schema import Preset

LONGEST_LIST = 1000  # of classes of sizes, of kinds and of shapes


def to_table(preset: "Preset") -> dict:
    """The preset as a table of JSON's kinds of values, all numbers in SI."""
    return json.loads(json.dumps(asdict(preset)))


def from_table(table: object) -> "Preset":
    """The preset of such a table, also of one from an earlier version.

    Raises ValueError where it is none, LabError where its plug-ins may not run or are gone.
    """
    from pydantic import ValidationError  # slow to load, as the schema is; a recording is opened without both

    try:
        kept = formats.recorded(table) if isinstance(table, Mapping) else table
        if isinstance(kept, Mapping):
            admit(kept.get("plugins") or ())
            _check_motions(kept.get("motion"))
        return _model().validate_json(json.dumps(kept), strict=True)
    except ValidationError as error:
        first = error.errors()[0]
        raise ValueError(f"{'.'.join(map(str, first['loc']))}: {first['msg']}") from None
    except (RecursionError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(str(error)) from error


def _check_motions(motion: object) -> None:
    """Raise LabError for a motion of a plug-in that is not loaded, by which the tank would stand still unsaid."""
    from lab.preset.sections.motion import Motion

    known = taken_of(Motion)
    for name, part in motion.items() if isinstance(motion, Mapping) else ():
        if part is not None and name not in known:
            raise LabError(
                f"motion.{name}: is of a plug-in that is not loaded, as one defined in a notebook: define it there, or "
                "load its file by cargolab.plugin."
            )


def resolved_from(table: object) -> "Preset":
    """The preset of such a table, ready to run. Raises ValueError if no valid preset could have given it."""
    return checked(from_table(table))


def checked(preset: "Preset") -> "Preset":
    """The preset. Raises ValueError if no table that a person may write could have given it."""
    from lab.preset.schema import check

    try:
        _check_numbers(preset)
        check(preset)
    except (LabError, RecursionError, ArithmeticError) as error:
        raise ValueError(str(error)) from error
    return preset


@cache
def _model() -> "TypeAdapter":
    from pydantic import TypeAdapter

    from lab.preset.schema import Preset

    return TypeAdapter(Preset)


def _check_numbers(preset: "Preset") -> None:
    """Raise LabError for a number out of its range, a list that is too long, or a name that is none."""
    for key, taken, value in _values(preset, "", Taken(type(preset))):
        if isinstance(value, int | float):
            if not math.isfinite(value) or abs(value) > BOUND:
                raise LabError(f"{key}: is beyond all measure.")
            check_interval(taken, value, value, key)
        elif isinstance(value, Table):
            _check_columns(key, taken, value)
        elif isinstance(value, Mapping) and not all(BARE_KEY.fullmatch(name) for name in value):
            raise LabError(f"{key}: names are letters, digits, - and _.")
        elif len(value) > LONGEST_LIST:
            raise LabError(f"{key}: more entries than a preset may have.")


def _check_columns(key: str, taken: Taken, table: Table) -> None:
    """Raise LabError for columns that a file may not have, are too long, or are no finite numbers."""
    lengths = {len(values) for values in table.columns.values()}
    allowed = {*taken.columns.needed, *taken.columns.optional}
    known = ANY in allowed or table.columns.keys() <= allowed
    if not (known and set(taken.columns.needed) <= table.columns.keys()) or len(lengths) != 1:
        raise LabError(f"{key}: its columns are not those of such a file.")
    if not 1 <= max(lengths) <= taken.columns.most:
        raise LabError(f"{key}: more rows than such a file may have.")
    if not all(math.isfinite(x) and abs(x) <= BOUND for values in table.columns.values() for x in values):
        raise LabError(f"{key}: is beyond all measure.")


def _values(value: object, key: str, taken: Taken) -> Iterator[tuple[str, Taken, object]]:
    """Every number, file, list and set of named tables of a preset, with its key and what its field takes."""
    if isinstance(value, bool | str) or value is None:
        return
    if is_dataclass(value) and not isinstance(value, Table):
        for name, inner in taken_of(type(value)).items():
            yield from _values(getattr(value, name), f"{key}.{name}" if key else name, inner)
        return
    yield key, taken, value
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _values(inner, f"{key}.{name}", taken)
    elif isinstance(value, tuple):
        for place, inner in enumerate(value):
            yield from _values(inner, f"{key}[{place}]", taken)
