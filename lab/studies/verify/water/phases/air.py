"""Water and air: a still tank, the wave between them, air in a closed column, and what pairs of both must keep."""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad

from lab.studies.case import Case, Found, Line
from lab.studies.verify.water.phases.interface import waves
from lab.studies.verify.water.scenes import (
    G,
    bearing,
    box,
    grid,
    kept,
    looks,
    of_both,
    scene,
    set_going,
    simulated,
)
from solvers.fluid.given import Air, Water, particles
from solvers.fluid.phases.adiabatic import GAMMA
from solvers.scene import Scene
from solvers.simulation import Simulation

SECTION = "Water and air"
WIDTH, DEPTH, HEIGHT = 0.3, 0.15, 0.3  # m, of the still tank
REST, ROWS = 20.0, (8, 16)  # s, layers
COLUMN, PRESSED, POOL = 0.15, 0.03, 0.05  # m: length of each cushion of air, how much of it is taken, the water between
CUSHIONS = (8, 16, 32)  # particles over its length
REAL = 343.0  # m/s


def rested(rows: int, duration: float) -> tuple[float, float, float]:
    """How far the surface came off its place in spacings, r.m.s., error of the pressure in ρ g H, and of the energy.

    The surface is between the highest water and the lowest air of each column of two smoothing lengths, over the second
    half of the time (s).
    """
    sound = 10.0 * np.sqrt(G * DEPTH)
    water = bearing(Water(DEPTH / rows, sound, air=Air(sound_speed=sound)))
    off, pressed, bins = [], [], np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, max(2, rows // 2))
    with simulated(of_both(water, box(WIDTH, HEIGHT), DEPTH)) as run:
        for time in looks(run, np.arange(1.0, duration + 0.5)):
            rows_now, state = run.observe(), run.snapshot()
            if time < 0.5 * duration:
                continue
            wet, dry = state["water_position"][0], state["air_position"][0]
            high = [wet[np.digitize(wet[:, 0], bins) == k, 1].max() for k in range(1, len(bins))]
            low = [dry[np.digitize(dry[:, 0], bins) == k, 1].min() for k in range(1, len(bins))]
            off.append(np.abs(0.5 * np.add(high, low) - DEPTH).max() / water.spacing)
            error = state["water_pressure"][0] - water.density * G * (DEPTH - wet[:, 1])
            pressed.append(np.sqrt((error**2).mean()) / (water.density * G * DEPTH))
    stirred = rows_now["air_kinetic"][0] / (0.5 * air_mass(run))
    return max(off), max(pressed), float(np.sqrt(stirred))


def air_mass(run: Simulation) -> float:
    """Mass (kg) of the air in a slab of one metre."""
    drops, air = run.scene.fluid.particles[0], run.scene.fluid.water.air
    return float((air.density * (1.0 + drops["deviation"]) * drops["volume"] * drops["gas"]).sum())


def still(fast: bool) -> Found:
    """Twenty seconds of rest at two spacings; the last decides."""
    rows, duration = (ROWS[1:], 4.0) if fast else (ROWS, REST)
    found = [rested(count, duration) for count in rows]
    off, pressed, stirred = found[-1]
    lines = [
        Line.off("surface, of a spacing, largest of all columns", "rest", off, 0.5, "half a spacing"),
        Line.off(
            "pressure in the water, r.m.s., of ρ g H", "hydrostatic", pressed, 0.02, "noise of particles that creep"
        ),
        Line.off("speed of the air at the end, r.m.s.", "rest", stirred, 0.05, "noise", "m/s"),
    ]
    shown = "; ".join(
        f"{count} layers: {a:.2f} Δx, {100 * b:.2f} %, {c:.3f} m/s"
        for count, (a, b, c) in zip(rows, found, strict=True)
    )
    return Found(lines, notes=[f"{duration:g} s; surface, pressure, air's speed at the end. {shown}."])


@dataclass(frozen=True)
class Slug:
    """Water between two cushions of air in a column with walls, without gravity, that squeezes one by a fifth.

    Without losses d²x/dt² = −p_a [(L/(L − x))^1.4 − (L/(L + x))^1.4]/(ρ d): Bagnold's (1939) piston with air on both
    sides. `sound` (m/s) of the air; `rows` particles over the length L of each cushion, of as many in its width.
    """

    sound: float
    rows: int

    @property
    def spacing(self) -> float:
        """Distance (m) of the particles."""
        return COLUMN / self.rows

    @property
    def thick(self) -> float:
        """How thick (m) the water is."""
        return round(POOL / self.spacing) * self.spacing

    @property
    def at_rest(self) -> float:
        """The pressure p_a (Pa) of the air at rest."""
        return 1.2 * self.sound**2 / GAMMA

    def excess(self, way: float) -> float:
        """The difference (Pa) of both pressures where the water has gone a way (m)."""
        return self.at_rest * ((COLUMN / (COLUMN - way)) ** GAMMA - (COLUMN / (COLUMN + way)) ** GAMMA)

    def made(self) -> Scene:
        """The water set going, and air that is squeezed evenly."""
        of_water = max(10.0 * np.sqrt(G * POOL), self.sound / 7.4)
        water = bearing(Water(self.spacing, of_water, air=Air(sound_speed=self.sound, alpha=0.1)))
        high = 2.0 * COLUMN + self.thick
        place = grid(COLUMN, high, self.spacing) - [0.5 * COLUMN, 0.0]
        gas = (np.abs(place[:, 1] - 0.5 * high) > 0.5 * self.thick).astype(float)
        order = np.argsort(gas, kind="stable")
        drops = particles(1, len(place))
        drops["position"][0], drops["gas"][0], drops["volume"] = place[order], gas[order], self.spacing**2
        speed = np.sqrt(2.0 * quad(self.excess, 0.0, PRESSED)[0] / (water.density * self.thick))
        set_going(
            drops, lambda at: np.outer(speed * np.minimum(1.0, np.minimum(at[:, 1], high - at[:, 1]) / COLUMN), UP)
        )
        return scene(water, drops, box(COLUMN, high), 0.0)

    def squeezed(self) -> tuple[float, float, float]:
        """p/p_a of the squeezed cushion, (V_0/V)^1.4, and the same of the other, where the water turns back.

        The volumes follow from the water's centre and how much thinner it is, being squeezed itself.
        """
        made, found = self.made(), []
        rate = np.sqrt(2.0 * GAMMA * self.at_rest / (COLUMN * made.fluid.water.density * self.thick))
        upper = made.fluid.particles["position"][0, made.fluid.particles["gas"][0], 1] > COLUMN
        with simulated(made) as run:
            for _ in looks(run, np.linspace(1.2, 2.0, 17) / rate):
                state = run.snapshot()
                pressure = state["air_pressure"][0]
                way = state["water_position"][0][:, 1].mean() - COLUMN - 0.5 * self.thick
                thinner = state["water_pressure"][0].mean() / (1000.0 * made.fluid.water.sound_speed**2) * self.thick
                shares = [1.0 + pressure[part].mean() / self.at_rest for part in (upper, ~upper)]
                volumes = [1.0 - (side * way - 0.5 * thinner) / COLUMN for side in (1.0, -1.0)]
                found.append((way, *(share * volume**GAMMA for share, volume in zip(shares, volumes, strict=True))))
        return max(found)


UP = np.array([0.0, 1.0])


def column(fast: bool) -> Found:
    """Closed air at a fifth less volume, for a slow and for the real speed of sound."""
    lines, notes, rows = [], [], CUSHIONS[:1] if fast else CUSHIONS
    for name, sound in (("equal", 10.0 * np.sqrt(G * POOL)), *(() if fast else (("real", REAL),))):
        found = [Slug(sound, count).squeezed() for count in rows]
        way, squeezed, drawn = found[-1]
        for what, value in (("squeezed", squeezed), ("drawn out", drawn)):
            line = f"p V^1.4 of air that is {what}, of that at rest, {name} speed of sound"
            lines.append(
                Line(line, value, 1.0, "adiabatic", 0.01, f"1 % at {100.0 * way / COLUMN:.0f} % of the length")
            )
        shown = "; ".join(
            f"{n}: {100 * (a - 1):+.2f}, {100 * (b - 1):+.2f} %" for n, (_, a, b) in zip(rows, found, strict=True)
        )
        notes.append(f"{name}, particles over the length: squeezed, drawn out: {shown}.")
    return Found(lines, notes=notes)


def balance(_: bool) -> Found:
    """Both fluids in space without walls, stirred: momentum and energy."""
    water = Water(0.05, 20.0, alpha=0.02, periodic=("y", "z"), air=Air(1.2, 15.0, 0.02))
    place = grid(1.0, 1.0, 0.05) + np.array([-0.5, 0.0])
    gas = (np.abs(place[:, 1] - 0.5) > 0.25).astype(float)
    order = np.argsort(gas, kind="stable")
    drops, random = particles(1, len(place)), np.random.default_rng(1)
    drops["position"][0] = place[order] + 0.005 * random.uniform(-1.0, 1.0, place.shape)
    drops["volume"][0], drops["gas"][0] = 0.05**2, gas[order]
    set_going(drops, lambda where: 0.2 * random.uniform(-1.0, 1.0, where.shape))
    with simulated(scene(water, drops, box(1.0, 1.0), 0.0, step=1e-3)) as run:
        start = run.observe()
        _, before, mass = kept(run)
        run.advance(200)
        end = run.observe()
        change = np.abs(mass @ (kept(run)[1] - before)).max() / (mass @ np.hypot(*before.T))
    lost = start["water_total"][0] - end["water_total"][0]
    taken = sum(end[name][0] - start[name][0] for name in ("water_viscous", "water_diffusive", "water_wall_energy"))
    return Found(
        [
            Line.off("momentum, of Σ m |u|", "kept", change, 1e-12, "pair forces are equal and opposite"),
            Line(
                "energy that viscosity and diffusion take, of what is lost",
                taken / lost,
                1.0,
                "balance",
                0.01,
                "the step",
            ),
        ]
    )


CASES = (
    Case("water-air-rest", SECTION, "A still tank of water and air", still),
    Case("water-air-wave", SECTION, "The wave between water and air", waves),
    Case("water-air-column", SECTION, "Air in a closed column", column),
    Case("water-air-balance", SECTION, "What pairs of water and air keep", balance, quick=True),
)
