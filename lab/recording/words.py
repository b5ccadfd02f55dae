"""What a recording holds, in the words of errors about what it does not."""

from lab.recording.layout import GRAIN_FRAMES, SERIES, SHIP_SERIES


def recorded_by(name: object) -> str:
    """The rest of a sentence on what is not there: the key that would have it recorded, if one does."""
    if name in SHIP_SERIES:
        return "; a preset with a table [ship] records it."
    if name == "waves":
        return "; `cargolab view` records it, of a ship in waves."
    if name in SERIES:
        return "; it is in the series (record.series_rate)."
    if name in GRAIN_FRAMES:
        return "; it is in the frames (record.picture_rate)."
    return "; nothing records that."


def axes(name: str, shape: tuple[int, ...]) -> str:
    """The size of a data set in words, with the keys that make it so."""
    table, _, column = name.rpartition("/")
    rate = "record.series_rate" if table == "series" else "record.picture_rate"
    words = [f"{shape[0]} times ({rate}, run.duration)"]
    if len(shape) > 1 and column != "waves":
        words.append(f"{shape[1]} beds (run.repeats)")
    if len(shape) > 2 and table == "frames":
        words.append(f"{shape[2]} parts (parts.NAME)" if column == "part" else f"{shape[2]} grains (grains.count)")
        words = words[:2] if column == "pose" else words
    rest = shape[len(words) :]
    return " × ".join([*words, *map(str, rest)])


def indexed(index: object) -> str:
    """An index as people write it, from numbers and slices."""

    def one(part: object) -> str:
        if not isinstance(part, slice):
            return str(part)
        ends = ["" if end is None else str(end) for end in (part.start, part.stop, part.step)]
        return ":".join(ends if ends[2] else ends[:2])

    return f"[{', '.join(map(one, index if isinstance(index, tuple) else (index,)))}]"
