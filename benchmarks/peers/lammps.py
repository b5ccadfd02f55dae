"""The peer code LAMMPS (Thompson et al. 2022; www.lammps.org) on a bed of ours, timed and traced.

Its grains are spheres in two dimensions and in three; the run is in three, with every grain of the plane at zero
depth, as LIGGGHTS', and as fast as in two. In a tilt not the tank turns but gravity, which leaves out the centrifugal
and Euler accelerations.

The contact law is `gran/hertz/history`, the faster of its granular styles, with the overlap d, effective radius R* and
mass m*, shear displacement s: a normal force √(R* d) (K_n d + m* γ_n ḋ), not below zero (`limit_damping`); a tangential
√(R* d) (K_t s + m* γ_t ṡ), cut at Coulomb's limit. K_n = 4/3 E*, K_t = 8 G*. That is our viscoelastic law, with a
dissipative time A = m* γ_n/(1.5 K_n) that depends on the mass: γ_n and γ_t are set for two mean grains, and for one and
a wall, so that their restitution is the material's at its restitution speed. s is stored, not the force.

Without history it is `gran/hooke`, the only classic style that has none: a linear spring as stiff as the Hertz contact
under half the bed's weight on a mean grain, with the material's restitution at every speed, and a tangential dashpot
under Coulomb's limit, as strong as our Haff–Werner law takes at once (`splitting.AT_ONCE`).

Choices for speed, tried on 2000 grains of 3 mm within 10 %, at rest and in flow: grains sorted in space in bins of a
diameter, a skin of a tenth of the mean diameter, `newton on`, lists rebuilt only when a grain has crossed half the
skin, processes side by side along the bed. A skin half or twice as thick, no sorting (the bed comes in order), `newton
off` and two dimensions changed the median speed by less than a tenth, no more than it changes by itself. With the
longest steps that hold an error, a skin three times as thick is a tenth faster in flow (`speed.equal_error`).
"""

import shutil
from math import pi

import numpy as np

from benchmarks.peers.peer import MOTION, PeerRun, Task, carry_out
from solvers.grains.laws.splitting import AT_ONCE
from solvers.grains.materials import Interface, hertz_stiffness, interface
from solvers.space.impact import damping_ratio_for

NAME = "LAMMPS"
EXECUTABLE = "lmp"
STYLES = {"history": "hertz/history", "no_history": "hooke"}

_DECK = """\
atom_style sphere
atom_modify map array sort 1000 {diameter:.17g}
boundary f f f
newton on
comm_modify vel yes
units si
processors * 1 1
read_data {bed}
neighbor {skin:.17g} bin
neigh_modify delay 0 every 1 check yes

pair_style gran/{style} {grains}
pair_coeff * *
fix sides all wall/gran {style} {walls} xplane {left:.17g} {right:.17g}
fix ends all wall/gran {style} {walls} zplane 0 {lid:.17g}
{fronts}
"""
_FRONTS = "fix fronts all wall/gran {style} {walls} yplane -{half:.17g} {half:.17g}\n"  # of a tank in space
_DUMP = """\
write_dump all custom {final} id x z y vx vz vy modify sort id format float %.17g
"""


def available() -> str | None:
    """Path of the LAMMPS executable, or None if it is not installed."""
    return shutil.which(EXECUTABLE)


def run_lammps(task: Task) -> PeerRun:
    """Let LAMMPS do a task. Raises LabError if it is not installed or stops."""
    grains, walls = _models(task)
    style = STYLES[task.tangential]
    told = {"style": style, "grains": grains, "walls": walls}
    told["fronts"] = "" if task.along is None else _FRONTS.format(half=task.along / 2, **told)
    deck = task.fill(_DECK + MOTION + _DUMP, skin=task.skin * task.diameter, **told)
    return carry_out(NAME, EXECUTABLE, task, deck)


def _models(task: Task) -> list[str]:
    """The contact laws' numbers between two mean grains, and between one and a wall."""
    material, radius = task.material, task.diameter / 2
    mass = 4 / 3 * pi * radius**3 * material.density
    found = []
    for m_eff, r_eff in ((mass / 2, radius / 2), (mass, radius)):
        between = interface(material, material, m_eff, r_eff, 1.0)
        if task.tangential == "history":
            numbers = _hertz_history(between, m_eff)
        else:
            rows = np.ptp(np.atleast_2d(task.position)[:, 1]) / (2 * radius)
            load = mass * task.gravity * (1 + rows / 2)
            numbers = _hooke(between, m_eff, r_eff, load, task.dt)
        found.append(" ".join(f"{number:.17g}" for number in (*numbers, material.friction)) + " 1 limit_damping")
    return found


def _hertz_history(between: Interface, mass: float) -> tuple[float, float, float, float]:
    """K_n, K_t (Pa), γ_n, γ_t (1/(m s)) for an effective mass (kg)."""
    normal, shear = 4 / 3 * between.young_modulus, 8 * between.shear_modulus
    time = between.dissipative_time
    return normal, shear, 1.5 * time * normal / mass, time * shear / mass


def _hooke(between: Interface, mass: float, radius: float, load: float, dt: float) -> tuple[float, float, float, float]:
    """K_n, K_t (N/m), γ_n, γ_t (1/s) for an effective mass (kg) and radius (m) under a load (N); K_t is not used."""
    spring = load ** (1 / 3) * hertz_stiffness(between.young_modulus, radius) ** (2 / 3)
    damping = 2 * damping_ratio_for(between.restitution) * (spring / mass) ** 0.5
    return spring, spring, damping, AT_ONCE * 2 / 7 / dt
