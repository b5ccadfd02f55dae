"""The step that each code takes: the same for all, or the longest that holds an error of the restitution.

The error is found by measurement: pairs of grains meet head-on, their contacts beginning at moments spread over a step,
and rebound with a speed that is compared with that at FINEST steps a collision. So each code is compared with the limit
of its own law.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from benchmarks.peers import lammps, liggghts
from benchmarks.peers.peer import Task
from benchmarks.speed.beds import ACETATE, DIAMETER, HEIGHT, SCALE, Bed
from lab.base.errors import LabError
from lab.preset.accuracy import LEVELS
from solvers.machine.limit import furthest
from solvers.scene import Scene
from solvers.simulation import Simulation

RUNS = {liggghts: liggghts.run_liggghts, lammps: lammps.run_lammps}
LAB = "the lab"
LONGEST = "the lab, longest step"  # that may be forced, not only derived
SAME = "the lab's at standard"  # what all codes' steps are set by where they are equal
LEVEL_OF = {0.01: "draft", 0.001: "standard"}  # error of the restitution, the largest over the moments of onset
SPEED, PAIRS = 0.3, 24  # m/s; meeting pairs, each beginning 1/PAIRS of a step later than the one before
# A collision, of those tried: each at most a fifteenth more than the one before, or one more
STEPS = tuple(dict.fromkeys(round(6.0 * 1.066**k) for k in range(69)))
FINEST = 3000
GRAINS = replace(ACETATE, restitution_speed=SPEED)
SOFT = replace(GRAINS, young=GRAINS.young * SCALE)  # as a peer is told the material


def steps_taken(codes: Mapping[str, Callable], bed: Bed) -> dict[str, dict[str, float]]:
    """The step (s) of each code, and of the lab as LONGEST, by the rule that it follows from, on such a bed."""
    usual = derived_step("standard", bed.along)
    found = {SAME: dict.fromkeys([*codes, LONGEST], usual)}
    for error, level in LEVEL_OF.items():
        longest = {name: longest_step(code, error) for name, code in codes.items()}
        forced = min(longest[LAB], furthest(_scene(bed.along).step_limits()))
        own = {LAB: min(longest[LAB], derived_step(level, bed.along)), LONGEST: forced}
        found[f"{100.0 * error:g} % of restitution"] = longest | own
    return found


def duration() -> float:
    """Time (s) that two of the grains touch as they meet at SPEED, losses aside (Hertz; Timoshenko & Goodier 1951)."""
    mass = 0.5 * SOFT.density * np.pi / 6.0 * DIAMETER**3
    young = SOFT.young / (2.0 * (1.0 - SOFT.poisson**2))
    return 2.87 * (mass**2 / (0.25 * DIAMETER * young**2 * SPEED)) ** 0.2


def longest_step(rebounds: Callable[[float], np.ndarray], error: float) -> float:
    """The longest step (s) of those tried at which, and at all shorter ones, rebounds err by at most `error`.

    Raises LabError if they err by more at the shortest.
    """
    limit, found = float(np.mean(rebounds(duration() / FINEST))), 0.0
    for share in reversed(STEPS):
        if np.abs(rebounds(duration() / share) / limit - 1.0).max() > error:
            break
        found = duration() / share
    if not found:
        raise LabError(f"a code's restitution errs by more than {error:g} at {STEPS[-1]} steps a collision.")
    return found


def derived_step(level: str, along: float | None = None) -> float:
    """The step (s) that the lab derives at a level of accuracy for collisions at SPEED, in a tank `along` (m) long."""
    return _scene(along).longest_step(LEVELS[level].longer_steps)


def _scene(along: float | None = None) -> Scene:
    pair = Bed(np.full(2, 0.5 * DIAMETER), np.zeros((2, 2 if along is None else 3)), HEIGHT, along)
    return pair.scene(material=GRAINS, gravity=0.0, start_speed=SPEED)


def colliders() -> dict[str, Callable[[float], np.ndarray]]:
    """How pairs rebound (PAIRS,), m/s, at a step (s) of each code that is installed."""
    found: dict[str, Callable[[float], np.ndarray]] = {LAB: rebounds_here}
    for peer, run in RUNS.items():
        if peer.available() is not None:
            found[peer.NAME] = partial(rebounds_there, run)
    return found


def meeting(dt: float) -> tuple[Bed, np.ndarray, int]:
    """Pairs in a row that meet at SPEED, their velocities (n, 2) m/s, and steps of dt (s) until they have parted."""
    apart = 4.0 * DIAMETER
    left = apart * (np.arange(PAIRS) - 0.5 * PAIRS)
    gap = SPEED * dt * (2.0 + np.arange(PAIRS) / PAIRS)
    position = np.full((PAIRS, 2, 2), 0.5 * HEIGHT)
    position[:, 0, 0], position[:, 1, 0] = left, left + DIAMETER + gap
    velocity = np.zeros((PAIRS, 2, 2))
    velocity[:, 0, 0] = SPEED
    bed = Bed(np.full(2 * PAIRS, 0.5 * DIAMETER), position.reshape(-1, 2), apart * (PAIRS + 2))
    return bed, velocity.reshape(-1, 2), round(4.0 * duration() / dt) + 10


def parted(velocity: np.ndarray) -> np.ndarray:
    """Speeds (PAIRS,) at which the pairs part, from the velocities (n, 2) of all grains, m/s."""
    pairs = velocity.reshape(PAIRS, 2, 2)[..., 0]
    return pairs[:, 1] - pairs[:, 0]


def rebounds_here(dt: float) -> np.ndarray:
    """The lab's rebounds."""
    bed, velocity, steps = meeting(dt)
    scene = bed.scene(material=GRAINS, gravity=0.0, step=dt, start_speed=SPEED)
    run = Simulation(scene, bed.places(), threads=1, arch="cpu")
    run.launch(velocity[None])
    run.advance(steps)
    found = parted(run.snapshot()["velocity"][0])
    run.close()
    return found


def rebounds_there(run: Callable, dt: float) -> np.ndarray:
    """A peer's rebounds."""
    bed, velocity, steps = meeting(dt)
    task = Task(bed.position, bed.radius, bed.width, HEIGHT, SOFT, dt, steps, velocity=velocity, gravity=0.0)
    return parted(run(task).velocity)
