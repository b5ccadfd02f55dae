"""On which line of a TOML text a key stands."""

import re
import tomllib

HEADER = re.compile(r"^\s*\[\[?\s*([^\]]+?)\s*\]\]?\s*(?:#.*)?$")
PART = re.compile(r"""\s*(?:"([^"]*)"|'([^']*)'|([A-Za-z0-9_-]+))\s*""")
TOKEN = re.compile(r'"""|\'\'\'|"(?:\\.|[^"\\])*"|\'[^\']*\'|#.*|[\[\]{}]')
LONG = '"""', "'''"
INDEX = re.compile(r"\[(\d+)\]")

Places = dict[tuple[str, ...], int]


def places(text: str) -> Places:
    """The line, from 1, of each table's header, each key and each item of a list, by its parts.

    The items that count are tables and lists: those that begin a value in brackets. Keys of inline tables are none of
    their own.
    """
    found: Places = {}
    table, key = (), ()
    depth, quote = 0, ""
    for number, line in enumerate(text.splitlines(), start=1):
        if not depth and not quote:
            if header := HEADER.match(line):
                table, key = _parts(header[1]), ()
                found.setdefault(table, number)
                continue
            key = _key(line)
            for end in range(1, len(key) + 1):
                found.setdefault((*table, *key[:end]), number)
            line = line.partition("=")[2]
        for token in TOKEN.findall(line):
            if quote:
                quote = "" if token == quote else quote
            elif token in LONG:
                quote = token
            elif token in ("[", "{"):
                if depth == 1 and key:
                    _count_item((*table, *key), number, found)
                depth += 1
            elif token in ("]", "}"):
                depth = max(depth - 1, 0)
    return found


def line_of(known: Places, dotted: str) -> int | None:
    """The line of a dotted key, of the first key below it, or of the nearest one above it; None: of none."""
    parts: list[str] = []
    for part in dotted.split("."):
        parts += [INDEX.sub("", part), *INDEX.findall(part)]
    whole = tuple(parts)
    below = [line for key, line in known.items() if key[: len(whole)] == whole]
    if whole not in known and below:
        return min(below)
    return next((known[whole[:end]] for end in range(len(whole), 0, -1) if whole[:end] in known), None)


def of_error(error: tomllib.TOMLDecodeError) -> tuple[int | None, str]:
    """The line that the standard library names in an error of syntax, and the rest of its sentence."""
    told = str(error)
    if place := re.search(r"\s*\(at line (\d+), column \d+\)", told):
        return int(place[1]), told[: place.start()]
    return None, told.removesuffix(" (at end of document)")


def _count_item(path: tuple[str, ...], number: int, found: Places) -> None:
    """Note the line of the next item of a list."""
    item = 0
    while (*path, str(item)) in found:
        item += 1
    found[*path, str(item)] = number


def _key(line: str) -> tuple[str, ...]:
    """The parts of the key that a line begins with; none without one."""
    head = line.partition("=")[0]
    return _parts(head) if "=" in line and not head.strip().startswith("#") else ()


def _parts(text: str) -> tuple[str, ...]:
    """The parts of a dotted key."""
    found, place = [], 0
    while match := PART.match(text, place):
        found.append(next(one for one in match.groups() if one is not None))
        place = match.end()
        if not text[place:].startswith("."):
            break
        place += 1
    return tuple(found)
