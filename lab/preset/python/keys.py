"""The keys of a preset one by one: their values, and what they take."""

import tomllib
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from lab.base.errors import LabError, NotRecorded
from lab.preset.fields import NAME, Taken, defaults_of, join, taken_by, walk
from lab.preset.reader import check_keys
from lab.preset.reference import default_of, range_of, sentence
from lab.preset.units import kind

if TYPE_CHECKING:
    from lab.preset.schema import Preset


def value_of(preset: "Preset", key: str) -> object:
    """The value of a dotted key in SI; None where it is left out. Raises LabError for a key that no preset has."""
    taken_for(key)
    found: object = preset
    for part in key.split("."):
        if found is None:
            return None
        if isinstance(found, Mapping):
            if part not in found:
                raise NotRecorded(f"{key}: this preset has no {part!r} there; it has {', '.join(found) or 'none'}.")
            found = found[part]
        else:
            found = getattr(found, part)
    return found


def taken_for(key: str) -> Taken:
    """What a dotted key takes. Raises LabError, with what is like it, for one that no preset has."""
    from lab.preset.schema import Preset

    taken = taken_by(Preset, key)
    if taken is None:
        nested: object = 0
        for part in reversed(key.split(".")):
            nested = {part: nested}
        check_keys(Preset, nested)
        raise LabError(f"{key}: unknown key.")
    return taken


def about(key: str) -> dict[str, object]:
    """What a key takes: its `unit`, in SI, the `usual` one, `range`, `words`, `default` and `sentence`."""
    taken = taken_for(key)
    above, _, last = key.rpartition(".")
    model = taken_for(above).below if above else None
    default = defaults_of(model).get(last) if model and last in defaults_of(model) else None
    number = taken.kind is float or any(item.kind is float for item in taken.items)
    return {
        "key": key,
        "unit": taken.symbol if number else "",
        "usual": kind(taken.symbol).unit if number else "",
        "range": range_of(taken),
        "words": list(taken.words),
        "default": default_of(taken, default),
        "sentence": sentence(taken),
    }


def given_keys(text: str) -> Iterator[str]:
    """The dotted keys that a preset's text sets."""
    from lab.preset.schema import Preset

    known = {key for key, taken in walk(Preset) if not taken.below}

    def below(table: Mapping, path: str) -> Iterator[str]:
        for name, value in table.items():
            key = join(path, name)
            if isinstance(value, Mapping) and not _is_one(key, known):
                yield from below(value, key)
            else:
                yield key

    yield from below(tomllib.loads(text), "")


def _is_one(key: str, known: set[str]) -> bool:
    """Whether a key has a value of its own, not a table."""
    parts = key.split(".")
    return any(
        len(one) == len(parts) and all(a in (b, NAME) for a, b in zip(one, parts, strict=True))
        for one in (other.split(".") for other in known)
    )
