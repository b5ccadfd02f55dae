"""Check that a scene fits into this machine's memory, before anything is allocated for it."""

from lab.base.errors import LabError
from lab.base.memory import SHARE, machine_memory
from lab.preset.schema import Preset

# Bytes per grain at the peak of a run, with its contacts and its share of the checkpoint and of the stored bed.
# Measured as the difference between 60 beds and one: 1.7 kB for discs, 7 kB for grains of rice that are not settled.
A_DISC, AN_OUTLINE = 2_000, 20_000
A_DROP = 3_000  # bytes per particle of water
A_BED = 10  # fixed cost of a bed, as a number of grains


def check_room(preset: Preset, grains: int, drops: int = 0) -> None:
    """Raise LabError if beds of so many `grains`, or of `drops` of water, do not fit into this machine's memory."""
    count, what, each = grains, "grains", AN_OUTLINE if preset.shapes else A_DISC
    if drops:
        count, what, each = drops, "particles of water", A_DROP
    beds, room, a_bed = preset.run.repeats, SHARE * machine_memory(), (count + A_BED) * each
    if beds * a_bed <= room:
        return
    many = f"{beds} {'tanks' if drops else 'beds'} of {count} {what}" if beds > 1 else f"{count} {what}"
    one = "particle" if drops else "grain"
    needed = f"{many} take some {_size(beds * a_bed)} of memory, at {_size(each)} a {one}"
    bound = f"half of this machine's is {_size(room)}"
    if room < a_bed:
        remedy = "take larger ones" if drops else "take fewer grains"
        raise LabError(f"{_count_key(preset)}: {needed}, and {bound}: {remedy}.")
    raise LabError(
        f"run.repeats: {needed}, and {bound}: take at most {int(room // a_bed)} {'tanks' if drops else 'beds'}."
    )


def _count_key(preset: Preset) -> str:
    """The key that sets the number of grains, or of particles of water."""
    grains = preset.grains
    if grains is None:
        return "water.spacing"
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
