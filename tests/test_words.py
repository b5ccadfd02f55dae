"""The words of the code are the field's: names that were replaced do not come back.

`docs/glossary.md` has the words to use.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from lab.recording.layout import OF_MATTERS
from tests.test_house import modules

# Old words of public names, and what to use. Words with other meanings elsewhere are not here.
STOP = {
    "dummy": "wall_particle",
    "dummies": "wall_particles",
    "consistency": "reinitialisation",
    "sight": "visibility",
    "wear": "validity",
    "worn": "may_be_invalid",
    "stale": "invalid",
    "dawdles": "may_lengthen",
    "rushes": "must_shorten",
    "soft_stride": "soft_multiple",
    "as_k": "staggered",
    "observer": "sampler",
    "publish": "update_state",
    "reel": "edit",
    "scenery": "scene",
    "studio": "pool",
    "dress": "style",
    "helm": "steering",
    "swell": "sea_controls",
    "outbox": "queue",
    "finding": "cached_result",
    "puff": "air_particle",
}


def public(name: str, path: Path) -> Iterator[str]:
    """The public names of a module: its own, those of its classes and functions, and of their methods."""
    yield name

    def within(body, prefix: str) -> Iterator[str]:
        for node in body:
            if isinstance(node, ast.ClassDef | ast.FunctionDef) and not node.name.startswith("_"):
                yield f"{prefix}.{node.name}"
                if isinstance(node, ast.ClassDef):
                    yield from within(node.body, f"{prefix}.{node.name}")

    yield from within(ast.parse(path.read_text(encoding="utf-8")).body, name)


def words_of(name: str) -> set[str]:
    """The last part of a dotted name, in small letters with strokes, and the words of it."""
    last = name.rpartition(".")[2]
    parted = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in last).strip("_")
    return {parted, *parted.split("_")}


def replaced(names: Iterator[str]) -> list[str]:
    """Which names have a word that was replaced, and what to use."""
    return [f"{name}: use {STOP[word]}" for name in names for word in sorted(words_of(name) & STOP.keys())]


def test_public_names_have_no_word_that_was_replaced():
    names = (name for module, path in modules().items() for name in public(module, path))
    assert replaced(names) == []


def test_quantities_have_no_word_that_was_replaced():
    of_all = (one for room in OF_MATTERS.values() for one in (*room.SERIES, *room.FRAMES))
    words = {"excess", "held", "place", "drop", *STOP}
    assert [one.name for one in of_all if {*one.name.split("_"), *one.per.split("_")} & words] == []


@pytest.mark.parametrize(("name", "use"), [("a.DummyLayer", "wall_particle"), ("a.b.dawdles", "may_lengthen")])
def test_an_old_word_is_found(name, use):
    assert replaced(iter([name])) == [f"{name}: use {use}"]


def test_the_glossary_names_what_there_is():
    text = (Path(__file__).parents[1] / "docs" / "glossary.md").read_text(encoding="utf-8")
    said = {word for part in text.split("`")[1::2] for word in [part] if part.isidentifier() and part[0].isupper()}
    sources = "\n".join(path.read_text(encoding="utf-8") for path in modules().values())
    assert len(said) > 20 and [word for word in said if word not in sources] == []
