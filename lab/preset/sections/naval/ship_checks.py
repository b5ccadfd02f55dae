"""Consistency checks of a ship in a preset; each error is one sentence that names the key."""

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import stands_out
from lab.preset.sections.sea import Waves
from lab.preset.sections.ship import Ship
from lab.preset.sections.tank import Tank
from lab.preset.units import show
from solvers.machine.errors import Unavailable
from solvers.ship.section import Section

MOST_FLAT = 200.0  # largest ratio of breadth and draught, either way; the panels do not resolve flatter sections
FARTHEST = 10.0  # times the hull's size: largest distance of a ship's points from the origin

MOST_KEEL = 0.1  # of the hull's breadth
NARROW = 0.98  # of the middle frequency: half the breadth of white noise is less

NEEDS = {
    "regular": ("amplitude",),
    "packet": ("amplitude", "spread", "time"),
    "jonswap": ("height",),
    "pierson-moskowitz": ("height",),
    "white-noise": ("height", "spread"),
}


def check_ship(ship: Ship | None, waves: Waves | None, moves: bool, hold: Tank) -> None:
    """Raise LabError for settings that contradict each other; `hold` is the tank."""
    _check_hold_length(ship, hold.length)
    if ship is None:
        if waves is not None:
            raise LabError("waves: there is no ship in them; add a table [ship], or leave the waves out.")
        return
    if moves:
        raise LabError("motion: a ship moves her hold herself; leave the motions out, or the ship.")
    box = ship.breadth is not None and ship.height is not None
    if box == (ship.outline is not None) or (ship.breadth is None) != (ship.height is None):
        raise LabError("ship.breadth: give breadth and height, or an outline.")
    if (ship.gyradius is None) == (ship.roll_period is None):
        raise LabError("ship.gyradius: give exactly one of gyradius and roll_period.")
    if ship.bare and ship.roll_period is not None:
        raise LabError("ship.roll_period: is that of ship and cargo together; give a gyradius, or leave out bare.")
    if ship.linear_damping is not None and ship.damping:
        raise LabError("ship.linear_damping: give either damping or linear_damping, not both.")
    _check_keels(ship)
    _check_whole(ship)
    _check_hatch(ship, box)
    try:
        Section(ship.corners)
    except Unavailable as error:
        raise LabError(f"ship.outline: {error}") from None
    depth = ship.height if box else float(np.ptp(ship.corners[:, 1]))
    if ship.draught >= depth:
        raise LabError(f"ship.draught: must be less than the hull's height, {show(depth, 'm')}.")
    _check_lengths(ship, box)
    _check_openings(ship, box)
    _check_hold(ship, np.array(hold.corners))
    if ship.release < 0.1 and ship.heel:
        raise LabError('ship.release: she is heeled until then, and not at a blow; give at least "0.1 s".')
    if waves is None:
        if ship.radiation == "at-frequency":
            raise LabError('ship.radiation: "at-frequency" takes the frequency of waves; add a table [waves].')
        return
    for name in NEEDS[waves.kind]:
        if getattr(waves, name) is None:
            raise LabError(f'waves.{name}: missing; waves.kind = "{waves.kind}" needs it.')
    if waves.kind == "white-noise" and not waves.spread < NARROW * waves.frequency:
        most = show(NARROW * waves.frequency, "rad/s")
        raise LabError(f"waves.spread: must be below {most}, so that the band of white noise stays above zero.")


def _check_keels(ship: Ship) -> None:
    """Raise LabError for bilge keels that nothing asks for or that no ship has, and for damping that is told twice."""
    keels = ship.bilge_keels
    if ship.viscous_damping == "given":
        if keels is not None:
            raise LabError('ship.bilge_keels: are not used; set ship.viscous_damping = "ikeda", or leave them out.')
        return
    if ship.linear_damping is not None or ship.damping or ship.quadratic_damping:
        raise LabError('ship.damping: is computed with viscous_damping = "ikeda"; leave all given damping out, or 0.')
    if keels is None:
        return
    if ship.length is None:
        raise LabError("ship.length: missing; the bilge keels have a length, so give the ship's too.")
    if keels.length > ship.length:
        raise LabError(f"ship.bilge_keels.length: more than the ship's {show(ship.length, 'm')}; make it shorter.")
    most = MOST_KEEL * float(np.ptp(ship.corners[:, 0]))
    if keels.breadth > most:
        raise LabError(f"ship.bilge_keels.breadth: at most {show(most, 'm')}, {MOST_KEEL:g} of the hull's breadth.")


