"""The JSON Schema of a preset, with which editors complete and check its keys.

An editor with Taplo in it (Even Better TOML) reads the first line of a preset, `#:schema PATH`, a path relative to the
preset or a URL. The shipped presets name the file beside their folders; `cargolab schema --out FILE` writes one for
presets of one's own. The schema knows the keys, words, units and plain ranges of numbers; that keys fit to each other,
and ranges of quantities with a unit, only the lab checks.
"""

import json
from collections.abc import Mapping
from typing import Any

from lab.preset.fields import NAME, Table, Taken, defaults_of, marked, taken_of
from lab.preset.reader import LONGEST_NAME
from lab.preset.reference import default_of, sentence
from lab.preset.schema import Preset
from lab.preset.units import kind

DRAFT = "http://json-schema.org/draft-07/schema#"
NUMBER = r"[+\-−]?(\d+\.?\d*|\.\d+)([eE][+\-]?\d+)?"
REMOVES = {"const": False, "description": "Removes what the base says."}


def json_schema() -> dict:
    """The schema, as draft 7 of JSON Schema has it."""
    schema = _table(Preset)
    schema["properties"]["quick"] = _quick()
    return {
        "$schema": DRAFT,
        "title": "A preset of Cargo Shift Lab",
        **schema,
        "if": {"not": {"required": ["based_on"]}},
        "then": {"required": [name for name in taken_of(Preset) if name not in defaults_of(Preset)]},
    }


def text_of_schema() -> str:
    """The schema as the text of a file."""
    return json.dumps(json_schema(), indent=1, ensure_ascii=False) + "\n"


def _table(model: type) -> dict:
    """The schema of a table. What is missing may come from a base, so nothing in it is required."""
    fields = taken_of(model)
    properties = {name: _field(taken, defaults_of(model).get(name)) for name, taken in fields.items()}
    return {"type": "object", "additionalProperties": False, "properties": properties}


def _field(taken: Taken, default: object) -> dict:
    """The schema of a field, with its sentence and default."""
    found = _values(taken)
    if taken.optional or (taken.below and default is not None):
        found = {"anyOf": [*found.get("anyOf", [found]), REMOVES]}
    said = sentence(taken)
    shown = default_of(taken, default)
    return {"description": said + (f" Default: {shown}." if shown else ""), **found}


def _values(taken: Taken) -> dict:
    """The schema of a field's values."""
    options = [_value(taken)] if taken.kind is not None else []
    if taken.words:
        options.append({"enum": list(taken.words)})
    return options[0] if len(options) == 1 else {"anyOf": options}


def _value(taken: Taken) -> dict:
    if taken.table:
        return _table(taken.table)
    if taken.named:
        return _named(taken.named)
    if taken.items:
        return _list(taken)
    if taken.kind is float:
        return _number(taken)
    plain = {int: "integer", bool: "boolean", str: "string", Table: "string"}
    return {"type": plain[taken.kind], **(_bounds(taken) if taken.kind is int else {})}


def _named(model: type) -> dict:
    """Tables that users name."""
    name = f"^[A-Za-z0-9_-]{{1,{LONGEST_NAME}}}$"
    inner = {"anyOf": [_table(model), REMOVES]}
    return {"type": "object", "patternProperties": {name: inner}, "additionalProperties": False}


def _list(taken: Taken) -> dict:
    items = [_values(item) for item in taken.items]
    if taken.many:
        return {"type": "array", "items": items[0]}
    return {"type": "array", "items": items, "minItems": len(items), "maxItems": len(items), "additionalItems": False}


def _number(taken: Taken) -> dict:
    """A pure number, which may also be a text such as "5 %", or a quantity with its unit."""
    if taken.symbol != "1":
        unit = rf"^\s*{NUMBER}\s*\S.*$"
        return {"type": "string", "pattern": unit, "examples": [kind(taken.symbol).example]}
    text = {"type": "string", "pattern": rf"^\s*{NUMBER}\s*(%|percent|1)?\s*$"}
    return {"anyOf": [{"type": "number", **_bounds(taken)}, text]}


def _bounds(taken: Taken) -> dict[str, float]:
    """The range of a plain number."""
    limits = taken.interval
    bounds = {
        "exclusiveMinimum": limits.gt,
        "minimum": limits.ge,
        "exclusiveMaximum": limits.lt,
        "maximum": limits.le,
    }
    return {name: bound for name, bound in bounds.items() if bound is not None}


def _quick() -> dict:
    """The table of a quick variant: how it differs, and the keys that it may change."""
    whole, keys = _table(Preset), marked(Preset, "cheap")
    table = _picked(whole, [key.split(".") for key in keys])
    table["properties"]["differs"] = {"type": "string", "description": "How the quick variant differs, in a sentence."}
    said = 'Keys that make the preset cheaper, under the name with "-quick" at its end; false: none.'
    return {"description": said, "anyOf": [table, REMOVES, {"type": "string"}]}


def _picked(schema: Mapping[str, Any], paths: list[list[str]]) -> dict:
    """The schema of a table with some of its keys alone."""
    if paths[0][0] == NAME:
        ((pattern, inner),) = schema["patternProperties"].items()
        picked = _picked(_table_in(inner), [path[1:] for path in paths])
        return {"type": "object", "additionalProperties": False, "patternProperties": {pattern: picked}}
    found = {}
    for name in dict.fromkeys(path[0] for path in paths):
        rest = [path[1:] for path in paths if path[0] == name]
        inner = schema["properties"][name]
        if not all(rest):
            found[name] = inner
            continue
        found[name] = _picked(_table_in(inner), rest)
    return {"type": "object", "additionalProperties": False, "properties": found}


def _table_in(schema: Mapping[str, Any]) -> dict:
    """The schema of a table among those of what a key takes."""
    return next(one for one in schema.get("anyOf", [schema]) if {"properties", "patternProperties"} & one.keys())
