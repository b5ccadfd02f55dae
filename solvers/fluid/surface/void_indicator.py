"""The void indicator: whether particles fill the room between them, and the pressure of those that do not."""

import numpy as np
import taichi as ti

from solvers.fluid.phases.dispersed import Dispersed
from solvers.fluid.state import SPRAY, Particles
from solvers.fluid.surface.reinitialisation import Reinitialisation
from solvers.fluid.terms.renormalisation import Renormalisation
from solvers.fluid.terms.term import Sums, Term
from solvers.machine.quantity import PLANE
from solvers.machine.state import State
from solvers.space.axes import dot

PACKING = 0.93  # packing threshold: F from which on water bears pressure, in the plane
RAMP = 0.05  # of F, over which the relief grows to all of c0/h, in the plane


@ti.data_oriented
class VoidIndicator(Term):
    """F = Σ V (−W'/r) r²/D + b |Σ V ∇W|, over water and wall particles: 1 where water is packed, at its surface too.

    The first sum is the trace of the matrix of Randles & Libersky (1996) over the number of axes D; it is 1 within
    packed water and ½ at a plane surface. What a plane cuts off is told by the second sum, and b, a length, is such
    that both are 1 together (own derivation). A drop alone has F = 0, a lattice that is stretched by 5 % in all
    directions 1.05^−D, 0.90 in the plane. Beside air both sums are over the own phase. PACKING and RAMP are those of
    the plane; in space they stand for the same stretch.

    Density that follows from the motion of neighbours keeps what a particle lacked when it parted: drops that come
    together would count as pressed as soon as they are within 2 h, and stay that far apart. Water with voids bears
    neither pressure nor suction, as cavitated water does not (Bleich & Sandler 1970): where F < PACKING, p is lost at
    the rate c0/h, at which a void within reach relieves it (own derivation), all of it from F = PACKING − RAMP down, in
    between in proportion. So it falls together until it is packed. The step is implicit, the energy counts as
    diffused.
    Spray (λ < SPRAY) bears no suction at all. Beside air it is the air's pressure that such water gets, see
    `solvers.fluid.phases.dispersed`.

    Limits: water that was broken is packed to within 1 − PACKING. A flat gap between two surfaces is not seen: both are
    plane. Corners and tips, sharper than some 6 Δx, count as voids, though p is nearly zero there anyway. Not in
    full tanks, which have no voids, nor beside air where its surface has tension or it coheres.

    Units: V m², W 1/m², r, b and h m.
    """

    def __init__(self, arrays: State, sums: Sums, particles: Particles, constants, matrix: Renormalisation):
        self.particles, self.constants, self.matrix = particles, constants, matrix
        self.dispersed = Dispersed(arrays, sums, particles, constants)
        self.acts = self.dispersed.acts or not (constants.full or constants.two)
        if self.acts:
            self.lean, self.by_walls = sums.room(particles.axes), sums.room()
        self.reinitialisation = Reinitialisation(arrays, particles, constants, self.acts)
        if self.acts:
            (self.indicator,) = arrays.under("water").wide(particles.of_water, "void_indicator", kept=False)

    @staticmethod
    def numbers(kernel, length: float, sound: float, axes: int = PLANE) -> dict[str, float]:
        """The constants of F, for a smoothing length (m) and a speed of sound (m/s)."""
        return {
            "relief": sound / length,
            "plane": plane(kernel, axes) * length,
            "packing": PACKING ** (axes / PLANE),
            "ramp": PLANE / (axes * RAMP),
        }

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a neighbour's Σ V (−W'/r)(r_i − r_j) over the own phase; the trace is that of `Renormalisation`."""
        for a in ti.static(range(self.particles.axes)):
            sums[self.lean + a] += pair.steep[a]

    @ti.func
    def add_wall(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a wall particle, which is no part of the air."""
        sums[self.by_walls] += pair.weight * pair.square
        for a in ti.static(range(self.particles.axes)):
            off = pair.weight * pair.apart[a]
            sums[self.lean + a] += (1.0 - block.gas) * off if ti.static(self.constants.two) else off

    @ti.func
    def end(self, block: ti.template(), sums: ti.template()):
        """Store F of a block, and what follows from it."""
        p, c, b = self.particles, self.constants, block.b
        lean = [sums[self.lean + a] for a in ti.static(range(p.axes))]
        lacking = c.get("plane") * ti.sqrt(dot(lean, lean))
        both = self.matrix.trace(sums) + sums[self.by_walls]
        own = both - block.gas * sums[self.by_walls] if ti.static(c.two) else both
        indicator = c.get("slope") * ((1.0 / p.axes) * own + lacking)
        p.store(self.indicator, b, indicator)
        if ti.static(self.dispersed.acts):
            whole = (0.5 * c.get("slope")) * (both + self.dispersed.trace(sums))
            indicator, lacking = (1.0 - block.gas) * indicator + block.gas * whole, (1.0 - block.gas) * lacking
        if ti.static(self.reinitialisation.acts):
            self.reinitialisation.note(b, indicator, c.get("slope") * lacking, block.gas)

    @ti.func
    def stepped(self, b, s, rate, rate_of_walls, step):
        """The density deviations of a block after a `step` (s) with these rates (1/s)."""
        p = self.particles
        spray = p.load(p.eigenvalue, b) + p.gases(b) < SPRAY  # air is never spray
        after = s + step * rate
        if ti.static(self.reinitialisation.acts):
            after += step * self.reinitialisation.rate(b, s)
        # Walls come last: spray that parts is still pushed off a wall that it nears.
        after = self.floored(spray, self.floored(spray, after) + step * rate_of_walls)
        if ti.static(self.acts):
            loose = self.loose(b)
            lost = (self.constants.get("relief") * loose) * step  # implicit
            share = lost / (1.0 + lost)
            if ti.static(self.dispersed.acts):
                after = after - self.dispersed.off(b, s, after, loose, share)
            else:
                rest = self.constants.get("thinnest") if ti.static(self.constants.pressed) else 0.0
                after = after - share * (after - rest)
        return after

    @ti.func
    def loose(self, b):
        """How far a block is broken: 0 where packed, 1 from PACKING − RAMP down; of air beside ALONE."""
        p, c = self.particles, self.constants
        return ti.min(ti.max((c.of("packing", p.gases(b)) - p.load(self.indicator, b)) * c.get("ramp"), 0.0), 1.0)

    @ti.func
    def floored(self, spray, s):
        """The density deviation, of spray at least that at which it bears no pressure; a full tank has no spray.

        With the background's pressure p_b that is below the density at rest. There the elastic energy ∫ (p + p_b)/ρ² dρ
        is least, so that what is floored gains none (own derivation); at ρ0 each step would give it p_b times the
        volume by which it has spread.
        """
        found, c = s, self.constants
        if ti.static(not c.full):
            least = c.get("thinnest") if ti.static(c.pressed) else ti.cast(0.0, self.particles.real)
            found = ti.select(spray, ti.max(s, least), s)
        return found


def plane(kernel, axes: int = PLANE) -> float:
    """b/h: the mean, from a plane surface to the depth h, of what it makes the trace over D lack over |Σ V ∇W|.

    At a depth z it lacks z w/D + ∫ w dz from z on, where w is the kernel's integral along the surface and |Σ V ∇W| = w
    (own derivation: of the trace Σ V (−W'/r) r² = D W + div (r W) what is beyond the surface is left out).
    """
    step = 0.01
    z = np.arange(0.0, 2.0 + step, step)
    y = np.arange(-2.0, 2.0 + step, step)
    round_it = 1.0 if axes == PLANE else np.pi * np.abs(y[:, None])  # in space a ring at this distance
    across = step * (round_it * kernel.printed(np.minimum(np.hypot(y[:, None], z[None]), 2.0), 1.0, axes)).sum(axis=0)
    beyond = step * (across[::-1].cumsum()[::-1] - 0.5 * across)
    shallow = z <= 1.0
    return float((z / axes + beyond / np.maximum(across, 1e-30))[shallow].mean())
