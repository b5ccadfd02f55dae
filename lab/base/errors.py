"""Errors whose messages are meant for users."""

import errno

from solvers.machine.errors import Told

REMEDIES = {
    errno.ENOSPC: "free some space or choose another folder with --out",
    errno.EDQUOT: "free some space or choose another folder with --out",
    errno.EACCES: "choose another folder with --out",
    errno.EPERM: "choose another folder with --out",
    errno.EROFS: "choose another folder with --out",
}


class LabError(Told):
    """An error with one sentence that names the key or file at fault and the remedy."""


class NotRecorded(LabError, KeyError, IndexError):
    """A recording lacks the requested data. Also a KeyError and an IndexError, so that `get` and iteration work."""

    __str__ = Exception.__str__  # a KeyError would put its sentence in quotes


class Unusable(LabError):
    """A file cannot be used: a run cannot continue from it, or it is not safe to read."""


def os_sentence(error: OSError) -> str:
    """One sentence on an error of the system, with the remedy where there is one."""
    where = f"{error.filename}: " if error.filename else ""
    what = error.strerror or str(error) or type(error).__name__
    remedy = REMEDIES.get(error.errno)
    return f"{where}{what[0].lower()}{what[1:]}{f'; {remedy}' if remedy else ''}."
