"""Errors that a solver raises when it cannot continue."""


class BadState(RuntimeError):
    """A running simulation reached an unphysical state; the message is one sentence with the remedy.

    `world` is the number of the world in the simulation, `what` the sentence without that number.
    """

    def __init__(self, world: int, what: str):
        super().__init__(f"world {world}: {what}")
        self.world, self.what = world, what


class Unavailable(ValueError):
    """This machine or scene cannot provide what was asked for; the message is one sentence with the remedy."""


class BadOutline(ValueError):
    """An outline that no grain, or no contact rule, can use; the message is one sentence."""
