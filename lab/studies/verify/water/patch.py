"""A rotating square patch of water: its turning is kept, no voids open in its middle, and its corners fly off."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from lab.studies.case import Case, Found, Line, Picture, Table
from lab.studies.verify.water.drawing import shapes
from lab.studies.verify.water.scenes import box, filled, grid, looks, order, scene, simulated
from lab.studies.verify.water.vorticity import middle_pressure
from solvers.fluid.given import Water
from solvers.fluid.start.flow import stirred, torsion

SECTION = "Water: drops"
SIDE, RATE = 1.0, 1.0  # m, rad/s
SOUND = 15.0 * RATE * SIDE / np.sqrt(2.0)
ACROSS, TIMES = (32, 64, 96), (0.5, 1.0, 1.5, 2.0)  # particles; s
CORE = 0.25  # m: the radius of the middle, where the pressure is lowest
MIDST = 0.15  # m: the radius within which a parabola is laid through the pressure
FOLLOWED = (0.5, 1.0)  # s: times at which there is a reference of the pressure
TERMS = 4000  # of the series of the first pressure


@dataclass(frozen=True)
class Patch:
    """What became of a patch at TIMES: places (n, 2) m, and by time the angular momentum in shares of the first."""

    places: list[np.ndarray]
    turning: np.ndarray
    corners: np.ndarray  # distances (4,) m of the particles of the corners, over those of free flight
    hole: float  # radius of the largest empty circle in the middle, in spacings, at any of TIMES
    nearest: float  # least distance of two particles in the middle, in spacings
    middle: np.ndarray  # pressure (2,) in the middle at FOLLOWED over ρ ω² L²


def turned(count: int, shifting: str = "delta-plus-momentum") -> Patch:
    """A patch of so many particles across, without walls and gravity."""
    water = Water(SIDE / count, SOUND, alpha=0.01, walls=False, shifting=shifting, speed=RATE * SIDE / np.sqrt(2.0))
    place = grid(SIDE, SIDE, water.spacing) - 0.5 * SIDE
    drops = filled(place, water, lambda r: stirred(r, 0.0, RATE), pressure)
    corner = [np.argmax(place @ [a, b]) for a in (-1, 1) for b in (-1, 1)]
    start = np.hypot(*place[corner].T)
    places, turning, holes, distances, pressures = [], [], [], [], []
    with simulated(scene(water, drops, box(4.0, 4.0), 0.0)) as run:
        mass = run.water.particles.read(run.water.particles.mass)[0][0]
        for time in looks(run, (0.0, *TIMES)):
            now = run.snapshot()
            place, velocity, pressed = (now[f"water_{name}"][0] for name in ("position", "velocity", "pressure"))
            turning.append(mass @ (place[:, 0] * velocity[:, 1] - place[:, 1] * velocity[:, 0]))
            if time > 0.0:
                places.append(place)
                pressures.append(in_middle(place, pressed))
                holes.append(widest_gap(place) / water.spacing)
                middle = place[np.hypot(*place.T) < CORE]
                distances.append(cKDTree(middle).query(middle, 2)[0][:, 1].min() / water.spacing)
    flown = start * np.sqrt(1.0 + (RATE * time) ** 2)
    corners = np.hypot(*place[corner].T) / flown
    followed = np.array(pressures)[np.isin(TIMES, FOLLOWED)]
    return Patch(places, np.array(turning) / turning[0], corners, max(holes), min(distances), followed)


def pressure(place: np.ndarray) -> np.ndarray:
    """Pressure (n,) Pa at places (n, 2) m in the patch as it begins to turn, see `solvers.fluid.start.flow`."""
    return -1000.0 * RATE**2 * torsion(0.5 * SIDE * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]), place)


def corner_pull(spacing: float) -> float:
    """Pressure gradient (m) half a spacing (m) from both sides at a corner at first, along a side, over ρ ω².

    Exact, of the sine series of ∇²p = 2 ρ ω² with p = 0 on all sides (Saint-Venant 1855). Near a corner it goes as
    r ln r: free flight is a limit that is reached more slowly than in proportion to the spacing.
    """
    place, k = 0.5 * spacing, np.pi / SIDE * np.arange(1, 2 * TERMS, 2)
    across = (np.exp(-k * place) + np.exp(-k * (SIDE - place))) / (1.0 + np.exp(-k * SIDE))
    return float((8.0 / (SIDE * k**2) * (1.0 - across) * np.cos(k * place)).sum())


def in_middle(place: np.ndarray, pressed: np.ndarray) -> float:
    """Pressure in the middle over ρ ω² L²: of the parabola a + b r² that fits pressures (n,) Pa near it best."""
    square = (place**2).sum(axis=1)
    near = square < MIDST**2
    a, _ = np.linalg.lstsq(np.stack([np.ones(near.sum()), square[near]], axis=1), pressed[near], rcond=None)[0]
    return a / (1000.0 * (RATE * SIDE) ** 2)


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
    found, alone = [turned(count) for count in counts], turned(counts[0], "none")
    best, drift, unshifted = found[-1], *(np.abs(one.turning - 1.0).max() for one in (found[-1], alone))
    wanted = middle_pressure(FOLLOWED)
    lattice = "a square lattice has 0.71"
    free = "free flight: no pressure gradient in a corner"
    sharp = "the corner particle is half a spacing inside, and feels its neighbours' pressure"
    apart = "no particles in pairs"
    flux = "the momentum of a shift is spread over neighbours, whose sums are not exact at the surface"
    sound = "sound of the start, of a twentieth, and the corners, which are half a spacing short"
    spacings = [SIDE / count for count in counts]
    errors = [abs(one.corners.mean() - 1.0) for one in found]
    pressures = [
        Line(f"pressure in the middle at ωt = {time:g}, of ρ ω² L²", value, exact, "potential flow", 0.05, sound)
        for time, value, exact in zip(FOLLOWED, best.middle, wanted, strict=True)
    ]
    lines = [
        Line.off(
            f"angular momentum, unshifted, {counts[0]} across", "kept", unshifted, 1e-3, "pair forces are central"
        ),
        Line.off("angular momentum, shifted", "kept", drift, 1e-2, flux),
        *pressures,
        Line("widest gap in the middle, radius in spacings", best.hole, 0.71, lattice, 0.4, "no voids", relative=False),
        Line("least distance in the middle, in spacings", best.nearest, 1.0, "lattice", 0.5, apart, relative=False),
        Line("corners' distance, of free flight", best.corners.mean(), 1.0, free, 0.1 if fast else 0.05, sharp),
    ]
    more = []
    if not fast:
        pulls = [corner_pull(one) for one in spacings]
        told = f"""The corners come to free flight with an order of {order(spacings, errors):.2f}; that of the pull on
        these particles at first is {order(spacings, pulls):.2f}. Later pulls, in arms that grow thin, are not known, so
        that it is not judged."""
        more.append(told)
    rows = [row(str(count), one) for count, one in zip(counts, found, strict=True)]
    rows.append(row(f"{counts[0]}, unshifted", alone))
    head = "particles across", "angular momentum", "pressure at 0.5", "at 1", "widest gap", "least distance", "corners"
    notes = ["Shifting with its momentum; changes and errors in shares, distances in spacings, corners of free flight."]
    shown = {f"ωt = {time:g}": place for time, place in zip(TIMES[1::2], best.places[1::2], strict=True)}
    picture = Picture("water-patch", shapes(shown, "m"), "The rotating patch; its arms are its corners.")
    return Found(lines, [picture], notes=[*notes, *more], tables=[Table(head, rows)])


def row(name: str, one: Patch) -> tuple[str, ...]:
    """A patch in the table."""
    errors = one.middle / middle_pressure(FOLLOWED) - 1.0
    shares = f"{one.turning[-1] - 1.0:.1e}", *(f"{100.0 * error:.1f} %" for error in errors)
    return name, *shares, f"{one.hole:.2f}", f"{one.nearest:.2f}", f"{one.corners.mean():.3f}"


CASES = (Case("water-patch", SECTION, "A rotating square patch", rotating, quick=False),)
