"""When each picture of a film is: at an even pace, slower around the event, and at rest at the end."""

import math

import numpy as np

from lab.paint.edit.event import find_event
from lab.paint.film import Timeline
from lab.paint.footage import Bed

RATE = 60.0  # pictures a second
SLOWER = 5.0  # times slower than the rest of the film
LASTS = 3.0  # s of film in slow motion
BEFORE = 0.6  # of the slow motion that is before the event
RAMP = 0.25  # of the slow motion's length, in which the pace changes at either end
HELD = 3.0  # s for which the last picture stays
LONGEST = 36_000  # pictures


def hero_timeline(bed: Bed, speed: float, rate: float = RATE) -> Timeline:
    """The timeline of a bed's film at a playback speed: slow motion at its event, the verdict on the last still."""
    first, last = float(bed.footage.time[0]), float(bed.footage.time[-1])
    event = find_event(bed)
    length = LASTS * speed / SLOWER
    begin = end = math.inf
    if event and last - first > 2.0 * length:
        begin = min(max(event.time - BEFORE * length, first), last - length)
        end = begin + length
    times, notes = [], []
    now = first
    while now < last and len(times) < LONGEST:
        slow = _slowness(now, begin, end, RAMP * length)
        pace = speed / (1.0 + (SLOWER - 1.0) * slow)
        times.append(now)
        notes.append(_note(pace, speed, slow))
        now += pace / rate
    held = round(HELD * rate)
    times += [last] * (1 + held)
    notes += [""] * (1 + held)
    return Timeline(np.array(times), notes, event.says if event else "", held)


def _slowness(now: float, begin: float, end: float, ramp: float) -> float:
    """0 far from the slow part, 1 in it, and smooth between."""
    if not math.isfinite(begin):
        return 0.0
    away = max(begin - now, now - end, 0.0) / max(ramp, 1e-12)
    share = min(away, 1.0)
    return 1.0 - share * share * (3.0 - 2.0 * share)


def _note(pace: float, speed: float, slow: float) -> str:
    if slow > 0.5:
        return f"slow motion: {pace:.2g} of real time"
    return "" if speed == 1.0 else f"{speed:g} × real time"
