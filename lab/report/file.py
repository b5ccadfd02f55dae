"""`cargolab report`: one self-contained page a run for the file, as HTML and, with WeasyPrint, as PDF.

The page holds inputs, assumptions, criteria, figures, numbers, versions and the SHA-256 of the recording: whoever has
the recording can check that the page is of it.
"""

from base64 import b64encode
from collections.abc import Iterator
from hashlib import file_digest
from io import BytesIO
from pathlib import Path

import matplotlib

from lab.base.errors import LabError
from lab.base.files import replacing, write_text
from lab.measures import measure_all
from lab.naval import sheet
from lab.preset.units import show
from lab.recording import Recording, open_recording
from lab.report.numbers import number
from lab.report.page import render_text
from lab.report.plots import STYLE, figures
from lab.report.ship import judged
from lab.report.stability import SIGNS
from lab.report.summary import cautions, machine_of, status_of

TEMPLATE = "file.html.j2"
DPI = 110


def write_report(folder: Path, pdf: bool = False) -> list[Path]:
    """Write report.html, and report.pdf if asked for, beside a recording; returns the files.

    Raises LabError for a folder without one, one that cannot be written, and without the library that writes PDF.
    """
    with open_recording(folder) as recording:
        text = render_text(TEMPLATE, **_data(recording))
        place = recording.path.parent
    written = [place / "report.html"]
    try:
        write_text(written[0], text)
    except OSError as error:
        raise LabError(f"{place} cannot be written ({error.strerror}): make room there.") from error
    return [*written, _pdf(text, place / "report.pdf")] if pdf else written


def _pdf(text: str, path: Path) -> Path:
    """The page as PDF. Raises LabError if the library, or what it needs of the system, is not installed."""
    try:
        from weasyprint import HTML
    except (ImportError, OSError) as error:  # OSError: without Pango
        raise LabError(
            "--pdf: needs WeasyPrint and the system's Pango: pip install 'cargo-shift-lab[pdf]'; or print report.html "
            "from a browser, which lays it out on A4."
        ) from error
    with replacing(path) as part:
        HTML(string=text).write_pdf(part)
    return path


def _data(recording: Recording) -> dict[str, object]:
    """What the template shows."""
    values = measure_all(recording)
    rows, facts, notes = judged(recording)
    with recording.path.open("rb") as file:
        signature = file_digest(file, "sha256").hexdigest()
    return {
        "title": recording.preset.title,
        "name": recording.name,
        "created": recording.created,
        "status": status_of(recording),
        "warnings": list(cautions(recording)),
        "shown": sheet.shown,
        "condition": facts,
        "criteria": rows,
        "assumptions": [*_assumptions(recording, bool(rows)), *notes],
        "figures": [{"name": name, "data": data} for name, data in _pictures(recording, values)],
        "measures": [(name.replace("_", " "), number(value), value.note) for name, value in values.items()],
        "given": recording.given,
        "version": recording.version,
        "versions": recording.versions,
        "machine": machine_of(recording),
        "recording": recording.path.name,
        "signature": signature,
    }


def _assumptions(recording: Recording, judged: bool) -> Iterator[str]:
    """What the numbers rest on, a sentence each."""
    preset = recording.preset
    yield "All happens in a plane across the tank; what is in it is a slab, whose forces count per metre of length."
    if preset.grains:
        real = preset.grains.stands_for
        stands = f"many of {show(real, 'm')}: coarse grains" if real else "itself"
        yield f"Grains are spheres that move in the plane, or outlines of that mass; each grain stands for {stands}."
    lines = preset.ship is not None and preset.ship.offsets is not None
    hull = "has the lines of her offsets, on an even keel," if lines else "is a prism of one section"
    if preset.ship:
        yield f"The hull {hull} in beam waves of linear theory, with viscous roll damping as given."
    if judged:
        yield f"Criteria are those of calm water; levers are those of her {'lines' if lines else 'section'}."
        yield "As it lay farthest aside: the cargo's centre as the run's worst moment had it, as if it then lay still."
        yield SIGNS


def _pictures(recording: Recording, values) -> Iterator[tuple[str, str]]:
    """The run's figures as PNG in base 64, by name."""
    with matplotlib.rc_context(STYLE):
        for name, figure in figures(recording, values):
            stream = BytesIO()
            figure.savefig(stream, dpi=DPI)
            yield name, b64encode(stream.getvalue()).decode("ascii")
