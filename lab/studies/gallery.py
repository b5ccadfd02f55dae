"""cargolab gallery: a poster, a clip and the numbers of every preset, and a page that shows them all.

The page is plain HTML beside its pictures, so it opens from the disk. A preset is run in its quick variant, if it has
one, in the folder `runs`; runs that are done are not repeated.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from html import escape
from math import ceil
from pathlib import Path

from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.measures.value import read_values
from lab.paint.cargoes import COLOURS, paint_cargoes
from lab.paint.video import poster, render_recording
from lab.preset.find import QUICK, names
from lab.recording import Recording, open_recording
from lab.recording.ship_end import ends
from lab.report.numbers import number
from lab.report.summary import TELLING
from lab.runs.runner import reported, resume_run, run_preset
from solvers.machine.errors import BadState

WIDTH, HEIGHT = 640, 360  # pixels
LONGEST = 8.0  # s of a clip
MOMENT = 0.85  # fraction of the film that the poster shows; of a ship that is lost, the end
UNITS = {"deg": "°", "d": "diameters"}
MOST_NUMBERS = 4
CARGOES = "cargoes.png"

ERRORS = (
    "Behind each number stands of how many beds it is: ± is their standard deviation. Of one bed there is none, "
    "though angles of like beds differ by several degrees. What a measure knows of its own uncertainty has a name: see "
    "docs/numbers.md. Each card says with which accuracy, by which version and when its numbers were made."
)

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #212934; margin: 2rem auto; max-width: 1320px; padding: 0 1rem; }
h2 { margin: 2.2rem 0 .6rem; text-transform: capitalize; }
.presets { display: grid; grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); gap: 1.2rem; }
figure { margin: 0; border: 1px solid #e1e5ea; border-radius: 6px; overflow: hidden; }
video, img { width: 100%; aspect-ratio: 16 / 9; display: block; background: #f6f7f9; }
figcaption { padding: .6rem .8rem .8rem; }
img.wide { aspect-ratio: auto; background: none; margin-bottom: 1.2rem; }
code { background: #f1f3f6; padding: .1em .35em; border-radius: 3px; }
table { font-size: 13.5px; } td { padding: .05rem .8rem .05rem 0; vertical-align: top; }
td + td { padding-right: 0; white-space: nowrap; } .why { color: #68727e; }
"""
SCRIPT = """
for (const clip of document.querySelectorAll("video")) {
  clip.controls = false;  // they would hide a third of the poster
  clip.tabIndex = 0;
  clip.onmouseenter = clip.onfocus = () => { clip.controls = true; };
  clip.onmouseleave = clip.onblur = () => { clip.controls = !clip.paused; };
}
"""


def make_gallery(wanted: Sequence[str], out: Path | str, quiet: bool = False, beds: int = 1) -> Path:
    """Run the presets whose names begin like one of `wanted`, or all, and write the page; returns its file.

    Each is run with this number of `beds`. Raises LabError if no preset begins with a name, and if something cannot be
    written.
    """
    every = names()
    shown = [name for name in every if not name.endswith(QUICK)]
    for start in wanted:
        if not any(name.startswith(start) for name in shown):
            raise LabError(f"there is no preset {start}; `cargolab list` shows all.")
    out = Path(out)
    out.mkdir(parents=True, exist_ok=True)
    chosen = [name for name in shown if not wanted or name.startswith(tuple(wanted))]
    with Progress(quiet) as progress:
        for name in chosen:
            progress.say(f"{name} …")
            _show(name, out, beds)
            _write_page(every, out)
        _show_cargoes(out)
    return _write_page(every, out)


def _show(name: str, out: Path, beds: int) -> None:
    """Run a preset, or what is left of its run, and write its poster, its clip and its numbers."""
    clip = out / f"{_plain(name)}.mp4"
    if clip.exists():
        return
    folder = out / "runs" / name
    try:
        if reported(folder, "complete"):
            pass
        elif (folder / "recording.h5").exists():
            resume_run(folder, video=False, plots=False, quiet=True)
        else:
            run_preset(_cheapest(name, names()), {"run.repeats": beds}, folder, video=False, plots=False, quiet=True)
    except BadState:  # its page says so
        pass
    with open_recording(folder) as recording:
        lasts, speed = float(recording.series["time"][-1]), recording.preset.video.speed
        made, lost = _made(recording), any(ends(recording.series))
    poster(folder, out / f"{_plain(name)}.png", fraction=1.0 if lost else MOMENT, width=WIDTH, height=HEIGHT)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    told = json.dumps({**_telling(summary), **made}, indent=1)
    (out / f"{_plain(name)}.json").write_text(told + "\n", encoding="utf-8")
    render_recording(folder, clip, width=WIDTH, height=HEIGHT, speed=max(speed, ceil(10.0 * lasts / LONGEST) / 10.0))


