"""What is told of a live experiment in words: lines at the top of the column, and what its overlay means."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lab.paint.decorations import number
from lab.ship import axis_motion
from lab.view.forces import newtons, on_grain

if TYPE_CHECKING:
    from lab.view.session import Session


def clock(session: Session) -> str:
    """The time, and whether it goes on."""
    state = "running" if session.going else "paused" if session.playhead is None else "looking back"
    return f"t = {number(session.footage.row_time(session.frame), 2)} s, {state}"


def readings(session: Session) -> list[str]:
    """How fast it goes, where the tank is, what the grains do, and of the picked one more."""
    limit = "no limit" if np.isinf(session.pace) else f"limit {session.pace:g}"
    footage, frame = session.footage, session.frame
    count = footage.radius.size
    found = [
        f"{session.factor:.2f} of real time ({limit})",
        _pose(session),
        f"{count} grains, {footage.row(frame, 'contacts') * 2 / count:.2f} contacts each",
    ]
    return found if session.look.picked is None else [*found, *_picked(session)]


def _pose(session: Session) -> str:
    """Tilt and place of the tank, or of the ship's axis from where it was at rest."""
    pose = np.array([session.footage.row(session.frame, f"pose_{name}") for name in ("y", "z", "angle")])
    if session.footage.sea:
        pose = axis_motion(session.footage.sea.ship, pose)
    y, z, turn = pose
    return f"φ {number(np.degrees(turn), 1)}°, y {number(1e3 * y, 0)} mm, z {number(1e3 * z, 0)} mm"


def _picked(session: Session) -> list[str]:
    footage, frame, i = session.footage, session.frame, session.look.picked
    speed, spin = np.hypot(*footage.grains("velocity", frame)[i]), footage.grains("spin", frame)[i]
    forces = on_grain(footage.pressing(frame), i)
    largest = f", {newtons(forces.max())} at most" if len(forces) else ""
    contacts = "contact" if len(forces) == 1 else "contacts"
    return [
        f"grain {i}: {number(1e3 * speed, 1)} mm/s, {number(spin, 2)} rad/s",
        f"{len(forces)} {contacts}{largest}",
    ]
