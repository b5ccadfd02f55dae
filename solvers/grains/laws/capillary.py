"""The common part of the cohesion laws: a liquid bridge that forms on contact, pulls, and breaks at its range."""

from math import pi

import taichi as ti

from solvers.grains.materials import Interface, hertz_stiffness
from solvers.machine.limit import Limit
from solvers.machine.wide import entry, minus, size
from solvers.space.extremes import greater, lesser

STEPS = 36.0  # per period of two grains that oscillate about the balance of pull and elasticity
ROUNDS = 3  # in which a pull and the way of its step are found; a fourth changes a film's work by some per cent at most
SHORTEST = 1e-3  # of the range: the least way per step over which the force is averaged
NO_RANGE = 1e-15  # m; keeps divisions finite where there is no bridge


@ti.data_oriented
class Capillary:
    """F = f₀ while the grains touch, f₀ p(s) at a gap s up to the range, then nothing until they touch again.

    The pull is added to the normal law, whose repulsive force F_n is unchanged: the Coulomb cap is μ F_n without the
    pull, as Spandonidis (2016), eq. 4.6, refers to the force of eq. 4.4. In a wet contact without external load F_n
    balances f₀, so friction resists with up to μ f₀.

    A step may be much longer than the range. So the force is the mean over the way of the grains in a step, from the
    gap halfway since the last step to that halfway to the next, [f₀ (part that overlaps) + f₀ p(middle of the rest)
    (part within the range)]/way. Verlet's kick by F Δt changes the energy by F (v₋ + v₊) Δt/2, with the velocities
    before and after it, so if the way is (v₋ + v₊) Δt/2 and begins at s − v₋ Δt/2, the ways of successive steps join,
    and the work over a cycle of contact and rupture is that of the law, whatever the step. v₊ depends on F: where a
    pull begins or ends within a step the speed changes by f₀ Δt/m_eff, and ways from predicted speeds overlap and leave
    gaps of up to f₀ Δt²/(4 m_eff). In the mean a pass costs f₀² Δt²/(12 m_eff) too little: little with a material's own
    stiffness, but several times the work of a film between softened grains, whose steps are long. So F and the way are
    found together, ROUNDS times each from the last, which converges with f₀ Δt/(2 m_eff |u_n|). The changes of other
    forces within a step are left out: they are small near touch, and of either sign.

    The energy of a bridge is counted from first touch: it is negative while grains overlap, and otherwise the work of
    stretching it, f₀ ∫ p ds, which is lost at rupture.
    """

    wide = True
    memory = ("bridged", "bridge_last")
    pulls = True

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """Longest steps (s) and reasons: f₀ against Hertz's elasticity, (3/2) f₀/ξ (N/m) at k ξ^(3/2) = f₀."""
        pull = self.coefficients(between)[0] * radius
        if pull == 0.0:
            return []
        depth = (pull / hertz_stiffness(between.young_modulus, radius)) ** (2.0 / 3.0)
        period = 2.0 * pi * (mass * depth / (1.5 * pull)) ** 0.5
        return [Limit(period / STEPS, f"1/{STEPS:.0f} of the swing under the pull of a liquid bridge")]

    @ti.func
    def pull(self, contacts: ti.template(), w, block, approach, rate, dt):
        """The pull (N) of a block of contacts that approach by `approach` (m; negative: a gap) at a rate (m/s)."""
        held, last = contacts.bridged[w, block], contacts.bridge_last[w, block]
        led = 0.5 * dt * contacts.bridge_yield[w, block]  # change of the mean speed of a step with the pull, m/(s N)
        foreseen = 2.0 * self.integrator.ahead * last  # the pull that is in `rate`
        force, kept = last, held
        for _ in ti.static(range(ROUNDS)):
            closing = rate + led * (force - foreseen)
            middle = approach + 0.5 * dt * led * force
            force, kept = self.averaged(contacts, w, block, middle, closing, held, dt)
        contacts.bridged[w, block] = kept
        contacts.bridge_last[w, block] = force
        return force

    @ti.func
    def averaged(self, contacts: ti.template(), w, block, middle, closing, held, dt):
        """The mean pull (N) over the way of a step about an overlap `middle` (m), and whether there is a bridge after.

        `closing` is the mean speed (m/s) of the step, `held` 1 where there was a bridge before.
        """
        reach = greater(contacts.bridge_range[w, block], NO_RANGE)
        way = greater(size(closing) * dt, SHORTEST * reach)
        near, far = minus(middle) - 0.5 * way, 0.5 * way - middle
        bridged = ti.select(near < 0.0, 1.0 + 0.0 * held, held)
        pulling = ti.select(closing < 0.0, bridged, held)  # a bridge forms when the overlap begins, not before
        begin, end = greater(lesser(near, reach), 0.0), greater(lesser(far, reach), 0.0)
        overlapping = greater(lesser(minus(near), way), 0.0)
        tail = pulling * (end - begin) * self.profile(contacts, w, block, 0.5 * (begin + end), reach)
        leaving = ti.select(closing < 0.0, far, near)
        kept = ti.select(leaving < reach, bridged, 0.0 * held)
        return contacts.bridge_pull[w, block] * (overlapping + tail) / way, kept

    @ti.func
    def energy(self, contacts: ti.template(), w, block, lane, approach):
        """Energy (J) of one contact's bridge; zero if there is none."""
        pull, reach = entry(contacts.bridge_pull, w, block, lane), entry(contacts.bridge_range, w, block, lane)
        stored = -pull * approach
        if approach < 0.0:
            stored = 0.0 * pull
            if -approach < reach:
                held = entry(contacts.bridged, w, block, lane)
                stored = held * pull * self.stretch(contacts, w, block, lane, -approach)
        return stored
