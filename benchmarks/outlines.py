"""cargolab bench outlines: contact rules of irregular grains, by rule and number of nodes: energy error and cost."""

import statistics
import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from benchmarks.bench import Bench
from lab.preset.outline import rectangle
from lab.report.page import Page
from lab.report.plots import BLUE, GREY, VERMILION
from solvers.grains.given import Grains
from solvers.grains.materials import Material
from solvers.grains.shapes.cargo import cargo
from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.given import Shapes
from solvers.scene import Scene
from solvers.simulation import Simulation

RADIUS = 1.5e-3
PAIRS, SPEED = 24, 0.3  # m/s, of each of the two
COLUMNS, ROWS, SETTLING = 10, 10, 0.6  # s
TURNS, STEPS, THROW, THROWN = 5, 2000, 0.5, 0.02  # m/s, s
# Cellulose acetate at a thousandth of its stiffness.
SOFT = Material(density=1319.0, young=3.2e6, poisson=0.28, friction=0.25, restitution=0.6)
LOSSLESS = Material(density=1319.0, young=3.2e6, poisson=0.28, friction=0.0, dissipative_time=0.0)
RULES = (
    ("continuous", None),
    ("nodes", 60),
    ("nodes", 200),
    ("nodes", 500),
    ("area", 60),
    ("area", 200),
    ("area", 500),
)
FEW = RULES[::3]
DISCS = None
COSTS, TICKS = (3.0, 300.0), (5, 10, 20, 50, 100, 200)  # of a step in motion, in the figure
COLOURS = {"continuous": BLUE, "nodes": GREY, "area": VERMILION}


def outlines() -> dict[str, list[Contour]]:
    """The grains that are tried, with the area of a disc of radius 1."""
    random = np.random.default_rng(1)
    return {
        "ellipses, 2 : 1": [Contour.through(_ellipse(2.0**0.5, 0.5**0.5), 60).with_diameter(2.0)],
        "corn": [cargo("corn").outline(random, 2.0) for _ in range(4)],
        "rough discs, 50 lobes of 0.02 mm": [
            Contour(1.0, [0.0] * 49 + [0.02e-3 / RADIUS], [0.0] * 50).with_diameter(2.0)
        ],
    }


def _ellipse(a: float, b: float) -> np.ndarray:
    angle = 2.0 * np.pi / 240 * np.arange(240)
    return a * b / np.hypot(b * np.cos(angle), a * np.sin(angle))


@dataclass(frozen=True)
class Tried:
    """A rule with a number of nodes: relative changes of the pairs' energy, and cost of steps relative to discs."""

    rule: str
    nodes: int | None
    changes: np.ndarray
    rest: float
    thrown: float

    @property
    def name(self) -> str:
        """In words."""
        return self.rule if self.nodes is None else f"{self.rule}, {self.nodes} nodes"


def study(page: Page, work: Path, fast: bool) -> None:
    """Try all rules on all outlines, a section each."""
    kinds = outlines()
    figure = Figure(figsize=(7.2, 3.2), layout="constrained")
    panels = np.atleast_1d(figure.subplots(1, 1 if fast else len(kinds), sharey=True))
    for axes, (name, given) in zip(panels, kinds.items(), strict=False):
        tried = [try_rule(given, rule, nodes) for rule, nodes in (FEW if fast else RULES)]
        page.section(name[0].upper() + name[1:])
        page.table(
            ["rule", "energy, median change", "largest", "cost at rest (discs = 1)", "thrown"],
            [
                [
                    one.name,
                    *(f"{f(one.changes):.1e}" for f in (np.median, np.max)),
                    f"{one.rest:.1f}",
                    f"{one.thrown:.1f}",
                ]
                for one in tried
            ],
        )
        draw(axes, tried, name)
    name_rules(figure)
    page.figure("cost", figure, "Change of energy in a collision against what a step costs, by rule")


def draw(axes, tried: list[Tried], title: str) -> None:
    """Largest change of energy against cost; the larger the mark, the more nodes."""
    for one in tried:
        size = 6.0 if one.nodes is None else 2.0 + one.nodes / 80
        axes.loglog(one.thrown, one.changes.max(), "o", color=COLOURS[one.rule], ms=size)
    axes.set(title=title.replace(", ", "\n"), xlim=COSTS, ylabel="largest change of energy")
    axes.set_xticks(TICKS, [str(cost) for cost in TICKS])
    axes.minorticks_off()
    axes.label_outer()


def name_rules(figure: Figure) -> None:
    """Above all panels what the colours mean, below them what goes across."""
    marks = [Line2D([], [], ls="", marker="o", color=colour, label=rule) for rule, colour in COLOURS.items()]
    figure.supxlabel("cost of a step in motion (discs = 1); the larger a mark, the more nodes", fontsize="medium")
    figure.legend(handles=marks, loc="outside upper center", ncols=len(marks), frameon=False)


