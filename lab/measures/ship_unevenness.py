"""How uneven the surface of a ship's cargo lies, as the IMSBC Code asks of dry cargoes that do not cohere (section 5).

The hold is cut into columns two mean diameters wide, in space over all its length; the top of the highest grain in
each is a level of the surface, and the mean of three neighbouring levels evens out single grains. Unevenness Δh is the
difference between the highest and the lowest of these means, square to the deck, wherever there is cargo; at the full
scale if the preset has one.

unevenness: as the cargo settled, before the ship moves. final_unevenness: in the last picture; largest_unevenness: in
any picture, which thrown grains can raise. A level is uncertain by half a mean diameter, which the note tells.
"""

import numpy as np

from lab.measures.ship import has_ship
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

OF = "grains"
COLUMN = 2.0  # mean diameters
NEIGHBOURS = 3  # columns whose mean is a level
MOST_FRAMES = 200  # looked at


def applies(recording: Recording) -> bool:
    """There is a ship with grains, and a picture of them."""
    return has_ship(recording) and len(recording.frames["time"]) > 0


def measure(recording: Recording) -> dict[str, Value]:
    """unevenness, final_unevenness and largest_unevenness (m)."""
    count = len(recording.frames["time"])
    frames = np.unique(np.linspace(0, count - 1, min(count, MOST_FRAMES)).astype(int))
    scale = recording.preset.ship.scale or 1.0
    found = np.array([_in_picture(recording, int(frame)) for frame in frames]) * scale
    note = f"to half a mean diameter, {recording.radius.mean() * scale:.2g} m"
    named = {"unevenness": found[0], "final_unevenness": found[-1], "largest_unevenness": found.max(axis=0)}
    return {name: over_worlds(values, "m", note=note, missing="too little cargo") for name, values in named.items()}


def _in_picture(recording: Recording, frame: int) -> list[float]:
    position = recording.frames["position"][frame].astype(float)
    worlds = zip(position, recording.radius, strict=True)
    return [unevenness(place, radius, recording.outline) for place, radius in worlds]


def unevenness(position: np.ndarray, radius: np.ndarray, outline: np.ndarray) -> float:
    """Δh (m) of grains at position (n, 2), m, in the hold's axes; not a number for less than three columns of them."""
    (left, floor), (right, _) = outline.min(axis=0), outline.max(axis=0)
    held = (position[:, 0] > left) & (position[:, 0] < right) & (position[:, 1] > floor)
    position, radius = position[held], radius[held]
    column = ((position[:, 0] - left) / (COLUMN * 2.0 * radius.mean())).astype(int) if held.any() else np.zeros(0, int)
    top = np.full(column.max(initial=-1) + 1, -np.inf)
    np.maximum.at(top, column, position[:, 1] + radius)
    levels = top[np.isfinite(top)]
    if len(levels) < NEIGHBOURS:
        return np.nan
    return float(np.ptp(np.convolve(levels, np.full(NEIGHBOURS, 1.0 / NEIGHBOURS), mode="valid")))
