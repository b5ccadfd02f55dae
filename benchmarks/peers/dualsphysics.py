"""The peer code DualSPHysics 5 (Domínguez et al. 2022; dual.sphysics.org), on processors, on a pool of ours.

Its own tool for cases, GenCase, is not needed: the case is two files, an XML with the numbers and a .bi4 with the
particles, which are written here. The water's plane is its (x, z) at y = 0.

Models, the nearest to ours that it has: Wendland's kernel with the same smoothing length, artificial viscosity with the
same α, the diffusion of density of Fourtakas et al. (2019) with the same δ = 0.1 (Antuono's it has not), Tait's
equation of state with γ = 7 and the same speed of sound. Time step by its own default, 0.2 of the time in which sound
crosses h; Verlet's scheme, one force evaluation a step.

Walls: `dbc`, its dynamic boundary particles, in one layer half a spacing behind the wall: the cheapest that it can, and
what its users take first. `mdbc`, its modified ones (English et al. 2022), extrapolates density to as many layers as
the kernel reaches, at rest. Walls of later versions that slip freely are other templates, which not every build
has; a build without them lets water fall freely.

Built from its source by `make -f Makefile_cpu COMPILE_CHRONO=NO COMPILE_WAVEGEN=NO COMPILE_MOORDYNPLUS=NO
USE_NATIVE_CPU_OPTIMIZATIONS=YES` (-O3 -ffast-math -march=native). `JSphCpu.cpp` alone makes some two thousand instances
of its templates and compiles for the better part of an hour; of those that its `Interaction_Forces_ct` functions choose
from, this case needs one kernel, one viscosity, no floating bodies, no shifting, `MDBC2_None`.

Its time is the `Simulation Runtime` it prints, without loading; its processor time is the whole process's, in the
same proportion.
"""

import re
import shutil
import subprocess
from collections.abc import Iterable
from os import times
from pathlib import Path
from typing import Literal
from xml.etree import ElementTree

import numpy as np

from benchmarks.peers.bi4 import BOOL, DOUBLE3, TEXT, UINT, ULLONG, Item, read_file, write_file
from benchmarks.peers.peer import working_folder
from benchmarks.peers.pool import (
    Frame,
    Pool,
    PoolRun,
    tait_density,
    tait_pressure,
    wall_densities,
    wall_particles,
)
from lab.base.errors import LabError

NAME = "DualSPHysics"
EXECUTABLES = "DualSPHysics5.4CPU_linux64", "DualSPHysicsCPU_linux64", "dualsphysics"
EXPONENT = 7  # γ of its equation of state
COURANT = 0.2
CASE, OUT = "pool", "out"
INT, FLOAT, DOUBLE, FLOAT3 = 7, 11, 12, 22
PRINTED = "Total Runtime", "Simulation Runtime", "Steps of simulation"
Walls = Literal["dbc", "mdbc"]


def available() -> str | None:
    """Path of the DualSPHysics executable for processors, or None if it is not on the PATH."""
    return next(filter(None, map(shutil.which, EXECUTABLES)), None)


def run_dualsphysics(pool: Pool, walls: Walls = "dbc") -> PoolRun:
    """Let DualSPHysics follow a pool. Raises LabError if it is not installed or stops."""
    executable = available()
    if executable is None:
        raise LabError(f"`{EXECUTABLES[0]}` is not on the PATH: install {NAME}.")
    with working_folder(pool.workdir) as folder:
        bound = _write_case(folder, pool, walls)
        options = [f"-ompthreads:{pool.threads}", "-sv:binx", "-svres:0", "-svtimers:0"]
        before = times()
        done = subprocess.run(
            [executable, "-cpu", CASE, OUT, *options], cwd=folder, capture_output=True, text=True, errors="replace"
        )
        after, said = times(), done.stdout + done.stderr
        numbers = [re.search(rf"^{words}\.*: *([\d.,]+)", said, re.MULTILINE) for words in PRINTED]
        if done.returncode != 0 or None in numbers:
            raise LabError(f"{NAME} stopped: {said.strip()[-400:]}")
        whole, loop_s, steps = (float(number.group(1).replace(",", "")) for number in numbers)
        busy = after.children_user + after.children_system - before.children_user - before.children_system
        frames = list(_frames(folder / OUT, pool, bound))
    ran = frames[-1].time - frames[0].time
    return PoolRun(loop_s, busy * loop_s / whole, int(steps), ran, len(pool.position), frames)


