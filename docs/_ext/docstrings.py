"""Docstrings as Markdown: a law's formula is set on a line of its own, then its source, what it says, limits, units.

A law's docstring begins with its formula and, in brackets, the source with its year. Paragraphs that begin with
"Limits:" or "Units:" say where it holds and what its symbols are measured in. A paragraph indented by four spaces is a
formula.
"""

import re
from importlib import import_module
from inspect import cleandoc

from formula import FUNCTIONS, inline, mathml

SOURCE = re.compile(r"\s\((?=[A-Z])([^()]*\b1[6-9]\d\d[^()]*|[^()]*\b20\d\d[^()]*)\)")
LABEL = re.compile(r"(Limits|Units|Source): (.*)", re.DOTALL)
WORD = re.compile(r"\b[a-z]{3,}\b")
PLAIN = re.compile(r"(?<!_)\b[a-z]{3,}\b")
FEW = 2  # words within a formula of an entry


def text_of(thing: object) -> str:
    """The docstring of a module, class or function itself, not of what it inherits. Raises ValueError without one."""
    if not thing.__doc__:
        raise ValueError(f"{thing} has no docstring")
    return cleandoc(thing.__doc__)


def headline(text: str) -> tuple[str, str, str]:
    """Formula, source and the rest of a docstring's first paragraph; an empty formula where it begins with words."""
    text = " ".join(text.split())
    found = SOURCE.search(text)
    end = re.search(r"\.(?= [A-Z])|\.$|:(?= )", text)
    if found and (not end or found.start() < end.start()):
        formula, source, rest = text[: found.start()], found[1], text[found.end() :]
    else:
        formula, source, rest = text[: end.start()], "", text[end.end() :]
    if "=" not in formula or WORD.search(formula.partition("=")[0]):
        return "", "", text
    return formula, source, rest.lstrip(".,:; ")


def in_markdown(text: str) -> str:
    """A docstring as Markdown."""
    first, *others = re.split(r"\n\s*\n", text)
    formula, source, rest = headline(first)
    blocks = [mathml(formula)] if formula else []
    if source:
        blocks.append(f"*Source:* {inline(source)}.")
    if rest:
        blocks.append(inline(rest[:1].upper() + rest[1:] if formula else rest))
    return "\n\n".join([*blocks, *map(paragraph, others)])


def paragraph(text: str) -> str:
    """A paragraph of a docstring: a formula where it is indented, else a list, what a label says, or sentences."""
    if text.startswith("    "):
        return mathml(text)
    if found := LABEL.match(text):
        return f"*{found[1]}:* {inline(' '.join(found[2].split()))}"
    lines = text.splitlines()
    if any(line.startswith("- ") for line in lines):
        return "\n".join(_listed(lines))
    return inline(" ".join(text.split()))


def _listed(lines: list[str]) -> list[str]:
    """The lines of a list, with a blank one before its first item, and what follows an item indented."""
    found, begun = [], False
    for line in lines:
        if line.startswith("- "):
            found += ["", f"- {inline(line[2:])}"] if not begun else [f"- {inline(line[2:])}"]
            begun = True
        else:
            found.append(f"  {inline(line)}" if begun else inline(line))
    return found


def module(name: str) -> str:
    """What a module says of itself."""
    return in_markdown(text_of(import_module(name)))


def registry(name: str, table: str, level: str = "###") -> str:
    """Each class of a registry under the name that it has in presets."""
    entries = getattr(import_module(name), table)
    return "\n\n".join(
        f"{level} `{key}`\n\n{in_markdown(text_of(thing))}\n\n*In* `{_file(thing)}`." for key, thing in entries.items()
    )


def things(name: str, *wanted: str) -> str:
    """Classes and functions of a module, an entry of a list each; one that begins with a formula has it set."""
    return "\n".join(_entry(getattr(import_module(name), one), one) for one in wanted)


def _entry(thing: object, name: str) -> str:
    text = text_of(thing)
    indented = (in_markdown(text) if _in_symbols(text) else _in_sentences(text)).replace("\n", "\n  ")
    return f"- `{name}`: {indented}\n"


def _in_symbols(text: str) -> bool:
    """Whether a docstring begins with a formula that is hardly interrupted by words."""
    formula, _, _ = headline(re.split(r"\n\s*\n", text)[0])
    return bool(formula) and len(set(PLAIN.findall(formula)) - FUNCTIONS) <= FEW


def _in_sentences(text: str) -> str:
    return "\n\n".join(paragraph(block) for block in re.split(r"\n\s*\n", text))


def _file(thing: type) -> str:
    return thing.__module__.replace(".", "/") + ".py"
