"""Cargoes as text: the table of the library, a cargo with its sources, and both for programs."""

from collections.abc import Mapping

from lab.preset.cargo.cargoes import library
from lab.preset.cargo.numbers import QUANTITIES, Cargo, Number

COLUMNS = {"density": "solids kg/m3", "bulk_density": "bed kg/m3", "stowage": "SF m3/t", "repose": "repose deg"}
COLUMNS |= {"diameter": "grains mm", "rolling_friction": "friction in"}
UNKNOWN, NOT_KNOWN = "-", "not known"


def table(cargoes: Mapping[str, Cargo]) -> str:
    """Cargoes, a line each: the first number of each quantity."""
    head = ["cargo", "code", *COLUMNS.values()]
    rows = [head, *(_row(cargo) for cargo in cargoes.values())]
    widths = [max(len(row[k]) for row in rows) for k in range(len(head))]
    lines = ["  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    return "\n".join([*lines, "", "`cargolab cargoes NAME` shows one with its sources and all its numbers."])


def card(cargo: Cargo) -> str:
    """A cargo with all its numbers, what they hold for, and their sources."""
    lines = [f"{cargo.title}  ({', '.join([cargo.name, *cargo.also])})"]
    if cargo.code:
        lines.append(f"  {cargo.code}{f': {cargo.code_source}' if cargo.code_source else ''}")
    for name, quantity in QUANTITIES.items():
        known = cargo.numbers.get(name, ())
        lines += [f"  {quantity.doc}: {_words(one)}" for one in known] or [f"  {quantity.doc}: {NOT_KNOWN}"]
    lines += [f"  {text}: {source}" for text, source in cargo.notes]
    return "\n".join(lines)


def markdown() -> str:
    """The library as a page has it: a table of the first numbers, and each cargo with all its numbers and sources."""
    known = library()
    head = ["cargo", "code", *COLUMNS.values()]
    rows = [f"| {' | '.join(_row(cargo))} |" for cargo in known.values()]
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}", *rows]
    for cargo in known.values():
        title, *numbers = card(cargo).splitlines()
        lines += ["", f"**{title}**", "", *(f"- {line.strip()}" for line in numbers if not line.endswith(NOT_KNOWN))]
    return "\n".join(lines)


def as_objects(cargoes: Mapping[str, Cargo]) -> dict[str, object]:
    """The same as JSON has it, numbers in SI."""
    return {
        name: {
            "title": cargo.title,
            "code": cargo.code,
            "notes": [list(note) for note in cargo.notes],
            "numbers": {
                key: [vars(one) | {"unit": QUANTITIES[key].symbol} for one in known]
                for key, known in cargo.numbers.items()
            },
        }
        for name, cargo in cargoes.items()
    }


def _row(cargo: Cargo) -> list[str]:
    cells = [_cell(cargo, name) for name in COLUMNS]
    return [cargo.name, cargo.code.removeprefix("IMSBC ") or UNKNOWN, *cells]


def _cell(cargo: Cargo, name: str) -> str:
    if name == "rolling_friction":
        return ", ".join(one.axes for one in cargo.numbers.get(name, ())) or UNKNOWN
    known = cargo.number(name)
    return known.text.removesuffix(QUANTITIES[name].unit).strip() if known else UNKNOWN


def _words(number: Number) -> str:
    model = {"plane": "discs in the plane", "space": "spheres in space"}.get(number.axes, "")
    said = ", ".join(part for part in (number.text, model, number.note) if part)
    return f"{said}: {number.source}"
