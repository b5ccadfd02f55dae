"""Errors whose messages are meant for users."""


class LabError(Exception):
    """An error with one sentence that names the key or file at fault and the remedy."""


class NotRecorded(LabError, KeyError, IndexError):
    """A recording lacks the requested data. Also a KeyError and an IndexError, so that `get` and iteration work."""

    __str__ = Exception.__str__  # a KeyError would put its sentence in quotes


class Unusable(LabError):
    """A file cannot be used: a run cannot continue from it, or it is not safe to read."""
