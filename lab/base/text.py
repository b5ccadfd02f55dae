"""Escape texts from users and files, so that terminals, Markdown and spreadsheets show them and never execute them."""

import re

MARKUP = {"\\": "\\\\", "`": "\\`", "[": "\\[", "|": "\\|", "*": "\\*", "<": "&lt;", ">": "&gt;", "&": "&amp;"}
LONGEST_HEADING = 300  # letters
FORMULA = ("=", "+", "-", "@", "\t", "\r")  # characters that begin a formula in a spreadsheet


def printable(text: str) -> str:
    """A text with ? for characters that cannot be printed, such as terminal control codes; line ends stay."""
    return "".join(c if c.isprintable() or c == "\n" else " " if c == "\t" else "?" for c in text)


def one_line(text: object) -> str:
    """A text on one line."""
    return printable(" ".join(str(text).split()))


def heading(text: object) -> str:
    """A text on one line to draw above a picture, cut where it is longer than any title."""
    line = one_line(text)
    return line if len(line) <= LONGEST_HEADING else f"{line[:LONGEST_HEADING]}…"


def inline(text: object) -> str:
    """A text escaped for use within a line or a table cell of a Markdown page."""
    return "".join(MARKUP.get(c, c) for c in one_line(text))


def paragraphs(text: str) -> str:
    """A text of several paragraphs, escaped for a Markdown page."""
    lines = [inline(part) for part in re.split(r"\n\s*\n", text)]
    return "\n\n".join(f"\\{line}" if line[0] in "#+=~-" else _numbered(line) for line in lines if line)


def _numbered(line: str) -> str:
    """Escape a number and a full stop at the start of a line, which would begin a list."""
    return re.sub(r"^(\d+)([.)])(?=\s)", r"\1\\\2", line)


def code(text: object) -> str:
    """A text as code within a line of a Markdown page."""
    return f"`{one_line(text).replace('`', chr(39)).replace('|', '/')}`"


def fenced(text: str, language: str) -> str:
    """A text of many lines as a fenced code block in a Markdown page; the fence is longer than any in the text."""
    longest = max((len(run) for run in re.findall("`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    return f"{fence}{language}\n{printable(text).strip()}\n{fence}"


def cell(value: object) -> object:
    """A value for a spreadsheet; a text that would be read as a formula gets an apostrophe before it."""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULA) else value
