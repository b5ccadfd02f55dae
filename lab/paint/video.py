"""Paint a recording as a video, a folder of pictures, or a poster."""

import json
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from lab import __version__
from lab.base.errors import LabError
from lab.base.files import replacing
from lab.base.turn import in_turn
from lab.paint.decorations import number
from lab.paint.edit.animation import FORMATS, stride_of, write_animation
from lab.paint.edit.event import find_event, half_poured, telling_moments
from lab.paint.edit.timeline import RATE, hero_timeline
from lab.paint.encoder import says, write_video
from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import Bed, open_footage
from lab.recording import open_recording
from solvers.machine.runtime import initialise

MOST_IN_GRID, MOMENTS = 24, 6  # beds of a grid; moments of a contact sheet
HERO = 1920, 1080  # pixels
AFTER, LATE = 0.15, 0.85  # s after an event, and the share of a film without one, of the moment that tells most
SLOWEST, FASTEST = 0.01, 60.0  # pictures per second of a video
USUAL = 0.04  # s between pictures if the frames' times do not define it
HELD = 3.0  # s for which the last picture is held if a ship is lost

Progress = Callable[[int, int], None]


@in_turn
def render_recording(
    path: Path | str,
    out: Path | str | None = None,
    *,
    colour: str | None = None,
    frame: str | None = None,
    width: int | None = None,
    height: int | None = None,
    speed: float | None = None,
    world: int | None = None,
    png: bool = False,
    sound: bool = False,
    hero: bool = False,
    piece: tuple[int, int] = (0, 1),
    progress: Progress | None = None,
    **style: str | None,
) -> Path:
    """Paint a recording (its file or its run's folder); returns the path of the video or folder.

    out: an .mp4, .gif or .webp file (default: video.mp4 beside the recording), or with png a folder for PNG files
    (default: pictures). hero: 60 pictures a second, 1920 x 1080 where no size is given, in slow motion at the event,
    with the result on the last still. style: theme, cargo, overlay and inset of [video]. Options that are None are
    taken from the preset's [video]. world: one bed, counted from 0; None: up to six side by side. sound: only the rows
    before the first damaged one. piece (k, n): only the k-th, from 0, of n even parts of the pictures, which
    `lab.paint.edit.batches` joins. progress(done, total) is called after each picture. Raises LabError.
    """
    initialise(fields=False)
    wishes = {"colour": colour, "frame": frame, "width": width, "height": height, "speed": speed, **style}
    comment = made_with(**wishes, world=world, sound=sound, hero=hero)
    if hero:
        wishes |= {"width": width or HERO[0], "height": height or HERO[1]}
    with open_footage(path, sound) as footage:
        beds, look = choose_beds(footage, world), choose_look(footage, **wishes)
        timeline = hero_timeline(beds[0], look.speed) if hero else None
        film = Film(beds, look, timeline=timeline)
        return _write(_made(target_of(path, out, png)), film, look.speed, png, progress, comment, piece)


def target_of(path: Path | str, out: Path | str | None, png: bool) -> Path:
    """The video, or with png the folder, that `render_recording` writes."""
    return _target(path, out, "pictures" if png else "video.mp4")


def made_with(**wishes: object) -> str:
    """The text that a video or its last picture keeps of what it was made with; wishes: of `render_recording`."""
    asked = {name: wish for name, wish in sorted(wishes.items()) if wish is not None and wish is not False}
    return f"cargolab {__version__} {json.dumps(asked)}"


def is_made(target: Path, recording: Path, png: bool, comment: str) -> bool:
    """Whether a video, or a folder of pictures, is whole, no older than the recording and made with this comment."""
    try:
        if not png:
            newer = target.stat().st_mtime_ns >= recording.stat().st_mtime_ns
            return newer and says(target, comment)
        last = max(target.glob("picture_*.png"), default=None)
        if last is None or last.stat().st_mtime_ns < recording.stat().st_mtime_ns:
            return False
        with Image.open(last) as picture:
            return picture.info.get("Comment") == comment
    except (OSError, ValueError, SyntaxError):  # Pillow's, for a file that is damaged
        return False


