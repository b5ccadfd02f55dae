"""Motion of the measured section in the flume's own wave train, and the effect of each term of the model.

There are no grains: the hull alone, free in sway, heave and roll, as in the preset `ship/model-test`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from math import inf, pi, sqrt

import numpy as np

from lab.assembly.scene import vessels
from lab.assembly.ship import FASTEST, FREQUENCIES, SLOWEST, natural_roll
from lab.assembly.ship_tables import stored_table
from lab.preset.find import load
from solvers.ship.hydrostatics import equilibrium, metacentric_height
from solvers.ship.linear import inertia_for_roll, response
from solvers.ship.loads import Floating, floating_in_waves
from solvers.ship.motion import Rig, RollDamping, Ship, remembered, sail, start
from solvers.ship.potential.flume import Flap, fundamental
from solvers.ship.potential.memory import fit_memory
from solvers.ship.potential.radiation import Hydrodynamics, hydrodynamics
from solvers.ship.viscous import COMMON, common_damping, estimated_damping, friction_damping
from solvers.ship.water import Water

PRESET = "ship/model-test"
FLUME = Water(depth=1.0)
FLAP = Flap(0.9, 7.0, 5.0)  # of the authors' set-up: hinge, way to the model, periods of the ramp
LENGTH, WIDTH = 0.586, 0.600  # m, of the model and of the flume
INTERVAL = 0.02  # s; half of it changes the amplitudes by 0.1 %
MEMORY_ORDER = 8
MOTIONS = ("sway", "heave", "roll")


@dataclass(frozen=True)
class Measurement:
    """Waves of a `frequency` (rad/s) and `amplitude` (m), and the amplitudes measured in a `window` (s).

    The window counts from the flap's start. Amplitudes are of sway and heave over the waves' and roll over their
    slope's: `camera`'s are published, those of the `accelerometers` aboard are of the same runs. Of sway they tell only
    where it is not a small part of what gravity does to a sensor that rolls. `calibrated` is the waves' amplitude over
    the nominal, measured without the model.
    """

    frequency: float
    amplitude: float
    window: tuple[float, float]
    camera: tuple[float, float, float]
    accelerometers: tuple[float | None, float, float]
    calibrated: float

    @property
    def title(self) -> str:
        """For a reader."""
        return f"{self.frequency:g} rad/s" + (", 40 mm" if self.amplitude > 0.015 else "")

    @property
    def time(self) -> np.ndarray:
        """Instants (n,) s in the window."""
        return np.arange(self.window[0], self.window[1], INTERVAL)


# Sundsdal, Greco, Hanssen and Lugni (NTNU, 2025), CC0: runs 3012_1, 3031_2, 3041_2, 3061_1, 3101_3, 3102_1, 3111_2 and
# 3142_1; those of 24 mm in height at 5.425 and 7.004 rad/s, done twice, came out alike to 5 % (sway at 5.425: 20 %).
MEASUREMENTS = (
    Measurement(4.143, 0.020, (15.21, 19.76), (0.944, 1.209, 2.248), (None, 1.214, 2.256), 0.976),
    Measurement(5.075, 0.012, (14.64, 20.83), (0.563, 1.544, 6.663), (None, 1.818, 7.165), 1.001),
    Measurement(5.194, 0.012, (14.85, 22.11), (0.348, 1.619, 5.874), (None, 1.840, 6.234), 1.014),
    Measurement(5.425, 0.012, (14.89, 21.84), (0.278, 1.568, 3.252), (None, 1.897, 3.507), 1.001),
    Measurement(7.004, 0.012, (15.52, 25.39), (0.393, 0.307, 0.331), (0.409, 0.356, 0.379), 1.026),
    Measurement(7.004, 0.020, (15.97, 23.15), (0.390, 0.301, 0.331), (0.399, 0.349, 0.380), 1.000),
    Measurement(7.830, 0.012, (16.69, 23.11), (0.290, 0.129, 0.165), (0.335, 0.165, 0.191), 0.991),
    Measurement(9.905, 0.020, (18.81, 23.88), (0.144, 0.020, 0.050), (0.181, 0.024, 0.052), 1.021),
)


@dataclass(frozen=True, eq=False)
class Model:
    """The hull, where she floats (m), her coefficients over frequencies; `roll` (rad) is her lasting heel."""

    ship: Ship
    heave: float
    table: Hydrodynamics
    roll: float = 0.0

    @property
    def water(self) -> Water:
        """The water she floats in."""
        return self.ship.load.water

    def steady(self, frequency: np.ndarray) -> np.ndarray:
        """Amplitudes (n, 3) in small waves that have always been there, as in `Measurement`."""
        found = self._linear(np.asarray(frequency))
        return np.abs(found) / self._per(np.asarray(frequency))

    def small(self, test: Measurement) -> np.ndarray:
        """Amplitudes (3,) in the train's window by linear theory: the responses to its components."""
        waves = self._train(test)
        parts = self._linear(waves.frequency) * waves.amplitude[:, None]
        motion = (np.exp(-1j * np.outer(test.time, waves.frequency)) @ parts).real
        found = fundamental(test.time, motion, test.frequency) / test.amplitude
        return np.abs(found) / self._per(test.frequency)

    def sailed(self, test: Measurement) -> np.ndarray:
        """The same with the section clipped at the waves' slope, its memory and quadratic damping, stepped in time."""
        return self.in_windows(test, [test.window])[0]

    def in_windows(self, test: Measurement, windows: Sequence[tuple[float, float]]) -> np.ndarray:
        """The same (windows, 3) of other windows (s) in one voyage."""
        ship = self.ship
        section, about = ship.load.section, ship.about
        load = floating_in_waves(section, self.water, about, self._train(test), self.table, (self.heave, 0.0))
        ship = replace(ship, load=load, radiation=remembered(self.table, self._memory))
        voyage = sail(ship, start(ship, self.heave, self.roll), INTERVAL, max(end for _, end in windows))
        found = []
        for begin, end in windows:
            inside = (voyage.time >= begin) & (voyage.time <= end + 0.5 * INTERVAL)
            found.append(fundamental(voyage.time[inside], voyage.state[inside, :3], test.frequency) / test.amplitude)
        return np.abs(np.array(found)) / self._per(test.frequency)

    @property
    def _memory(self):
        return _fitted(self.table, self.water.depth == inf)

    def _linear(self, frequency: np.ndarray) -> np.ndarray:
        return response(self.ship, self.ship.load.section, self.water, self.heave, self.table.at(frequency))

    def _per(self, frequency) -> np.ndarray:
        slope = FLUME.wave_number(frequency)
        return np.stack([np.ones_like(slope), np.ones_like(slope), slope], axis=-1)

    def _train(self, test: Measurement):
        return FLAP.train(test.amplitude, test.frequency, FLUME, test.window[1] + 10.0)


