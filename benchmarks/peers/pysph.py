"""The peer code PySPH (Ramachandran et al. 2021; pysph.readthedocs.io) on a pool of ours, in an environment of its own.

PySPH is found by its command `pysph`, whose interpreter runs the script below: it reads the pool from a file and writes
its times. Its scheme is WCSPH with δ-SPH, Wendland's kernel (`WendlandQuintic`, which is C2), Tait's equation of state
with γ = 7, its PEC integrator with one force evaluation a step, and as many layers of boundary particles as the kernel
reaches. Step: 0.25 h/c0, as its examples of collapsing columns. Pressures of its frames are those of their densities.
"""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np

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

NAME, EXECUTABLE = "PySPH", "pysph"
EXPONENT, COURANT = 7, 0.25
GIVEN, FOUND, FRAMES = "pool.npz", "found.json", "frames.npz"
SCRIPT = """\
import json, resource, time
import numpy as np
pool = np.load("pool.npz")
number = {name: float(pool[name]) for name in ("dx", "h", "rho0", "c0", "alpha", "g", "dt", "tf", "every", "threads")}
from pysph.base.kernels import WendlandQuintic
from pysph.base.utils import get_particle_array
from pysph.solver.application import Application
from pysph.sph.scheme import WCSPHScheme


class Tank(Application):
    def keep(self, time):
        water = self.particles[0]
        frames.append([time, *(water.get(key).copy() for key in ("x", "y", "u", "v", "rho"))])

    def pre_step(self, solver):
        if number["every"] < number["tf"] and solver.t >= (len(frames) - 1e-6) * number["every"]:
            self.keep(solver.t)
        if len(begun) == 0 and solver.count >= 5:  # after the first steps, to warm up
            begun.extend([solver.count, solver.t, time.perf_counter(), resource.getrusage(resource.RUSAGE_SELF)])

    def create_particles(self):
        made = []
        for name in ("fluid", "boundary"):
            a = {key: pool[name + "_" + key] for key in ("x", "y", "u", "v", "rho", "m")}
            made.append(get_particle_array(name=name, h=number["h"], **a))
        self.scheme.setup_properties(made)
        return made

    def create_scheme(self):
        scheme = WCSPHScheme(["fluid"], ["boundary"], dim=2, rho0=number["rho0"], c0=number["c0"], h0=number["h"],
                             hdx=number["h"] / number["dx"], gamma=7.0, alpha=number["alpha"], beta=0.0,
                             gy=-number["g"], delta_sph=True, delta=0.1)
        scheme.configure_solver(kernel=WendlandQuintic(dim=2), dt=number["dt"], tf=number["tf"], pfreq=10**9,
                                adaptive_timestep=False)
        return scheme


begun, frames = [], []
app = Tank(fname="tank", output_dir="out")
cores = ["--openmp"] if number["threads"] > 1 else []
app.run(["--no-adaptive-timestep", "--max-steps", "1000000000", "--logfile", "log", *cores])
after, end = time.perf_counter(), resource.getrusage(resource.RUSAGE_SELF)
count, t, before, use = begun
busy = end.ru_utime + end.ru_stime - use.ru_utime - use.ru_stime
app.keep(app.solver.t)
np.savez("frames.npz", **dict(zip(("time", "x", "y", "u", "v", "rho"), map(np.array, zip(*frames)))))
with open("found.json", "w") as out:
    json.dump({"loop_s": after - before, "busy_s": busy, "steps": app.solver.count - count,
               "seconds": app.solver.t - t}, out)
"""


def available() -> str | None:
    """Path of PySPH's command, or None if it is not on the PATH."""
    return shutil.which(EXECUTABLE)


def run_pysph(pool: Pool) -> PoolRun:
    """Let PySPH follow a pool. Raises LabError if it is not installed or stops."""
    command = available()
    if command is None:
        raise LabError(f"`{EXECUTABLE}` is not on the PATH: install {NAME}.")
    with working_folder(pool.workdir) as folder:
        np.savez(folder / GIVEN, **_arrays(pool))
        (folder / "tank.py").write_text(SCRIPT)
        done = subprocess.run(
            [Path(command).with_name("python"), "tank.py"],
            cwd=folder,
            env=os.environ | {"OMP_NUM_THREADS": str(pool.threads)},
            capture_output=True,
            text=True,
            errors="replace",
        )
        if done.returncode != 0 or not (folder / FOUND).is_file():
            raise LabError(f"{NAME} stopped: {done.stderr.strip()[-400:]}")
        found = json.loads((folder / FOUND).read_text())
        frames = _frames(folder / FRAMES, pool)
    return PoolRun(particles=len(pool.position), frames=frames, **found)


def _frames(path: Path, pool: Pool) -> list[Frame]:
    """What the script kept: at the start and after each `every`, where that is less than the whole, and at the end."""
    with np.load(path) as kept:
        place, velocity = (np.stack([kept[one], kept[other]], axis=-1) for one, other in ("xy", "uv"))
        pressure = tait_pressure(pool, kept["rho"], EXPONENT)
        return [Frame(*one) for one in zip(kept["time"].tolist(), place, velocity, pressure, strict=True)]


def _arrays(pool: Pool) -> dict[str, object]:
    """What the script reads: particles of water and of walls, and the numbers."""
    wall, _ = wall_particles(pool, int(np.ceil(2.0 * pool.smoothing)))
    water = tait_density(pool, EXPONENT)
    columns = {
        "fluid": (pool.position, pool.velocity, water),
        "boundary": (wall, np.zeros_like(wall), wall_densities(pool, wall)),
    }
    given = {"dx": pool.spacing, "h": pool.length, "rho0": pool.density, "c0": pool.sound_speed, "alpha": pool.alpha}
    given |= {"g": pool.gravity, "dt": COURANT * pool.length / pool.sound_speed, "tf": pool.seconds}
    given |= {"every": pool.every, "threads": pool.threads}
    for name, (place, velocity, density) in columns.items():
        for key, values in zip("xyuv", (*place.T, *velocity.T), strict=True):
            given[f"{name}_{key}"] = values
        given[f"{name}_rho"], given[f"{name}_m"] = density, np.full(len(place), pool.particle_mass)
    return given