def _write_case(folder: Path, pool: Pool, walls: str) -> int:
    """Write both files; returns the number of wall particles."""
    layers = 1 if walls == "dbc" else int(np.ceil(2.0 * pool.smoothing))
    wall, nearest = wall_particles(pool, layers)
    place = np.zeros((len(wall) + len(pool.position), 3))
    place[:, [0, 2]] = np.concatenate([wall, pool.position])
    velocity = np.zeros_like(place)
    velocity[len(wall) :, [0, 2]] = pool.velocity
    density = np.concatenate([wall_densities(pool, wall), tait_density(pool, EXPONENT)])
    arrays = {
        "Idp": (UINT, np.arange(len(place))),
        "Posd": (DOUBLE3, place),
        "Vel": (FLOAT3, velocity),
        "Rhop": (FLOAT, density),
    }
    if walls == "mdbc":
        normal = np.zeros((len(wall), 3))
        normal[:, [0, 2]] = nearest - wall
        arrays["BoundNor"] = (FLOAT3, normal)
    low, high = place.min(axis=0), place.max(axis=0)
    values = {
        "Piece": (UINT, 0),
        "Npiece": (UINT, 1),
        "CaseName": (TEXT, CASE),
        "Data2d": (BOOL, 1),
        "Data2dPosY": (DOUBLE, 0.0),
        "MapPosMin": (DOUBLE3, np.zeros(3)),
        "MapPosMax": (DOUBLE3, np.zeros(3)),
        "PeriMode": (INT, -1),
        **{f"Peri{axis}inc": (DOUBLE3, np.zeros(3)) for axis in "XYZ"},
        "CaseNp": (ULLONG, len(place)),
        "CaseNfixed": (ULLONG, len(wall)),
        "CaseNmoving": (ULLONG, 0),
        "CaseNfloat": (ULLONG, 0),
        "CaseNfluid": (ULLONG, len(pool.position)),
        "CasePosMin": (DOUBLE3, low),
        "CasePosMax": (DOUBLE3, high),
        "NpDynamic": (BOOL, 0),
        "ReuseIds": (BOOL, 0),
        **{name: (DOUBLE, value) for name, value in _constants(pool).items()},
    }
    part = Item("PART_0000", {"Cpart": (UINT, 0), "TimeStep": (DOUBLE, 0.0), "Npok": (UINT, len(place))}, arrays)
    write_file(folder / f"{CASE}.bi4", Item("JPartDataBi4", values, {}, [part]))
    _write_xml(folder / f"{CASE}.xml", pool, len(wall), walls)
    return len(wall)


def _constants(pool: Pool) -> dict[str, float]:
    """The numbers that both files tell, by the names in the .bi4."""
    return {
        "Dp": pool.spacing,
        "H": pool.length,
        "B": pool.density * pool.sound_speed**2 / EXPONENT,
        "Rhop0": pool.density,
        "Gamma": float(EXPONENT),
        "MassBound": pool.particle_mass,
        "MassFluid": pool.particle_mass,
    }


def _write_xml(path: Path, pool: Pool, bound: int, walls: str) -> None:
    case = ElementTree.Element("case", app="Cargo Shift Lab")
    execution = ElementTree.SubElement(case, "execution")
    constants = ElementTree.SubElement(execution, "constants")
    for name, value in {"data2d": "true", "data2dposy": 0.0, "cflnumber": COURANT}.items():
        ElementTree.SubElement(constants, name, value=str(value))
    ElementTree.SubElement(constants, "gravity", x="0", y="0", z=f"{-pool.gravity:.17g}")
    for name, value in _constants(pool).items():
        ElementTree.SubElement(constants, name.lower(), value=f"{value:.17g}")
    fluid = len(pool.position)
    counts = {"np": bound + fluid, "nb": bound, "nbf": bound, "mkboundfirst": 11, "mkfluidfirst": 1}
    particles = ElementTree.SubElement(execution, "particles", {name: str(count) for name, count in counts.items()})
    ElementTree.SubElement(particles, "fixed", mkbound="0", mk="11", begin="0", count=str(bound))
    ElementTree.SubElement(particles, "fluid", mkfluid="0", mk="1", begin=str(bound), count=str(fluid))
    parameters = ElementTree.SubElement(execution, "parameters")
    chosen = {
        "StepAlgorithm": 1,  # Verlet
        "Kernel": 2,
        "ViscoTreatment": 1,
        "Visco": pool.alpha,
        "DensityDT": 3,
        "DensityDTvalue": pool.delta,
        "Boundary": {"dbc": 1, "mdbc": 2}[walls],
        "SlipMode": 1,
        "TimeMax": pool.seconds,
        "TimeOut": pool.every,
        "SavePosDouble": 1,
    }
    for name, value in chosen.items():
        ElementTree.SubElement(parameters, "parameter", key=name, value=str(value))
    ElementTree.ElementTree(case).write(path, encoding="UTF-8", xml_declaration=True)


def _frames(out: Path, pool: Pool, bound: int) -> Iterable[Frame]:
    """The frames of a run; particles that left it are missing."""
    for path in sorted(out.glob("data/Part_*.bi4")):
        part = read_file(path).items[0]
        arrays = {name: values for name, (_, values) in part.arrays.items()}
        water = np.flatnonzero(arrays["Idp"] >= bound)
        water = water[np.argsort(arrays["Idp"][water])]
        place = arrays["Posd" if "Posd" in arrays else "Pos"][water]
        density = arrays["Rhop"][water].astype(float)
        yield Frame(
            float(part.values["TimeStep"][1]),
            place[:, [0, 2]].astype(float),
            arrays["Vel"][water][:, [0, 2]].astype(float),
            tait_pressure(pool, density, EXPONENT),
        )
