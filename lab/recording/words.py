"""What a recording holds, in the words of errors about what it does not."""

from lab.recording.layout import WAVES, frames_of, series_of
from solvers.machine.quantity import Quantity

SAID = {  # of an axis: what it counts, and the key that makes it so
    "world": "beds (run.repeats)",
    "part": "parts (parts.NAME)",
    "grain": "grains (grains.count)",
}


def recorded_by(name: object) -> str:
    """The rest of a sentence on what is not there: the key that would have it recorded, if one does."""
    if name == WAVES.name:
        return "; `cargolab view` records it, of a ship in waves."
    if name in _names(series_of(afloat=False)):
        return "; it is in the series (record.series_rate)."
    if name in _names(series_of(afloat=True)):
        return "; a preset with a table [ship] records it."
    if name in _names(frames_of()):
        return "; it is in the frames (record.picture_rate)."
    return "; nothing records that."


def _names(quantities: tuple[Quantity, ...]) -> set[str]:
    return {quantity.name for quantity in quantities}


def axes(name: str, quantity: Quantity, shape: tuple[int, ...]) -> str:
    """The size of a data set of a quantity in words, with the keys that make it so."""
    rate = "record.series_rate" if name.startswith("series/") else "record.picture_rate"
    said = SAID | {"time": f"times ({rate}, run.duration)"}
    words = (f"{size} {said.get(axis, '')}".strip() for size, axis in zip(shape, quantity.axes, strict=True))
    return " × ".join(words)


def indexed(index: object) -> str:
    """An index as people write it, from numbers and slices."""

    def one(part: object) -> str:
        if not isinstance(part, slice):
            return str(part)
        ends = ["" if end is None else str(end) for end in (part.start, part.stop, part.step)]
        return ":".join(ends if ends[2] else ends[:2])

    return f"[{', '.join(map(one, index if isinstance(index, tuple) else (index,)))}]"
