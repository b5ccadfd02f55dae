"""Check that a scene fits into this machine's memory, before anything is allocated for it."""

from lab.base.errors import LabError
from lab.base.memory import SHARE, machine_memory
from lab.preset.schema import Preset

# Bytes per grain at the peak of a run, with its contacts and its share of the checkpoint and of the stored bed.
# Measured as the difference between 60 beds and one: 1.7 kB for discs, 7 kB for grains of rice that are not settled.
A_DISC, AN_OUTLINE = 2_000, 20_000
A_BED = 10  # fixed cost of a bed, as a number of grains


def check_room(preset: Preset, count: int) -> None:
    """Raise LabError if the beds of `count` grains do not fit into this machine's memory."""
    a_grain, beds = AN_OUTLINE if preset.shapes else A_DISC, preset.run.repeats
    room, a_bed = SHARE * machine_memory(), (count + A_BED) * a_grain
    if beds * a_bed <= room:
        return
    what = f"{beds} beds of {count} grains" if beds > 1 else f"{count} grains"
    needed = f"{what} take some {_size(beds * a_bed)} of memory, at {_size(a_grain)} a grain"
    bound = f"half of this machine's is {_size(room)}"
    if room < a_bed:
        raise LabError(f"{_count_key(preset)}: {needed}, and {bound}: take fewer grains.")
    raise LabError(f"run.repeats: {needed}, and {bound}: take at most {int(room // a_bed)} beds.")


def _count_key(preset: Preset) -> str:
    """The key that sets the number of grains."""
    grains = preset.grains
    if grains.listed:
        return "grains.bed"
    return "grains.depth" if grains.count is None else "grains.count"


def _size(size: float) -> str:
    """A number of bytes as text."""
    for unit in ("bytes", "kB", "MB", "GB", "TB"):
        if size < 1000.0 or unit == "TB":
            break
        size /= 1000.0
    return f"{size:.3g} {unit}"
