"""Contacts with a smooth surface of several features, which go on from one to the next."""

import taichi as ti

from solvers.tank.walls import NOWHERE


@ti.func
def hand_on(units: ti.template(), walls: ti.template(), g: ti.template(), contacts: ti.template(), u, shift):
    """Let what a unit's contacts remember go on to the feature of the same smooth surface that a grain has come to.

    So a grain that rolls over triangles of one plane rolls as on the plane. Where two faces meet in a hollow a grain
    touches both for a while, and each remembers its own.
    """
    for row in range(units.end(u) - units.first(u)):
        start, end = contacts.first[u, row], contacts.first[u, row + 1]
        for p in range(start, end):
            if contacts.remembers(u, p) and not is_faced(units, walls, g, contacts, u, p, shift):
                group = walls.group[contacts.mate[u, p][0]]
                to = -1
                for q in range(start, end):
                    if to < 0 and walls.group[contacts.mate[u, q][0]] == group and not contacts.remembers(u, q):  # noqa: SIM102
                        if is_faced(units, walls, g, contacts, u, q, shift):
                            to = q
                if to >= 0:
                    contacts.hand_on(u, p, to)


@ti.func
def is_faced(units: ti.template(), walls: ti.template(), g: ti.template(), contacts: ti.template(), u, p, shift):
    """Whether the grain of contact p faces its wall feature."""
    gap = walls.gap(contacts.mate[u, p][0], shift, *g.at(units.world(u), contacts.grain[u, p][0]))
    return 0.0 < gap[0] < NOWHERE
