"""Measured series from files that are not shipped, in the folder that the environment variable CARGOLAB_DATA names."""

import textwrap

import numpy as np
from matplotlib.axes import Axes

from lab.base.data import FOLDER, data_file
from lab.base.errors import LabError

LINE = 44  # letters, of a sentence in a figure


def series(name: str) -> np.ndarray | None:
    """The columns (k, n) of a CSV file with one line of names, by its path in the folder; None if it is not there.

    Raises LabError for a file that holds something else.
    """
    path = data_file(name)
    if path is None:
        return None
    try:
        columns = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2).T
    except (OSError, ValueError) as error:
        raise LabError(f"{path} is not a table of numbers under one line of names: {error}.") from error
    return columns


def drawn(axes: Axes, name: str) -> np.ndarray | None:
    """The columns of a file that is about to be drawn; where it is not there, the axes say so in one sentence."""
    found = series(name)
    if found is None:
        said = f"The measured series is not drawn: {FOLDER} names no folder with {name}."
        place = {"xy": (0.98, 0.98), "xycoords": "axes fraction", "ha": "right", "va": "top"}
        axes.annotate(
            textwrap.fill(said, LINE, break_long_words=False, break_on_hyphens=False), fontsize=6, color="0.4", **place
        ).set_in_layout(False)
    return found
