"""The peer code LIGGGHTS-PUBLIC 3.8 (www.cfdem.com) on a bed of ours, timed and traced.

In its `dimension 2` grains have the mass of discs. So the run is in three dimensions with every
grain at zero depth: nothing pushes a grain out of that plane, and its mass is a sphere's. Our
(y, z) are LIGGGHTS' (x, z). In a tilt not the tank turns but gravity; that leaves out the
centrifugal and Euler accelerations, negligible at a slow rate.

Its contact law, with E*, G*, R*, m* effective for the pair, overlap d and shear displacement s: a
normal force 4/3 E* sqrt(R* d) d with a dashpot 2 sqrt(5/6) b sqrt(2 E* sqrt(R* d) m*), where
b = -ln e / sqrt(ln^2 e + pi^2) makes the restitution e the given one at every impact speed, as
grains may attract while they part; a tangential spring 8 G* sqrt(R* d) s with a dashpot alike, cut
at Coulomb's limit. The displacement s is stored, not the force.

Choices for speed, tried on 2000 grains of 3 mm within 10 %, on one core, at rest and in flow:

- a skin of a tenth of the mean diameter. One a third as thick was up to a tenth faster at rest but
  a sixth slower in flow, where it rebuilds the lists three times as often; one three times as
  thick was slower at rest and no faster in flow;
- grains sorted in space, in bins of a diameter: a fifth faster at rest than grains in random order;
- lists rebuilt only when a grain has crossed half the skin; a box closed in depth, so that no grain
  has an image; thermodynamic output at both ends only; one process, one thread.

`newton off` is no choice: the contact history demands it.
"""

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import Literal

import numpy as np

from lab.errors import LabError
from solvers.materials import Material

EXECUTABLE = "liggghts"
SKIN = 0.1
"""Thickness of the skin of the neighbour lists over the grains' mean diameter."""

_DECK = """\
atom_style granular
atom_modify map array sort 1000 {diameter:.17g}
boundary f f f
newton off
communicate single vel yes
units si
soft_particles yes
read_data bed.data
neighbor {skin:.17g} bin
neigh_modify delay 0 every 1 check yes

fix young all property/global youngsModulus peratomtype {young:.17g}
fix poisson all property/global poissonsRatio peratomtype {poisson:.17g}
fix restitution all property/global coefficientRestitution peratomtypepair 1 {restitution:.17g}
fix friction all property/global coefficientFriction peratomtypepair 1 {friction:.17g}
pair_style gran {model}
pair_coeff * *
fix left all wall/gran {model} primitive type 1 xplane {left:.17g}
fix right all wall/gran {model} primitive type 1 xplane {right:.17g}
fix floor all wall/gran {model} primitive type 1 zplane 0
fix lid all wall/gran {model} primitive type 1 zplane {lid:.17g}

variable chute equal ramp(0,{chute:.17g})
fix gravity all gravity {gravity:.17g} chute v_chute
fix motion all nve/sphere
timestep {dt:.17g}

compute centre all com
variable y equal c_centre[1]
variable z equal c_centre[3]
fix trace all print {every} "$(step) ${{y}} ${{z}}" file trace.txt screen no
thermo_style custom step atoms
thermo_modify lost error
thermo 0
run {steps}
write_dump all custom final.txt id x z modify format "%d %.17g %.17g"
"""


@dataclass(frozen=True)
class PeerRun:
    """What a peer code made of a bed: how long it took and where the grains went.

    loop_s: wall time of the stepping as the code itself reports it, without set-up (s).
    grain_steps_per_s: grains times steps over that time (1/s).
    time: (T,) instants of the trace (s).
    centre_of_mass: (T, 2) centre of mass of all grains, (y, z) in the tank's frame (m).
    position: (n, 2) grains at the end, (y, z) in the tank's frame, in the order given (m).
    """

    loop_s: float
    grain_steps_per_s: float
    time: np.ndarray
    centre_of_mass: np.ndarray
    position: np.ndarray


def available() -> str | None:
    """Path of the LIGGGHTS executable, or None where it is not installed."""
    return shutil.which(EXECUTABLE)


