"""Each key of a preset is set by one of the presets, or named where the manual tells of its table."""

import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path

from lab.preset.kept.read import FILE

ROOT = Path(__file__).parents[2]
ROW = re.compile(r"^\| ((?:`\[[^|]+\]`(?:, )?)+) \|(.+)\|$", re.MULTILINE)
SAME = {  # tables that take the keys of another
    **dict.fromkeys(("wall", "kinds.NAME.against", "kinds.NAME"), "material"),
    **{f"parts.NAME.{name}": f"motion.{name}" for name in ("tilt", "sway", "heave", "roll", "history")},
    "tanks.NAME": "tank",
}


def keys(fields: Mapping, path: str = "") -> Iterator[str]:
    """The dotted keys of the schema; NAME stands for what the user names."""
    for name, field in fields.items():
        kind, key = field.get("kind"), path + name
        below = {inner: kind[inner] for inner in ("keys", "named") if inner in kind} if isinstance(kind, dict) else {}
        if "keys" in below:
            yield from keys(below["keys"], f"{key}.")
        elif "named" in below:
            yield from keys(below["named"], f"{key}.NAME.")
        else:
            yield key


def given(table: Mapping, known: set[str], path: str = "") -> Iterator[str]:
    """The schema's keys that a preset's table sets."""
    for name, value in table.items():
        for key in (path + name, f"{path}NAME"):
            if key in known:
                yield key
            elif isinstance(value, Mapping) and any(one.startswith(f"{key}.") for one in known):
                yield from given(value, known, f"{key}.")


def told() -> dict[str, set[str]]:
    """By table, as its first word, the words set as code in its row of the page on presets."""
    words: dict[str, set[str]] = {}
    for names, text in ROW.findall((ROOT / "docs" / "presets.md").read_text(encoding="utf-8")):
        codes = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`]+)`", text))))
        for name in re.findall(r"\[(\w+)", names):
            words.setdefault(name, set()).update(codes)
    return words


def test_each_key_is_set_by_a_preset_or_named_in_the_manual():
    every = set(keys(json.loads(FILE.read_text(encoding="utf-8"))))
    presets = [tomllib.loads(path.read_text(encoding="utf-8")) for path in (ROOT / "presets").rglob("*.toml")]
    shown = {key for table in presets for key in given(table, every)}
    words = told()
    pages = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "docs").rglob("*.md"))

    def known(key: str) -> bool:
        dotted = r"(?<![\w.])" + re.escape(key).replace("NAME", r"[\w-]+") + r"\b"
        return key in shown or key.split(".")[-1] in words.get(key.split(".")[0], ()) or bool(re.search(dotted, pages))

    def alike(key: str) -> Iterator[str]:
        yield key
        yield from (key.replace(table, other, 1) for table, other in SAME.items() if key.startswith(f"{table}."))

    assert len(every) > 300 and len(shown) > 200
    assert sorted(key for key in every if not any(known(one) for one in alike(key))) == []
