"""What the lab says to a person when something cannot be done."""


class LabError(Exception):
    """One clear sentence that names the key or file at fault and the remedy."""


class NotRecorded(LabError, KeyError, IndexError):
    """What is asked of a recording is not in it. As for any mapping and sequence, it ends a loop and has a default."""

    __str__ = Exception.__str__  # a KeyError puts its sentence in quotes


class Useless(LabError):
    """A file that no run can go on from."""
