"""The figure of a run of flooding: heel and trim, water in the rooms, freeboard, and the levers that are left."""

from pathlib import Path

import matplotlib
import numpy as np

from lab.base.errors import LabError
from lab.naval.flooding.results import Results
from lab.report.page import save_figure
from lab.report.plots import BLUE, GREEN, STYLE, VERMILION, as_written, canvas

SIZE = (9.0, 5.8)  # inches
MINUTES = 300.0  # s: longer runs have minutes on their axis


def draw(results: Results, folder: Path) -> Path:
    """Save flooding.png in a folder. Raises LabError when it cannot be written."""
    with matplotlib.rc_context(STYLE):
        figure, axes = canvas(SIZE, 2, 2)
        minutes = results.time[-1] > MINUTES
        time = results.time / (60.0 if minutes else 1.0)
        _heel(axes[0, 0], time, results)
        _water(axes[0, 1], time, results)
        _freeboard(axes[1, 0], time, results)
        _levers(axes[1, 1], results)
        for panel in (axes[0, 0], axes[0, 1], axes[1, 0]):
            panel.set_xlabel("time (min)" if minutes else "time (s)")
        as_written(figure)
        try:
            return save_figure(folder / "flooding.png", figure)
        except OSError as error:
            raise LabError(f"{folder} cannot be written ({error.strerror}): choose another folder.") from error


def _heel(axes, time: np.ndarray, results: Results) -> None:
    axes.plot(time, np.degrees(results.heel), color=BLUE)
    axes.set_title("heel, starboard down (deg)")


def _water(axes, time: np.ndarray, results: Results) -> None:
    share = 100.0 * results.volume / results.built.ship.rooms.full
    for k, name in enumerate(results.built.ship.rooms.names):
        axes.plot(time, share[:, k], label=name)
    axes.set_title("water in rooms (% of what they hold)")
    axes.legend()


def _freeboard(axes, time: np.ndarray, results: Results) -> None:
    axes.plot(time, results.freeboard, color=GREEN, label="deck's edge above the sea")
    axes.plot(time, results.draughts.mean(axis=1), color=VERMILION, label="mean draught")
    axes.axhline(0.0, color="black", linewidth=0.6)
    axes.set_title("freeboard and draught (m)")
    axes.legend()


def _levers(axes, results: Results) -> None:
    axes.set_title("levers left, by lost buoyancy (m)")
    if results.residual is None:
        axes.text(0.5, 0.5, "she does not float at rest", transform=axes.transAxes, ha="center")
        axes.set_axis_off()
        return
    side = "port" if results.side > 0 else "starboard"
    axes.plot(np.degrees(results.residual.heel), results.residual.lever, color=BLUE)
    axes.axhline(0.0, color="black", linewidth=0.6)
    axes.set_xlabel(f"heel to {side} (deg)")
