"""Side by side with LIGGGHTS and LAMMPS: how the centre of mass of the same beds shifts as they are tilted."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks.peers import lammps, liggghts
from benchmarks.peers.peer import Task
from benchmarks.remembered import remembered
from benchmarks.speed.beds import ACETATE, DIAMETER, HEIGHT, SCALE, Bed, settled_bed
from lab.measures.value import over_worlds
from lab.report.numbers import mean_within, plus_minus
from lab.report.page import Page
from lab.report.plots import BELOW, BLUE, GREEN, VERMILION
from solvers.grains.materials import Material
from solvers.motion import Tilt
from solvers.simulation import Simulation

IMPACT = 0.1  # m/s, of grains in a slide: where all codes have the same restitution
GRAINS = replace(ACETATE, restitution_speed=IMPACT)
LAB = "the lab"
COLOURS = {LAB: BLUE, liggghts.NAME: VERMILION, lammps.NAME: GREEN}
DOUBLED = "the lab, steps doubled while slow"  # as its runs have it, and not as the other codes
EVERY = 0.05  # deg, of tilt between two samples
LOOKED_AT = 5.0, 15.0, 25.0  # deg, of slow tilts
APART = 0.1  # d: where two curves have parted


@dataclass(frozen=True)
class Tilting:
    """Beds with a number of grains in a tank of a width (m), tilted at a rate (deg/s) to an angle (deg)."""

    beds: int = 4
    count: int = 300
    width: float = 0.12
    rate: float = 10.0
    angle: float = 40.0


@dataclass(frozen=True)
class Curve:
    """Tilts (T,) in deg and the shift downhill (T,) of the centre of mass along the floor, in mean diameters."""

    tilt: np.ndarray
    shift: np.ndarray

    def first_diameter(self) -> float:
        """The tilt (deg) at which the shift first reaches one diameter; NaN if it never does."""
        beyond = np.flatnonzero(self.shift >= 1.0)
        return float(self.tilt[beyond[0]]) if len(beyond) else float("nan")

    def at(self, angle: float) -> float:
        """The shift at a tilt (deg)."""
        return float(np.interp(angle, self.tilt, self.shift))

    def parts_from(self, other: "Curve") -> float:
        """The tilt (deg) from which the two shifts are more than APART apart; the last one if they never are."""
        apart = np.abs(self.shift - np.interp(self.tilt, other.tilt, other.shift))
        beyond = np.flatnonzero(apart > APART)
        return float(self.tilt[beyond[0] if len(beyond) else -1])


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    how = Tilting(beds=2, count=100, width=0.06, rate=100.0) if fast else Tilting()
    page.section("Curves of a tilt beside other codes")
    codes = followers()
    for name in COLOURS:
        if name not in codes:
            page.say(f"{name} is not installed here: its curves are left out.")
    beds = [settled_bed(work, how.count, how.width, seed) for seed in range(1, how.beds + 1)]
    found = all_kept(work, codes, how, beds)
    page.say(f"""{how.beds} beds of {how.count} grains, 3 mm ± 10 %, in a tank {1e3 * how.width:g} mm wide, tilted at
        {how.rate:g} deg/s, with the history law and {SCALE:g} of the stiffness, from the same settled places without
        contact history, at the same step. The lab turns the tank, and eases its rate in over {Tilt.ease:g} s; in the
        other codes gravity turns. Restitution is {GRAINS.restitution:g} at {IMPACT:g} m/s in all three: the lab's and
        LAMMPS's viscoelastic law loses more at faster impacts, LIGGGHTS' the same at all. LIGGGHTS' grains may attract
        while they part; the others' do not. The lab keeps the tangential history as a force, the others as a
        displacement.""")
    page.table(["bed", *(f"{name}: first d at (deg)" for name in codes), *_parting_heads(codes)], _rows(found))
    page.say(f"""First d: the tilt at which the centre of mass has first shifted by one diameter. Apart: the tilt at
        which a curve is first more than {APART:g} d off the lab's. Up to the first slip the codes agree; after it a bed
        is chaotic, and only means over beds can be compared.""")
    page.figure("curves", plotted(found), "Shift of the centre of mass against the tilt, by code and bed")


def study_slow(page: Page, work: Path, fast: bool) -> None:
    """Add the section on slow tilts to the page: whether the codes' shifts differ by more than chance."""
    how = Tilting(2, 100, 0.06, 100.0, 26.0) if fast else Tilting(12, 150, 0.06, 5.0, 26.0)
    page.section("Slow tilts beside other codes")
    codes = {**followers(), DOUBLED: partial(followed_here, largest_multiple=2)}
    beds = [settled_bed(work, how.count, how.width, seed) for seed in range(1, how.beds + 1)]
    found = all_kept(work, codes, how, beds)
    page.say(f"""As above, but {how.beds} beds of {how.count} grains in a tank {1e3 * how.width:g} mm wide, tilted at
        {how.rate:g} deg/s. The shift of the centre of mass, in thousandths of a diameter, less that of the lab in the
        same bed with the same step; means over the beds with their [95 % intervals]. The first column is the lab's
        shift itself.""")
    page.table(["tilt (deg)", *(f"{name}{' less the lab' * (name != LAB)}" for name in codes)], _apart(found))


