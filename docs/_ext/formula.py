"""Formulas as docstrings write them, in plain text with Unicode, set as MathML when the pages are built.

The text of a docstring is `F_n = k ξ^(3/2) + γ_n √ξ ξ̇`: an index follows `_`, a power `^` or is a raised digit, a dot,
a hat or a bar is a combining character, `√` takes the next symbol or bracket, and factors stand side by side. MathML
is drawn by Firefox and Chrome themselves: nothing is loaded, and no script runs.
"""

import re
import unicodedata
from html import escape

FUNCTIONS = {
    "arccos",
    "arcosh",
    "arctan",
    "cos",
    "cosh",
    "exp",
    "ln",
    "max",
    "min",
    "sgn",
    "sign",
    "sin",
    "sinh",
    "tan",
}
RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ᐟ", "0123456789+−/", strict=True))
LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True))
ACCENTS = {"\u0307": "˙", "\u0308": "¨", "\u0302": "^", "\u0304": "¯"}
GREEK = "\u0370-\u03ff"
TOKEN = re.compile(
    r"(?P<number>\d+(?:\.\d+)?(?:e[-−]?\d+)?)"
    rf"|(?P<name>[A-Za-z{GREEK}∞∂])(?P<more>[A-Za-z]*)"
    r"|(?P<sign>.)",
    re.DOTALL,
)
OPENING, CLOSING = "([{", ")]}"
SCRIPT = re.compile(rf"(?<=[A-Za-z0-9∇{GREEK}\u0300-\u0308)])_(?:\(|[A-Za-z0-9{GREEK}∞]+)|\^(?:\(|[-−]?[\w.∞]+)")
SHARE = re.compile(r"<mfrac>(?:<mrow>)+<mn>\d+</mn>(?:</mrow>)+(?:<mrow>)+<m[ni]>\w+</m[ni]>(?:</mrow>)+</mfrac>")


class Reader:
    """The tokens of a formula, read from left to right into MathML."""

    def __init__(self, text: str) -> None:
        self.text, self.at = unicodedata.normalize("NFD", text.strip()), 0

    def rest(self) -> str:
        """What is not read yet."""
        return self.text[self.at :]

    def peek(self) -> str:
        """The next character, empty at the end."""
        return self.text[self.at : self.at + 1]

    def row(self, until: str = "", stacked: bool = True) -> str:
        """Factors, signs and words up to one of the characters `until`, which is read, too; fractions are `stacked`."""
        parts: list[str] = []
        touching = 0  # how many of the last parts stand without a space or a sign between: what a stroke divides
        while self.peek() and self.peek() not in until:
            if self.peek().isspace():
                self.at, touching = self.at + 1, 0
            elif stacked and touching and self.peek() == "/" and "<mtext>" not in parts[-1]:
                self.at += 1
                above = "".join(parts[-touching:])
                parts[-touching:] = [f"<mfrac>{_bare(above)}{_bare(''.join(self.side_by_side()))}</mfrac>"]
                touching = 1
            else:
                parts.append(self.factor())
                touching = 0 if parts[-1].startswith("<mo") else touching + 1
        if until and not self.peek():
            raise ValueError(f"a bracket is not closed in: {self.text}")
        self.at += len(until) and 1
        return "".join(parts)

    def side_by_side(self) -> list[str]:
        """The factors up to the next space or sign: what a stroke divides by, as 2h in /2h."""
        parts = [self.factor()]
        while re.match(rf"[\w√({GREEK}]", self.peek()) and not parts[-1].startswith("<mrow><mo>("):
            parts.append(self.factor())
        return parts

    def factor(self) -> str:
        """One number, name, word, bracket, root or sign, with its accent, index and power."""
        found = self.atom()
        below = above = ""
        while True:
            sign = self.peek()
            if sign and sign in ACCENTS:
                self.at += 1
                found = f'<mover accent="true">{found}<mo>{ACCENTS[sign]}</mo></mover>'
            elif sign and sign in LOWERED:
                below += f"<mn>{LOWERED[sign]}</mn>"
                self.at += 1
            elif sign and sign in RAISED:
                above += f"<mn>{RAISED[sign]}</mn>"
                self.at += 1
            elif sign == "′" or (sign == "*" and not self.text[self.at - 1].isspace()):
                above += f"<mo>{sign}</mo>"
                self.at += 1
            elif sign == "_":
                below += self.script()
            elif sign == "^":
                above += self.script()
            else:
                return _with_scripts(found, below, above)

    def script(self) -> str:
        """An index or a power: a bracket's content, or a sign and a word."""
        self.at += 1
        if self.peek() in OPENING:
            self.at += 1
            return _row(self.row(until=CLOSING, stacked=False))
        found = re.match(rf"[-−]?[A-Za-z0-9.{GREEK}∞⅔]+", self.rest())
        if not found:
            raise ValueError(f"no index or power at: {self.rest()}")
        self.at += found.end()
        tag = "mn" if found[0].lstrip("-−").isdigit() else "mi"
        return f'<{tag} mathvariant="normal">{escape(found[0])}</{tag}>' if tag == "mi" else f"<mn>{found[0]}</mn>"

    def matrix(self) -> str:
        """Rows in brackets of their own, behind the bracket that opens them all."""
        rows = []
        while self.text[self.at - 1] != "]" or self.peek() not in "]":
            self.at = self.text.index("[", self.at) + 1
            cells = [self.row(until=",]")]
            while self.text[self.at - 1] == ",":
                cells.append(self.row(until=",]"))
            rows.append("".join(f"<mtd>{_row(cell)}</mtd>" for cell in cells))
        self.at += 1
        table = "".join(f"<mtr>{row}</mtr>" for row in rows)
        return f"<mrow><mo>(</mo><mtable>{table}</mtable><mo>)</mo></mrow>"

    def atom(self) -> str:
        """One number, name, word, bracket, root or sign."""
        self.at += len(self.rest()) - len(self.rest().lstrip())
        found = TOKEN.match(self.text, self.at)
        if not found:
            raise ValueError(f"something is missing at the end of: {self.text}")
        self.at = found.end()
        if found["number"]:
            return f"<mn>{escape(found['number'])}</mn>"
        if found["name"]:
            return _named(found["name"], found["more"])
        sign = found["sign"]
        if sign == "[" and self.peek() == "[":
            return self.matrix()
        if sign in OPENING:
            inside, end = self.row(until=CLOSING), self.text[self.at - 1]
            alone = SHARE.fullmatch(inside) and self.peek() != "^" and self.peek() not in RAISED
            return inside if alone else f"<mrow><mo>{sign}</mo>{inside}<mo>{end}</mo></mrow>"
        if sign in CLOSING:
            raise ValueError(f"a bracket is not opened in: {self.text}")
        if sign == "√":
            return f"<msqrt>{_bare(self.factor())}</msqrt>"
        if sign in RAISED:
            return f"<mn>{RAISED[sign]}</mn>"
        if sign in ",;:":
            return f'<mo>{sign}</mo><mspace width="0.8em"/>'
        return f'<mo stretchy="false">{escape(sign)}</mo>'


