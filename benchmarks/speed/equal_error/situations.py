"""The beds on which codes are timed: at rest, flowing in a leaning tank, swayed; from the same places and speeds.

What flows or is swayed begins in motion: the lab moves the settled bed for a while, and all codes go on from there, as
if no grain had touched another before.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.peers.peer import Shaking, Task
from benchmarks.remembered import remembered
from benchmarks.speed.beds import HEIGHT, Bed
from benchmarks.speed.equal_error.steps import GRAINS, LAB, LONGEST, RUNS, SAME, SOFT
from benchmarks.speed.workers import Speeds, Worker, in_turn, workers
from solvers.motion import Sway, Tilt
from solvers.simulation import Simulation

LEAN = np.radians(45.0)
SWAY = Sway(amplitude=0.01, frequency=5.0)  # an acceleration of g
MIXED = "the lab, mixed precision"
SKIN_IN_MOTION = 0.3  # mean diameters, of peers: LAMMPS is a tenth faster than with 0.1 at its longest steps
LONGEST_STRIDE = 2  # of the lab's steps while grains are slow, as in its runs


@dataclass(frozen=True)
class Situation:
    """A bed whose grains have velocities (n, axes) m/s, or rest, and the motion (s since it began) of its tank."""

    bed: Bed
    velocity: np.ndarray | None = None
    motion: Tilt | Sway | None = None
    since: float = 0.0
    peers: Mapping[str, object] = field(default_factory=dict)  # the motion as a peer is told it

    def times(self, number: int) -> "Situation":
        """So many copies side by side in one tank."""
        velocity = None if self.velocity is None else np.tile(self.velocity, (number, 1))
        return replace(self, bed=self.bed.times(number), velocity=velocity)

    @property
    def scene(self) -> dict[str, object]:
        """What the lab is told of the motion."""
        return {} if self.motion is None else {"motions": [(self.motion,)]}


def every_situation(bed: Bed, work: Path) -> dict[str, Situation]:
    """By its words each situation of a settled bed; beds in motion are kept in the folder `work`."""
    leaning = Tilt(1.0, LEAN)
    begun = 1.25 / SWAY.frequency  # at the end of its way
    name = f"{bed.count}" if bed.along is None else f"spheres-{bed.count}"
    flowing = moved(bed, leaning, LEAN, 0.15, work / f"flowing-{name}.npz")
    swayed = moved(bed, SWAY, 0.0, begun, work / f"swayed-{name}.npz")
    omega = 2.0 * np.pi * SWAY.frequency
    shaking = Shaking(SWAY.amplitude * omega**2, omega, begun)
    return {
        "at rest": Situation(bed),
        "in flow": Situation(*flowing, leaning, LEAN, {"tilt": LEAN}),
        "swayed": Situation(*swayed, SWAY, begun, {"shaking": shaking}),
    }


def moved(bed: Bed, motion: Tilt | Sway, since: float, course: float, path: Path) -> tuple[Bed, np.ndarray]:
    """The bed after a `course` (s) of a motion that began `since` (s) ago, and the velocities (n, axes) m/s."""

    def make() -> Mapping[str, np.ndarray]:
        run = Simulation(bed.scene(material=GRAINS, motions=[(motion,)]), bed.places(), threads=1, arch="cpu")
        run.origin = since
        run.advance(round(course / run.dt))
        found = run.snapshot()
        run.close()
        return {name: found[name][0] for name in ("position", "velocity")}

    found = remembered(path, f"moving {bed.count} grains", make)
    return replace(bed, position=found["position"]), found["velocity"]


def timed(one: Situation, rule: str, dts: Mapping[str, float], turns: int, course: float | Callable) -> Speeds:
    """Simulated seconds a wall second (turns,) of each code over a `course` (s), each at its step of `dts` (s).

    `course` may be a function of the step. Where all take the SAME step the lab's never double.
    """
    timings = peers_on(one, dts, course)
    largest_multiple = 1 if rule == SAME else LONGEST_STRIDE
    how = {
        "material": GRAINS,
        "schedule": "per-world",
        "largest_multiple": largest_multiple,
        "origin": one.since,
        **one.scene,
    }
    ours = {LAB: {"step": dts[LAB]}, MIXED: {"step": dts[LAB], "precision": "mixed"}}
    if rule != SAME:
        ours[LONGEST] = {"step": dts[LONGEST]}
    with workers({name: partial(Worker, one.bed, **how, **own) for name, own in ours.items()}) as made:
        for name, worker in made.items():
            dt = ours[name]["step"]
            timings[name] = partial(_seconds, worker, one, length(course, dt), dt)
        return in_turn(timings, turns, warming=0)  # workers are warm, and peers begin anew each time


def _seconds(worker: Worker, one: Situation, course: float, dt: float) -> float:
    return worker.course(course, one.velocity) * dt / one.bed.count


def length(course: float | Callable[[float], float], dt: float) -> float:
    """The course (s) of a code with a step (s)."""
    return course(dt) if callable(course) else course


def peers_on(one: Situation, dts: Mapping[str, float], course: float | Callable) -> dict[str, Callable[[], float]]:
    """Timings of the peers that are installed, in simulated seconds a wall second."""

    def timing(run: Callable, dt: float) -> Callable[[], float]:
        many = max(1, round(length(course, dt) / dt))
        bed = one.bed
        more = {"sample_every": many, "velocity": one.velocity, "along": bed.along, **one.peers}
        if one.velocity is not None:
            more["skin"] = SKIN_IN_MOTION
        task = Task(bed.position, bed.radius, bed.width, HEIGHT, SOFT, dt, many, **more)
        return lambda: run(task).grain_steps_per_s * dt / bed.count

    return {peer.NAME: timing(run, dts[peer.NAME]) for peer, run in RUNS.items() if peer.NAME in dts}
