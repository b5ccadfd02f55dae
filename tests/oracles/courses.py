"""Scenes run to their end, with a balance of their energy, and what is asked of any of them."""

from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, replace
from math import ceil

import numpy as np

from solvers.grains.bed.filling import SPACING, radii, start_positions
from solvers.grains.materials import Material, hertz_stiffness
from solvers.machine.errors import BadState
from solvers.machine.limit import furthest
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

RADIUS = 1.5e-3  # m, where nothing else is said
SPREAD = 0.1  # of a bed's diameters, each way
AN_INSTANT = 1e-15  # s, a step in which nothing moves: it lists the contacts that a start has
DEEPEST = 0.05  # radii: a contact of small strain, which Hertz's law is for
IMPACTS = 3.0  # Hertz estimates: grains that push from behind deepen an impact
RESTING_ENERGY = 1e-6  # of the scale: what a scheme of second order errs by in contacts, and rounding
MOVING_ENERGY = 1e-3  # of the scale: the tank's work is a sum over looks
RIPPLE = 0.01  # of the scale: with few steps a contact the scheme's own energy ripples while grains touch
NUDGE = 1e-9  # m


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
    def mass(self) -> np.ndarray:
        """Masses (n,) kg."""
        return 4.0 / 3.0 * np.pi * self.scene.grains.radius[0] ** 3 * self.scene.grains.density[0]

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
    """A trial at its T looks, the first of them before anything moves, or up to where the watch `stopped` it.

    `time` (T,) s; `rows` (T, *shape) of each quantity that is observed, by name; `position` (T, n, 2) m; `energy` (T,)
    J in the earth frame: kinetic with spin, potential and elastic; `work` (T,) J that the tank has done on the grains.
    """

    step: float
    time: np.ndarray
    rows: dict[str, np.ndarray]
    position: np.ndarray
    spin: np.ndarray
    energy: np.ndarray
    work: np.ndarray
    stopped: str | None = None

    def late(self, share: float) -> np.ndarray:
        """Which looks (T,) are in the last share of the run."""
        return self.time > (1.0 - share) * self.time[-1]


def bed(
    count: int,
    duration: float,
    grain: Material | None = None,
    diameter: float = 2.0 * RADIUS,
    across: int = 10,
    looks: int = 200,
    **scene: object,
) -> Trial:
    """Grains let go of on a loose lattice `across` grains wide, in a tank twice as high as that."""
    random = np.random.default_rng(1)
    radius = radii(count, diameter, SPREAD, random)
    pitch = SPACING * diameter * (1.0 + SPREAD)
    outline = box((across + 0.5) * pitch, 2.0 * ceil(count / across) * pitch)
    grain = grain or material()
    return Trial(
        scene_of(radius, outline, grain, grain, **scene),
        start_positions(radius, outline, random),
        duration,
        looks=looks,
    )


def square(columns: int, rows: int, pitch: float) -> np.ndarray:
    """Places (n, 2) m on a square lattice centred on y = 0, the lowest at half a pitch."""
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"))
    return pitch * np.column_stack([column - 0.5 * (columns - 1), row + 0.5])


def wall_stiffness(trial: Trial) -> float:
    """k (N/m^1.5) of a grain and a wall."""
    return hertz_stiffness(trial.scene.grains.interfaces[1].young_modulus, trial.scene.grains.sizes[0])


@contextmanager
def running(trial: Trial):
    """The simulation of a trial, to be followed again and again."""
    run = Simulation(trial.scene, trial.position[None], 1, arch="cpu")
    try:
        yield run
    finally:
        run.close()


def followed(run: Simulation, trial: Trial, step: float) -> Course:
    """Run a trial from its start with steps of `step` s until it ends or the watch stops it."""
    looks, stopped = [], None
    targets = np.unique(np.ceil(np.linspace(0.0, trial.duration / step, trial.looks + 1)[1:]).astype(int))
    try:
        _begin(run, trial, AN_INSTANT)
        run.advance(1)
        looks.append(_look(run))
        _begin(run, trial, step)
        for target in targets:
            run.advance(int(target) - run.steps)
            looks.append(_look(run))
    except BadState as error:
        stopped = error.what
    columns = {name: np.array([look[name] for look in looks]) for name in (looks[0] if looks else ())}
    shown = {name: columns.pop(name, np.zeros(0)) for name in ("time", "position", "spin", "energy")}
    return Course(step, rows=columns, work=_work(shown["time"], columns), stopped=stopped, **shown)


def _begin(run: Simulation, trial: Trial, step: float) -> None:
    run.dt = step
    run.start_clock()
    run.place(trial.position[None], trial.scene.grains.velocity, trial.scene.grains.spin)


