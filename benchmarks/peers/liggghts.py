"""The peer code LIGGGHTS-PUBLIC 3.8 (www.cfdem.com) on a bed of ours, timed and traced.

In its `dimension 2` grains have the mass of discs. So the run is in three dimensions with every
grain of the plane at zero depth: nothing pushes a grain out of that plane, and its mass is a sphere's. Our
(y, z) are LIGGGHTS' (x, z), our x its y. In a tilt not the tank turns but gravity; that leaves out the
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

from benchmarks.peers.peer import MOTION, PeerRun, Task, carry_out

NAME = "LIGGGHTS"
EXECUTABLE = "liggghts"

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
{fronts}
"""
_FRONT = "fix {name} all wall/gran {model} primitive type 1 yplane {place:.17g}\n"  # an end wall of a tank in space
_DUMP = """\
write_dump all custom {final} id x z y vx vz vy modify format "%d %.17g %.17g %.17g %.17g %.17g %.17g"
"""


def available() -> str | None:
    """Path of the LIGGGHTS executable, or None if it is not installed."""
    return shutil.which(EXECUTABLE)


def run_liggghts(task: Task) -> PeerRun:
    """Let LIGGGHTS do a task, on one process. Raises LabError if it is not installed or stops."""
    material, model = task.material, f"model hertz tangential {task.tangential}"
    ends = {} if task.along is None else {"front": -task.along / 2, "back": task.along / 2}
    fronts = "".join(_FRONT.format(name=name, model=model, place=place) for name, place in ends.items())
    deck = task.fill(
        _DECK + MOTION + _DUMP,
        skin=task.skin * task.diameter,
        young=material.young,
        poisson=material.poisson,
        restitution=material.restitution,
        friction=material.friction,
        model=model,
        fronts=fronts,
    )
    return carry_out(NAME, EXECUTABLE, task, deck)
