"""Errors whose message is one sentence for users."""


class Told(Exception):
    """An error that says in one sentence what is wrong and what to do; notebooks show the sentence alone."""

    def _render_traceback_(self) -> list[str]:  # IPython asks for it
        return [f"{type(self).__name__}: {self}"]


class BadState(Told, RuntimeError):
    """A running simulation reached an unphysical state; the message is one sentence with the remedy.

    `world` is the number of the world in the simulation, `what` the sentence without that number.
    """

    def __init__(self, world: int, what: str):
        super().__init__(f"world {world}: {what}")
        self.world, self.what = world, what


class Unavailable(Told, ValueError):
    """This machine or scene cannot provide what was asked for; the message is one sentence with the remedy."""


class NotLoaded(Told, ImportError):
    """Taichi cannot be loaded on this machine; the message is one sentence with the remedy."""


class BadOutline(Told, ValueError):
    """An outline that no grain, or no contact rule, can use; the message is one sentence."""
