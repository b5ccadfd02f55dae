"""Shared code for the peer codes: working folder, file with the bed, running them, reading the results."""

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import Literal

import numpy as np

from lab.base.errors import LabError
from solvers.grains.materials import Material

DECK, BED = "deck.in", "bed.data"  # what a peer reads
TRACE, FINAL = (
    "trace.txt",
    "final.txt",
)  # what it writes: step, y, z of the centre of mass; id, y, z, velocities of the grains
SKIN = 0.1  # of the neighbour lists, over the grains' mean diameter
HEADER = 9  # lines of a dump before its rows
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}  # for Open MPI; MPICH needs nothing


# The end of a deck: gravity that turns, the motion, and what is written of it.
MOTION = """\
variable chute equal ramp({lean:.17g},{chute:.17g})
fix gravity all gravity {gravity:.17g} chute v_chute
{shaking}
fix motion all nve/sphere
timestep {dt:.17g}

compute centre all com
variable y equal c_centre[1]
variable z equal c_centre[3]
fix trace all print {every} "$(step) ${{y}} ${{z}}" file {trace} screen no
thermo_style custom step atoms
thermo_modify lost error
thermo 0
run {steps}
"""


@dataclass(frozen=True)
class Shaking:
    """A sideways acceleration of the grains in their tank's axes: peak · sin(omega (since + t)).

    It is what grains feel in a tank at y = A sin(ω t) with peak = A ω² (m/s²), omega = ω (rad/s), since in s.
    """

    peak: float
    omega: float
    since: float = 0.0

    @property
    def lines(self) -> str:
        """The lines of a deck."""
        phase = f"{self.omega:.17g}*({self.since:.17g}+step*dt)"
        return f"variable shake equal {self.peak:.17g}*sin({phase})\nfix shake all gravity v_shake vector 1 0 0"


@dataclass(frozen=True)
class Task:
    """A bed at rest that remembers no earlier contact, and the steps that a peer is to take from it.

    position: (n, 2) centres (y, z), or (n, 3) with x; the floor is z = 0, the walls are y = ± width / 2 (m).
    radius: (n,) (m).
    width, height: inner size of the tank (m).
    along: its length (m) along x, between walls at x = ± along / 2; None of a bed in the plane.
    material: of grains and walls; it must have a restitution.
    dt, steps: time step (s), and how many.
    tilt, tilt_rate: tilt of the tank at the start (rad) and its constant rate (rad/s), counter-clockwise positive.
    velocity: as `position`, of the grains at the start (m/s); None for grains at rest.
    shaking: sideways acceleration in time; None for a tank that stands still.
    gravity: (m/s^2).
    tangential: "history" is spring, dashpot and slider; "no_history" dashpot and slider.
    sample_every: steps from one sample of the trace to the next, the first being t = 0.
    processes: how many share the bed among them through MPI.
    skin: thickness of the skin of the neighbour lists over the grains' mean diameter.
    workdir: folder that keeps deck, bed and log; without it they are thrown away.

    Raises LabError for a material without a restitution.
    """

    position: np.ndarray
    radius: np.ndarray
    width: float
    height: float
    material: Material
    dt: float
    steps: int
    tilt: float = 0.0
    tilt_rate: float = 0.0
    velocity: np.ndarray | None = None
    shaking: Shaking | None = None
    gravity: float = 9.81
    tangential: Literal["history", "no_history"] = "history"
    sample_every: int = 1000
    processes: int = 1
    skin: float = SKIN
    workdir: Path | None = None
    along: float | None = None

    def __post_init__(self):
        if self.material.restitution is None:
            raise LabError("other codes are given their damping by a restitution: give the material one.")

    @property
    def diameter(self) -> float:
        """Mean diameter of the grains (m)."""
        return 2 * float(np.mean(self.radius))

    @property
    def depth(self) -> float:
        """How far (m) a peer's box reaches along our x; grains of the plane have room to either side."""
        return 4 * float(np.max(self.radius)) if self.along is None else self.along

    def fill(self, deck: str, **numbers: object) -> str:
        """A deck, with MOTION at its end but for a dump, with these numbers and those that every deck asks for."""
        return deck.format(
            diameter=self.diameter,
            left=-self.width / 2,
            right=self.width / 2,
            lid=self.height,
            lean=-degrees(self.tilt),
            chute=-degrees(self.tilt + self.tilt_rate * self.steps * self.dt),
            gravity=self.gravity,
            shaking="" if self.shaking is None else self.shaking.lines,
            dt=self.dt,
            every=min(self.sample_every, self.steps),
            steps=self.steps,
            bed=BED,
            trace=TRACE,
            final=FINAL,
            **numbers,
        )