def _look(run: Simulation) -> dict[str, np.ndarray]:
    """What is observed now, places and spins, the energy, and the velocity of the tank's origin along its axes."""
    rows = {name: values[0] for name, values in run.observe().items()}
    state = {name: values[0] for name, values in run.snapshot().items()}
    cosine, sine = np.cos(rows["pose"][2]), np.sin(rows["pose"][2])
    rate_y, rate_z, turning = rows["pose_rate"]
    carried = np.array([cosine * rate_y + sine * rate_z, -sine * rate_y + cosine * rate_z])
    y, z = state["position"].T
    velocity = state["velocity"] + carried + turning * np.column_stack([-z, y])
    mass, radius = run.grains.mass[0], run.scene.grains.radius[0]
    kinetic = 0.5 * mass @ (velocity**2).sum(axis=1) + 0.2 * (mass * radius**2) @ (state["spin"] + turning) ** 2
    energy = kinetic + rows["potential"] + rows["elastic"]
    places = {"position": state["position"], "spin": state["spin"]}
    return rows | places | {"time": run.time, "energy": energy, "carried": carried}


def _work(time: np.ndarray, rows: dict[str, np.ndarray]) -> np.ndarray:
    """Work (T,) J of the tank since the first look: mean forces between looks times mean velocities."""
    if len(time) < 2:
        return np.zeros(len(time))
    velocity = np.column_stack([rows["carried"], rows["pose_rate"][:, 2]])
    between = 0.5 * (velocity[:-1] + velocity[1:])
    return np.append(0.0, -np.cumsum(np.diff(time) * (between * rows["wall_force"][1:]).sum(axis=1)))


def overlap_of(scene: Scene, speed: float, load: float) -> float:
    """Hertz's overlap, in radii of the smallest grain, of the hardest impact at `speed` (m/s) and of a `load` (N).

    ξ = ((5/4) m v²/k)^(2/5) (Johnson 1985, eq. 11.22) of the largest grain upon the smallest one, and
    ξ = (F/k)^(2/3); the larger of grain on grain and grain on wall.
    """
    smallest, largest = scene.grains.sizes
    mass = 4.0 / 3.0 * np.pi * largest**3 * scene.grains.density.max()
    deepest = []
    for between, share in zip(scene.grains.interfaces, (0.5, 1.0), strict=True):
        k = hertz_stiffness(between.young_modulus, share * smallest)
        struck = share * mass if smallest == largest else mass
        deepest += [(1.25 * struck * speed**2 / k) ** 0.4, (load / k) ** (2.0 / 3.0)]
    return float(max(deepest)) / smallest


def made_energy(trial: Trial, course: Course) -> float:
    """The largest rise of the energy less the tank's work above any earlier value, as a share of the scale.

    The scale is the energy at the start, weight counted from the tank's lowest point, and the range of the work.
    """
    left = course.energy - course.work
    rise = np.max(left - np.minimum.accumulate(left))
    start = course.energy[0] - course.rows["potential"][0] + trial.weight * trial.height
    return float(rise / (start + np.ptp(course.work)))


def sound(trial: Trial, course: Course, energy: float | None = None) -> None:
    """Nobody escapes, all numbers are numbers, no overlap is too deep, and no energy is made beyond a share.

    The watch sees to the first two. `energy` is the share, if not the usual one.
    """
    assert not course.stopped
    estimate = IMPACTS * overlap_of(trial.scene, trial.scene.credible_speed(), trial.load)
    assert course.rows["overlap"].max() <= min(DEEPEST, estimate)
    usual = MOVING_ENERGY if trial.scene.motions[0] else RESTING_ENERGY
    assert made_energy(trial, course) <= (energy or usual)


def hard(
    trial: Trial,
    measure: Callable[[Course], float] | None = None,
    within: float = 0.0,
    energy: float | None = None,
    starts: int = 1,
) -> Course:
    """The course of a trial at the automatic step, which must be sound.

    At the longest step that may be forced the trial must end in a sentence of the watch, or
    its measure be right within the share `within`, and no energy made beyond a ripple. In a chaotic case the measure is
    a mean over `starts` a nanometre apart, as a single course is as good as a draw.
    """
    with running(trial) as run:
        course = followed(run, trial, trial.scene.time_step())
        sound(trial, course, energy)
        if measure:
            longer = followed(run, trial, furthest(trial.scene.step_limits()))
            if not longer.stopped:
                wanted, found = (_mean(run, trial, one, measure, starts) for one in (course, longer))
                assert abs(found - wanted) <= within * abs(wanted)
                assert made_energy(trial, longer) <= max(RIPPLE, energy or 0.0)
    return course


def _mean(run: Simulation, trial: Trial, course: Course, measure: Callable[[Course], float], starts: int) -> float:
    found = [measure(course)]
    for seed in range(1, starts):
        off = np.random.default_rng(seed).uniform(-NUDGE, NUDGE, trial.position.shape)
        other = followed(run, replace(trial, position=trial.position + off), course.step)
        if not other.stopped:
            found.append(measure(other))
    return sum(found) / len(found)