def _apart(found: Mapping[str, list[Curve]]) -> list[list[str]]:
    """A row an angle: the lab's shift, and how much more each other code shifts, over the beds."""
    rows = []
    for angle in LOOKED_AT:
        shift = {name: 1e3 * np.array([one.at(angle) for one in curves]) for name, curves in found.items()}
        told = [values if name == LAB else values - shift[LAB] for name, values in shift.items()]
        means = (over_worlds(values, "1") for values in told)
        rows.append([f"{angle:g}", *(mean_within(one.value, one.interval, 1) for one in means)])
    return rows


def followers() -> dict[str, Callable[..., Curve]]:
    """How each code that is installed follows a bed."""
    found: dict[str, Callable[..., Curve]] = {LAB: followed_here}
    for peer, run in ((liggghts, liggghts.run_liggghts), (lammps, lammps.run_lammps)):
        if peer.available() is not None:
            found[peer.NAME] = partial(followed_there, run)
    return found


def kept(work: Path, name: str, how: Tilting, bed: Bed, number: int, follow: Callable[..., Curve]) -> Curve:
    """The curve of a code and a bed from the folder `work`, where it is put once it is done."""
    path = work / f"curve-{name.replace(' ', '-')}-{how.count}-{how.rate:g}-{how.angle:g}-{number}.npz"
    return Curve(**remembered(path, f"curves: {name}, bed {number}", lambda: vars(follow(how, bed))))


def all_kept(work: Path, codes: Mapping[str, Callable], how: Tilting, beds: list[Bed]) -> dict[str, list[Curve]]:
    """The curves of all beds by code."""
    return {
        name: [kept(work, name, how, bed, k, follow) for k, bed in enumerate(beds, start=1)]
        for name, follow in codes.items()
    }


def followed_here(how: Tilting, bed: Bed, largest_multiple: int = 1) -> Curve:
    """The lab's curve; while grains are slow its steps may be `largest_multiple` times as long."""
    # On beyond the angle, so that the rate is not eased out before it.
    tilt = Tilt(np.radians(how.rate), np.radians(how.angle + how.rate * Tilt.ease))
    scene = bed.scene(material=GRAINS, schedule="per-world", motions=[(tilt,)])
    run = Simulation(scene, bed.places(), threads=1, arch="cpu", largest_multiple=largest_multiple)
    angle, centre = [], []
    duration = how.angle / how.rate + 0.5 * Tilt.ease
    for _ in range(1 + round(duration * how.rate / EVERY)):
        rows = run.observe()
        angle.append(np.degrees(rows["pose"][0, 2]))
        centre.append(rows["centre_of_mass"][0, 0])
        run.advance(every(how, run.dt))
    run.close()
    return Curve(np.array(angle), -(np.array(centre) - centre[0]) / DIAMETER)


def followed_there(run: Callable, how: Tilting, bed: Bed) -> Curve:
    """A peer's curve."""
    dt = bed.scene(material=GRAINS).time_step()
    soft: Material = replace(GRAINS, young=GRAINS.young * SCALE)
    steps, rate = round(how.angle / how.rate / dt), np.radians(how.rate)
    how_often = every(how, dt)
    found = run(
        Task(bed.position, bed.radius, bed.width, HEIGHT, soft, dt, steps, tilt_rate=rate, sample_every=how_often)
    )
    centre = found.centre_of_mass[:, 0]
    return Curve(how.rate * found.time, -(centre - centre[0]) / DIAMETER)


def every(how: Tilting, dt: float) -> int:
    """Steps from one sample to the next."""
    return max(1, round(EVERY / how.rate / dt))


def _parting_heads(codes: Mapping[str, object]) -> list[str]:
    return [f"{name}: apart at (deg)" for name in codes if name != LAB]


def _rows(found: Mapping[str, list[Curve]]) -> list[list[str]]:
    """A row a bed, and one of means and standard deviations."""
    first = np.array([[curve.first_diameter() for curve in curves] for curves in found.values()])
    others = [curves for name, curves in found.items() if name != LAB]
    parting = np.array([[c.parts_from(own) for c, own in zip(cs, found[LAB], strict=True)] for cs in others])
    table = np.concatenate([first, parting.reshape(len(others), -1)])
    rows = [[str(k), *(f"{value:.2f}" for value in column)] for k, column in enumerate(table.T, start=1)]
    return [
        *rows,
        [f"mean ± std of {table.shape[1]} beds", *(plus_minus(line.mean(), line.std(ddof=1)) for line in table)],
    ]


def plotted(found: Mapping[str, list[Curve]]) -> Figure:
    """Shift against tilt, a panel a bed, a colour a code."""
    beds = len(found[LAB])
    figure = Figure(figsize=(6.4, 2.4 * -(-beds // 2) + 0.4), layout="constrained")
    panels = figure.subplots(-(-beds // 2), 2, sharex=True, sharey=True, squeeze=False)
    for k, axes in enumerate(panels.flat[:beds]):
        for name, curves in found.items():
            axes.plot(curves[k].tilt, curves[k].shift, color=COLOURS[name], label=name, linewidth=1.2)
        axes.set_title(f"bed {k + 1}")
    for axes in panels[-1]:
        axes.set_xlabel("tilt (deg)")
    figure.supylabel("shift of the centre of mass (d)", fontsize=9)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc=BELOW, ncols=len(found))
    return figure