@in_turn
def render_grid(
    beds: Sequence[Path | str | tuple[Path | str, int]],
    captions: Sequence[str],
    out: Path | str,
    *,
    title: str | None = None,
    colour: str | None = None,
    frame: str | None = None,
    width: int | None = None,
    height: int | None = None,
    speed: float | None = None,
    frozen: bool = False,
    progress: Progress | None = None,
    **style: str | None,
) -> Path:
    """Paint up to 24 beds of one or several recordings in one grid, such as the points of a sweep; returns `out`.

    beds: recordings (file or folder), or pairs of a recording and one of its worlds (else its first); captions: one
    each; out: an .mp4, .gif or .webp file, or a .png file for the last picture alone. All are drawn to one scale, at
    the same times and with one colour scale; a recording that ends sooner keeps its last frame. frozen: after each ship
    the same one with her cargo frozen. Title and options that are None are taken from the first recording. Raises
    LabError.
    """
    if not 1 <= len(beds) <= MOST_IN_GRID:
        raise LabError(f"A grid has room for 1 to {MOST_IN_GRID} beds (got {len(beds)}): choose some of them.")
    chosen = [bed if isinstance(bed, tuple) else (bed, 0) for bed in beds]
    initialise(fields=False)
    with ExitStack() as opened:
        footages = {
            path: opened.enter_context(open_footage(path)) for path in dict.fromkeys(path for path, _ in chosen)
        }
        shown = []
        for (path, world), caption in zip(chosen, captions, strict=True):
            (bed,) = choose_beds(footages[path], world)
            shown.append(replace(bed, name=caption))
            if frozen:
                shown += _frozen_twin(shown, path)
        first = shown[0].footage
        look = choose_look(first, colour=colour, frame=frame, width=width, height=height, speed=speed, **style)
        film = Film(shown, look, title, MOST_IN_GRID)
        out = _made(Path(out))
        if out.suffix == ".png":
            _save(film.picture(len(film.time) - 1), out)
            return out
        return _write(out, film, look.speed, False, progress)


def _frozen_twin(shown: list[Bed], path: Path | str) -> list[Bed]:
    """The last of the beds that are shown with its cargo frozen, which gives both their names."""
    from lab.paint.edit.frozen import frozen_bed

    loose = shown[-1]
    named = f"{loose.name}, " if loose.name else ""
    shown[-1] = replace(loose, name=f"{named}loose")
    with open_recording(path) as recording:
        return [frozen_bed(loose, recording, f"{named}frozen")]


@in_turn
def poster(
    path: Path | str,
    out: Path | str | None = None,
    *,
    time: float | None = None,
    fraction: float = 1.0,
    colour: str | None = None,
    frame: str | None = None,
    width: int | None = None,
    height: int | None = None,
    world: int | None = None,
    **style: str | None,
) -> Path:
    """Paint one picture of a recording as a PNG file (default: poster.png beside it).

    It shows the frame nearest to `time` (s), or to this fraction of the duration. Raises LabError.
    """
    initialise(fields=False)
    with open_footage(path) as footage:
        beds = choose_beds(footage, world)
        look = choose_look(footage, colour=colour, frame=frame, width=width, height=height, **style)
        if time is None:
            time = footage.time[0] + fraction * (footage.time[-1] - footage.time[0])
        nearest = int(np.abs(footage.time - time).argmin())
        out = _made(_target(path, out, "poster.png"))
        if out.suffix != ".png":
            raise LabError(f"{out} cannot be written: a poster is a .png file.")
        _save(Film(beds, look).picture(nearest), out)
        return out


def telling_time(path: Path | str, world: int | None = None) -> float:
    """When one picture of a bed tells most (s): just after its event, as half the grains have poured, else late."""
    with open_footage(path) as footage:
        (bed,) = choose_beds(footage, world or 0)
        event, first, last = find_event(bed), footage.time[0], footage.time[-1]
        if event is None and (poured := half_poured(bed)) is not None:
            return poured
        return float(min(event.time + AFTER, last) if event else first + LATE * (last - first))