def _check_hold_length(ship: Ship | None, length: float | None) -> None:
    """Raise LabError for the length of a hold without a ship, or longer than she is."""
    if length is None:
        return
    if ship is None:
        raise LabError("tank.length: is that of a hold in a ship; add a table [ship], or leave this out.")
    if ship.length is None:
        raise LabError("ship.length: missing; the hold has a length, so give the ship's too.")
    if length > ship.length:
        raise LabError(f"tank.length: the hold is longer than the ship, {show(ship.length, 'm')}; make it shorter.")


def _check_whole(ship: Ship) -> None:
    """Raise LabError for a whole hull without a length, or offsets that nothing asks for."""
    if ship.hydrodynamics != "section" and ship.length is None:
        raise LabError(f'ship.length: missing; ship.hydrodynamics = "{ship.hydrodynamics}" needs it.')
    if ship.hydrodynamics == "section" and ship.offsets is not None:
        raise LabError('ship.offsets: is not used by a section; set ship.hydrodynamics to "strips" or "hull".')
    if ship.hydrodynamics != "section" and ship.about[0] != 0.0:
        raise LabError("ship.axis: must be amidships, y = 0, with a whole hull.")


def _check_lengths(ship: Ship, box: bool) -> None:
    """Raise LabError for lengths so different that the hull's coefficients cannot be computed."""
    breadth, draught = float(np.ptp(ship.corners[:, 0])), ship.draught
    if not 1.0 / MOST_FLAT <= breadth / draught <= MOST_FLAT:
        key = "ship.breadth" if box else "ship.outline"
        raise LabError(
            f"{key}: {show(breadth, 'm')} of breadth and {show(draught, 'm')} of draught are too far apart for the "
            f"hull's coefficients; keep one within {MOST_FLAT:g} times the other."
        )
    farthest = FARTHEST * float(np.ptp(ship.corners, axis=0).max())
    lengths = {"gravity_height": ship.gravity_height, "gyradius": ship.gyradius or 0.0}
    lengths |= {"axis": max(map(abs, ship.about)), "hold": max(map(abs, ship.hold))}
    for key, length in lengths.items():
        if abs(length) > farthest:
            raise LabError(f"ship.{key}: {show(length, 'm')} is more than {FARTHEST:g} times the hull's size.")


def _check_hatch(ship: Ship, box: bool) -> None:
    """Raise LabError if the hull cannot have this hatch."""
    if ship.hatch is None:
        return
    if not box:
        raise LabError(
            "ship.hatch: goes with breadth and height; draw a coaming in the outline, its edges as openings."
        )
    if ship.hatch.breadth >= ship.breadth:
        raise LabError(f"ship.hatch.breadth: must be less than the hull's breadth, {show(ship.breadth, 'm')}.")


def _check_openings(ship: Ship, box: bool) -> None:
    """Raise LabError if an opening is under water at rest, or the deck is not above the waterline."""
    keel, top = (float(end(ship.corners[:, 1])) for end in (np.min, np.max))
    waterline = keel + ship.draught
    for y, z in ship.openings:
        if z <= waterline:
            place = f"[{show(y, 'm')}, {show(z, 'm')}]"
            raise LabError(f"ship.openings: {place} is under water at rest; it must be above {show(waterline, 'm')}.")
    if ship.deck is None:
        return
    if box:
        raise LabError("ship.deck: the deck of a box is at its height; leave it out.")
    if not waterline < ship.deck <= top:
        between = f"{show(waterline, 'm')} and {show(top, 'm')}"
        raise LabError(f"ship.deck: must be between the waterline and the hull's top, {between}.")


def _check_hold(ship: Ship, hold: np.ndarray) -> None:
    """Raise LabError if the hold sticks out of the hull: a corner of it outside, or one of the hull inside it."""
    out = stands_out(hold + np.array(ship.hold), ship.corners)
    if out is not None:
        place = f"[{show(float(out[0]), 'm')}, {show(float(out[1]), 'm')}]"
        raise LabError(
            f"ship.hold: the tank stands out of the hull at {place}; move it, or change the hull or the tank."
        )
