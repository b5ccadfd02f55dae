"""What a recording holds, in a line and as a page of a notebook."""

from lab.base.notebook.html import details, paragraph, table, titled
from lab.base.text import one_line
from lab.recording.layout import OF_MATTERS

TABLES = {"series": "samples", "frames": "frames"}


def line(recording) -> str:
    """In a line: of what preset, its beds, rows and status."""
    return f"<Recording of {one_line(recording.name)}: {_counted(recording)}; {one_line(recording.status)}>"


def html(recording) -> str:
    """What it is of and what it holds: the tables with their quantities, all texts escaped."""
    title = str(recording.resolved.get("title", "")) or recording.name
    facts = f"{recording.name}, {recording.created}: {_counted(recording)}; {recording.status}"
    parts = [paragraph(facts)]
    for name, what in TABLES.items():
        held = getattr(recording, name)
        rows = [
            (one.name, ", ".join(dict.fromkeys(one.units)), " × ".join(one.axes), one.label)
            for one in held.quantities.values()
        ]
        said = f"{name}: {len(rows)} quantities, {held.rows} {what}"
        parts.append(details(said, table(("name", "unit", "axes", "what"), rows)))
    return titled(title, *parts)


def _counted(recording) -> str:
    """Beds, particles and rows."""
    sizes = {"grains": "grain", "water": "water_particle", "air": "air_particle", "bulk": "point"}
    matters = [f"{recording.sizes[sizes[one]]} {_said(one)}" for one in OF_MATTERS if one in recording.content.matters]
    rows = [f"{getattr(recording, name).rows} {what}" for name, what in TABLES.items()]
    return ", ".join([f"{recording.worlds} bed{'s' * (recording.worlds != 1)}", *matters, *rows])


def _said(matter: str) -> str:
    return {"grains": "grains", "bulk": "points of bulk"}.get(matter, f"particles of {matter}")