def run_liggghts(
    position: np.ndarray,
    radius: np.ndarray,
    outline_width: float,
    outline_height: float,
    material: Material,
    dt: float,
    steps: int,
    *,
    tilt_rate: float = 0.0,
    gravity: float = 9.81,
    tangential: Literal["history", "no_history"] = "history",
    sample_every: int = 1000,
    workdir: Path | None = None,
) -> PeerRun:
    """Let LIGGGHTS take `steps` steps from a bed at rest that remembers no earlier contact.

    position: (n, 2) centres (y, z); the floor is z = 0, the walls are y = ± outline_width / 2 (m).
    radius: (n,) (m).
    outline_width, outline_height: inner size of the tank (m).
    material: of grains and walls; it must have a restitution.
    dt: time step (s).
    tilt_rate: constant rate of the tank, counter-clockwise positive (rad/s).
    gravity: (m/s^2).
    tangential: "history" is spring, dashpot and slider; "no_history" dashpot and slider.
    sample_every: steps from one sample of the trace to the next, the first being t = 0.
    workdir: folder that keeps deck, bed and log; without it they are thrown away.

    Raises LabError where LIGGGHTS is not installed or stops, or the material has no restitution.
    """
    if material.restitution is None:
        raise LabError("LIGGGHTS damps contacts by a restitution: give the material one.")
    diameter = 2 * float(np.mean(radius))
    deck = _DECK.format(
        diameter=diameter,
        skin=SKIN * diameter,
        young=material.young,
        poisson=material.poisson,
        restitution=material.restitution,
        friction=material.friction,
        model=f"model hertz tangential {tangential}",
        left=-outline_width / 2,
        right=outline_width / 2,
        lid=outline_height,
        chute=-degrees(tilt_rate * steps * dt),
        gravity=gravity,
        dt=dt,
        every=min(sample_every, steps),
        steps=steps,
    )
    with _folder(workdir) as folder:
        bed = _bed(position, radius, material.density, outline_width, outline_height)
        (folder / "bed.data").write_text(bed)
        (folder / "deck.in").write_text(deck)
        loop_s = _execute(folder)
        trace = np.loadtxt(folder / "trace.txt", ndmin=2)
        final = np.loadtxt(folder / "final.txt", skiprows=9, ndmin=2)
    start = np.average(position, axis=0, weights=np.asarray(radius) ** 3)
    return PeerRun(
        loop_s=loop_s,
        grain_steps_per_s=len(radius) * steps / loop_s,
        time=np.append(0.0, trace[:, 0] * dt),
        centre_of_mass=np.vstack((start, trace[:, 1:])),
        position=final[np.argsort(final[:, 0]), 1:],
    )


@contextmanager
def _folder(workdir: Path | None) -> Iterator[Path]:
    """The folder to work in: the given one, made if need be, or a passing one."""
    if workdir is None:
        with tempfile.TemporaryDirectory() as passing:
            yield Path(passing)
    else:
        workdir.mkdir(parents=True, exist_ok=True)
        yield workdir


def _bed(position: np.ndarray, radius: np.ndarray, density: float, width: float, height: float) -> str:
    """LIGGGHTS' data file: number, kind, diameter (m), density (kg/m^3) and x, y, z (m) a grain."""
    depth = 4 * float(np.max(radius))
    grains = (
        f"{number} 1 {2 * r:.17g} {density:.17g} {y:.17g} 0 {z:.17g}"
        for number, ((y, z), r) in enumerate(zip(position, radius, strict=True), start=1)
    )
    return "\n".join(
        (
            "a bed of spheres in the plane y = 0",
            "",
            f"{len(radius)} atoms",
            "1 atom types",
            f"{-width / 2:.17g} {width / 2:.17g} xlo xhi",
            f"{-depth / 2:.17g} {depth / 2:.17g} ylo yhi",
            f"0 {height:.17g} zlo zhi",
            "",
            "Atoms",
            "",
            *grains,
            "",
        )
    )


def _execute(folder: Path) -> float:
    """Run the deck in `folder` on one thread; return the loop time LIGGGHTS prints (s)."""
    executable = available()
    if executable is None:
        raise LabError(f"`{EXECUTABLE}` is not on the PATH: install LIGGGHTS 3.8.")
    done = subprocess.run(
        [executable, "-in", "deck.in"],
        cwd=folder,
        env=os.environ | {"OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        errors="replace",  # it may print stray memory after an error
    )
    loop = re.search(r"^Loop time of (\S+) on 1 procs", done.stdout, re.MULTILINE)
    if done.returncode != 0 or loop is None:
        error = re.search(r"^ERROR.*", done.stdout, re.MULTILINE)
        raise LabError(f"LIGGGHTS stopped: {error.group() if error else done.stderr.strip()}")
    return float(loop.group(1))
