"""What a shell completes: names of presets, keys and their words, names of measures; quick, since each Tab asks."""

import re
from pathlib import Path

import click
from click.shell_completion import CompletionItem

MEASURES = Path(__file__).parents[1] / "measures"
NAMED = re.compile(r"(?:^|\. )((?:[a-z]\w*)(?:, [a-z]\w*)*):", re.MULTILINE)  # in the docstring of a measure
UNCHOSEN = "NAME"  # stands in keys for a name of the user's


class PresetName(click.ParamType):
    """A shipped preset by its name, or a file, which the shell completes."""

    name = "preset"

    def shell_complete(self, _context: click.Context, _param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """The names that begin so, and files."""
        from lab.preset.find import names

        found = [CompletionItem(name, help=title) for name, title in names().items() if name.startswith(incomplete)]
        return found or [CompletionItem(incomplete, type="file")]


class Setting(click.ParamType):
    """KEY=VALUE: a key of presets, and after the = its words."""

    name = "text"

    def shell_complete(self, _context: click.Context, _param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """The keys that begin so, or the words of a key."""
        from lab.preset.fields import taken_by, walk
        from lab.preset.kept.read import preset

        key, equals, begun = incomplete.partition("=")
        if equals:
            taken = taken_by(preset(), key)
            words = (*taken.words, *(("true", "false") if taken.kind is bool else ())) if taken else ()
            return [CompletionItem(f"{key}={word}") for word in words if word.startswith(begun)]
        keys = [(name, taken) for name, taken in walk(preset()) if UNCHOSEN not in name.split(".") and not taken.below]
        return [CompletionItem(f"{name}=", help=taken.doc) for name, taken in keys if name.startswith(key)]


class MeasureName(click.ParamType):
    """MEASURE=VALUE: a measure by its name."""

    name = "text"

    def shell_complete(self, _context: click.Context, _param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """The measures that begin so."""
        return [CompletionItem(f"{name}=") for name in measures() if name.startswith(incomplete)]


def measures() -> list[str]:
    """The names of measures as their modules tell them, without loading these."""
    found = set()
    for path in MEASURES.glob("*.py"):
        text = path.read_text(encoding="utf-8")
        docstring = text.split('"""')[1] if text.startswith('"""') else ""
        if "\ndef measure(" in text:
            found |= {name for line in NAMED.findall(docstring) for name in line.split(", ")}
    return sorted(found)
