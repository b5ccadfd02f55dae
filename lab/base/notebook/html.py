"""Pieces of HTML for notebooks. Every text is escaped: presets and recordings may come from anybody."""

from collections.abc import Iterable, Sequence
from html import escape

from lab.base.text import printable


def text(value: object) -> str:
    """A text that a page shows as it stands."""
    return escape(printable(str(value)))


def paragraph(value: object, style: str = "") -> str:
    """A paragraph; `style`: of CSS, of the lab's own."""
    return f"<p{_styled(style or 'margin: .2em 0')}>{text(value)}</p>"


def table(heads: Sequence[object], rows: Iterable[Sequence[object]]) -> str:
    """A table with a row of heads."""
    head = "".join(f"<th{_styled('text-align: left')}>{text(one)}</th>" for one in heads)
    body = "".join(f"<tr>{''.join(_cell(one) for one in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def details(summary: object, inner: str, is_open: bool = False) -> str:
    """A piece of a page, `inner`, that opens at a click on its summary."""
    return f"<details{' open' if is_open else ''}><summary>{text(summary)}</summary>{inner}</details>"


def titled(title: object, *pieces: str) -> str:
    """Pieces of a page below a title."""
    return f"<div><strong>{text(title)}</strong>{''.join(pieces)}</div>"


def preformatted(value: object) -> str:
    """A text of many lines as it is written."""
    return f"<pre>{text(value)}</pre>"


def _cell(value: object) -> str:
    return f"<td{_styled('text-align: left; vertical-align: top')}>{text(value)}</td>"


def _styled(style: str) -> str:
    return f' style="{style}"'
