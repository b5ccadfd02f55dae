"""cargolab gallery: a poster, a clip and the numbers of every preset, and a page that shows them all.

The page is plain HTML beside its pictures, so it opens from the disk. A preset is run in its quick variant, if it has
one, in the folder `runs`. What is done is not repeated, as long as it is of the preset as it is now, with as many beds;
a card says which version made it.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from math import ceil
from pathlib import Path

from PIL import Image

from lab.base.errors import LabError
from lab.base.files import replacing, write_text
from lab.base.progress import Progress
from lab.measures.value import read_values
from lab.paint.cargoes import COLOURS, paint_cargoes
from lab.paint.video import poster, render_recording, telling_time
from lab.preset.find import QUICK, load, names
from lab.recording import Recording, open_recording
from lab.report.numbers import number
from lab.report.page import render
from lab.report.summary import TELLING
from lab.studies.reproduce.cached import asked
from lab.studies.reproduce.runs import Batch, carry_out

WIDTH, HEIGHT = 640, 360  # pixels of a clip
CARD, WIDE, QUALITY = (400, 225), (1000, 1000), 65  # pixels of a card and of a wide one; what WebP calls quality
LONGEST = 8.0  # s of a clip
UNITS = {"deg": "°", "d": "diameters"}
MOST_NUMBERS = 4
CARGOES = "cargoes.webp"
TOLD = {"status": str, "numbers": dict, "accuracy": str, "beds": int, "version": str, "date": str}


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
            _show(name, out, beds, progress)
            _write_page(every, out)
        _show_cargoes(out)
    return _write_page(every, out)


def _show(name: str, out: Path, beds: int, progress: Progress) -> None:
    """Run a preset, or what is left of its run, and write its poster, its clip and its numbers."""
    clip, path, folder = out / f"{_plain(name)}.mp4", out / f"{_plain(name)}.json", out / "runs" / name
    cheapest = _cheapest(name, names())
    batch = Batch(cheapest, {"run.repeats": max(beds, repeats_of_twin(cheapest))})
    wanted = asked({"": batch})
    if clip.exists() and path.exists():
        told = _told(path)
        if told.get("asked") == wanted:
            progress.say(f"{name}: kept, made by version {told['version']} on {told['date']}")
            return
        progress.say(
            f"{name}: what is there is of another preset, of other beds or of an earlier version; it is made anew …"
        )
        clip.unlink()  # else it would count as made where this is cut short
    else:
        progress.say(f"{name} …")
    carry_out(batch, folder, quiet=True, by="the gallery")
    with open_recording(folder) as recording:
        lasts, speed = float(recording.series["time"][-1]), recording.preset.video.speed
        made = _made(recording)
    painted = poster(folder, time=telling_time(folder), width=WIDTH, height=HEIGHT)
    lighten(painted, out / f"{_plain(name)}.webp", CARD)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    told = json.dumps({**_telling(summary), **made, "asked": wanted}, indent=1)
    write_text(path, told + "\n")
    render_recording(folder, clip, width=WIDTH, height=HEIGHT, speed=max(speed, ceil(10.0 * lasts / LONGEST) / 10.0))


def lighten(picture: Path, out: Path, size: tuple[int, int]) -> None:
    """Keep a PNG file as WebP of at most this size (pixels): a tenth of the bytes."""
    with Image.open(picture) as image:
        lean = image.convert("RGB")
    lean.thumbnail(size, Image.Resampling.LANCZOS)
    with replacing(out) as part:
        lean.save(part, "WEBP", quality=QUALITY, method=6)


def repeats_of_twin(name: str) -> int:
    """The repeats of a preset that differs from the one it is based on by these alone; of others 1."""
    one = load(name).resolved
    quick = name.endswith(QUICK)
    base = f"{one.based_on}{QUICK}" if quick else one.based_on
    if not one.based_on or base not in names():
        return 1
    other = load(base).resolved
    said = {"title", "source", "reports", "based_on", "quick", "run"}
    alike = all(getattr(one, key.name) == getattr(other, key.name) for key in fields(one) if key.name not in said)
    same_run = replace(one.run, repeats=1) == replace(other.run, repeats=1)
    return one.run.repeats if alike and same_run else 1


def _show_cargoes(out: Path) -> None:
    """One picture of the beds of all cargoes that have been run."""
    beds = {name: out / "runs" / "shapes" / name for name in COLOURS}
    run = {name: folder for name, folder in beds.items() if (folder / "recording.h5").exists()}
    if run:
        painted = paint_cargoes(run, out / "runs" / "cargoes.png")
        lighten(painted, out / CARGOES, WIDE)


def _cheapest(name: str, every: Mapping[str, str]) -> str:
    return name + QUICK if name + QUICK in every else name


def _plain(name: str) -> str:
    return name.replace("/", "-")


def _made(recording: Recording) -> dict[str, object]:
    """The accuracy, number of beds, version and date of a recording."""
    return {
        "accuracy": recording.preset.run.accuracy,
        "beds": recording.worlds,
        "version": recording.version,
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
    groups: dict[str, list[dict]] = {}
    for name, title in every.items():
        if not name.endswith(QUICK):
            groups.setdefault(name.split("/")[0], []).append(_card(name, title, _cheapest(name, every), out))
    wide = {"shapes": CARGOES} if (out / CARGOES).exists() else {}
    return render(out / "index.html", "gallery.html.j2", groups=groups, wide=wide)


def _card(name: str, title: str, cheapest: str, out: Path) -> dict[str, object]:
    """What the page shows of a preset: its files, its cheapest variant, and what is `told` of it, None if not run."""
    plain = _plain(name)
    path, clip = out / f"{plain}.json", (out / f"{plain}.mp4").exists()
    told = _told(path) if path.exists() else None
    return {"title": title, "cheapest": cheapest, "plain": plain, "clip": clip, "told": told}


def _told(path: Path) -> dict[str, object]:
    """Read what `_show` has kept of a preset. Raises LabError."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        if not all(isinstance(found[key], kind) for key, kind in TOLD.items()):
            raise ValueError("something is of another kind")
        if not all(isinstance(text, str) for text in found["numbers"].values()):
            raise ValueError("a number is no text")
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise LabError(f"{path} is damaged: remove it, and the clip beside it, and ask again.") from error
    return found