@cache
def _fitted(table: Hydrodynamics, deep: bool):
    return fit_memory(table, MEMORY_ORDER, deep)


@cache
def potential_flow() -> Model:
    """The model of the preset without viscous damping."""
    resolved = load(PRESET).resolved
    ship, heave = vessels(resolved)[0].ship, resolved.ship.heave
    ship = replace(ship, damping=RollDamping(), load=ship.load.still)
    return Model(ship, heave, stored_table(ship.load.section, ship.load.water, heave, _grid(heave), ship.about))


def _grid(heave: float) -> np.ndarray:
    """Frequencies (rad/s) of the preset's own table, so that it is not solved twice."""
    unit = sqrt(FLUME.gravity / -heave)
    return np.linspace(SLOWEST * unit, FASTEST * unit, FREQUENCIES)


def usual() -> tuple[Model, Model]:
    """With the least and the most viscous damping of roll that is usual for bare hulls."""
    model = potential_flow()
    low, high = common_damping(*natural_roll(model.ship, model.heave, model.table))
    return damped(model, low), damped(model, high)


def damped(model: Model, damping: RollDamping) -> Model:
    """With another viscous damping of roll."""
    return replace(model, ship=replace(model.ship, damping=damping))


def estimated() -> Model:
    """With Ikeda's eddies and Kato's friction."""
    return damped(potential_flow(), estimated_damping(*_shape(), _roll_frequency()))


def rubbed() -> Model:
    """With Kato's friction alone."""
    return damped(potential_flow(), RollDamping(friction_damping(*_shape(), _roll_frequency())))


def _shape() -> tuple[float, float, float, float]:
    """Breadth, draught, radius of the bilges and height of the axis (m)."""
    model = potential_flow()
    corners = model.ship.load.section.outline
    flat = corners[corners[:, 1] < 1e-6, 0]
    return float(np.ptp(corners[:, 0])), -model.heave, float(corners[:, 0].max() - flat.max()), model.ship.about[1]


def _roll_frequency() -> float:
    model = potential_flow()
    return natural_roll(model.ship, model.heave, model.table)[0]


@dataclass(frozen=True)
class Term:
    """A term, where its range is from, and the amplitudes (3,) with it in a test."""

    name: str
    source: str
    found: Callable[[Measurement], np.ndarray]


