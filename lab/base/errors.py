"""Errors that tell a user what cannot be done."""


class LabError(Exception):
    """One clear sentence that names the key or file at fault and the remedy."""


class NotRecorded(LabError, KeyError, IndexError):
    """A recording lacks what was asked for. Also a KeyError and an IndexError, so that `get` and iteration work."""

    __str__ = Exception.__str__  # a KeyError puts its sentence in quotes


class Useless(LabError):
    """A file that cannot be used: a run cannot continue from it, or it is not safe to read."""
