"""The wave between water and a lighter fluid, its rate and its decay, against linear theory of two viscous fluids."""

from dataclasses import dataclass

import numpy as np

from lab.studies.case import Found, Line
from lab.studies.verify.water.scenes import (
    G,
    Swing,
    bearing,
    box,
    kept,
    looks,
    of_both,
    order_line,
    set_going,
    simulated,
    swing,
)
from lab.studies.verify.water.waves import between
from solvers.fluid.given import Air, Water
from solvers.scene import Scene

K = np.pi  # 1/m, of the wave in a box of 1 m, half filled with 1 m of water
WAVED, STEEP, VISCOSITY = (20, 40), 0.03, np.sqrt(G) / 500.0  # layers; k times the largest rise; m²/s
PERIODS, A_PERIOD = 5.0, 20


@dataclass(frozen=True)
class Between:
    """The wave between water and a lighter fluid (kg/m³), under pressures that are `reduced` by its weight or not."""

    density: float
    reduced: bool = False

    @property
    def rate(self) -> float:
        """ω (1/s): ω² = g k (ρ_w − ρ_a)/(ρ_w coth kd + ρ_a coth kd_a) (Lamb 1932, §231)."""
        cotangent = 1.0 / np.tanh(K)
        return float(np.sqrt(G * K * (1000.0 - self.density) / ((1000.0 + self.density) * cotangent)))

    @property
    def viscous(self) -> complex:
        """Growth rate (1/s) with viscosity, see `between`."""
        return between(1000.0, self.density, VISCOSITY)

    def unsure(self, spacing: float) -> float:
        """The share of the decay that is not known where the surface is known to half a spacing (m).

        What flow and layers of shear lose below a height z grows as exp 2kz and exp 2z/δ, δ = √(2ν/ω); the flow has
        2 ν k² of the whole, the layers the rest.
        """
        exact = self.viscous
        flow = min(1.0, 2.0 * VISCOSITY * K**2 / -exact.real)
        thick = np.sqrt(2.0 * VISCOSITY / exact.imag)
        return float(flow * np.expm1(K * spacing) + (1.0 - flow) * np.expm1(spacing / thick))

    def made(self, rows: int) -> Scene:
        """The wave on a level surface, with so many layers of each fluid."""
        spacing, sound = 1.0 / rows, 10.0 * np.sqrt(G)
        alpha = 8.0 * VISCOSITY / (2.0 * spacing * sound)
        speed = STEEP / K * self.rate  # of the water at the surface
        air = Air(self.density, sound, alpha, reduced=1.0 if self.reduced else None)
        water = Water(spacing, sound, alpha=alpha, speed=speed, air=air)
        made = of_both(bearing(water, 1.0), box(1.0, 2.0), 1.0)
        set_going(made.fluid.particles, lambda place: STEEP / K * self.rate * mode(place))
        return made

    def waved(self, rows: int) -> Swing:
        """The oscillation of the mode's momentum, from a level surface, with so many layers of each fluid."""
        times, found = np.arange(1, round(PERIODS * A_PERIOD)) * 2.0 * np.pi / (self.rate * A_PERIOD), []
        with simulated(self.made(rows)) as run:
            for time in looks(run, times):
                place, velocity, mass = kept(run)
                shape = mode(place)
                found.append((time, (mass[:, None] * velocity * shape).sum() / (mass[:, None] * shape**2).sum()))
        time, amplitude = np.array(found).T
        later = time > 2.0 * np.pi / self.rate
        return swing(time[later], amplitude[later], self.rate)


def mode(place: np.ndarray) -> np.ndarray:
    """Velocities (n, 2) of the first mode of two fluids 1 m deep each in a box 1 m wide."""
    y, z = place.T
    lower, upper = z <= 1.0, np.where(z <= 1.0, z, 2.0 - z)
    along = np.where(lower, 1.0, -1.0) * np.cos(K * y) * np.cosh(K * upper)
    return np.stack([along, np.sin(K * y) * np.sinh(K * upper)], axis=1) / np.sinh(K)


def waves(fast: bool) -> Found:
    """Waves of water under air, and under a fluid of half its density."""
    rows, lines, notes = WAVED[:1] if fast else WAVED, [], []
    for fluid in (Between(1.2), *(() if fast else (Between(500.0, reduced=True),))):
        swings = [fluid.waved(count) for count in rows]
        exact = fluid.viscous
        errors = [one.rate / exact.imag - 1.0 for one in swings]
        name = f"rate under a fluid of {fluid.density:g} kg/m³"
        why, allowed = "the surface is known to half a spacing; c0 = 10 √(g H)", 0.02 if fast else 0.01
        if fluid.density > 100.0:
            why, allowed = "layers of shear on both sides of the surface are two or three spacings thick", 0.02
        source = "linear theory of two viscous fluids"
        lines.append(Line(name, swings[-1].rate, exact.imag, source, allowed, why, "1/s"))
        lines += order_line(name, [1.0 / count for count in rows], errors, 0.01)
        decays = [-one.decay / exact.real - 1.0 for one in swings]
        half = "half a spacing at the surface, of exp 2kz in the flow and exp 2z/δ in layers of shear"
        lines.append(
            Line(
                f"decay under a fluid of {fluid.density:g} kg/m³",
                swings[-1].decay,
                -exact.real,
                source,
                fluid.unsure(1.0 / rows[-1]),
                half,
                "1/s",
            )
        )
        lines += order_line(
            f"the decay under a fluid of {fluid.density:g} kg/m³", [1.0 / n for n in rows], decays, 0.01
        )
        told = ", ".join(f"{1.0 + one:.2f}" for one in decays)
        shown = ", ".join(f"{100 * error:+.2f} %" for error in errors)
        slower = f"{100 * (exact.imag / fluid.rate - 1):+.2f} %"
        lamb = f"{-exact.real / (2.0 * VISCOSITY * K**2):.2f}"
        notes.append(
            f"{fluid.density:g} kg/m³: with viscosity the rate is {slower} off ω² = g k (ρ_w − ρ_a)/(ρ_w coth kd + "
            f"ρ_a coth kd_a), the decay {lamb} of 2 ν k². {rows} layers: rates {shown}, decay {told} of that"
            f"{', with the reduced pressure.' if fluid.reduced else '.'}"
        )
    return Found(lines, notes=notes)
