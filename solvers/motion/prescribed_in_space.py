"""A carrier with prescribed motions in all six freedoms of space."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.quantity import SPACE
from solvers.motion.frame import AXIS, TURNING, is_turn
from solvers.motion.prescribed import Driven
from solvers.space.axes import UP

# First of the numbers of a motion: place, rotation matrix row by row, velocity, rate of turning, and their rates
PLACE, TURN, VELOCITY, RATE, GAIN, RISE = 0, 3, 12, 15, 18, 21
NUMBERS = 24
AT_REST = np.concatenate([np.zeros(SPACE), np.eye(SPACE).ravel(), np.zeros(NUMBERS - VELOCITY)]).tolist()
Y, Z, X = AXIS.values()


@ti.func
def about(axis: ti.template(), c, s, v: ti.template()):
    """The vector v (a list) turned about an axis of space by an angle with this cosine and sine."""
    turned = ti.static([axis, (axis + 1) % SPACE, (axis + 2) % SPACE])
    parts = [v[turned[0]], c * v[turned[1]] - s * v[turned[2]], s * v[turned[1]] + c * v[turned[2]]]
    return [parts[(a - axis) % SPACE] for a in ti.static(range(SPACE))]


@ti.func
def aside(axis: ti.template(), v: ti.template()):
    """The vector product of an axis' unit vector with v (a list)."""
    parts = [0.0 * v[axis], 0.0 - v[(axis + 2) % SPACE], v[(axis + 1) % SPACE]]
    return [parts[(a - axis) % SPACE] for a in ti.static(range(SPACE))]


@ti.func
def part(m: ti.template(), begin: ti.template()):
    """The vector of a motion (a list) that begins at a number."""
    return [m[begin + a] for a in ti.static(range(SPACE))]


@ti.func
def seen(m: ti.template(), v: ti.template()):
    """A vector v over the earth (a list) in the axes of a tank that moves so, Rᵀ v."""
    return [
        m[TURN + a] * v[0] + m[TURN + SPACE + a] * v[1] + m[TURN + 2 * SPACE + a] * v[2]
        for a in ti.static(range(SPACE))
    ]


