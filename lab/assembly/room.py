"""How many grains there is room for in this machine's memory, before anything is made of them."""

from lab.base.errors import LabError
from lab.base.memory import SHARE, machine_memory
from lab.preset.schema import Resolved

# Bytes that a grain takes at the peak of a run, with its contacts, its share of the checkpoint and of the settled bed
# that is stored: 1.7 kB of discs and 7 kB of grains of rice not settled, measured as what 60 beds take more than one.
A_DISC, AN_OUTLINE = 2_000, 20_000
A_BED = 10  # grains: what a bed takes by itself, as these would


def check_room(preset: Resolved, count: int) -> None:
    """Raise LabError where the beds of `count` grains do not fit into this machine's memory."""
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


def _count_key(preset: Resolved) -> str:
    """The key that says how many grains there are."""
    grains = preset.grains
    if grains.listed:
        return "grains.bed"
    return "grains.depth" if grains.count is None else "grains.count"


def _size(size: float) -> str:
    """Bytes as people read them."""
    for unit in ("bytes", "kB", "MB", "GB", "TB"):
        if size < 1000.0 or unit == "TB":
            break
        size /= 1000.0
    return f"{size:.3g} {unit}"
