"""Run a scene to its end, with a balance of its energy and the work done by the tank's motion."""

from dataclasses import dataclass, field

import numpy as np

from solvers.grains.materials import hertz_stiffness
from solvers.machine.errors import BadState
from solvers.scene import Scene
from solvers.simulation import Simulation

AN_INSTANT = 1e-15  # s, a step in which nothing moves: it lists the contacts that a start has


@dataclass(frozen=True)
class Trial:
    """A scene of one world, its grains' places (n, 2) m at the start, and how long (s) it runs.

    `load` (N) is the largest weight that a contact carries at rest; `looks` counts the times at which it is looked at.
    """

    scene: Scene
    position: np.ndarray
    duration: float
    load: float = 0.0
    looks: int = 200

    @property
    def count(self) -> int:
        """Number of grains."""
        return self.scene.radius.shape[1]

    @property
    def mass(self) -> np.ndarray:
        """Masses (n,) kg."""
        return 4.0 / 3.0 * np.pi * self.scene.radius[0] ** 3 * self.scene.density[0]

    @property
    def weight(self) -> float:
        """Weight (N) of all grains."""
        return float(self.mass.sum() * self.scene.gravity)

    @property
    def height(self) -> float:
        """Height (m) of the centre of mass above the tank's lowest point at the start."""
        return float(self.mass @ self.position[:, 1] / self.mass.sum() - self.scene.outline[:, 1].min())


@dataclass(frozen=True)
class Course:
    """What came of a trial at its T looks, the first of them before anything moves.

    `time` (T,) s; `rows` (T, *shape) of each quantity that is observed, by name; `position` (T, n, 2) m; `energy` (T,)
    J in the earth frame: kinetic with spin, potential and elastic; `work` (T,) J that the tank has done on the grains;
    `stopped` what the watch said, if it stopped the run.
    """

    step: float
    time: np.ndarray
    rows: dict[str, np.ndarray]
    position: np.ndarray
    spin: np.ndarray
    energy: np.ndarray
    work: np.ndarray
    stopped: str | None = None

    def last(self, name: str) -> np.ndarray:
        """A quantity at the last look."""
        return self.rows[name][-1]


@dataclass
class _Look:
    """The tank and its grains at one time; `carried` (2,) m/s is the velocity of the tank's origin along its axes."""

    time: float
    rows: dict[str, np.ndarray]
    position: np.ndarray
    spin: np.ndarray
    kinetic: float
    carried: np.ndarray = field(repr=False)

    @property
    def energy(self) -> float:
        """Energy (J) in the earth frame."""
        return self.kinetic + self.rows["potential"] + self.rows["elastic"]


def follow(run: Simulation, trial: Trial, step: float) -> Course:
    """Run a trial from its start with steps of `step` s until it ends or the watch stops it."""
    looks, work, stopped = [], [0.0], None
    targets = np.unique(np.ceil(np.linspace(0.0, trial.duration / step, trial.looks + 1)[1:]).astype(int))
    try:
        _begin(run, trial, AN_INSTANT)
        run.advance(1)
        looks.append(_look(run))
        _begin(run, trial, step)
        for target in targets:
            run.advance(int(target) - run.steps)
            looks.append(_look(run))
            work.append(work[-1] + _work(looks[-2], looks[-1]))
    except BadState as error:
        stopped = error.what
    return Course(
        step=step,
        time=np.array([look.time for look in looks]),
        rows={name: np.array([look.rows[name] for look in looks]) for name in (looks[0].rows if looks else ())},
        position=np.array([look.position for look in looks]),
        spin=np.array([look.spin for look in looks]),
        energy=np.array([look.energy for look in looks]),
        work=np.array(work[: len(looks)]),
        stopped=stopped,
    )


def overlap_of(scene: Scene, speed: float, load: float) -> float:
    """Hertz's overlap, in radii of the smallest grain, of the hardest impact at `speed` (m/s) and of a `load` (N).

    ξ = ((5/4) m v²/k)^(2/5) (Johnson 1985, eq. 11.22) of the largest grain upon the smallest one, and
    ξ = (F/k)^(2/3); the larger of grain on grain and grain on wall.
    """
    smallest, largest = scene.sizes
    mass = 4.0 / 3.0 * np.pi * largest**3 * scene.density.max()
    deepest = []
    for between, share in zip(scene.interfaces, (0.5, 1.0), strict=True):
        k = hertz_stiffness(between.young_modulus, share * smallest)
        struck = share * mass if smallest == largest else mass
        deepest += [(1.25 * struck * speed**2 / k) ** 0.4, (load / k) ** (2.0 / 3.0)]
    return float(max(deepest)) / smallest


def _begin(run: Simulation, trial: Trial, step: float) -> None:
    run.dt = step
    run.start_clock()
    run.place(trial.position[None], trial.scene.velocity, trial.scene.spin)


def _look(run: Simulation) -> _Look:
    """Raises BadState from the watch."""
    rows = {name: values[0] for name, values in run.observe().items()}
    state = {name: values[0] for name, values in run.snapshot().items()}
    cosine, sine = np.cos(rows["pose"][2]), np.sin(rows["pose"][2])
    rate_y, rate_z, turning = rows["pose_rate"]
    carried = np.array([cosine * rate_y + sine * rate_z, -sine * rate_y + cosine * rate_z])
    y, z = state["position"].T
    velocity = state["velocity"] + carried + turning * np.column_stack([-z, y])
    mass, radius = run.grains.mass[0], run.scene.radius[0]
    kinetic = 0.5 * mass @ (velocity**2).sum(axis=1) + 0.2 * (mass * radius**2) @ (state["spin"] + turning) ** 2
    return _Look(run.time, rows, state["position"], state["spin"], float(kinetic), carried)


def _work(before: _Look, after: _Look) -> float:
    """Work (J) of the tank on its grains between two looks: its mean forces times its mean velocities."""
    rows, passed = after.rows, after.time - before.time
    carried = 0.5 * (before.carried + after.carried)
    turning = 0.5 * (before.rows["pose_rate"][2] + rows["pose_rate"][2])
    return -passed * float(carried @ rows["wall_force"][:2] + turning * rows["wall_force"][2])
