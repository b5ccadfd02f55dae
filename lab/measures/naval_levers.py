"""The naval architect's figure: righting levers with heeling arms, and what the criteria look at."""

from collections.abc import Callable
from math import isfinite

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION
from lab.naval.sheet import AS_IT_LIES, ASSUMED, Judged, arms
from solvers.ship.naval.curve import Levers
from solvers.ship.naval.grain_code import residual
from solvers.ship.naval.weather import weather

COLOURS = {ASSUMED: VERMILION, AS_IT_LIES: BLUE}
FURTHEST = 80.0  # deg
HEEL = np.radians(np.linspace(0.0, FURTHEST, 321))


def draw_levers(axes, ship: Judged, lying: Callable[[np.ndarray], np.ndarray] | None = None) -> None:
    """GZ against heel to a side, the heeling arms, the residual area of each, deck edge and flooding."""
    heel, levers = HEEL, ship.levers
    draw_curve(axes, levers, ship.metacentric_height, f" to {ship.side}")
    for name, arm in arms(ship, lying).items():
        found = residual(levers, arm, ship.flooding)
        lies = f"{np.degrees(found.heel):.1f} deg" if isfinite(found.heel) else "no equilibrium"
        label = f"arm, {name}: {lies}, residual area {found.area:.3f} m rad"
        reach = heel[heel <= np.radians(50.0)]
        axes.plot(np.degrees(reach), arm(reach), color=COLOURS[name], label=label)
        if found.area > 0.0:
            inside = np.linspace(found.heel, found.end, 101)
            axes.fill_between(np.degrees(inside), arm(inside), levers.at(inside), color=COLOURS[name], alpha=0.15, lw=0)
    if ship.exposed is not None and ship.metacentric_height > 0.0:
        wind = weather(levers, ship.exposed, ship.flooding)
        axes.axhline(
            wind.gust, color=GREEN, lw=1.0, ls=":", label=f"gust, {wind.gust:.3f} m (steady wind {wind.wind:.3f} m)"
        )
    marks = {"deck edge": (ship.deck_edge_angle, "--"), "flooding": (ship.flooding, "-.")}
    for name, (angle, style) in marks.items():
        if angle is not None and np.degrees(angle) <= FURTHEST:
            axes.axvline(np.degrees(angle), color=GREY, lw=1.0, ls=style, label=f"{name} {np.degrees(angle):.1f} deg")


def draw_curve(axes, levers: Levers, metacentric_height: float, side: str = "") -> None:
    """GZ against heel to a side, its GM (m) in the legend."""
    axes.plot(np.degrees(HEEL), levers.at(HEEL), color="black", label=f"GZ, GM {metacentric_height:.2f} m")
    axes.axhline(0.0, color=GREY, lw=0.8)
    axes.set_xlim(0.0, FURTHEST)
    axes.set_xlabel(f"heel{side} (deg)")
    axes.set_ylabel("lever (m)")
