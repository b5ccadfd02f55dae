"""Words and keys beyond those of the lab, as the names of a user's own laws, colours and motions."""

from dataclasses import field, fields, make_dataclass
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
    _forget()


def add_key(kind: type, name: str, hint: object) -> None:
    """Let a preset's dataclass have another key, which may be left out, or take another annotation for it.

    The class stays the same object, since others hold it; what was made of it has the key as left out.
    """
    kind.__annotations__[name] = hint
    setattr(kind, name, None)  # of objects that were made before
    own = {one.name: one for one in fields(kind)}
    keys = [(key, hint, field(default=own[key].default if key in own else None)) for key, hint in _own_keys(kind)]
    made = make_dataclass(kind.__name__, keys, bases=kind.__bases__, frozen=True)
    for part in ("__init__", "__repr__", "__eq__", "__hash__", "__match_args__", "__dataclass_fields__"):
        setattr(kind, part, getattr(made, part))
    _forget()


def _own_keys(kind: type) -> list[tuple[str, object]]:
    """The keys of a dataclass that its bases do not have, with their annotations."""
    return list(kind.__annotations__.items())


def _forget() -> None:
    """Forget what is remembered of the keys."""
    assert schema  # loaded, since the short list of keys knows nothing of the word
    for remembered in (reading.taken_of, reading.defaults_of, reading.walk, recorded._model):
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