def _show_cargoes(out: Path) -> None:
    """One picture of the beds of all cargoes that have been run."""
    beds = {name: out / "runs" / "shapes" / name for name in COLOURS}
    run = {name: folder for name, folder in beds.items() if (folder / "recording.h5").exists()}
    if run:
        paint_cargoes(run, out / CARGOES)


def _cheapest(name: str, every: Mapping[str, str]) -> str:
    return name + QUICK if name + QUICK in every else name


def _plain(name: str) -> str:
    return name.replace("/", "-")


def _made(recording: Recording) -> dict[str, object]:
    """The accuracy, number of beds, version and date of a recording."""
    return {
        "accuracy": recording.preset.run.accuracy,
        "beds": recording.worlds,
        "version": recording.versions["cargo-shift-lab"],
        "date": recording.created[:10],
    }


def _telling(summary: Mapping) -> dict[str, object]:
    """How the run ended, and its most important measures as text."""
    measures = read_values(summary["measures"])
    order = [name for name in TELLING if name in measures] + [name for name in measures if name not in TELLING]
    numbers = {}
    for name in order[:MOST_NUMBERS]:
        value = measures[name]
        told = number(replace(value, unit=UNITS.get(value.unit, value.unit)))
        numbers[name] = told.replace("-", "\N{MINUS SIGN}").replace(" °", "°")
    return {"status": summary["status"], "numbers": numbers}


def _write_page(every: Mapping[str, str], out: Path) -> Path:
    groups: dict[str, list[str]] = {}
    for name, title in every.items():
        if not name.endswith(QUICK):
            groups.setdefault(name.split("/")[0], []).append(_card(name, title, _cheapest(name, every), out))
    wide = {"shapes": f'<img class="wide" alt="" src="{CARGOES}">'} if (out / CARGOES).exists() else {}
    body = "".join(
        f'<h2>{escape(group)}</h2>{wide.get(group, "")}<div class="presets">{"".join(cards)}</div>'
        for group, cards in groups.items()
    )
    head = f'<meta charset="utf-8"><title>Cargo Shift Lab</title><style>{STYLE}</style>'
    body = f"<h1>Every experiment of the lab</h1><p class='why'>{ERRORS}</p>{body}<script>{SCRIPT}</script>"
    text = f"<!doctype html><html><head>{head}</head><body>{body}</body></html>\n"
    path = out / "index.html"
    path.write_text(text, encoding="utf-8")
    return path


def _origin(found: Mapping) -> str:
    """How the numbers of a card were made, in words."""
    beds = f"{found['beds']} bed{'s' if found['beds'] > 1 else ''}"
    return f"{found['accuracy']} accuracy, {beds}; version {found['version']}, {found['date']}"


def _told(path: Path) -> tuple[dict[str, str], str, str]:
    """Read the numbers of a preset that `_telling` gave, how its run ended, how they were made. Raises LabError."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        numbers, status, origin = dict(found["numbers"]), found["status"], _origin(found)
        if not all(isinstance(text, str) for text in (status, *numbers, *numbers.values())):
            raise ValueError("something is no text")
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise LabError(f"{path} is damaged: remove it, and the clip beside it, and ask again.") from error
    return numbers, status, origin


def _card(name: str, title: str, cheapest: str, out: Path) -> str:
    """The card of a preset: its clip, else its poster, the command of its cheapest variant, its numbers."""
    plain = _plain(name)
    if not (out / f"{plain}.json").exists():
        picture, told = "<img alt='not run yet'>", "<p class='why'>not run yet</p>"
    else:
        numbers, status, origin = _told(out / f"{plain}.json")
        rows = [f"<tr><td>{escape(k.replace('_', ' '))}</td><td>{escape(v)}</td></tr>" for k, v in numbers.items()]
        ended = "" if status == "complete" else f"<p class='why'>{escape(status)}</p>"
        told = f"<table>{''.join(rows)}</table>{ended}<p class='why'>{escape(origin)}</p>"
        link = escape(plain)
        picture = f'<img alt="" src="{link}.png">'
        if (out / f"{plain}.mp4").exists():
            picture = f'<video controls loop muted preload="none" poster="{link}.png" src="{link}.mp4"></video>'
    command = f"cargolab run {cheapest}"
    return (
        f"<figure>{picture}<figcaption><b>{escape(title)}</b><p><code>{escape(command)}</code></p>{told}"
        "</figcaption></figure>"
    )
