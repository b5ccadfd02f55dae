"""Whether a user's own file or folder hides a package of the lab from Python, which takes the first of a name."""

import sys
from importlib.machinery import PathFinder
from pathlib import Path

HOME = Path(__file__).parents[1]  # the folder that holds the packages
PACKAGES = "lab", "solvers"


def sentence() -> str:
    """What hides which package, and the remedy; empty where nothing does."""
    for name in PACKAGES:
        if other := _other(name):
            return (
                f"{other} hides the lab's own package {name}: rename it, or start Python from another folder "
                "(and leave its folder out of PYTHONPATH)."
            )
    return ""


def check() -> None:
    """Raise ImportError, one sentence, where `lab` or `solvers` is another's."""
    if found := sentence():
        raise ImportError(found)


def _other(name: str) -> Path | None:
    """The file or folder that Python takes for the package of that name; None if it is the lab's."""
    known = sys.modules.get(name)
    spec = known.__spec__ if known is not None else PathFinder.find_spec(name)
    if spec is None:  # on no path of Python's: an editable installation finds it otherwise
        return None
    places = list(spec.submodule_search_locations or [spec.origin])
    place = Path(places[0])
    return None if place.resolve() == (HOME / name).resolve() else place.absolute()
