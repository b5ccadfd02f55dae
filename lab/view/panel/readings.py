"""Texts on a live experiment: the lines at the top of the column, and the meaning of the overlay."""

import numpy as np

from lab.paint.decorations import number
from lab.paint.forces.chains import newtons
from lab.preset.sections.ship import axis_motion
from lab.view.panel.forces import contacts_each, on_grain
from lab.view.shown import Shown


def clock(shown: Shown) -> str:
    """The time, and whether it is running; before that, how far the bed has settled."""
    if shown.settling:
        return shown.status
    if shown.playhead is not None:
        state = "looking back"
    else:
        state = "ended" if shown.over else "running" if shown.going else "paused"
        state = shown.lost.kind if shown.lost else state
    return f"t = {number(shown.footage.row_time(shown.frame), 2)} s, {state}"


def readings(shown: Shown) -> list[str]:
    """Lines on the pace, the pose of the tank, the grains, and the picked grain."""
    limit = "no limit" if np.isinf(shown.pace) else f"limit {shown.pace:g}"
    footage, frame = shown.footage, shown.frame
    count = footage.radius.size
    if shown.settling:
        return [f"{count} grains"]
    if footage.water:
        drops = f"{footage.water.volume.size} particles of water, {1e3 * footage.water.spacing:.3g} mm apart"
        return [f"{shown.factor:.2f} of real time ({limit})", _pose(shown), drops]
    found = [f"{shown.factor:.2f} of real time ({limit})", _pose(shown)]
    if count:
        found.append(f"{count} grains, {contacts_each(footage.pressing(frame), count):.2f} contacts each")
    return found if shown.look.picked is None else [*found, *_picked(shown)]


def _pose(shown: Shown) -> str:
    """Tilt and place of the tank, or of the ship's axis from where it was at rest."""
    pose = shown.footage.row(shown.frame, "pose")
    if shown.footage.sea:
        pose = axis_motion(shown.footage.sea.ship, pose)
    y, z, turn = pose
    return f"φ {number(np.degrees(turn), 1)}°, y {number(1e3 * y, 0)} mm, z {number(1e3 * z, 0)} mm"


def _picked(shown: Shown) -> list[str]:
    footage, frame, i = shown.footage, shown.frame, shown.look.picked
    speed, spin = np.hypot(*footage.grains("velocity", frame)[i]), footage.grains("spin", frame)[i]
    forces = on_grain(footage.pressing(frame), i)
    largest = f", {newtons(forces.max())} at most" if len(forces) else ""
    contacts = "contact" if len(forces) == 1 else "contacts"
    return [
        f"grain {i}: {number(1e3 * speed, 1)} mm/s, {number(spin, 2)} rad/s",
        f"{len(forces)} {contacts}{largest}",
    ]
