"""`cargolab flood`: a case computed, and its page, tables and film written."""

from base64 import b64encode
from io import BytesIO
from pathlib import Path

from lab import __version__
from lab.base.errors import LabError
from lab.base.files import write_text
from lab.naval import tables as naval
from lab.naval.flooding import tables
from lab.naval.flooding.case import LoadedCase
from lab.naval.flooding.results import Results

RENDERS = Path("renders/flood")
ON_PAGE = {"stages": "Stages of flooding", "rooms": "Rooms at the end"}
NOTES = (
    "Heel is positive starboard down, trim by the stern, z from the keel; levels are above the sea, which is calm.",
    "GM of the stages is that of M + water by added weight, with all free surfaces.",
    "Q = C_d ∫ √(2 g Δh) dA through each opening; no waves, no sloshing, no inertia of the water in openings.",
)
AT_REST = "At each moment she lies as she comes to rest with the water that is in her; transient roll is not in it."
IN_MOTION = "She heaves and rolls with added mass and drag; the water in her rooms lies level."


def describe(loaded: LoadedCase, results: Results) -> str:
    """Text for the terminal."""
    facts = tables.facts(results)
    width = max(len(name) for name, _ in facts)
    lines = [f"{loaded.case.title}  ({loaded.name})", *(f"  {name:<{width}}  {text}" for name, text in facts), ""]
    for table in (tables.stages(results), tables.rooms(results)):
        lines += [*_aligned(table), ""]
    return "\n".join([*lines, *_notes(loaded)])


def write(loaded: LoadedCase, results: Results, out: Path | None, film: bool) -> Path:
    """Write page, tables and film into a folder, which is returned. Raises LabError."""
    from lab.paint.flooding.film import LevelFilm, write_film
    from lab.report.flooding.figures import draw
    from lab.report.page import render_text

    folder = RENDERS / loaded.name if out is None else Path(out)
    found = tables.all_of(results)
    naval.write(found, folder)
    pictures = LevelFilm(results, loaded.case.title)
    figures = [("how it floods", draw(results, folder))]
    stills = [(f"at {results.time[k]:.4g} s", _png(pictures.picture(k))) for k in _moments(results)]
    page = render_text(
        "flooding.html.j2",
        title=loaded.case.title,
        name=loaded.name,
        source=loaded.case.source,
        version=__version__,
        facts=tables.facts(results),
        notes=_notes(loaded),
        figures=[(name, b64encode(path.read_bytes()).decode("ascii")) for name, path in figures],
        stills=stills,
        tables=[(title, *found[name]) for name, title in ON_PAGE.items()],
        given=loaded.text,
    )
    try:
        write_text(folder / "flood.html", page)
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror}): choose another folder.") from error
    if film:
        write_film(results, loaded.case.title, folder / "levels.mp4")
    return folder


def numbers(results: Results) -> dict[str, object]:
    """What happened, as JSON has it: seconds, degrees, kilograms, metres; None where it did not happen."""
    import numpy as np

    heel, when = results.largest
    found = {
        "outcome": results.course.end,
        "time": float(results.time[-1]),
        "deck_edge_under": results.deck_time,
        "at_rest": results.rest_time,
        "largest_heel": float(np.degrees(heel)),
        "largest_heel_at": when,
        "heel": float(np.degrees(results.heel[-1])),
        "trim": float(results.trim[-1]),
        "water": float(results.mass[-1]),
        "doors": results.course.doors,
    }
    if results.course.end != "afloat":
        return found
    added, lost = results.displacements
    one, two = results.heights
    found["added_weight"] = {"displacement": added, "gm": one}
    found["lost_buoyancy"] = {"displacement": lost, "gm": two}
    left = results.survival
    if left is None:
        return found
    return found | {"largest_lever": left.lever, "range": float(np.degrees(left.range)), "s": left.factor}


def _notes(loaded: LoadedCase) -> list[str]:
    return [*NOTES, AT_REST if loaded.case.motion is None else IN_MOTION]


def _moments(results: Results) -> list[int]:
    """Numbers of the moments that the page shows: early, at the largest heel or half way, and the end."""
    import numpy as np

    last = len(results.moments) - 1
    total = results.volume.sum(axis=1)
    half = int(np.argmax(total >= total[0] + 0.5 * (total[-1] - total[0])))
    most = int(np.argmax(np.abs(results.heel)))
    return sorted({half, most, last} - {0})


def _png(picture) -> str:
    from PIL import Image

    out = BytesIO()
    Image.fromarray(picture).save(out, "PNG", optimize=True)
    return b64encode(out.getvalue()).decode("ascii")


def _aligned(table: naval.Table) -> list[str]:
    header, rows = table
    cells = [tuple(map(str, row)) for row in (header, *rows)]
    widths = [max(len(row[k]) for row in cells) for k in range(len(header))]
    return ["  " + "  ".join(f"{one:>{width}}" for one, width in zip(row, widths, strict=True)) for row in cells]
