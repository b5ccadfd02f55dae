"""Figures of the cases of water."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BLUE, GREEN, GREY, VERMILION, canvas

COLOURS = (BLUE, VERMILION, GREEN, GREY)


def profiles(run: Sequence[tuple], exact: Callable, half: float) -> Figure:
    """Velocities (m/s) of particles across a channel at several times, and exact ones."""
    figure, axes = canvas((6.4, 3.0))
    across = np.linspace(-half, half, 200)
    for (time, place, velocity), colour in zip(run, COLOURS, strict=True):
        axes.plot(across, exact(across, time), color=colour, lw=1.0, label=f"{time:.3g} s")
        axes.plot(place, velocity, ".", color=colour, ms=4)
    axes.set(xlabel="place across (m)", ylabel="velocity (m/s)")
    axes.legend()
    return figure


def shapes(clouds: Mapping[str, np.ndarray], unit: str) -> Figure:
    """Particles (n, 2) by a panel's title, side by side."""
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    for axes, (title, place) in zip(np.atleast_1d(figure.subplots(1, len(clouds))), clouds.items(), strict=True):
        axes.plot(*place.T, ".", color=BLUE, ms=1.0)
        axes.set_aspect("equal")
        axes.set_title(title)
        axes.set(xlabel=f"y ({unit})", ylabel=f"z ({unit})")
    return figure


def courses(curves: Mapping[str, tuple[np.ndarray, np.ndarray]], axis: tuple[str, str]) -> Figure:
    """Curves by their names, exact ones (names that end in "exact") in black."""
    figure, axes = canvas((6.4, 3.0))
    colours = iter(COLOURS * 3)
    for name, (x, y) in curves.items():
        exact = name.endswith("exact")
        look = {"color": "black", "ls": "--", "lw": 0.8} if exact else {"color": next(colours), "lw": 1.0}
        axes.plot(x, y, label=name, **look)
    axes.set(xlabel=axis[0], ylabel=axis[1])
    axes.legend()
    return figure
