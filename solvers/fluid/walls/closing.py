"""How fast water closes on the walls' dummies, which is what their pressure compresses."""

import taichi as ti

from solvers.fluid.lists import Medium
from solvers.motion.poses import AT_MIDDLE
from solvers.space.axes import dot


@ti.data_oriented
class Closing:
    """C_w = Σ V_i (u_i − u_w)·∇W_iw / Σ V_f W_fw, and dρ_f/dt = ρ_f Σ V_w W_fw C_w: the adjoint of the dummies' push.

    A dummy pushes on the water i with a pressure that is a mean of that of the water f before it (`Extrapolation`). So
    what the dummy does to the kinetic energy of i has to come from the elastic energy of f, in the same shares. That is
    so if div u of f has the term −Σ V_w W_fw C_w: own derivation, from the power of the pressures p_w. In sums over
    pairs of particles force and divergence are adjoint of themselves (Bonet & Lok 1999, sec. 3); dummies that stand
    still in the balance of mass break this, and give or take energy (Cercos-Pita, Antuono, Colagrossi & Souto-Iglesias
    2017). A mirror image of the water, that moves against it, would be another remedy; this one needs no normals, so
    that it holds at corners, plates and bodies, and it closes the account of energy.

    A dummy whose pressure is cut off compresses nothing. Air has its own wall pressure, 2 p_i, whose adjoint is in the
    weight of the wall's velocity, see `solvers.fluid.phases.interfaces`.

    Limits: the compression of water near a wall is right in sum, not in each particle: a flow that is linear in place
    gives a divergence off by its own size in some of them. The weights in p_w that stand for gravity between f and the
    dummy change as water moves; their work is left to `held`.
    """

    def __init__(self, medium: Medium):
        self.units, self.particles, self.shares = medium.units, medium.particles, medium.shares
        self.lists, self.constants = medium.lists, medium.constants

    @ti.func
    def close(self, u, frame, kick, dt):
        """C_w (1/s) of a unit's dummies in the middle of the step, as their `rate`; returns that all is well."""
        first, end = self.shares.dry(u)
        for b in range(first, end):
            self.close_block(b, self.lists.facing.first[u, b - first], self.lists.facing.first[u, b - first + 1], u)
        return True

    @ti.func
    def close_block(self, b, begin, end, u):
        """As `close`, for a block of dummies, from the entries `begin` to `end` of its list."""
        p, c, lists = self.particles, self.constants, self.lists
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        speed = [p.load(p.velocity[a], b) for a in ti.static(range(p.axes))]
        shrink = c.get("shrink")
        seen, closed = p.zeros(), p.zeros()
        for k in range(begin, end):
            j = lists.facing.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(b, own, origin, j, AT_MIDDLE)
            t = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * shrink, 0.0)
            volume = p.volume[jb, lane]
            if ti.static(p.two):
                volume *= 1.0 - p.gas[jb, lane]
            nearing = [p.velocity[a][jb, lane] - speed[a] for a in ti.static(range(p.axes))]
            seen += volume * c.kernel.value(t)
            closed += (volume * c.kernel.slope(t)) * dot(nearing, apart)
        factor, pressure = c.get("slope") / c.get("value"), p.load(p.pressure, b)
        # A pressure that is cut off, or of a dummy that sees no water, is exactly zero.
        acts = ti.select(pressure * pressure > 0.0, p.ones(), p.zeros())
        p.store(p.rate, b, acts * (factor * closed / ti.max(seen, 1e-30)))
