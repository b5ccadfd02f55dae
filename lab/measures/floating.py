"""How bodies that float lie, and how much water is in the rooms of hulls.

heel_NAME: how far a body has turned at the end (deg, positive from y to z: its side towards +y goes up); its note says
the largest heel of the run, and when. heave_NAME: by how much its centre of mass is higher than as drawn (mm).
room_water_NAME: the water in a room at the end (kg). Error: none of their own.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, band
from lab.measures.gauges import MOST_DRAWN
from lab.measures.value import Value, over_worlds
from lab.preset.units import show
from lab.recording import Recording

OF = "water"
COLOURS = BLUE, VERMILION, GREEN, GREY
UP, TURN = 1, 2  # of a place


def applies(recording: Recording) -> bool:
    """There are bodies that float, or rooms."""
    return bool(recording.names["body"] or recording.names["room"])


def measure(recording: Recording) -> dict[str, Value]:
    """heel_NAME (deg) and heave_NAME (mm) of each body, room_water_NAME (kg) of each room."""
    series, found = recording.series, {}
    for k, name in enumerate(recording.names["body"]):
        heel = np.degrees(series["body_place"][..., k, TURN])
        found[_key("heel", name)] = over_worlds(heel[-1], "deg", note=_largest(series["time"], heel))
        found[_key("heave", name)] = over_worlds(1e3 * _raised(recording, k)[-1], "mm")
    for k, name in enumerate(recording.names["room"]):
        found[_key("room_water", name)] = over_worlds(series["room_water"][-1, :, k], "kg")
    return found


def _key(prefix: str, name: str) -> str:
    """The name of a number of one body or room."""
    return f"{prefix}_{name}".replace("-", "_").replace(".", "_")


def _largest(time: np.ndarray, heel: np.ndarray) -> str:
    """The largest heel (T, W) of all worlds in words."""
    when, world = np.unravel_index(np.argmax(np.abs(heel)), heel.shape)
    return f"largest {heel[when, world]:.3g} deg at {show(float(time[when]), 's')}"


def _raised(recording: Recording, body: int) -> np.ndarray:
    """By how much the centre of a body is higher than at the start (T, W), m."""
    height = recording.series["body_place"][..., body, UP]
    return height - height[:1]


def draw(sheet: Sheet, recording: Recording, _values: Mapping[str, Value]) -> None:
    """Heel and heave of the first bodies, and the water in the first rooms, against time."""
    time, series = recording.series["time"], recording.series
    bodies, rooms = recording.names["body"][:MOST_DRAWN], recording.names["room"][:MOST_DRAWN]
    rooms = rooms if rooms and series["room_water"].any() else []
    panels = list(sheet.panels(heights=(1,) * (2 * bool(bodies) + bool(rooms)))[:, 0])
    last = panels[-1]
    if bodies:
        heel, heave = panels.pop(0), panels.pop(0)
        for k, (name, colour) in enumerate(zip(bodies, COLOURS, strict=False)):
            band(heel, time, np.degrees(series["body_place"][..., k, TURN]), colour, name if len(bodies) > 1 else None)
            band(heave, time, 1e3 * _raised(recording, k), colour)
        heel.set_ylabel("heel (deg)")
        heave.set_ylabel("heave (mm)")
    if rooms:
        for k, (name, colour) in enumerate(zip(rooms, COLOURS, strict=False)):
            band(panels[0], time, series["room_water"][..., k], colour, name)
        panels[0].set_ylabel("water in rooms (kg)")
    last.set_xlabel("time (s)")
    last.set_xlim(time[0], time[-1])


FIGURES = {"floating": draw}
