"""Invariance of one scene: mirrored, with all pairs listed, with other schedules, in other precisions."""

from functools import cache

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.frames import scattered
from lab.studies.verify.scenes import ACETATE, Setup, grain, simulated

SECTION = "The same scene in other ways"
STEP, STEPS, SOFT = 1e-5, 4000, 1e-3
# A box with a slanting side, so that left and right differ.
OUTLINE = np.array([[-0.012, 0.0], [0.009, 0.0], [0.02, 0.04], [-0.012, 0.04]])
SWAY = {"amplitude": 0.004, "frequency": 8.0}
EVERY_PAIR = 1.0  # m, a skin wider than the tank
# Rounding of 1e-17 m, grown ten thousandfold by collisions; digits of 32 bits are 2²⁹ times coarser.
ROUNDING, REASON = 1e-13, "rounding, grown 1e4-fold by collisions"
COARSE, COARSE_REASON = 2.0**29 * ROUNDING, "32-bit digits, as rounding grown"
SOURCE_SHIFT = 0.02  # diameters: the source's own deviation between its precisions (Spandonidis 2016, figure 6.2)


def bed(mirrored: bool = False, **run: object) -> Setup:
    """Unequal rough grains that fall into a swayed tank; all from right to left if `mirrored`."""
    radius, place = scattered(5, 8, seed=11)
    side = np.array([-1.0 if mirrored else 1.0, 1.0])
    rows = [grain(y, z, r) for (y, z), r in zip(side * (place - [0.002, 0.0]), radius, strict=True)]
    sway = SWAY | {"phase": np.pi if mirrored else 0.0}
    return Setup(
        np.array(rows),
        ACETATE,
        {"outline": side * OUTLINE},
        contact={"tangential": "mindlin", "stiffness_scale": SOFT},
        motion={"sway": sway},
        run={"step": STEP, "force_step": True, **run},
    )


def told(setup: Setup, **options) -> dict[str, np.ndarray]:
    """The observation of a setup after STEPS: the grains' states and the numbers of its world."""
    with simulated(setup, **options) as run:
        run.advance(STEPS)
        return run.observe() | run.snapshot()


@cache
def usual() -> dict[str, np.ndarray]:
    """The scene as it is told by default."""
    return told(bed())


def apart(found: dict[str, np.ndarray]) -> float:
    """Largest distance (m) of a grain from where it is by default."""
    return float(np.linalg.norm(found["position"] - usual()["position"], axis=-1).max())


def mirror(_: bool) -> Found:
    """The mirrored scene does the mirrored thing."""
    found = told(bed(mirrored=True))
    found["position"] = found["position"] * [-1.0, 1.0]
    turning = np.abs(found["angle"] + usual()["angle"]).max()
    return Found(
        [
            _same("places, mirrored back", apart(found)),
            Line.off("angles", "opposite angles", turning, 1e3 * ROUNDING, REASON, "rad"),
        ]
    )


def every_pair(_: bool) -> Found:
    """Lists of near pairs against a list of all pairs, and the contacts counted by hand."""
    found = told(bed(), skin=EVERY_PAIR)
    radius, place = scattered(5, 8, seed=11)[0], usual()["position"][0]
    counted = touching_pairs(place, radius) + touching_walls(place, radius)
    return Found(
        [
            _same("places, every pair listed", apart(found)),
            Line("contacts", usual()["contacts"][0], counted, "every pair looked at", 0.5, "a number", relative=False),
        ]
    )


def touching_pairs(place: np.ndarray, radius: np.ndarray) -> int:
    """How many of all pairs overlap."""
    distance = np.linalg.norm(place[:, None] - place, axis=-1)
    return int(np.triu(distance < radius[:, None] + radius, 1).sum())


def touching_walls(place: np.ndarray, radius: np.ndarray) -> int:
    """How many grains overlap with how many sides of the OUTLINE."""
    along = np.roll(OUTLINE, -1, axis=0) - OUTLINE
    inwards = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
    distance = ((place[:, None] - OUTLINE) * inwards).sum(axis=-1)
    return int((distance < radius[:, None]).sum())


def schedules(_: bool) -> Found:
    """A world as a whole, in two bands on two cores, and grain by grain."""
    bands, grains = told(bed(schedule="per-band"), threads=2, units=2), told(bed(schedule="per-grain"))
    return Found([_same("places, per-band", apart(bands)), _same("places, per-grain", apart(grains))])


def precisions(_: bool) -> Found:
    """The same in 32 bits, and with places alone in 64."""
    radius = scattered(5, 8, seed=11)[0]
    lines = []
    for precision in ("mixed", "f32"):
        found = told(bed(precision=precision))
        gap = apart(found)
        lines.append(Line.off(f"places, {precision}", "f64", gap, COARSE, COARSE_REASON, "m"))
        shift = (found["centre_of_mass"][..., 0] - usual()["centre_of_mass"][..., 0])[0] / (2.0 * radius.mean())
        source = "f64; Spandonidis (2016): < 2 % of a diameter"
        name = f"centre of mass, {precision}, in diameters"
        lines.append(Line.off(name, source, shift, SOURCE_SHIFT, "as the source's"))
    return Found(lines)


def _same(quantity: str, gap: float) -> Line:
    return Line.off(quantity, "the scene as it is by default", gap, ROUNDING, REASON, "m")


def _case(name: str, title: str, check) -> Case:
    return Case(name, SECTION, title, check, quick=False)


CASES = (
    _case("mirror", "Left and right", mirror),
    _case("every-pair", "Neighbour lists and brute force", every_pair),
    _case("schedules", "The three schedules", schedules),
    _case("precisions", "The three precisions", precisions),
)
