"""A rotating square patch of water: its turning is kept, no voids open in its middle, and its corners fly off."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from lab.studies.case import Case, Found, Line, Picture
from lab.studies.verify.water.drawing import shapes
from lab.studies.verify.water.scenes import box, filled, grid, looks, order_line, scene, seen, simulated
from solvers.fluid.given import Water

SECTION = "Water: drops"
SIDE, RATE = 1.0, 1.0  # m, rad/s
SOUND = 15.0 * RATE * SIDE / np.sqrt(2.0)
ACROSS, TIMES = (32, 64, 96), (0.5, 1.0, 1.5, 2.0)  # particles; s
SUM = 41  # largest number of the waves in the series
CORE = 0.25  # m: the radius of the middle, where the pressure is lowest


@dataclass(frozen=True)
class Patch:
    """What became of a patch at TIMES: places (n, 2) m, and by time the angular momentum in shares of the first."""

    places: list[np.ndarray]
    turning: np.ndarray
    corners: np.ndarray  # distances (4,) m of the particles of the corners, over those of free flight
    hole: float  # radius of the largest empty circle in the middle, in spacings, at any of TIMES
    nearest: float  # least distance of two particles in the middle, in spacings


def pressure(place: np.ndarray) -> np.ndarray:
    """Pressure (Pa) of the patch at first, which solves ∇²p = 2 ρ ω² with p = 0 at its edges (Le Touzé et al. 2013).

    −Σ 32 ρ ω² sin(nπy/L) sin(mπz/L)/(n m π² ((nπ/L)² + (mπ/L)²)) over odd n and m, y and z from a corner: below zero.
    """
    wave = np.arange(1, SUM + 1, 2)
    along_y, along_z = (np.sin(np.pi * wave * (c[:, None] / SIDE + 0.5)) for c in place.T)
    n, m = np.meshgrid(wave, wave, indexing="ij")
    weight = -32.0 / (n * m * np.pi**2 * (np.pi / SIDE) ** 2 * (n**2 + m**2))
    return 1000.0 * RATE**2 * np.einsum("in,nm,im->i", along_y, weight, along_z)


def turned(count: int) -> Patch:
    """A patch of so many particles across, with shifting, no walls and no gravity."""
    water = Water(SIDE / count, SOUND, alpha=0.01, walls=False, shifting="delta-plus", speed=RATE * SIDE / np.sqrt(2.0))
    place = grid(SIDE, SIDE, water.spacing) - 0.5 * SIDE
    drops = filled(place, water, lambda r: RATE * np.stack([-r[:, 1], r[:, 0]], axis=1), pressure)
    corner = [np.argmax(place @ [a, b]) for a in (-1, 1) for b in (-1, 1)]
    start = np.hypot(*place[corner].T)
    places, turning, holes, distances = [], [], [], []
    with simulated(scene(water, drops, box(4.0, 4.0), 0.0)) as run:
        mass = run.water.particles.read(run.water.particles.mass)[0][0]
        for time in looks(run, (0.0, *TIMES)):
            place, velocity = seen(run)
            turning.append(mass @ (place[:, 0] * velocity[:, 1] - place[:, 1] * velocity[:, 0]))
            if time > 0.0:
                places.append(place)
                holes.append(widest_gap(place) / water.spacing)
                middle = place[np.hypot(*place.T) < CORE]
                distances.append(cKDTree(middle).query(middle, 2)[0][:, 1].min() / water.spacing)
    flown = start * np.sqrt(1.0 + (RATE * time) ** 2)
    corners = np.hypot(*place[corner].T) / flown
    return Patch(places, np.array(turning) / turning[0], corners, max(holes), min(distances))


def widest_gap(place: np.ndarray) -> float:
    """Radius (m) of the largest circle without a particle whose centre is in the middle of the patch."""
    mesh = Delaunay(place)
    a, b, c = (place[mesh.simplices[:, k]] for k in range(3))
    b, c = b - a, c - a
    double = 2.0 * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
    b2, c2 = (b**2).sum(axis=1), (c**2).sum(axis=1)
    away = np.stack([c[:, 1] * b2 - b[:, 1] * c2, b[:, 0] * c2 - c[:, 0] * b2], axis=1) / double[:, None]
    return float(np.hypot(*away.T)[np.hypot(*(a + away).T) < CORE].max())


def rotating(fast: bool) -> Found:
    """A square patch turned loose at ω = 1 rad/s (Colagrossi 2005), without surface tension."""
    counts = ACROSS[:1] if fast else ACROSS
    found = [turned(count) for count in counts]
    best, drift = found[-1], np.abs(found[-1].turning - 1.0).max()
    lattice = "a square lattice has 0.71"
    free = "free flight: no pressure gradient in a corner"
    sharp = "the corner particle is half a spacing inside, and feels its neighbours' pressure"
    apart = "no particles in pairs"
    spacings = [SIDE / count for count in counts]
    errors = [abs(one.corners.mean() - 1.0) for one in found]
    lines = [
        Line.off("angular momentum", "kept", drift, 1e-3, "pair forces are central; shifting moves water alone"),
        Line("widest gap in the middle, radius in spacings", best.hole, 0.71, lattice, 0.4, "no voids", relative=False),
        Line("least distance in the middle, in spacings", best.nearest, 1.0, "lattice", 0.5, apart, relative=False),
        Line("corners' distance, of free flight", best.corners.mean(), 1.0, free, 0.1 if fast else 0.05, sharp),
        *order_line("the corners' distance", spacings, errors, 5e-3),
    ]
    rows = ", ".join(
        f"{count}: {one.turning[-1] - 1:.1e}, {one.hole:.2f}, {one.nearest:.2f}, {one.corners.mean():.3f}"
        for count, one in zip(counts, found, strict=True)
    )
    note = f"By particles across, the change of angular momentum, widest gap, least distance and corners: {rows}."
    shown = {f"ωt = {time:g}": place for time, place in zip(TIMES[1::2], best.places[1::2], strict=True)}
    picture = Picture("water-patch", shapes(shown, "m"), "The rotating patch; its arms are its corners.")
    return Found(lines, [picture], notes=[note])


CASES = (Case("water-patch", SECTION, "A rotating square patch", rotating, quick=False),)
