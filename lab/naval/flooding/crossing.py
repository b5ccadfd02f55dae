"""`cargolab cross-flooding`: what it is asked, and what it answers."""

from dataclasses import dataclass

from lab.base.errors import LabError
from solvers.ship.flooding.crossing import (
    LONGEST,
    OUTLET,
    Device,
    girders,
    in_series,
    side_by_side,
    time_by_steps,
    time_needed,
)


@dataclass(frozen=True)
class Asked:
    """Volume (m³), heads (m) at the beginning and the end, devices (m², Σk, share of the volume) one behind the other.

    `girders`: area (m²), distance (m), spaces, manholes; `beside`: area (m²) and Σk of a duct beside them; `heel`: the
    volume (m³) and head (m) that are left from a heel on the way.
    """

    volume: float
    head: float
    last: float = 0.0
    device: tuple[tuple[float, float, float], ...] = ()
    girders: tuple[float, float, int, int] | None = None
    beside: tuple[tuple[float, float], ...] = ()
    heel: tuple[float, float] | None = None
    gravity: float = 9.81


def told(asked: Asked) -> tuple[list[str], dict[str, object]]:
    """Lines of text, and the numbers by name. Raises LabError."""
    if not asked.last < asked.head:
        raise LabError(f"--last: the head at the end must be below the {asked.head:g} m of the beginning; give less.")
    devices = [Device(*one) for one in asked.device]
    if asked.girders is not None:
        area, length, count, manholes = asked.girders
        devices.append(Device(area, count * girders(length, manholes) + OUTLET))
    if not devices:
        raise LabError("--device: nothing lets the water over; give a device, or --girders.")
    row = in_series(devices)
    effective = side_by_side([row, *(Device(*one) for one in asked.beside)])
    seconds = time_needed(asked.volume, effective, asked.head, asked.last, asked.gravity)
    stepped = time_by_steps(asked.volume, effective, asked.head, asked.last, asked.gravity)
    found = {"k": row.friction, "f": row.factor, "sf": effective, "time": seconds, "time_by_integration": stepped}
    limit = "within" if seconds <= LONGEST else "beyond"
    lines = [
        f"  sum of k      {row.friction:.4f} of {row.area:.4g} m2: F = {row.factor:.4f}",
        f"  S F           {effective:.5g} m2",
        f"  time          {seconds:.2f} s; by integration {stepped:.2f} s; {limit} the 10 min of SOLAS II-1/7-2",
    ]
    if asked.heel is not None:
        left = _left(asked, effective)
        found["time_left"] = left
        lines.append(f"  from the heel {left:.2f} s are left, {seconds - left:.2f} s have passed")
    return lines, found


def _left(asked: Asked, effective: float) -> float:
    volume, head = asked.heel
    if volume > asked.volume or not asked.last < head <= asked.head:
        raise LabError("--heel: what is left must be less than at the beginning; give a smaller volume and head.")
    return time_needed(volume, effective, head, asked.last, asked.gravity)
