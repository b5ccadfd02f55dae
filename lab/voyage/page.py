"""The page of a voyage for the file: the answer first, then the sea, every seed, the worst, and what is left out."""

from base64 import b64encode
from collections.abc import Iterator
from pathlib import Path

from lab import __version__
from lab.base.errors import LabError
from lab.base.files import write_text
from lab.measures.value import Value
from lab.report.page import render_text
from lab.sweeps.grid import Sweep
from lab.voyage.asked import AXIS, Voyage
from lab.voyage.judged import SHIFTED, Judged, coarseness, first_of

FILE = "voyage.html"
COLUMNS = {  # heading: measure and digits
    "largest roll (deg)": ("largest_roll", 1),
    "frozen (deg)": ("frozen_largest_roll", 1),
    "largest shift (%)": ("largest_shifted_share", 1),
    "shift at the end (%)": ("shifted_share", 1),
    "list (deg)": ("list_as_it_lay", 2),
    "lost at (s)": ("capsized_at", 0),
}
NOTES = (
    "A run is the part of a sea round its worst group by linear roll: shares are of such parts, not of all hours.",
    "The sea is long-crested and abeam; she is a section, free in sway, heave and roll.",
    "The list is that of calm water with the cargo as it lay at the end; a ship that is lost counts as listed.",
    "Shifts are in % of the volumetric moment that the Grain Code assumes for the hold.",
    "Frozen is the same ship in the same sea with her cargo held as it lay at the start.",
)


def facts(voyage: Voyage, judged: Judged) -> list[tuple[str, object]]:
    """The answers and what they are of, each a name and a text."""
    rows: list[tuple[str, object]] = [
        ("verdict", judged.verdict),
        (f"lists by {voyage.limit:g} deg or more, or is lost", judged.listed),
        ("is lost", judged.lost),
        ("would be lost with frozen cargo", judged.frozen_lost),
        (f"cargo shifts by {SHIFTED:g} % of the code's moment or more", judged.shifted),
        ("list", _number(judged.mean("list_as_it_lay", "deg"))),
        ("largest roll", _number(judged.mean("largest_roll", "deg"))),
        ("largest roll, frozen", _number(judged.mean("frozen_largest_roll", "deg"))),
        ("sea", f"JONSWAP, H_s {voyage.height:g} m, T_p {voyage.period:g} s, {voyage.hours:g} h, abeam"),
        ("runs", f"{len(judged.points)} of {voyage.seeds} seeds, each of {voyage.span:g} s round the worst group"),
        ("cargo", coarseness(judged.preset)[0]),
    ]
    rows += [(f"worst seed with grains of {check.size}", _checked(check)) for check in judged.checks]
    return rows


def describe(voyage: Voyage, judged: Judged) -> str:
    """Text for the terminal."""
    found = facts(voyage, judged)
    width = max(len(name) for name, _ in found)
    return "\n".join([judged.preset.title, *(f"  {name:<{width}}  {text}" for name, text in found)])


def write(voyage: Voyage, judged: Judged, sweep: Sweep, folder: Path) -> Path:
    """Write the page into a folder; returns its file. Raises LabError."""
    worst = judged.points[judged.worst]
    number = sweep.axes[AXIS].index(worst.setting[AXIS])
    page = render_text(
        "voyage.html.j2",
        title=judged.preset.title,
        name=sweep.name,
        version=__version__,
        facts=facts(voyage, judged),
        columns=["seed", "begins at (s)", *COLUMNS],
        rows=list(_rows(judged, sweep)),
        worst=worst.setting[AXIS],
        figures=[(path.stem, _embedded(path)) for path in sorted(worst.folder.glob("*.png"))],
        notes=[*NOTES, *_unchecked(judged)],
        given=sweep.points[number].given_text,
    )
    path = folder / FILE
    try:
        write_text(path, page)
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror}): choose another folder.") from error
    return path


def _rows(judged: Judged, sweep: Sweep) -> Iterator[list[str]]:
    for point in judged.points:
        seed = point.setting[AXIS]
        begin = sweep.points[sweep.axes[AXIS].index(seed)].resolved.waves.begin
        yield [str(seed), f"{begin:.0f}", *(_cell(first_of(point, name), digits) for name, digits in COLUMNS.values())]


def _cell(number: float | None, digits: int) -> str:
    return "" if number is None else f"{number:.{digits}f}"


def _number(value: Value) -> str:
    return f"{value}".replace("bed", "sea") if value.value is not None else "not found"


def _checked(check) -> str:
    names = {"largest roll": "largest_roll", "largest shift": "largest_shifted_share"} | {"list": "list_as_it_lay"}
    units = {"largest shift": "%"}
    found = {words: first_of(check.point, name) for words, name in names.items()}
    told = [f"{words} {one:.1f} {units.get(words, 'deg')}" for words, one in found.items() if one is not None]
    return ", ".join(told) or "was not run to its end"


def _unchecked(judged: Judged) -> list[str]:
    if judged.checks:
        return []
    return ["The cargo was not checked with grains (--grains PRESET --size ...)."]


def _embedded(path: Path) -> str:
    return b64encode(path.read_bytes()).decode("ascii")
