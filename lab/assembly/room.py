"""Check that a scene fits into this machine's memory, before anything is allocated for it."""

from dataclasses import dataclass

from lab.base.errors import LabError
from lab.base.memory import SHARE, machine_memory
from lab.preset.schema import Preset
from solvers.machine.quantity import PLANE, SPACE

# Bytes per grain at the peak of a run, with its contacts and its share of the checkpoint and of the stored bed.
# Measured as the difference between 60 beds and one: 1.7 kB for discs, 7 kB for grains of rice that are not settled.
A_DISC, AN_OUTLINE = 2_000, 20_000
A_DROP = {PLANE: 3_000, SPACE: 1_500}  # bytes per particle of water, at the peak (of space `lab.base.memory`)
A_BED = 10  # fixed cost of a bed, as a number of grains


@dataclass(frozen=True)
class Load:
    """So many particles in each world, and how they are called: the memory they take, and the key that sets them."""

    count: int
    each: int  # bytes
    key: str
    noun: str
    world: str
    remedy: str

    def many(self, worlds: int) -> str:
        """All of them in words."""
        nouns = self.noun.replace(" ", "s ", 1) if " " in self.noun else f"{self.noun}s"
        return f"{worlds} {self.world}s of {self.count} {nouns}" if worlds > 1 else f"{self.count} {nouns}"


def check_room(preset: Preset, grains: int, drops: int = 0) -> None:
    """Raise LabError if worlds of so many `grains`, or of `drops` of water, do not fit into this machine's memory."""
    load = Load(
        grains, AN_OUTLINE if preset.shapes else A_DISC, _count_key(preset), "grain", "bed", "take fewer grains"
    )
    if drops:
        load = Load(drops, A_DROP[preset.axes], "water.spacing", "particle of water", "tank", "take larger ones")
    worlds, room, a_world = preset.run.repeats, SHARE * machine_memory(), (load.count + A_BED) * load.each
    if worlds * a_world <= room:
        return
    one = load.noun.partition(" ")[0]
    needed = f"{load.many(worlds)} take some {_size(worlds * a_world)} of memory, at {_size(load.each)} a {one}"
    bound = f"half of this machine's is {_size(room)}"
    if room < a_world:
        raise LabError(f"{load.key}: {needed}, and {bound}: {load.remedy}.")
    raise LabError(f"run.repeats: {needed}, and {bound}: take at most {int(room // a_world)} {load.world}s.")


def _count_key(preset: Preset) -> str:
    """The key that sets the number of grains."""
    grains = preset.grains
    if grains is None or not grains.listed:
        return "grains.depth" if grains is None or grains.count is None else "grains.count"
    return "grains.bed"


def _size(size: float) -> str:
    """A number of bytes as text."""
    for unit in ("bytes", "kB", "MB", "GB", "TB"):
        if size < 1000.0 or unit == "TB":
            break
        size /= 1000.0
    return f"{size:.3g} {unit}"
