"""Operations and bytes of a step, counted by hand from the engine's source.

Counted for 64-bit numbers, one kind of grains, the viscoelastic Hertz law, Mindlin's friction with history, no rolling
resistance, a closed tank that does not turn. A sum, difference, product, least or largest value and a choice by a
comparison are one simple operation; changes of sign are free. Bytes are what has to come from and go to memory if
nothing else stays in between: what a pair's entry in the list holds, and a grain's numbers once a pass, however many
contacts it has.
"""

from dataclasses import dataclass

REAL, INTEGER = 8, 4  # bytes


@dataclass(frozen=True)
class Count:
    """What one function does for one pair or grain: `simple` operations, `slow` ones (roots, divisions), `bytes`."""

    where: str
    simple: int
    slow: int
    bytes: int


PAIR = (
    # Two grains, reach and part of it; Δy, Δz, their squares' sum, root, inverse, normal, overlap.
    Count("`Contacts.geometry`", 9, 2, 2 * INTEGER + 2 * REAL),
    # Velocity 2, levers 4, rate 3, slip 7, force's components 6, torques 4.
    Count("`Contacts.pair_forces`", 26, 0, 0),
    # The root of the overlap; the stiffness.
    Count("`ChosenLaws.forces`", 0, 1, REAL),
    # Overlaps that a kick begins and ends with 5, what is swept 3, spring and lag 4, damper 3, rise 3, cut 8; the lag.
    Count("`HertzViscoelastic.force`", 26, 2, REAL),
    # Stiffness and cap 8, mean of the root 14, slip of the step 7, spring's force 10, dashpot and sum 9; the damper's
    # limit, the stiffening, three memories, read and written.
    Count("`Mindlin.force`", 48, 2, 8 * REAL),
    Count("`Grains.push`, twice", 6, 0, 0),
)
GRAIN = (
    # Places, velocities and spin; force and torque, read and written.
    Count("a grain's numbers in the pair forces", 0, 0, 5 * REAL + 2 * 3 * REAL),
    # Load 7, accelerations 6, speed's powers 4.
    Count("`Mover.move`", 17, 0, 7 * REAL + 3 * REAL),
    # Velocities 6, places 6, predictions 6, square of the speed 3.
    Count("`Verlet.step`", 21, 0, 4 * REAL + 9 * REAL),
)


def total(counts: tuple[Count, ...], where: str) -> Count:
    """The sum of counts, under a name of its own."""
    return Count(where, sum(c.simple for c in counts), sum(c.slow for c in counts), sum(c.bytes for c in counts))
