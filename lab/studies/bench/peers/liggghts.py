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

import shutil
from math import degrees
from pathlib import Path
from typing import Literal

import numpy as np

from lab.base.errors import LabError
from lab.studies.bench.peers.peer import (
    BED,
    DECK,
    FINAL,
    TRACE,
    PeerRun,
    bed_file,
    execute,
    read_outcome,
    working_folder,
)
from solvers.grains.materials import Material

NAME = "LIGGGHTS"
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
read_data {bed}
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
fix trace all print {every} "$(step) ${{y}} ${{z}}" file {trace} screen no
thermo_style custom step atoms
thermo_modify lost error
thermo 0
run {steps}
write_dump all custom {final} id x z modify format "%d %.17g %.17g"
"""


def available() -> str | None:
    """Path of the LIGGGHTS executable, or None if it is not installed."""
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

    Raises LabError if LIGGGHTS is not installed or stops, or the material has no restitution.
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
        bed=BED,
        trace=TRACE,
        final=FINAL,
    )
    with working_folder(workdir) as folder:
        (folder / BED).write_text(bed_file(position, radius, material.density, outline_width, outline_height))
        (folder / DECK).write_text(deck)
        loop_s = execute(NAME, EXECUTABLE, ["-in", DECK], folder)
        return read_outcome(folder, position, radius, dt, steps, loop_s)