@dataclass(frozen=True)
class PeerRun:
    """The result of a peer code on a bed: its time and the motion of the grains.

    loop_s: wall time of the stepping as the code itself reports it, without set-up (s).
    grain_steps_per_s: grains times steps over that time (1/s).
    time: (T,) instants of the trace (s).
    centre_of_mass: (T, 2) centre of mass of all grains, (y, z) in the tank's frame (m).
    position, velocity: of the grains at the end, in the tank's frame, in the order given and by its axes (m, m/s).
    """

    loop_s: float
    grain_steps_per_s: float
    time: np.ndarray
    centre_of_mass: np.ndarray
    position: np.ndarray
    velocity: np.ndarray


def carry_out(name: str, executable: str, task: Task, deck: str) -> PeerRun:
    """Let a peer do what its deck says. Raises LabError if it is not installed or stops."""
    with working_folder(task.workdir) as folder:
        (folder / BED).write_text(bed_file(task) + moving(task.velocity))
        (folder / DECK).write_text(deck)
        loop_s = execute(name, executable, ["-in", DECK], folder, task.processes)
        return read_outcome(folder, task, loop_s)


@contextmanager
def working_folder(kept: Path | None) -> Iterator[Path]:
    """The folder to work in: the given one, made if need be, or a passing one."""
    if kept is None:
        with tempfile.TemporaryDirectory() as passing:
            yield Path(passing)
    else:
        kept.mkdir(parents=True, exist_ok=True)
        yield kept


def bed_file(task: Task) -> str:
    """The data file: number, kind, diameter (m), density (kg/m³) and place (m) a grain; our y, z, x are its x, z, y."""
    density, half = task.material.density, task.width / 2
    grains = (
        f"{number} 1 {2 * r:.17g} {density:.17g} {_theirs(place)}"
        for number, (place, r) in enumerate(zip(task.position, task.radius, strict=True), start=1)
    )
    return "\n".join(
        (
            "a bed of spheres",
            "",
            f"{len(task.radius)} atoms",
            "1 atom types",
            f"{-half:.17g} {half:.17g} xlo xhi",
            f"{-task.depth / 2:.17g} {task.depth / 2:.17g} ylo yhi",
            f"0 {task.height:.17g} zlo zhi",
            "",
            "Atoms",
            "",
            *grains,
            "",
        )
    )


def moving(velocity: np.ndarray | None) -> str:
    """The data file's section of velocities (n, axes) m/s; nothing where there are none."""
    if velocity is None:
        return ""
    rows = (f"{number} {_theirs(one)} 0 0 0" for number, one in enumerate(velocity, start=1))
    return "\n".join(("", "Velocities", "", *rows, ""))


def _theirs(vector: np.ndarray) -> str:
    """A vector (y, z) or (y, z, x) of ours as a peer reads it."""
    y, z, x = vector if len(vector) == 3 else (*vector, 0.0)
    return f"{y:.17g} {x:.17g} {z:.17g}"


def execute(name: str, executable: str, arguments: Sequence[str], folder: Path, processes: int = 1) -> float:
    """Run a peer in `folder`, each process on one thread; returns the loop time it prints (s).

    Raises LabError if it, or mpirun for several processes, is not installed, or if it stops.
    """
    for needed in (executable, *(["mpirun"] if processes > 1 else [])):
        if shutil.which(needed) is None:
            raise LabError(f"`{needed}` is not on the PATH: install {name}.")
    done = subprocess.run(
        [*_launcher(processes), executable, *arguments],
        cwd=folder,
        env=os.environ | {"OMP_NUM_THREADS": "1"} | AS_ROOT,
        capture_output=True,
        text=True,
        errors="replace",  # it may print stray memory after an error
    )
    loop = re.search(rf"^Loop time of (\S+) on {processes} procs", done.stdout, re.MULTILINE)
    if done.returncode != 0 or loop is None:
        error = re.search(r"^ERROR.*", done.stdout + done.stderr, re.MULTILINE)
        said = error.group() if error else (done.stderr.strip().splitlines() or ["it said nothing"])[0]
        raise LabError(f"{name} stopped: {said}")
    return float(loop.group(1))


def _launcher(processes: int) -> list[str]:
    """The command that starts several processes, each bound to its own core."""
    return ["mpirun", "--bind-to", "core", "-np", str(processes)] if processes > 1 else []


def read_outcome(folder: Path, task: Task, loop_s: float) -> PeerRun:
    """What a run left in its folder."""
    trace = np.loadtxt(folder / TRACE, ndmin=2)
    trace = trace[trace[:, 0] > 0]
    final = np.loadtxt(folder / FINAL, skiprows=HEADER, ndmin=2)
    final = final[np.argsort(final[:, 0])]
    start = np.average(task.position[:, :2], axis=0, weights=np.asarray(task.radius) ** 3)
    axes = np.shape(task.position)[1]
    return PeerRun(
        loop_s=loop_s,
        grain_steps_per_s=len(task.radius) * task.steps / loop_s,
        time=np.append(0.0, trace[:, 0] * task.dt),
        centre_of_mass=np.vstack((start, trace[:, 1:])),
        position=final[:, 1:4][:, :axes],
        velocity=final[:, 4:7][:, :axes],
    )
