"""What the lab says to a person when something cannot be done."""


class LabError(Exception):
    """One clear sentence that names the key or file at fault and the remedy."""


class Useless(LabError):
    """A file that no run can go on from."""
