"""What the water does to grains in their own steps, once it is known what it does in one of its own."""

import taichi as ti

FEW = 0.05  # of x, below which the means over a step are told by their series


@ti.data_oriented
class Pull:
    """Lift and drag on grains in each of their steps, from what `solvers.mixture.exchange.Exchange` has found.

    Those of a hull are told in her axes, and what the water does to them in those of its tank (`OnHull`).
    """

    @ti.func
    def lead(self, w, i, kick, dt):
        """Give a grain the half step by which its velocity is ahead of the water's, as far as the lift has changed."""
        g = self.grains
        jump = [
            0.5 * dt * g.inverse_mass[w, i] * (self.lift[a][w, i] - self.former[a][w, i])
            for a in ti.static(range(g.axes))
        ]
        if ti.static(self.frame.aboard):
            hold = self.frame.hold
            y, z = ti.cast(jump[0], hold.exact), ti.cast(jump[1], hold.exact)
            led = hold.led(w, y, z, ti.cast(kick, hold.exact), ti.cast(dt, hold.exact))
            jump[0], jump[1] = ti.cast(led[0], g.real), ti.cast(led[1], g.real)
        for a in ti.static(range(g.axes)):
            g.velocity[a][w, i] = g.velocity[a][w, i] + jump[a]
            self.former[a][w, i] = self.lift[a][w, i]

    @ti.func
    def act(self, w, i, acceleration: ti.template(), felt: ti.template(), kick):
        """Add what the water does to a grain to its `acceleration` (m/s²); `felt` (m/s²) is what all feel in the tank.

        The velocity of the water at the grain changes with the grain's own through the base steps of one of the water.
        Drag is that of a whole step, also in the half kick with which a run begins. There is no branch and no call in
        this, so that it is compiled into SIMD instructions.
        """
        g, light = self.grains, self.grains.inverse_mass[w, i]
        for a in ti.static(range(g.axes)):
            pushed = acceleration[a] + light * self.lift[a][w, i]
            acceleration[a] = pushed + light * self.drag(a, w, i, g.velocity[a][w, i], pushed, felt[a], kick)

    @ti.func
    def drag(self, axis: ti.template(), w, i, speed, pushed, felt, kick):
        """The drag (N) along an axis on a grain of a `speed` (m/s), else accelerated as `pushed`; its flow follows."""
        flow, risen = self.flow[axis][w, i], self.rise[axis][w, i] + felt
        drag = self.held[w, i] * (flow - speed) + self.gained[w, i] * (risen - pushed)
        self.flow[axis][w, i] = flow + kick * (risen - self.partner[w, i] * drag)
        self.impulse[axis][w, i] = self.impulse[axis][w, i] + kick * drag
        return drag

    @ti.func
    def act_aboard(self, w, i, place: ti.template(), speed: ti.template(), push: ti.template(), kick):
        """Add what the water does to a grain in a hull to what its contacts do, `push` (m/s²), in her axes."""
        g, hold, light = self.grains, self.frame.hold, self.grains.inverse_mass[w, i]
        u, a = hold.over_earth(w, place, speed), hold.into_tank(w, push[0], push[1])
        felt = [ti.cast(0.0, g.real), ti.cast(0.0 - hold.gravity[0], g.real)]
        given = [ti.cast(0.0, g.real) for _ in ti.static(range(g.axes))]
        for k in ti.static(range(g.axes)):
            lift = self.lift[k][w, i]
            pushed = ti.cast(a[k], g.real) + felt[k] + light * lift
            drag = self.drag(k, w, i, ti.cast(u[k], g.real), pushed, felt[k], kick)
            given[k] = light * (lift + drag)
        back = hold.into_body(w, given[0], given[1])
        for k in ti.static(range(g.axes)):
            push[k] = push[k] + ti.cast(back[k], g.real)

    @ti.func
    def means(self, x):
        """(1 − e^−x)/x and (x − 1 + e^−x)/x²: means over a step of what decays, and of what grows against decay."""
        safe = ti.max(x, FEW)
        lost = 1.0 - ti.exp(-safe)
        first, second = lost / safe, (safe - lost) / (safe * safe)
        if x < FEW:
            first = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0))
            second = 0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0))
        return first, second
