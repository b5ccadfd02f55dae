"""Write what the schema says of its keys to `keys.json`; `lab.preset.kept.read` is its other half."""

import json
from dataclasses import fields

from lab.preset.fields import Taken, defaults_of, taken_of
from lab.preset.kept.read import FILE, PLAIN, SEEN, hash_of_sources
from lab.preset.schema import Preset

NAMES = {kind: name for name, kind in PLAIN.items()}


def text_of_keys(preset: type = Preset) -> str:
    """The content of the file."""
    return json.dumps(_table(preset), ensure_ascii=False, separators=(",", ":")).replace('},"', '},\n"') + "\n"


def write_keys() -> None:
    """Write the file, and the hash of the sources that it is of."""
    FILE.write_text(text_of_keys(), encoding="utf-8")
    SEEN.write_text(f"{hash_of_sources()}\n", encoding="ascii")


def _table(kind: type) -> dict:
    """What each key of a table takes; those that must be given have no `default`."""
    optional = {"default": True}
    return {name: _taken(one) | (optional if name in defaults_of(kind) else {}) for name, one in taken_of(kind).items()}


def _taken(taken: Taken) -> dict:
    """What a key takes: all of its `Taken` that is not as in one that says nothing."""
    found = {"kind": _kind(taken)} if taken.kind is not None else {}
    limits = {name: bound for name, bound in vars(taken.interval).items() if bound is not None}
    found |= {"interval": limits} if limits else {}
    found |= {"usual": [*vars(taken.usual).values()]} if taken.usual else {}
    if asked := taken.columns:
        found["columns"] = [asked.needed, asked.optional, asked.most, *[True] * asked.surface]
    for field in fields(Taken):
        value = getattr(taken, field.name)
        if field.name not in ("kind", "interval", "usual", "columns") and value != field.default:
            found[field.name] = value
    return found


def _kind(taken: Taken) -> object:
    """The type of a value: a name, a table of keys, tables that users name, or the items of a list."""
    if taken.table:
        return {"keys": _table(taken.table)}
    if taken.named:
        return {"named": _table(taken.named)}
    if taken.items:
        return {"items": [_taken(item) for item in taken.items], "many": taken.many}
    return NAMES[taken.kind]
