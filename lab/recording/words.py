"""Texts for error messages about data that a recording does not have."""

from lab.recording.layout import OF_MATTERS, WAVES, frames_of, series_of
from solvers.machine.quantity import Quantity
from solvers.mixture import quantities as mixture

COUNTED = {  # what each axis counts, and the preset key that sets its size
    "world": "beds (run.repeats)",
    "part": "parts (parts.NAME)",
    "body": "floating bodies (parts.NAME.density)",
    "room": "rooms of hulls (parts.NAME.wall)",
    "opening": "openings of hulls (parts.NAME.openings.NAME)",
    "inlet": "openings of the ship (inflow.NAME)",
    "grain": "grains (grains.count)",
    "water_particle": "particles of water (water.spacing)",
    "air_particle": "particles of air (water.spacing)",
    "gauge": "gauges of pressure (gauges.NAME)",
    "level": "gauges of level (gauges.NAME)",
    "edge": "gauges of force (gauges.NAME)",
}

OF_CONTACTS = "normal_force", "force", "contact_force", "stress", "pressure", "coordination", "contact_place", "normal"


def recorded_by(name: object) -> str:
    """The end of a sentence on a missing quantity: what would record it."""
    if name in OF_CONTACTS:
        return "; `recording.contacts(frame)` finds it from the grains' places."
    if name == WAVES.name:
        return "; `cargolab view` records it, of a ship in waves."
    of_water = {quantity.name: quantity for quantity in (*OF_MATTERS["water"].SERIES, *OF_MATTERS["water"].FRAMES)}
    if name in _names((*OF_MATTERS["air"].SERIES, *OF_MATTERS["air"].FRAMES)):
        return "; a preset with a table [air] records it."
    if name in of_water:
        by_owner = {**dict.fromkeys(("gauge", "level", "edge"), "gauges.NAME"), "room": "parts.NAME.rooms.NAME"}
        table = (by_owner | {"opening": "parts.NAME.openings.NAME"}).get(of_water[name].per, "water")
        return f"; a preset with a table [{table}] records it."
    if name in _names(series_of(afloat=False)):
        return "; it is in the series (record.series_rate)."
    if name in _names(series_of(afloat=True)):
        return "; a preset with a table [ship] records it."
    if name in _names(series_of(afloat=False, axled=True)):
        return "; a preset with a table [axle] records it."
    if name in _names(series_of(afloat=False, floating=True)):
        return "; a preset with a part that floats (parts.NAME.density) records it."
    if name in _names(series_of(afloat=False, leaking=True)):
        return "; a preset with an opening to a room (inflow.NAME) records it."
    if name in _names(mixture.FRAMES):
        return "; a preset with grains and water in one tank records it."
    if name in _names(frames_of()):
        return "; it is in the frames (record.picture_rate)."
    return "; nothing records that."


def _names(quantities: tuple[Quantity, ...]) -> set[str]:
    return {quantity.name for quantity in quantities}


def axes(name: str, quantity: Quantity, shape: tuple[int, ...]) -> str:
    """The size of a quantity's data set in words, with the preset keys that set it."""
    rate = "record.series_rate" if name.startswith("series/") else "record.picture_rate"
    counted = COUNTED | {"time": f"times ({rate}, run.duration)"}
    words = (f"{size} {counted.get(axis, '')}".strip() for size, axis in zip(shape, quantity.axes, strict=True))
    return " × ".join(words)


def indexed(index: object) -> str:
    """An index of numbers and slices as it is written in Python."""

    def one(part: object) -> str:
        if not isinstance(part, slice):
            return str(part)
        ends = ["" if end is None else str(end) for end in (part.start, part.stop, part.step)]
        return ":".join(ends if ends[2] else ends[:2])

    return f"[{', '.join(map(one, index if isinstance(index, tuple) else (index,)))}]"
