"""Speed side by side with LIGGGHTS: the same settled bed, stiffness and step, runs in turn.

    python -m lab.bench.side_by_side [--repeats 7] [--steps 5000]

The machine's speed drifts, so only the ratios of runs made right after one another mean anything. LIGGGHTS
runs Hertz contacts with tangential history; the lab its own Haff–Werner and its history law, all on one core, and
last a batch of worlds on one and two cores.
"""

import time
from dataclasses import replace

import click
import numpy as np

from lab.bench.peers.liggghts import available, run_liggghts
from solvers.filling import radii, start_positions
from solvers.materials import Material
from solvers.scene import Scene
from solvers.simulation import Simulation

COUNT, DIAMETER, SPREAD = 2000, 3e-3, 0.1
WIDTH, HEIGHT = 0.192, 0.2
SCALE = 1e-3
ACETATE = Material(density=1319.0, young=3.2e9, poisson=0.28, friction=0.25, restitution=0.6)
LAWS = ("haff-werner", "mindlin")


def tank() -> np.ndarray:
    """Outline (4, 2) m of the tank."""
    return np.array([[-WIDTH / 2, 0.0], [WIDTH / 2, 0.0], [WIDTH / 2, HEIGHT], [-WIDTH / 2, HEIGHT]])


def scene(radius: np.ndarray, law: str, worlds: int = 1) -> Scene:
    """The bed of `radius` (n,) m under a tangential law, in as many equal worlds."""
    radius = np.tile(radius, (worlds, 1))
    return Scene(radius, tank(), ACETATE, ACETATE, tangential=law, stiffness_scale=SCALE)


def settled_bed() -> tuple[np.ndarray, np.ndarray]:
    """Positions (n, 2) and radii (n,) in m of a bed at rest."""
    random = np.random.default_rng(1)
    radius = radii(COUNT, DIAMETER, SPREAD, random)
    simulation = Simulation(scene(radius, "mindlin"), start_positions(radius, tank(), random)[None], threads=1)
    simulation.settle(rest=1e-8, limit=3.0)
    position = simulation.snapshot()["position"][0]
    simulation.close()
    return position, radius


def timed(simulation: Simulation, steps: int) -> float:
    """Grain-steps a second over `steps` steps."""
    begun = time.perf_counter()
    simulation.advance(steps)
    return steps * simulation.scene.radius.size / (time.perf_counter() - begun)


def against_liggghts(position: np.ndarray, radius: np.ndarray, repeats: int, steps: int) -> dict[str, np.ndarray]:
    """Grain-steps a second (repeats,) of LIGGGHTS and of each law, one core, in turn."""
    runs = {law: Simulation(scene(radius, law), position[None], threads=1) for law in LAWS}
    peer = replace(ACETATE, young=ACETATE.young * SCALE)
    speeds: dict[str, list[float]] = {"LIGGGHTS": [], **{law: [] for law in LAWS}}
    for run in runs.values():
        run.advance(steps)  # compiles, and lets the bed meet its law
    for _ in range(repeats):
        dt = runs[LAWS[0]].dt
        speeds["LIGGGHTS"].append(run_liggghts(position, radius, WIDTH, HEIGHT, peer, dt, steps).grain_steps_per_s)
        for law, run in runs.items():
            speeds[law].append(timed(run, steps))
    for run in runs.values():
        run.close()
    return {name: np.array(values) for name, values in speeds.items()}


def batch(position: np.ndarray, radius: np.ndarray, worlds: int, repeats: int, steps: int) -> dict[int, float]:
    """Median grain-steps a second of a batch on one and on two threads."""
    found = {}
    for threads in (1, 2):
        run = Simulation(scene(radius, "mindlin", worlds), np.tile(position, (worlds, 1, 1)), threads)
        run.advance(steps)
        found[threads] = float(np.median([timed(run, steps) for _ in range(repeats)]))
        run.close()
    return found


@click.command()
@click.option("--repeats", default=7, show_default=True, help="Runs of each code, in turn.")
@click.option("--steps", default=5000, show_default=True, help="Steps a run.")
def main(repeats: int, steps: int) -> None:
    """Print grain-steps a second and the ratios to LIGGGHTS run by run."""
    position, radius = settled_bed()
    if available() is None:
        click.echo("LIGGGHTS is not installed (Debian package liggghts): only the batch is timed.")
    else:
        speeds = against_liggghts(position, radius, repeats, steps)
        for name, values in speeds.items():
            ratio = values / speeds["LIGGGHTS"]
            click.echo(
                f"{name:<12} {np.median(values) / 1e6:6.1f} M grain-steps/s   ratio {np.median(ratio):.2f} "
                f"({ratio.min():.2f} to {ratio.max():.2f})"
            )
    found = batch(position, radius, 8, repeats, max(1, steps // 4))
    click.echo(
        f"8 worlds     {found[1] / 1e6:.1f} M on one core, {found[2] / 1e6:.1f} M on two: {found[2] / found[1]:.2f}"
    )


if __name__ == "__main__":
    main()
