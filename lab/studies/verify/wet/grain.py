"""A grain that falls in water at rest, beside its own law of drag."""

from dataclasses import dataclass, replace

import numpy as np

from lab.studies.case import Case, Found, Line, Table
from lab.studies.verify.water.scenes import box, looks, resting
from lab.studies.verify.water.scenes import simulated as alone_in_water
from lab.studies.verify.wet.disturbance import Disturbance, alone
from lab.studies.verify.wet.scenes import HEAVY, SIZE, advance, as_found, glass, simulated, solid_area, wet
from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS
from solvers.grains.given import Grains
from solvers.mixture.given import Mixture

SECTION = "Wet cargo: drag"
WIDTH, DEPTH, FROM = 0.2, 0.3, 0.22  # m: the tank, and the height that the grain falls from
SOUND = 24.0  # m/s: the water 80 mm down is denser by 0.14 %
CALM, LASTS, EVERY = 3.0, 0.2, 4e-3  # s: water before the grain is let go, its fall, and looks at it
SOFT = 1e-5  # of the stiffness: it meets nothing
# Particles' spacing and the slab's thickness in diameters, the tank's width in WIDTH.
SETTINGS = ((2.0, 1.0, 1.0), (3.0, 1.0, 1.0), (4.0, 1.0, 1.0), (2.0, 20.0, 1.0), (2.0, 1.0, 2.0))


@dataclass(frozen=True)
class Fall:
    """Mean speeds (T,) m/s between looks: as computed, by the law alone, and by the law in water that it disturbs."""

    found: np.ndarray
    alone: np.ndarray
    disturbed: np.ndarray

    def off(self, exact: np.ndarray) -> np.ndarray:
        """Errors (T,) in shares of the law's last speed."""
        return (self.found - exact) / self.alone[-1]


def at_rest(water: Water, outline: np.ndarray) -> np.ndarray:
    """Particles (1, n) of a water alone that has come to rest; it is made viscous until then."""
    with alone_in_water(resting(replace(water, alpha=0.5), outline, DEPTH)) as run:
        list(looks(run, [CALM]))
        return as_found(run.water, run.time)


def fall(across: float, thick: float, wide: float) -> Fall:
    """A grain let go in such a setting, see SETTINGS."""
    water, place = Water(across * SIZE, SOUND, alpha=0.02), np.array([[[0.0, FROM]]])
    outline = box(wide * WIDTH, DEPTH + 4.0 * water.spacing)
    drops = at_rest(water, outline)
    away = np.linalg.norm(drops["position"][0] - place[0], axis=1)
    kernel = KERNELS[water.kernel].printed(np.minimum(away, water.reach), water.length)
    drops["volume"] *= 1.0 - solid_area(SIZE, thick * SIZE) * np.where(away < water.reach, kernel, 0.0)
    grains = Grains(np.full((1, 1), 0.5 * SIZE), glass(), glass(), stiffness_scale=SOFT)
    scene = wet(outline, grains, water, drops, Mixture(), thickness=thick * SIZE)
    times, ways = [0.0], [0.0]
    with simulated(scene, place, drops) as run:
        while run.time < LASTS:
            advance(run, run.time + EVERY)
            times.append(run.time)
            ways.append(FROM - run.snapshot()["position"][0, 0, 1])
    times = np.array(times)
    tracks = ways, alone(times, SIZE, HEAVY)[0], Disturbance(SIZE, HEAVY, water, thick * SIZE).fallen(times)[0]
    return Fall(*(np.diff(way) / np.diff(times) for way in tracks))


def largest(errors: np.ndarray) -> float:
    """The error farthest from zero."""
    return float(errors[np.abs(errors).argmax()])


def falling(fast: bool) -> Found:
    """Glass of 4 mm from rest to 99 % of its last speed, 0.37 m/s."""
    settings = SETTINGS[:1] if fast else SETTINGS
    falls = [fall(*setting) for setting in settings]
    why = "1 % of the last speed: sums over a lattice, and half a step of the water by which lift leads, 0.2 to 0.5 %"
    lines, table = [], []
    for (across, thick, wide), one in zip(settings, falls, strict=True):
        name = f"speed at any time, of the last: water {across:g} d apart, slab of {thick:g} d"
        name += ", a tank twice as wide" if wide > 1.0 else ""
        if thick > 1.0:
            lines.append(Line.off(name, "the law alone", largest(one.off(one.alone)), 0.01, why))
        else:
            told = "the law in water that the grain disturbs"
            lines.append(Line.off(name, told, largest(one.off(one.disturbed)), 0.01, why))
        found = one.off(one.alone), one.off(one.disturbed)
        told = largest((one.disturbed - one.alone) / one.alone[-1])
        errors = largest(found[0]), told, largest(found[1])
        table.append((f"{across:g} d", f"{thick:g} d", f"{wide * WIDTH:g} m", *(f"{100.0 * x:+.2f} %" for x in errors)))
    note = """In a slab as thick as the grain its share of the room about it is up to 1.8 %, and it falls too slowly: by
    the porosity that it sees, by the flow back of what it displaces and by the pressure of what it pulls along; its
    wake has it fall faster, later. To the first order this follows from the kernel and the slab alone, and nothing is
    fitted (`Disturbance`). With water 2 d apart it is more than the 1 % that the law alone would be asked for. In a
    slab twenty times as thick there is a twentieth of it."""
    head = "water's spacing", "slab", "tank", "largest error, law alone", "told by its disturbance", "beside both"
    return Found(lines, notes=[note], tables=[Table(head, table)])


CASES = (Case("wet-grain", SECTION, "A grain that falls in water", falling),)
