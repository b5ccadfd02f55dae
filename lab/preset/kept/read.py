"""Read `keys.json`: dataclasses with the names, types and marks of the schema's, of which nothing else is there."""

import json
import re
import sys
from collections.abc import Mapping
from dataclasses import field, make_dataclass
from functools import cache
from hashlib import blake2b
from pathlib import Path
from typing import Annotated, Any, Literal, Optional, Union

from lab.preset.fields import Alike, Columns, Of, Table
from solvers.machine.marks import Cheap, Doc, Interval, Unit, Usual

FILE = Path(__file__).with_name("keys.json")
ROOT = Path(__file__).parents[3]
SEEN = FILE.with_name("sources.txt")  # the hash of the sources that the file was written from
OWN = "lab/preset/schema.py", "lab/preset/sections"  # what has the keys, and imports those of the solvers
IMPORTED = re.compile(r"^from (solvers[\w.]*) import (?:\(([^)]*)\)|([\w ,]+))", re.MULTILINE)
LOOKED_AT = 1000  # rows of a file, which is read whole by the schema afterwards
PLAIN = {"number": float, "whole": int, "truth": bool, "text": str, "file": Table}


def keys() -> type:
    """The schema's dataclass if it is loaded, else one with the same keys that takes a hundredth of the time.

    Where the code is another than the file is of, as while a key is being added to it, the schema is loaded.
    """
    if not loaded() and not is_current():
        from lab.preset.schema import Preset  # noqa: F401
    return loaded() or preset()


def loaded() -> type | None:
    """The schema's dataclass, None until something needed it."""
    return getattr(sys.modules.get("lab.preset.schema"), "Preset", None)


@cache
def is_current() -> bool:
    """Whether the file was written from the sources as they are."""
    return SEEN.read_text(encoding="ascii").strip() == hash_of_sources()


def hash_of_sources() -> str:
    """A hash of the files that the schema takes its keys from: its own, and what these import of the solvers."""
    own = sorted(path for one in OWN for path in ([ROOT / one] if one.endswith(".py") else (ROOT / one).rglob("*.py")))
    texts = {path: path.read_bytes() for path in own}
    names = {
        f"{module}.{name.split()[0]}"
        for text in list(texts.values())
        for module, *listed in IMPORTED.findall(text.decode())
        for name in filter(None, map(str.strip, "".join(listed).split(",")))
    }
    digest = blake2b(digest_size=16)
    for path in [*own, *sorted({found for name in names for found in _files(name)})]:
        digest.update(texts.get(path) or path.read_bytes())
    return digest.hexdigest()


def _files(name: str) -> list[Path]:
    """The files of a module, or of the module that has a name, and a table of data beside it."""
    whole, module = (ROOT / one.replace(".", "/") for one in (name, name.rpartition(".")[0]))
    at = whole if whole.with_suffix(".py").exists() or whole.is_dir() else module
    places = at.with_suffix(".py"), at / "__init__.py", at.with_suffix(".toml")
    return [path for path in places if path.exists()]


@cache
def preset() -> type:
    """A dataclass with the keys of a preset, as the file has them; its objects hold them and do nothing."""
    return _table("Preset", json.loads(FILE.read_text(encoding="utf-8")))


def _table(name: str, given: Mapping[str, dict]) -> type:
    made = [(key, _hint(key, one), *([field(default=None)] if "default" in one else [])) for key, one in given.items()]
    return make_dataclass(name, made, frozen=True, kw_only=True, repr=False, eq=False)


def _hint(key: str, given: Mapping[str, Any]) -> Any:
    """The annotation of a field, of which `taken_from` makes what was written."""
    kinds = [_kind(key, given["kind"])] if "kind" in given else []
    kinds += [Literal[tuple(given["words"])]] if "words" in given else []
    hint = Union[tuple(kinds)] if len(kinds) > 1 else kinds[0]  # noqa: UP007 (as many as there are)
    hint = Optional[hint] if given.get("optional") else hint  # noqa: UP045 (of a value, not of a name)
    return Annotated[hint, *_marks(given)]


def _marks(given: Mapping[str, Any]) -> list[object]:
    marks: list[object] = [Doc(given.get("doc", "")), Unit(given.get("symbol", "1")), Of(*given.get("of", ()))]
    marks += [Interval(**given["interval"])] if "interval" in given else []
    marks += [Usual(*given["usual"])] if "usual" in given else []
    if "columns" in given:
        needed, optional, most, *surface = map(_hashed, given["columns"])
        marks.append(Columns(needed, optional, most, LOOKED_AT, bool(surface)))
    return marks + [mark() for name, mark in {"cheap": Cheap, "alike": Alike}.items() if given.get(name)]


def _kind(key: str, given: Any) -> Any:
    if isinstance(given, str):
        return PLAIN[given]
    if "keys" in given:
        return _table(key, given["keys"])
    if "named" in given:
        return dict[str, _table(key, given["named"])]
    items = [_hint(key, one) for one in given["items"]]
    return tuple[*items, ...] if given["many"] else tuple[*items]


def _hashed(value: object) -> object:
    return tuple(value) if isinstance(value, list) else value