@ti.data_oriented
class PrescribedInSpace(Driven):
    """Prescribed motion of a tank with all six freedoms: motions applied one after the other, as in the plane.

    Each turns about an axis of the earth through its centre. With roll, pitch and yaw in this order the tank's axes are
    turned by R = R_z(ψ) R_y(θ) R_x(φ), as those of ships are (Fossen 2011, Handbook of Marine Craft Hydrodynamics and
    Motion Control, section 2.2.1; his axes x and z point the other way, so that roll and yaw have the other sign). The
    angles recorded are these, whatever turns the tank: θ from −90 to 90 deg, ψ and φ from −180 to 180 deg.

    The frame of the grains is (b, ω, ω̇) in the tank's axes, nine numbers, with b = Rᵀ(g − P̈). A grain at r with the
    velocity u and the spin s relative to the tank feels b − ω̇ × r − ω × (ω × r + 2 u), and its spin gains −ω̇ − ω × s.
    """

    spatial = True
    numbers = 9

    @staticmethod
    def centre(motion) -> Sequence[float]:
        """The point (3,) m in the earth frame about which a motion turns; the origin if it does not turn."""
        found = np.zeros(SPACE)
        if is_turn(motion.coordinate):
            found[np.arange(SPACE) != TURNING[motion.coordinate]] = motion.centre
        return found.tolist()

    @ti.func
    def motion(self, w, time):
        """Place P (m), rotation matrix R, P's velocity, the rate of turning ω, and the rates of both, over the earth.

        Composition by relative kinematics: turning by θ about the axis e through the earth's point c takes p to c +
        T(p − c), v to Tv + θ̇ e × (p' − c), a to Ta + 2 θ̇ e × Tv + θ̈ e × (p' − c) + θ̇² e × (e × (p' − c)), R to TR, ω
        to Tω + θ̇ e and ω̇ to Tω̇ + θ̈ e + θ̇ e × Tω.
        """
        t = ti.cast(time, self.exact)
        m = [ti.cast(AT_REST[k], self.exact) for k in ti.static(range(NUMBERS))]
        for k in ti.static(range(len(self.kinds))):
            first = self.first[k]
            q = self.kinds[k].state(self.table, w, first + SPACE, t)
            if ti.static(is_turn(self.kinds[k].coordinate)):
                self.turn(TURNING[self.kinds[k].coordinate], w, first, q, m)
            else:
                along = ti.static(AXIS[self.kinds[k].coordinate])
                m[PLACE + along] += q[0]
                m[VELOCITY + along] += q[1]
                m[GAIN + along] += q[2]
        return m

    @ti.func
    def turn(self, axis: ti.template(), w, first, q: ti.template(), m: ti.template()):
        """Turn a motion m about an axis by an angle with rate and acceleration q, the centre in the table."""
        c, s = ti.cos(q[0]), ti.sin(q[0])
        arm = about(axis, c, s, [m[PLACE + a] - self.table[w, first + a] for a in ti.static(range(SPACE))])
        speed, gain = about(axis, c, s, part(m, VELOCITY)), about(axis, c, s, part(m, GAIN))
        rate, rise = about(axis, c, s, part(m, RATE)), about(axis, c, s, part(m, RISE))
        swung, pushed, bent = aside(axis, arm), aside(axis, speed), aside(axis, rate)
        inward = aside(axis, swung)
        for a in ti.static(range(SPACE)):
            m[PLACE + a] = self.table[w, first + a] + arm[a]
            m[VELOCITY + a] = speed[a] + q[1] * swung[a]
            m[GAIN + a] = gain[a] + 2.0 * q[1] * pushed[a] + q[2] * swung[a] + q[1] * q[1] * inward[a]
            m[RATE + a] = rate[a]
            m[RISE + a] = rise[a] + q[1] * bent[a]
        m[RATE + axis] += q[1]
        m[RISE + axis] += q[2]
        for column in ti.static(range(SPACE)):
            image = about(axis, c, s, [m[TURN + SPACE * row + column] for row in ti.static(range(SPACE))])
            for row in ti.static(range(SPACE)):
                m[TURN + SPACE * row + column] = image[row]

    @ti.func
    def frame(self, w, t):
        """The tank's frame for the cargo: (b, ω, ω̇) in its own axes, with the body force per mass b = Rᵀ(g − P̈)."""
        m = self.motion(w, t)
        force = [0.0 - m[GAIN], 0.0 - m[GAIN + UP] - self.gravity[0], 0.0 - m[GAIN + X]]
        parts = seen(m, force), seen(m, part(m, RATE)), seen(m, part(m, RISE))
        return ti.Vector([ti.cast(parts[k // SPACE][k % SPACE], self.real) for k in ti.static(range(self.numbers))])

    @ti.func
    def stands(self, w, time):
        """Place (m) and angles (rad) θ, ψ, φ of the tank, its velocity, and its rate of turning, over the earth."""
        m = self.motion(w, time)
        up = [m[TURN + SPACE * UP + a] for a in ti.static(range(SPACE))]  # of the tank's axes
        pitch = ti.asin(ti.max(-1.0, ti.min(1.0, 0.0 - up[X])))
        yaw = ti.atan2(m[TURN + SPACE * Y + X], m[TURN + SPACE * X + X])
        roll = ti.atan2(up[Y], up[Z])
        angles = [pitch, yaw, roll]
        parts = part(m, PLACE), angles, part(m, VELOCITY), part(m, RATE)
        return [parts[k // SPACE][k % SPACE] for k in ti.static(range(4 * SPACE))]

    @ti.func
    def height(self, w, time, point: ti.template()):
        """Height (m) over the earth of a point of the tank (a list)."""
        m = self.motion(w, time)
        found = m[PLACE + UP]
        for a in ti.static(range(SPACE)):
            found += m[TURN + SPACE * UP + a] * point[a]
        return found