@in_turn
def contact_sheet(
    path: Path | str, out: Path | str | None = None, *, world: int | None = None, count: int = MOMENTS, **wishes: object
) -> Path:
    """Paint telling moments of one bed, and its whole curve, into a PNG file (default: sheet.png beside the recording).

    wishes: fields of a `Look`. The moments are closer together where the contents move faster. Raises LabError.
    """
    initialise(fields=False)
    with open_footage(path) as footage:
        (bed,) = choose_beds(footage, world or 0)
        look = choose_look(footage, **wishes)
        times = telling_moments(bed, count)
        beds = [replace(bed, name=f"{number(time, 2)} s") for time in times]
        out = _made(_target(path, out, "sheet.png"))
        _save(Film(beds, look, most=count, moments=times).picture(0), out)
        return out


def playback(time: np.ndarray, speed: float) -> tuple[float, int]:
    """The video's rate (pictures per second), and k if only every k-th frame is shown; time (F,) in s."""
    interval = float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    with np.errstate(over="ignore"):  # extreme times and speeds
        wanted = float(np.float64(speed) / interval) if 0.0 < interval < math.inf else speed / USUAL
    wanted = min(max(wanted, SLOWEST), FASTEST * len(time))
    stride = max(1, math.ceil(wanted / FASTEST - 1e-9))
    return round(wanted / stride, 3), stride


def _write(
    out: Path,
    film: Film,
    speed: float,
    png: bool,
    progress: Progress | None,
    comment: str = "",
    piece: tuple[int, int] = (0, 1),
) -> Path:
    rate, stride = (RATE, 1) if film.held else playback(film.time, speed)
    less = 1 if png or out.suffix not in FORMATS else stride_of(out.suffix, rate)
    shown, last = range(0, len(film.time), stride * less), piece[0] == piece[1] - 1
    shown = shown[len(shown) * piece[0] // piece[1] : len(shown) * (piece[0] + 1) // piece[1]]
    pictures = _counted(film, shown, progress)
    if png:
        return _write_folder(out, pictures, len(shown), comment if last else "")
    still = round(HELD * rate / less) if film.lost and not film.held and last else 0
    if out.suffix in FORMATS:
        return write_animation(out, _held(pictures, still), rate / less)
    return write_video(out, _held(pictures, still), rate, comment)


def _held(pictures: Iterator[np.ndarray], times: int) -> Iterator[np.ndarray]:
    """The pictures, then the last one repeated `times` times."""
    for picture in pictures:
        yield picture
    for _ in range(times):
        yield picture


def _counted(film: Film, shown: range, progress: Progress | None) -> Iterator[np.ndarray]:
    for done, frame in enumerate(shown, start=1):
        yield film.picture(frame)
        if progress:
            progress(done, len(shown))


def _target(path: Path | str, out: Path | str | None, name: str) -> Path:
    """The file to write to."""
    path = Path(path)
    beside = (path if path.is_dir() else path.parent) / name
    return beside if out is None else Path(out)


def _made(out: Path) -> Path:
    out.parent.mkdir(parents=True, exist_ok=True)
    return out


def _save(picture: np.ndarray, out: Path) -> None:
    """Write one picture, whole or not at all."""
    with replacing(out) as part:
        Image.fromarray(picture).save(part)


def _write_folder(folder: Path, pictures: Iterator[np.ndarray], count: int, comment: str) -> Path:
    """Write `count` pictures into a folder; the last one keeps a comment, so it tells that all are there."""
    folder.mkdir(exist_ok=True)
    for old in folder.glob("picture_*.png"):
        old.unlink()
    kept = PngInfo()
    kept.add_text("Comment", comment)
    for k, picture in enumerate(pictures):
        image, last = Image.fromarray(picture), k == count - 1
        with replacing(folder / f"picture_{k:05d}.png") as part:
            image.save(part, "PNG", pnginfo=kept if last and comment else None)
    return folder
