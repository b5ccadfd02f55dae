"""What rules have in common that see one contact of two grains, or of a grain and a wall."""

import taichi as ti


@ti.data_oriented
class Single:
    """Nothing is sought, found again or lost: two that are near each other have their one contact."""

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
        """How far contact q of an old list of the same two is from the one that has been found: it is the same."""
        return 0.0 * contacts.stiffness[u, 0][0]

    @ti.func
    def was_known(self, contacts: ti.template(), u, q):
        """Whether contact q of an old list had not been lost sight of."""
        return True

    @ti.func
    def note(self, contacts: ti.template(), u, p, k):
        """Nothing more is known of contact p."""

    @ti.func
    def places_for_pair(self, g: ti.template(), w, i, j, most):
        """Room to leave for contacts of two grains."""
        return 1

    @ti.func
    def places_for_wall(self, g: ti.template(), w, i, most):
        """Room to leave for contacts of a grain and a wall."""
        return 1

    @ti.func
    def free(self, contacts: ti.template(), u, p):
        """Nothing: it is a contact."""

    @ti.func
    def is_lost(self, contacts: ti.template(), u, p):
        """Whether a contact has been lost sight of: none is."""
        return False

    @ti.func
    def lose(self, contacts: ti.template(), u, p):
        """Remember that it has."""
