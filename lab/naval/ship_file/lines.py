"""On which line of a TOML text a key stands."""

import re
import tomllib

HEADER = re.compile(r"^\s*\[\[?\s*([^\]]+?)\s*\]\]?\s*(?:#.*)?$")
PART = re.compile(r"""\s*(?:"([^"]*)"|'([^']*)'|([A-Za-z0-9_-]+))\s*""")
TEXTS = re.compile(r'"""|\'\'\'|"(?:\\.|[^"\\])*"|\'[^\']*\'|#.*|[\[\]{}]')


def places(text: str) -> dict[tuple[str, ...], int]:
    """The line, from 1, of each table's header and each key of a TOML text, by its parts.

    Keys of inline tables are at the line on which they stand, if they begin one, else at that of the table.
    """
    found: dict[tuple[str, ...], int] = {}
    table: tuple[str, ...] = ()
    depth, quote, key = 0, "", ()
    for number, line in enumerate(text.splitlines(), start=1):
        if not depth and not quote:
            if header := HEADER.match(line):
                table = _parts(header[1])
                found.setdefault(table, number)
                continue
            key = _key(line)
            for end in range(1, len(key) + 1):
                found.setdefault((*table, *key[:end]), number)
        elif depth and key and not quote:
            _inner(line, (*table, *key), number, found)
        depth, quote = _after(line, depth, quote)
    return found


def line_of(known: dict[tuple[str, ...], int], dotted: str) -> int | None:
    """The line of a dotted key, or of the nearest table above it that is written; None: of none."""
    parts = tuple(re.sub(r"\[\d+\]", "", dotted).split("."))
    numbers = re.findall(r"\[(\d+)\]", dotted)
    if numbers and (item := known.get((*parts[: 1 + _first_list(dotted)], numbers[0]))):
        return item
    for end in range(len(parts), 0, -1):
        if parts[:end] in known:
            return known[parts[:end]]
    return None


def of_error(error: tomllib.TOMLDecodeError) -> tuple[int | None, str]:
    """The line that the standard library names in an error of syntax, and the rest of its sentence."""
    told = str(error)
    if place := re.search(r"\s*\(at line (\d+), column \d+\)", told):
        return int(place[1]), told[: place.start()]
    return None, told.removesuffix(" (at end of document)")


def _first_list(dotted: str) -> int:
    """How many dots stand before the first [ of a dotted key."""
    return dotted[: dotted.index("[")].count(".")


def _inner(line: str, path: tuple[str, ...], number: int, found: dict[tuple[str, ...], int]) -> None:
    """Note the line of an item of a list: items are counted by the lines that begin with a bracket."""
    if line.strip().startswith(("{", "[")):
        item = sum(1 for one in found if one[:-1] == path and one[-1].isdigit())
        found[*path, str(item)] = number


def _after(line: str, depth: int, quote: str) -> tuple[int, str]:
    """Depth of brackets and open long text after a line."""
    for one in TEXTS.findall(line):
        if quote:
            quote = "" if one == quote else quote
        elif one in ('"""', "'''"):
            quote = one
        elif one in ("[", "{"):
            depth += 1
        elif one in ("]", "}"):
            depth -= 1
        elif one.startswith("#"):
            break
    return max(depth, 0), quote


def _key(line: str) -> tuple[str, ...]:
    """The parts of the key that a line begins with; none without one."""
    head = line.partition("=")[0]
    return _parts(head) if "=" in line and not head.strip().startswith("#") else ()


def _parts(text: str) -> tuple[str, ...]:
    """The parts of a dotted key."""
    found, place = [], 0
    while match := PART.match(text, place):
        found.append(match[1] if match[1] is not None else match[2] if match[2] is not None else match[3])
        place = match.end()
        if not text[place:].startswith("."):
            break
        place += 1
    return tuple(found)