def terms() -> list[Term]:
    """One at a time, each beside potential flow in the train."""
    base = potential_flow()
    low, high = usual()
    share, most = (100.0 * value for value in COMMON)
    return [
        Term("skin friction in roll", "Kato (1957)", rubbed().sailed),
        Term("the same and eddies at the bilges", "Ikeda et al. (1978), bilges of 51 mm", estimated().sailed),
        Term(f"{share:g} % of the critical damping of roll", "usual for bare hulls, least", low.sailed),
        Term(f"{share:g} % and quadratic, {most:g} % at 15 deg", "usual for bare hulls, most", high.sailed),
        Term("no dashpots of the rig", "measured, 8.7 N s/m in sway and in heave", _without_dashpots(base).sailed),
        Term("no springs and mass of the rig", "measured, 59.4 N/m and 0.303 kg in sway", _without_springs),
        Term("dry friction of the rig's guides", "0.5 N, the most measured, in sway and heave", _with_guides),
        Term("deep water", "the model has its 1 m", _deep().sailed),
        Term("centre of gravity at 108 mm", "drawing; by the heel test 106", _higher().sailed),
        Term("natural roll of 1.265 s", "measured 1.26; 1.256 by the gyradius", _slower(base).sailed),
        Term("waves as calibrated", "probes without the model, −2 to 3 %", _calibrated),
        Term("water's forces 2.4 % more", "gaps of 7 mm beside the model, at most", _wide(base).sailed),
        Term("lasting heel of 0.4 deg", "camera, mean of the window", _heeled(base).sailed),
    ]


def _without_dashpots(model: Model) -> Model:
    ship = model.ship
    return replace(model, ship=replace(ship, rig=replace(ship.rig, damping=np.zeros(3))))


def _without_springs(test: Measurement) -> np.ndarray:
    """By the ratio in small waves: in high ones a hull without springs drifts away, and her frequency with her."""
    base = potential_flow()
    free = replace(base, ship=replace(base.ship, rig=Rig(damping=base.ship.rig.damping)))
    return base.sailed(test) * free.small(test) / base.small(test)


def _with_guides(test: Measurement) -> np.ndarray:
    """Dry friction F as the dashpot that takes as much of a swing of amplitude a: 4 F/(π ω a)."""
    base = potential_flow()
    sizes = base.sailed(test)[:2] * test.amplitude
    added = np.append(4.0 * 0.5 / LENGTH / (pi * test.frequency * sizes), 0.0)
    rig = replace(base.ship.rig, damping=base.ship.rig.damping + added)
    return replace(base, ship=replace(base.ship, rig=rig)).sailed(test)


def _calibrated(test: Measurement) -> np.ndarray:
    higher = replace(test, amplitude=test.calibrated * test.amplitude)
    return test.calibrated * potential_flow().sailed(higher)


def _deep() -> Model:
    base = potential_flow()
    section, about = base.ship.load.section, base.ship.about
    table = stored_table(section, Water(), base.heave, base.table.frequency, about)
    return replace(base, ship=replace(base.ship, load=Floating(section, Water(), about)), table=table)


def _higher() -> Model:
    base = potential_flow()
    section, centre = base.ship.load.section, (0.0, 0.108)
    table = stored_table(section, base.water, base.heave, base.table.frequency, centre)
    body = replace(base.ship.body, centre=centre)
    return replace(
        base, ship=replace(base.ship, body=body, about=centre, load=Floating(section, base.water, centre)), table=table
    )


def _slower(model: Model) -> Model:
    ship = model.ship
    one = model.table.at([2.0 * pi / 1.265])
    body = inertia_for_roll(ship, ship.load.section, model.water, model.heave, one)
    return replace(model, ship=replace(ship, body=body))


def _wide(model: Model) -> Model:
    share, table = WIDTH / LENGTH, model.table
    scaled = {one.name: share * getattr(table, one.name) for one in fields(table) if one.name != "frequency"}
    return replace(model, table=replace(table, **scaled))


def _heeled(model: Model, heel: float = np.radians(0.4)) -> Model:
    """With her centre of gravity so far off the middle that she lies at a heel (rad)."""
    ship, section = model.ship, model.ship.load.section
    aside = -heel * metacentric_height(section, ship.body.loading, model.water)
    body = replace(ship.body, centre=(aside, ship.body.centre[1]))
    heave, roll = equilibrium(section, body.loading, model.water)
    return replace(model, ship=replace(ship, body=body), heave=heave, roll=roll)


def panel_change(count: int, frequency: Sequence[float]) -> np.ndarray:
    """Largest change (3,) of the steady amplitudes over frequencies by another number of panels."""
    base = potential_flow()
    ship, omega = base.ship, np.asarray(frequency)
    other = hydrodynamics(ship.load.section, base.water, base.heave, omega, about=ship.about, count=count)
    return np.abs(replace(base, table=other).steady(omega) / base.steady(omega) - 1.0).max(axis=0)
