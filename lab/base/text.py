"""Texts of people and files on screens, in Markdown pages and in tables: shown as they stand, and obeyed by nothing."""

import re

MARKUP = {"\\": "\\\\", "`": "\\`", "[": "\\[", "|": "\\|", "*": "\\*", "<": "&lt;", ">": "&gt;", "&": "&amp;"}
FORMULA = ("=", "+", "-", "@", "\t", "\r")  # what begins a formula in a spreadsheet


def printable(text: str) -> str:
    """A text with ? for what is no sign, such as a terminal's commands; the ends of its lines stay."""
    return "".join(c if c.isprintable() or c == "\n" else " " if c == "\t" else "?" for c in text)


def one_line(text: object) -> str:
    """A text on one line."""
    return printable(" ".join(str(text).split()))


def inline(text: object) -> str:
    """A text as a part of a line of a Markdown page, or of a cell of its tables."""
    return "".join(MARKUP.get(c, c) for c in one_line(text))


def paragraphs(text: str) -> str:
    """A text of several paragraphs in a Markdown page."""
    lines = [inline(part) for part in re.split(r"\n\s*\n", text)]
    return "\n\n".join(f"\\{line}" if line[0] in "#+=~-" else _numbered(line) for line in lines if line)


def _numbered(line: str) -> str:
    """A line that begins with a number and a point, which is not meant to begin a list."""
    return re.sub(r"^(\d+)([.)])(?=\s)", r"\1\\\2", line)


def code(text: object) -> str:
    """A text as code within a line of a Markdown page."""
    return f"`{one_line(text).replace('`', chr(39)).replace('|', '/')}`"


def fenced(text: str, language: str) -> str:
    """A text of many lines as code in a Markdown page, whatever it holds."""
    longest = max((len(run) for run in re.findall("`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    return f"{fence}{language}\n{printable(text).strip()}\n{fence}"


def cell(value: object) -> object:
    """A value of a table for spreadsheets; a text that they would compute gets an apostrophe before it."""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULA) else value
