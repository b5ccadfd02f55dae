"""Water that leaves a plane tank through a slot in its floor: how much, how fast, and in what time.

By the theory of free streamlines (Kirchhoff 1869; von Mises 1917, VDI-Zeitschrift 61, 447) the jet under a slot of
width b in the middle of a floor of width B contracts to the width δ, far below, where

    b/δ = 1 + (2/π) (B/δ − δ/B) arctan(δ/B),

so that δ/b = π/(π + 2) = 0.611 in a wide floor. Gravity counts in the head alone, not along the jet; this neglects
terms of the order b/h. Water that sinks with U = −dh/dt in the tank has V² = 2 g h + U² in the jet, with U B = V δ:

    dh/dt = −(δ/B) √(2 g h/(1 − (δ/B)²)),   t = (2 B/(C_d b √(2 g))) (√h1 − √h2),   C_d = (δ/b)/√(1 − (δ/B)²)

from a depth h1 to h2, the law of emptying with B in place of the tank's area and b in place of the hole's. The flow is
alike on both sides, so that half of it is run, with a wall without friction in the middle.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from lab.studies.case import Case, Found, Line
from lab.studies.verify.water.scenes import G, errors_note, looks, scene, seen, simulated
from solvers.fluid.given import Water
from solvers.fluid.start.rest import at_rest

SECTION = "Water: outflow"
SLOT, PLATE = 0.02, 0.01  # m: width of the slot, thickness of the floor
WIDTH, FULL = 6.0 * SLOT, 7.0 * SLOT  # m: the tank's width, and the water's depth at first
HIGH, LOW = 6.5 * SLOT, 5.5 * SLOT  # m: depths between which the outflow is measured; before, it sets in
AIR, FALL = 2.0 * SLOT, 3.0 * SLOT  # m: of the tank over the water, of its outline below the floor
SOUND = 10.0 * np.sqrt(2.0 * G * FULL)  # m/s: ten times the jet's speed
ACROSS = (16, 32, 64)  # spacings of the slot
EVERY, LONGEST = 2.5e-3, 0.5  # s: between looks, and when to give up
JET = 0.5 * SLOT, 1.5 * SLOT  # m below the tank's floor: where the jet's speed is taken
ASKED = 0.05
WHY = "kernels blur the pressure at the slot's edges over h = 2 Δx; gravity in the jet, of the order of b/h"


def contraction(share: float) -> float:
    """δ/b of the jet from a slot that takes a `share` b/B of the floor, see above."""

    def lacking(width: float) -> float:
        """How much wider a slot the jet of a width (of B) would have, of B."""
        return width + (2.0 / np.pi) * (1.0 - width**2) * np.arctan(width) - share

    return float(brentq(lacking, 0.0, 1.0, xtol=1e-14)) / share


def discharge() -> float:
    """C_d of the slot, with the speed at which the water sinks in the tank."""
    share = SLOT / WIDTH
    narrowest = contraction(share)
    return narrowest / float(np.sqrt(1.0 - (narrowest * share) ** 2))


def emptying(coefficient: float, high: float, low: float) -> float:
    """Time (s) in which the water sinks from one depth (m) to another, with C_d."""
    return 2.0 * WIDTH / (coefficient * SLOT * np.sqrt(2.0 * G)) * (np.sqrt(high) - np.sqrt(low))


def outline() -> np.ndarray:
    """Half of the tank with its slotted floor, and below it a space without walls below and to the right."""
    half, side, out, rim = 0.5 * SLOT, 0.5 * WIDTH, 0.5 * WIDTH + SLOT, FULL + AIR
    floor = [(out, -PLATE), (half, -PLATE), (half, 0.0), (side, 0.0)]
    return np.array([(0.0, -FALL), (out, -FALL), *floor, (side, rim), (0.0, rim)])


OPEN = 0, 1  # its edges without a wall: under and beside the jet


@dataclass(frozen=True)
class Outflow:
    """Depths (T,) m of the water by its volume at times (T,) s, and speeds (T,) of the jet over √(2 g (h − z))."""

    time: np.ndarray
    depth: np.ndarray
    speed: np.ndarray

    @property
    def measured(self) -> np.ndarray:
        """At which looks the outflow is measured."""
        return (self.depth <= HIGH) & (self.depth >= LOW)

    @property
    def coefficient(self) -> float:
        """C_d by the slope of √h, which falls evenly."""
        slope = np.polyfit(self.time[self.measured], np.sqrt(self.depth[self.measured]), 1)[0]
        return float(-2.0 * slope * WIDTH / (SLOT * np.sqrt(2.0 * G)))

    @property
    def pace(self) -> float:
        """Mean speed of the jet meanwhile, over √(2 g (h − z))."""
        return float(self.speed[self.measured].mean())

    @property
    def lasting(self) -> float:
        """Time (s) from HIGH to LOW, between looks by straight lines."""
        high, low = np.interp([-HIGH, -LOW], -self.depth, self.time)
        return float(low - high)


def emptied(across: int) -> Outflow:
    """A tank whose slot, so many spacings wide, is opened at once under water at rest."""
    water = Water(SLOT / across, SOUND)
    half = 0.5 * WIDTH
    vessel = np.array([(0.0, 0.0), (half, 0.0), (half, FULL + AIR), (0.0, FULL + AIR)])
    drops = at_rest(vessel, FULL, water, G)[None]
    volume, found = drops["volume"][0], []
    with simulated(scene(water, drops, outline(), open_edges=OPEN)) as run:
        for time in looks(run, np.arange(EVERY, LONGEST, EVERY)):
            place, velocity = seen(run)
            depth, below = volume[place[:, 1] > 0.0].sum() / half, -place[:, 1]
            jet = (below > JET[0]) & (below < JET[1])
            fallen = np.sqrt(2.0 * G * (depth + below[jet]))
            found.append((time, depth, (np.hypot(*velocity[jet].T) / fallen).mean() if jet.any() else np.nan))
            if depth < LOW:
                break
    return Outflow(*np.array(found).T)


def converged(values: list[float]) -> tuple[float, float]:
    """Limit and order of three values at spacings that are halved twice (Roache 1998, section 5.10).

    Not of their errors: free streamlines without gravity are not the limit of a jet with it.
    """
    coarse, middle, fine = values
    order = float(np.log2((coarse - middle) / (middle - fine)))
    return fine + (fine - middle) / (2.0**order - 1.0), order


def outflow(_: bool) -> Found:
    """A slot in the middle of the floor, a sixth of its width, under five to seven times its width of water."""
    runs, exact = [emptied(count) for count in ACROSS], discharge()
    wanted = emptying(exact, HIGH, LOW)
    errors = {
        "C_d": [run.coefficient / exact - 1.0 for run in runs],
        "Speed of the jet": [run.pace - 1.0 for run in runs],
        "Time of emptying": [run.lasting / wanted - 1.0 for run in runs],
    }
    best, (limit, order) = runs[-1], converged([run.coefficient for run in runs])
    lines = [
        Line("C_d of the slot", best.coefficient, exact, "free streamlines", ASKED, WHY),
        Line("speed of the jet, of √(2g(h − z))", best.pace, 1.0, "no losses", ASKED, WHY),
        Line("time of emptying", best.lasting, wanted, "the law of emptying", ASKED, WHY, "s"),
        Line("C_d as the spacing goes to nothing", limit, exact, "free streamlines", ASKED, "gravity in the jet, b/h"),
    ]
    notes = [note for what, each in errors.items() for note in errors_note(what, ACROSS, "spacings in the slot", each)]
    notes.append(f"C_d converges with an order of {order:.2f}; kernels that blur a sharp edge over h ask for 1.")
    return Found(lines, notes=notes)


CASES = (Case("water-orifice", SECTION, "Outflow through a slot", outflow, quick=False),)
