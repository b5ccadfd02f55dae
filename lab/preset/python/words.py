"""Words that a key takes beyond those of the lab, as the names of a user's own laws and colours."""

from dataclasses import fields
from typing import Annotated, Literal, get_args, get_origin

from lab.preset import fields as reading
from lab.preset import recorded, schema


def add_word(kind: type, name: str, word: str) -> None:
    """Let the field of that name of a preset's dataclass take another word."""
    hint = kind.__annotations__[name]
    if word in reading.taken_from(hint).words:
        return
    widened = _widened(hint, word)
    kind.__annotations__[name] = widened
    next(field for field in fields(kind) if field.name == name).type = widened
    assert schema  # loaded, since the short list of keys knows nothing of the word
    for remembered in (reading.taken_of, reading.walk, recorded._model):
        remembered.cache_clear()


def _widened(hint: object, word: str) -> object:
    """An annotation whose first list of words has one more."""
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return Annotated[_widened(arguments[0], word), *hint.__metadata__]
    if origin is Literal:
        return Literal[*arguments, word]
    parts = [_widened(part, word) if get_origin(part) in (Literal, Annotated) else part for part in arguments]
    found = parts[0]
    for part in parts[1:]:
        found = found | part
    return found
