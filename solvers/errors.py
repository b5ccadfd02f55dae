"""What a solver says when it cannot go on."""


class BadState(RuntimeError):
    """A running simulation reached a state that is no longer physics; the message is one sentence with the remedy."""


class Unavailable(ValueError):
    """This machine or this scene has not what was asked for; the message is one sentence with the remedy."""