def mathml(text: str) -> str:
    """Formulas on lines of their own, three spaces between them. Raises ValueError where brackets do not match."""
    rows = [row.strip().rstrip(".,") for row in re.split(r"\n| {3,}", text.strip())]
    set_rows = [Reader(row).row() for row in rows if row]
    return "".join(f'<div class="formula"><math display="block">{_row(row)}</math></div>' for row in set_rows)


def inline(text: str) -> str:
    """A sentence, safe in Markdown, its indices and powers lowered and raised; what stands in `…` stays as it is."""
    pieces = re.split(r"(`[^`]*`)", text)
    return "".join(piece if piece.startswith("`") else _sentence(piece) for piece in pieces)


def _sentence(text: str) -> str:
    """Text outside of code, with its signs escaped."""
    found = SCRIPT.search(text)
    if not found:
        text = escape(text, quote=False)
        for sign in "*_[]|":
            text = text.replace(sign, f"&#{ord(sign)};")
        return text
    tag, end = ("sub", "sup")[found[0][0] == "^"], found.end()
    if found[0].endswith("("):
        end = _closed(text, end)
    content = text[found.end() : end - 1] if found[0].endswith("(") else found[0][1:]
    return f"{_sentence(text[: found.start()])}<{tag}>{_sentence(content)}</{tag}>{_sentence(text[end:])}"


def _closed(text: str, at: int) -> int:
    """The place behind the bracket that closes the one before `at`."""
    depth = 1
    while depth and at < len(text):
        depth += {"(": 1, ")": -1}.get(text[at], 0)
        at += 1
    return at


def _named(first: str, more: str) -> str:
    """A symbol, a function's name, a differential, or a word."""
    word = first + more
    if not more:
        return f"<mi>{first}</mi>"
    if word in FUNCTIONS or word in ("Re", "Im"):
        return f'<mi mathvariant="normal">{word}</mi><mspace width="0.17em"/>'
    if first == "d" and len(more) == 1:
        return f"<mi>d</mi><mi>{more}</mi>"
    if not first.isascii():
        return f"<mi>{first}</mi><mi>{more}</mi>" if len(more) == 1 else f"<mi>{first}</mi><mtext>{more}</mtext>"
    return f'<mspace width="0.3em"/><mtext>{word}</mtext><mspace width="0.3em"/>'


def _with_scripts(found: str, below: str, above: str) -> str:
    if not below and not above:
        return found
    base = _row(found)
    if below and above:
        return f"<msubsup>{base}{_row(below)}{_row(above)}</msubsup>"
    return f"<msub>{base}{_row(below)}</msub>" if below else f"<msup>{base}{_row(above)}</msup>"


def _row(parts: str) -> str:
    return f"<mrow>{parts}</mrow>"


def _bare(parts: str) -> str:
    """A row without the bracket that holds all of it, as under a root or a stroke."""
    found = re.fullmatch(r"<mrow><mo>\(</mo>(.*)<mo>\)</mo></mrow>", parts)
    return _row(found[1] if found and _balanced(found[1]) else parts)


def _balanced(inside: str) -> bool:
    """Whether no bracket of the content is closed before it is opened."""
    depth = 0
    for sign in re.findall(r"<mo>([()])</mo>", inside):
        depth += 1 if sign == "(" else -1
        if depth < 0:
            return False
    return depth == 0