def try_rule(given: list[Contour], rule: str, nodes: int | None) -> Tried:
    """Energy and cost of a rule with these outlines."""
    print(f"{rule} {nodes or ''}", flush=True)
    rest, thrown = costs(given, rule, nodes)
    return Tried(rule, nodes, np.abs(collide(given, rule, nodes)), rest, thrown)


def shapes(given: list[Contour], rule: str, nodes: int | None, worlds: int, count: int) -> Shapes:
    """Grains of these outlines at random angles."""
    random = np.random.default_rng(3)
    which = random.integers(0, len(given), (worlds, count))
    return Shapes(tuple(given), which, random.uniform(-np.pi, np.pi, (worlds, count)), rule, nodes or 120)


def collide(given: list[Contour], rule: str, nodes: int | None) -> np.ndarray:
    """By how much the energy of each pair has changed after it met, relative to what it was."""
    random = np.random.default_rng(1)
    reach = max(outline.bounding_radius for outline in given)
    first = np.stack([np.full(PAIRS, -1.03 * reach), random.uniform(-0.4, 0.4, PAIRS)], axis=1) * RADIUS
    place = np.stack([first, -first], axis=1) + np.array([0.0, 0.05])
    velocity = np.zeros_like(place)
    velocity[:, 0, 0], velocity[:, 1, 0] = SPEED, -SPEED
    scene = Scene(
        np.array(rectangle(0.1, 0.1)),
        (
            Grains(
                np.full((PAIRS, 2), RADIUS),
                LOSSLESS,
                LOSSLESS,
                shapes=shapes(given, rule, nodes, PAIRS, 2),
                start_speed=SPEED,
                velocity=velocity,
            ),
        ),
        gravity=0.0,
    )
    run = Simulation(scene, place, threads=1, arch="cpu")
    run.advance(1)
    start = _energy(run)
    run.advance(round(5.0 * RADIUS / SPEED / run.dt))
    change = _energy(run) / start - 1.0
    run.close()
    return change


def _energy(run: Simulation) -> np.ndarray:
    rows = run.observe()
    return rows["kinetic"] + rows["rotational"] + rows["elastic"]


def costs(given: list[Contour], rule: str, nodes: int | None) -> tuple[float, float]:
    """Time of a step of a bed at rest and of one that is thrown, relative to that of discs; medians of runs in turn."""
    run, discs = bed(given, rule, nodes), disc_bed()
    rest, thrown = [], []
    for turn in range(TURNS):
        rest.append(_taken(run, STEPS) / _taken(discs, STEPS))
        aside = THROW * (-1.0) ** turn
        thrown.append(_thrown(run, aside) / _thrown(discs, aside))
        for one in (run, discs):
            one.advance(round(SETTLING / one.dt))
    run.close()
    return statistics.median(rest), statistics.median(thrown)


@cache
def disc_bed() -> Simulation:
    """The bed of discs, at rest."""
    return bed([Contour(1.0)], DISCS, None)


def bed(given: list[Contour], rule: str | None, nodes: int | None) -> Simulation:
    """A bed that has come to rest."""
    width, count = 2.1 * COLUMNS * RADIUS, COLUMNS * ROWS
    pitch = 2.05 * max(outline.bounding_radius for outline in given) * RADIUS
    columns = int(width / pitch)
    site = np.stack(np.divmod(np.arange(count), columns)[::-1], axis=1)
    random = np.random.default_rng(2)
    place = pitch * (site - [0.5 * (columns - 1), -0.6]) + random.uniform(-1e-5, 1e-5, site.shape)
    high = place[:, 1].max() + 2.0 * pitch
    scene = Scene(
        np.array(rectangle(width, high)),
        (
            Grains(
                np.full((1, count), RADIUS),
                SOFT,
                SOFT,
                tangential="mindlin",
                shapes=None if rule is DISCS else shapes(given, rule, nodes, 1, count),
            ),
        ),
        schedule="per-world",
    )
    run = Simulation(scene, place[None], threads=1, arch="cpu")
    run.advance(round(SETTLING / run.dt))
    return run


def _thrown(run: Simulation, speed: float) -> float:
    velocity = np.zeros((*run.scene.grains.radius.shape, 2))
    velocity[..., 0] = speed
    run.launch(velocity)
    return _taken(run, round(THROWN / run.dt))


def _taken(run: Simulation, steps: int) -> float:
    """Seconds a step."""
    begun = time.perf_counter()
    run.advance(steps)
    return (time.perf_counter() - begun) / steps


ABOUT = f"""By rule of contact and nodes of an outline. Energy: {PAIRS} pairs without friction or losses meet off centre
at random angles, each grain at {SPEED:g} m/s and {RADIUS * 2e3:g} mm wide, with a thousandth of acetate's stiffness and
the automatic step; median and largest change of their energy. Cost: a step of a bed of {COLUMNS * ROWS} grains with
losses and Mindlin's friction on one core, that of as many discs being 1, median of {TURNS} runs in turn: at rest, and
while all are thrown at a wall at {THROW:g} m/s."""
BENCH = Bench("outlines", "How irregular grains touch", {"rules": study}, ABOUT)
