"""The common part of rules with a single contact of two grains, or of a grain and a wall."""

import taichi as ti

from solvers.machine.wide import entry


@ti.data_oriented
class Single:
    """A rule without search or loss of contacts: each neighbouring pair has exactly one contact."""

    farthest, bent, most = 1.0, False, 1

    @ti.func
    def seek_pair(self, g: ti.template(), w, i, j, margin, u):
        """How many contacts are to be listed."""
        return 1

    @ti.func
    def seek_wall(self, g: ti.template(), w, i, feature, shift: ti.template(), margin, u):
        """How many contacts are to be listed."""
        return 1

    @ti.func
    def away(self, contacts: ti.template(), u, q, k):
        """Distance from contact q of the old list to the pair's contact: zero, since it is the same."""
        return 0.0 * entry(contacts.stiffness, u, 0, 0)

    @ti.func
    def was_known(self, contacts: ti.template(), u, q):
        """Whether contact q of the old list was not lost: always."""
        return True

    @ti.func
    def note(self, contacts: ti.template(), u, p, k):
        """Do nothing: contact p has no places to store."""

    @ti.func
    def places_for_pair(self, g: ti.template(), w, i, j, most):
        """Number of entries for the contacts of two grains."""
        return 1

    @ti.func
    def places_for_wall(self, g: ti.template(), w, i, most):
        """Number of entries for the contacts of a grain with a wall."""
        return 1

    @ti.func
    def free(self, contacts: ti.template(), u, p):
        """Do nothing: every entry is a contact."""

    @ti.func
    def is_lost(self, contacts: ti.template(), u, p):
        """Whether contact p is lost: never."""
        return False

    @ti.func
    def lose(self, contacts: ti.template(), u, p):
        """Do nothing: no contact is lost."""
