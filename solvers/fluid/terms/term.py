"""What a term is: sums over the neighbours of a block of particles, what a pair gives to them, and what they end in."""

from collections.abc import Sequence
from typing import NamedTuple

import taichi as ti


class Block(NamedTuple):
    """A block of particles whose neighbours are gone through: what terms know of it. Vectors are lists by axis.

    `own` are the places (m) of its particles less those of the first, `origin`; `speed` (m/s), `pressure` (Pa), density
    deviations `s`, and `gas`, 1 for air, are of its lanes.
    """

    u: object  # its unit of work
    b: object
    kick: object  # s, from velocities to velocities
    origin: list
    own: list
    speed: list
    pressure: object
    s: object
    gas: object


class Pair(NamedTuple):
    """The particles of a block and one neighbour, in a lane of the block `jb`.

    `apart` is r_i − r_j (m), `square` its square, `t` = 1 − |r_i − r_j|/(2 h) or 0, `weight` V_j (−W'/r) without its
    factor, 0 of what is not seen; `volume` is V_j of what is seen. `other` is 1 for air i beside water j, −1 for water
    i beside air j; `within` the weight within a phase, `steep` that times `apart`. `along` has one entry, the force
    along the line between both, to which terms may add.
    """

    jb: object
    lane: object
    apart: list
    square: object
    t: object
    weight: object
    volume: object
    other: object
    within: object
    steep: list
    along: list


class Seen(NamedTuple):
    """A block of wall particles and one particle before it, in a lane of the block `jb`.

    `apart`, `square` and `t` are as of a `Pair`; `visible` is the share of the particle that is seen, `volume` V_f,
    `weight` W of what is seen, `massive` that times the mass of water in V_f, both without W's factor, and `slope`
    −W'/r without its own.
    """

    jb: object
    lane: object
    apart: list
    square: object
    t: object
    visible: object
    volume: object
    weight: object
    massive: object
    slope: object


class Sums:
    """Counts the sums of a pass, all of them entries of one list; each is of as many lanes as a block."""

    def __init__(self) -> None:
        self.count = 0

    def room(self, count: int = 1) -> int:
        """The place of the first of so many sums."""
        first = self.count
        self.count += count
        return first


@ti.data_oriented
class Term:
    """A model of the fluid in a pass over pairs. What a class does not define itself is not compiled.

    `begin(block, sums)` before the neighbours, where sums do not start at zero; `add(block, pair, sums)` for each
    neighbour; `add_wall(block, pair, sums)` for each wall particle; `end(block, sums)` after all. In the pass over wall
    particles (`Extrapolation`) the block is one of these, told by its number, and a neighbour is a `Seen`.
    """

    parts = ("begin", "add", "add_wall", "end")

    def does(self, part: str) -> bool:
        """Whether it has such a part."""
        return hasattr(self, part)


def doing(terms: Sequence[Term | None], part: str) -> list[Term]:
    """Those of the terms that have a part, in their order; None stands for a term that the scene does not need."""
    return [term for term in terms if term is not None and term.does(part)]
