"""The reference of presets as a page: every section and every key, from the schema's own fields."""

from collections.abc import Iterator
from typing import Any

from lab.preset.fields import NAME, Table, Taken, defaults_of, join, taken_of
from lab.preset.schema import Preset
from lab.preset.units import kind, show

INTRODUCTION = """# Keys of a preset

A preset is a TOML file. Quantities are texts with a unit, such as `"3 mm"`; any unit of the same kind will do. A key
that may be left out has a default; `false` in its place removes what a base says. NAME stands for a name of your own.
The ranges are those of single keys; that keys fit to each other, the lab checks, too.
"""


def reference() -> str:
    """The page in Markdown: a table a section, a row a key."""
    return "\n".join([INTRODUCTION, *_section(Preset, "", "The preset itself", "")])


def _section(model: type, path: str, heading: str, said: str) -> Iterator[str]:
    """The lines of a section and of those below it."""
    fields = taken_of(model)
    own = {name: taken for name, taken in fields.items() if not taken.below}
    yield f"## {heading}\n"
    if said:
        yield f"{said}\n"
    if own:
        yield "| key | value | range | default | says |\n|---|---|---|---|---|"
        yield from (_row(name, taken, model) for name, taken in own.items())
        yield ""
    for name, taken in fields.items():
        if taken.below:
            key = join(path, name) + (f".{NAME}" if taken.named else "")
            yield from _section(taken.below, key, f"[{key}]", taken.doc)


def _row(name: str, taken: Taken, model: type) -> str:
    defaults = defaults_of(model)
    default = default_of(taken, defaults[name]) or "–" if name in defaults else "must be given"
    cells = [f"`{name}`", value_of(taken), range_of(taken), default, taken.doc]
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def sentence(taken: Taken) -> str:
    """A field's sentence, with what it takes."""
    if taken.below:
        return taken.doc
    limits = range_of(taken)
    return f"{taken.doc} {_capital(value_of(taken))}{f', {limits}' if limits else ''}."


def value_of(taken: Taken) -> str:
    """What a field takes, in words."""
    words = " or ".join(f'"{word}"' for word in taken.words)
    return " or ".join(filter(None, [_kind_of(taken), words]))


def _kind_of(taken: Taken) -> str:
    if taken.kind is None:
        return ""
    if taken.below:
        return "tables with names of your own" if taken.named else "a table"
    if taken.items:
        inner = [_kind_of(item) for item in taken.items]
        if len(set(inner)) > 1:
            return f"a list of {' and '.join(inner)}"
        return f"a list, each {inner[0]}" if taken.many else f"a list of {len(inner)}, each {inner[0]}"
    if taken.kind is float:
        name, _, example = kind(taken.symbol)
        return name if taken.symbol == "1" else f'{name}, e.g. "{example}"'
    plain: dict[Any, str] = {int: "a whole number", bool: "true or false", str: "a text", Table: "the path of a file"}
    return plain[taken.kind]


def range_of(taken: Taken) -> str:
    """The range of a number, in words; empty without one."""
    limits = taken.interval
    if limits.ge is not None and limits.ge == limits.le:
        return f"only {limits.ge:g}"
    bounds = (("above", limits.gt), ("from", limits.ge), ("below", limits.lt), ("to", limits.le))
    return " ".join(f"{word} {_bound(taken, bound)}" for word, bound in bounds if bound is not None)


def _bound(taken: Taken, bound: float) -> str:
    return show(bound, taken.symbol) if bound and taken.kind is not int else f"{bound:g}"


def default_of(taken: Taken, default: object) -> str:
    """A default as a preset would say it; empty where it says nothing."""
    if default is None or default == "" or default == () or taken.below:
        return ""
    if isinstance(default, bool):
        return str(default).lower()
    if isinstance(default, str):
        return f'"{default}"'
    if isinstance(default, tuple):
        return f"[{', '.join(default_of(taken, item) for item in default)}]"
    if isinstance(default, float) and taken.symbol != "1":
        return f'"{show(default, taken.symbol)}"'
    return f"{default:g}" if isinstance(default, float) else str(default)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
