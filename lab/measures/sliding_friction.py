"""The friction of a level plate that moves along under a bed, as a shear cell measures the friction of a wall.

sliding_friction: the work of the bed against the plate over the load across it, ∫ F·dy / ∫ N |dy|, over the last
quarter of the plate's way. At first the bed does not slide: it shears in itself until what holds it pushes back as hard
as the plate drags. F and N are the forces of the bed on the plate along and across it, dy is the plate's way in the
tank; so a plate that goes to and fro is measured, too. sliding_friction_PART where several plates move so. Grains that
keep their places slide at their coefficient of friction, those that roll at less. How to use it as
`bulk.wall_friction`: `docs/physics/bulk-numbers.md`.
Error: standard error of the means of blocks of equal ways.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, Sheet, band
from lab.measures.steady import BLOCKS
from lab.measures.value import Value, over_worlds
from lab.preset.sections.parts import Part
from lab.recording import Recording

OF = "grains"
LAST = 0.25  # of the way
LEVEL = 1e-6  # of its length: a plate whose ends differ more in height slopes
LEAST = 1.0  # mean diameters of way
LEAST_SAMPLES = 2 * BLOCKS
MISSING, STOOD = "the plate bore no load", "the plate hardly moved"


def applies(recording: Recording) -> bool:
    """A level plate moves along itself, for some time, and its load was recorded."""
    long = len(recording.series["time"]) > LEAST_SAMPLES and len(recording.frames["time"]) > 0
    return long and "part_load" in recording.series and bool(plates(recording))


def plates(recording: Recording) -> dict[str, np.ndarray]:
    """The places (T,) m along y of the level plates that slide, by their names, at the times of the series."""
    time, of_frames, found = recording.series["time"], recording.frames["time"][:], {}
    for number, (name, line) in enumerate(recording.parts.items()):
        part = recording.preset.parts[name]
        if not part.closed and np.ptp(line[:, 1]) <= LEVEL * np.ptp(line[:, 0]) and _slides(part):
            place = recording.frames["part"][:][:, 0, number, 0].astype(float)
            found[name] = np.interp(time, of_frames, place)
    return found


def _slides(part: Part) -> bool:
    """Whether a part goes sideways, and no other way."""
    moves = set(part.moves)
    return (part.move[0] != 0.0 or bool(moves)) and part.move[1] == 0.0 and moves <= {"sway"}


def measure(recording: Recording) -> dict[str, Value]:
    """sliding_friction of each plate, a pure number."""
    found = {name: _friction(recording, name, place) for name, place in plates(recording).items()}
    return {f"sliding_friction_{name}" if len(found) > 1 else "sliding_friction": one for name, one in found.items()}


def _friction(recording: Recording, name: str, place: np.ndarray) -> Value:
    """Work over load times way, of all of the last part and of its blocks."""
    along, across, _ = _loads(recording, name)
    step = np.diff(place)[:, None]  # a sample of the series is the mean since the one before
    gone = np.cumsum(np.abs(step))
    if not gone[-1] > LEAST * recording.mean_diameter.mean():
        return over_worlds(np.full(along.shape[1], np.nan), "1", missing=STOOD)
    work, load = along[1:] * step, across[1:] * np.abs(step)
    share = (gone - (1.0 - LAST) * gone[-1]) / (LAST * gone[-1])
    block = np.clip((share * BLOCKS).astype(int), 0, BLOCKS - 1)
    kept = share > 0.0
    each = [_ratio(work[kept & (block == k)], load[kept & (block == k)]) for k in range(BLOCKS)]
    errors = np.std(each, axis=0, ddof=1) / np.sqrt(BLOCKS)
    note = f"of the last {LAST * gone[-1]:.3g} m of {gone[-1]:.3g}"
    value = _ratio(work[kept], load[kept])
    return over_worlds(value, "1", uncertainties=errors, kind="averaging", note=note, missing=MISSING)


def _ratio(work: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Work (k, W) over load times way (k, W), of each world; not a number without load."""
    total = load.sum(axis=0)
    return np.where(total > 0.0, -work.sum(axis=0) / np.where(total > 0.0, total, 1.0), np.nan)


def _loads(recording: Recording, name: str) -> tuple[np.ndarray, np.ndarray, int]:
    """The forces (T, W) N of the bed on a plate, along y and downwards, and the number of the plate."""
    number = list(recording.parts).index(name)
    force = recording.series["part_load"][:, :, number]
    return force[..., 0], -force[..., 1], number


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The force along each plate over that across it, against its way; upright line: from where on it counts."""
    moved = plates(recording)
    rows = sheet.panels(heights=(1,) * len(moved))[:, 0]
    for axes, (name, place) in zip(rows, moved.items(), strict=True):
        along, across, _ = _loads(recording, name)
        gone = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(place)))])
        way = np.sign(np.gradient(place))[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            band(axes, gone, np.where(across > 0.0, -way * along / across, np.nan), BLUE, f"along over across {name}")
        axes.axhline(recording.preset.wall_material.friction, color=GREY, ls="--", lw=1.0, label="coefficient")
        axes.axvline((1.0 - LAST) * gone[-1], color=GREY, ls=":", lw=1.0)
        axes.set_ylabel("friction")
    rows[-1].set_xlabel("way of the plate (m)")


FIGURES = {"sliding-friction": draw}
