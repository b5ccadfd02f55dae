"""What a solver says when it cannot go on."""


class BadState(RuntimeError):
    """A running simulation reached a state that is no longer physics; the message is one sentence with the remedy.

    `world` is the number of the world in the simulation, `what` the sentence without it.
    """

    def __init__(self, world: int, what: str):
        super().__init__(f"world {world}: {what}")
        self.world, self.what = world, what


class Unavailable(ValueError):
    """This machine or this scene has not what was asked for; the message is one sentence with the remedy."""


class BadOutline(ValueError):
    """No grain can have this outline, or no contact these outlines; the message is one sentence."""
