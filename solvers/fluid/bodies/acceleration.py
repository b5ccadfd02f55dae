"""What the wall particles of bodies feel of the acceleration of their part."""

import taichi as ti

from solvers.machine.quantity import PLANE
from solvers.space.axes import cross, dot, turns
from solvers.tank.pose import AT_START


@ti.data_oriented
class PartAcceleration:
    """A + ω' × r + ω × (ω × r), to which −2 Ω × v comes where the tank itself turns at Ω, of `Bodies`.

    r is from the drawn origin of a part, which is accelerated by A in the tank, v the velocity there. Water that slides
    freely (`slips`) is accelerated by what of it is across the face before a wall particle alone. A free body is taken
    as one without acceleration over the earth: `FreeBodyCoupling` adds what it has.
    """

    def __init__(self, bodies, slips: bool):
        self.bodies, self.slips = bodies, slips

    @ti.func
    def take_off(self, w, b, felt: ti.template()):
        """Take the acceleration of its part in the tank (m/s²) from what its particles in a block feel at the start.

        A free body feels gravity, and how it turns over the earth, about its centre of mass: −ω × (ω × r).
        """
        p, row, pose = self.bodies.particles, self.bodies.row(b), self.bodies.pose
        zero = ti.cast(0.0, p.exact)
        gain = [zero for _ in ti.static(range(p.axes))]
        origin, drift = [zero for _ in ti.static(range(p.axes))], [zero for _ in ti.static(range(p.axes))]
        turn = [zero for _ in ti.static(range(turns(p.axes)))]  # twice that of the tank
        rate, rise = [zero for _ in ti.static(range(turns(p.axes)))], [zero for _ in ti.static(range(turns(p.axes)))]
        loose = ti.cast(0.0, p.real)  # 1 of a free body
        if row >= 0:
            k = self.bodies.owner[row]
            at, turning = pose.origin(w, k, AT_START), pose.rate(w, k, AT_START)
            speed = pose.velocity(w, k, AT_START)
            for a in ti.static(range(p.axes)):
                gain[a], origin[a], drift[a] = self.bodies.pull[a][w, k], at[a], speed[a]
            for a in ti.static(range(turns(p.axes))):
                rise[a], rate[a] = self.bodies.pull[p.axes + a][w, k], turning[a]
                if ti.static(self.bodies.of_tank.rotating):
                    turn[a] = 2.0 * self.bodies.of_tank.felt[2 * p.axes + a][w]
            if ti.static(self.bodies.pieces.floats):
                i = self.bodies.pieces.bodies.loose(w, k)
                if i >= 0:
                    loose, over_earth = 1.0, self.bodies.pieces.bodies.rate_over_earth(w, i)
                    for a in ti.static(range(turns(p.axes))):
                        turn[a], rate[a] = zero, over_earth[a]
                    for a in ti.static(range(p.axes)):
                        origin[a] = self.bodies.pieces.bodies.place[a][w, i]
                        gain[a] = 0.0 - self.bodies.of_tank.felt[a][w]
        arm = [p.offset(b, ti.cast(origin[a], p.where), a) for a in ti.static(range(p.axes))]
        # Variables keep their type, and whole vectors cannot be cast: the factors have the vectors' own.
        spin = [ti.cast(rate[a], p.real) for a in ti.static(range(turns(p.axes)))]
        up = [ti.cast(rise[a], p.real) for a in ti.static(range(turns(p.axes)))]
        double = [ti.cast(turn[a], p.real) for a in ti.static(range(turns(p.axes)))]
        even = [ti.cast(gain[a], p.real) for a in ti.static(range(p.axes))]
        moves = [p.ones() * ti.cast(drift[a], p.real) for a in ti.static(range(p.axes))]
        back = self.pushed(arm, moves, even, [spin, up, double])
        if ti.static(self.bodies.pieces.floats):
            for a in ti.static(range(p.axes)):
                back[a] = back[a] - loose * felt[a]
        if ti.static(self.slips):
            across = self.across(b, row, back)
            for a in ti.static(range(p.axes)):
                back[a] = across[a]
        for a in ti.static(range(p.axes)):
            felt[a] += back[a]

    @ti.func
    def pushed(self, arm: ti.template(), drift: ti.template(), even: ti.template(), turning: ti.template()):
        """−A − ω' × r − ω × (ω × r) − 2 Ω × (V + ω × r) of lanes at r, V the `drift`, A `even`; ω, ω' and 2 Ω."""
        rate, rise, double = turning
        if ti.static(len(rate) == 1):
            square, spin = rate[0] * rate[0], double[0] * rate[0]
            return [
                rise[0] * arm[1] + (square + spin) * arm[0] + (double[0] * drift[1] - even[0]),
                (square + spin) * arm[1] - rise[0] * arm[0] - (double[0] * drift[0] + even[1]),
            ]
        else:
            swung, gained = cross(rate, arm), cross(rise, arm)
            inward, deflected = cross(rate, swung), cross(double, [drift[a] + swung[a] for a in ti.static(range(3))])
            return [0.0 - even[a] - gained[a] - inward[a] - deflected[a] for a in ti.static(range(3))]

    @ti.func
    def across(self, b, row, vector: ti.template()):
        """What of vectors of a block of wall particles is square to the faces before them, as the step begins."""
        along = [
            self.bodies.particles.load(self.bodies.along[a], ti.max(row, 0))
            for a in ti.static(range(self.bodies.particles.axes))
        ]
        self.bodies.turn(b, along, AT_START)
        slid = dot(vector, along)
        if ti.static(self.bodies.particles.axes == PLANE):
            return [vector[a] - slid * along[a] for a in ti.static(range(PLANE))]
        else:  # `along` is the normal
            return [slid * along[a] for a in ti.static(range(self.bodies.particles.axes))]
