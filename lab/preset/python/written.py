"""Presets that are no files: tables and TOML text from Python become files of the cache, so that they have a path."""

import re
import tomllib
from collections.abc import Mapping
from functools import reduce
from hashlib import blake2b
from pathlib import Path

from lab.base import toml
from lab.base.caches import cache_folder
from lab.base.errors import LabError, os_sentence
from lab.base.files import write_text
from lab.preset.fields import marked
from lab.preset.kept import read as kept
from lab.preset.merge import Layer
from lab.preset.python.plain import plain

FOLDER = "presets"  # of the cache
LONGEST_NAME = 40  # letters of a file's name


def asked(preset: object) -> tuple[str, dict[str, object]]:
    """The name or path of a preset that Python was given, and the changes to it.

    It is a name or path, a table, a text in TOML, or an object that has `asked` itself (`cargolab.Preset`).
    """
    if hasattr(preset, "asked"):
        return preset.asked()
    if isinstance(preset, Mapping) or is_text(preset):
        return written(preset), {}
    return str(preset), {}


def written(preset: Mapping | str) -> str:
    """The path of a file that says the same as a table, or as a text in TOML; paths in it are of the working directory.

    Raises LabError for what is no table, and where the cache cannot be written.
    """
    table = _parsed(preset) if isinstance(preset, str) else plain(preset)
    here = Layer(dict(table), Path.cwd())
    table = here.located([*marked(kept.keys(), "columns")])
    base = table.get("based_on")
    if isinstance(base, str) and base.endswith(".toml"):
        table["based_on"] = str(Path(base).absolute())
    try:
        text = toml.dumps(table)
    except RecursionError:
        raise LabError("the preset: nested too deeply.") from None
    name = reduce(lambda left, part: left or part, (_slug(str(table.get(k, ""))) for k in ("title", "based_on")), "")
    path = cache_folder() / FOLDER / blake2b(text.encode(), digest_size=8).hexdigest() / f"{name or 'preset'}.toml"
    if not path.exists():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_text(path, text)
        except OSError as error:
            raise LabError(os_sentence(error)) from error
    return str(path)


def is_text(preset: object) -> bool:
    """Whether a text is TOML and not the name of a preset: it has a line with a key."""
    return isinstance(preset, str) and ("\n" in preset or re.match(r"\s*[\w.\"-]+\s*=", preset) is not None)


def _parsed(text: str) -> dict:
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise LabError(f"the preset: not valid TOML: {str(error).splitlines()[0].removesuffix('.')}.") from None


def _slug(title: str) -> str:
    """A title as the name of a file."""
    return re.sub(r"[^a-z0-9]+", "-", title.lower())[:LONGEST_NAME].strip("-")
