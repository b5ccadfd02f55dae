"""The grains: what is known of each of n discs in each of W worlds."""

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, Scope, State
from solvers.machine.units import Units
from solvers.space.axes import dot, named, named_turns, turns

FAR = 1e3  # m


@ti.data_oriented
class GrainState:
    """Arrays (W, room + ghosts), SI, in the tank's frame: n that move, k fixed ones of rough walls, far-off points.

    `units` cut them; `room` is for n + k of them at least.

    `place` (m), `velocity` and `now` (m/s) and `force` (N) are lists with an array for each of the `axes`, `angle`,
    `spin` and `spin_now` (rad, rad/s) and `torque` (N m) for each of the `turns`, the axes about which grains turn.

    Where liquid bridges may drown (`soaks`), `dry` is 1 for a grain that no free water reaches, 0 for a soaked one.

    With a `period` (m) space repeats itself along the last axis (`nearest`, `fold`).

    A disc has the mass and inertia of the sphere it stands for. `velocity` and `spin` are what the integrator keeps;
    `now` and `spin_now` are their values at the positions' own time, for forces that depend on velocity. Grains that
    may leave the tank have `spilled` set once they are out of it, and `present` cleared once they are far away. `reach`
    (m) is how far from its centre a grain can touch; `spread` its moment of inertia relative to that of the sphere.
    """

    shaped = False  # whether grains have an orientation, `turn_y` and `turn_z` its cosine and sine

    def __init__(
        self,
        arrays: State,
        axes: int,
        radius: np.ndarray,
        density: np.ndarray,
        fixed: np.ndarray,
        units: Units,
        may_leave: bool,
        kind: np.ndarray | None = None,
        spread: np.ndarray | float = 1.0,
        period: float | None = None,
        soaks: bool = False,
    ):
        self.axes, self.turns, self.fixed = axes, turns(axes), fixed
        self.worlds, self.mobile = radius.shape
        self.count = self.mobile + len(fixed)
        self.units, self.room, self.may_leave = units, units.room, may_leave
        self.real, self.exact = arrays.real, arrays.exact
        self.mixed = arrays.real is not arrays.place
        self.stride = self.room + units.ghosts  # numbers from a grain of one world to its like of the next
        own, each = arrays.under("grains"), "world grain"
        self.each = Axis("world", self.worlds), Axis("grain", self.stride)
        self.place = own.reals(self.each, *named("place", axes), kind=own.place)
        self.angle = own.reals(self.each, *named_turns("angle", axes))
        self.velocity, self.spin = self._both(own, "velocity", "spin")
        self.now, self.spin_now = self._both(own, "now", "spin_now")
        self.force, self.torque = self._both(own, "force", "torque")
        self.periodic = period is not None
        if self.periodic:
            self.period = own.holding("period", np.array([period, 0.5 * period]), "number", own.place)
        self.mass = 4.0 / 3.0 * np.pi * radius**3 * density
        self.radius = own.holding("radius", self._filled(radius, fixed[:, -1], 0.0), each, kept=True)
        self.reach = self.radius
        self.inverse_mass = own.holding("inverse_mass", self._filled(1.0 / self.mass, 0.0, 0.0), each, kept=True)
        inverse_inertia = 2.5 / (self.mass * radius**2 * spread)
        inverse_inertia = self._filled(inverse_inertia, 0.0, 0.0)
        self.inverse_inertia = own.holding("inverse_inertia", inverse_inertia, each, kept=True)
        if kind is not None:
            self.kind = own.holding("kind", self._filled(kind, 0.0, 0.0), each, ti.i32, kept=True)
        self.soaks = soaks
        if soaks:
            self.dry = own.holding("dry", np.ones((self.worlds, self.stride)), each, kept=True)
        if may_leave:
            self.present = own.holding("present", np.ones((self.worlds, self.stride)), each, kept=True)
            self.spilled = own.holding("spilled", np.zeros((self.worlds, self.stride)), each, kept=True)

    def _both(self, own: Scope, along: str, about: str) -> tuple[list[ti.Field], list[ti.Field]]:
        """Arrays of a vector and of what there is of rotation with it."""
        fields = own.reals(self.each, *named(along, self.axes), *named_turns(about, self.axes))
        return fields[: self.axes], fields[self.axes :]

    def _filled(self, values: np.ndarray, fixed: np.ndarray | float, ghost: float) -> np.ndarray:
        """Values (W, n) of the grains that move, with those of the fixed ones and the ghosts after them."""
        whole = np.full((self.worlds, self.stride), ghost)
        whole[:, : self.mobile] = values
        whole[:, self.mobile : self.count] = fixed
        return whole

    def put(self, position: np.ndarray) -> None:
        """Put the grains at `position` (W, n, axes) m, all present, at rest and without history."""
        for axis, field in enumerate(self.place):
            values = self._filled(position[..., axis], self.fixed[:, axis], FAR)
            field.from_numpy(values.astype(np.float32) if field.dtype == ti.f32 else values)
        self.count_turns_anew()
        if self.may_leave:
            self.present.fill(1.0)
            self.spilled.fill(0.0)
        self.launch(np.zeros_like(position), np.zeros((*position.shape[:2], self.turns)))

    def count_turns_anew(self) -> None:
        """Count the angles from here on: of discs, one is like another."""
        for field in self.angle:
            field.fill(0.0)

    def launch(self, velocity: np.ndarray, spin: np.ndarray) -> None:
        """Set the velocities (W, n, axes) m/s and spins (W, n, turns) rad/s, or (W, n) where there is one turn."""
        kept, now = (*self.velocity, *self.spin), (*self.now, *self.spin_now)
        rates = np.concatenate([velocity, spin.reshape(*velocity.shape[:2], self.turns)], axis=-1)
        for *fields, values in zip(kept, now, np.moveaxis(rates, -1, 0), strict=True):
            whole = self._filled(values, 0.0, 0.0)
            for field in fields:
                field.from_numpy(whole.astype(np.float32) if field.dtype == ti.f32 else whole)
        for field in (*self.force, *self.torque):
            field.fill(0.0)

    def read(self) -> dict[str, np.ndarray]:
        """Positions and velocities (W, n, axes), and as `launch` has spins angles and spins, at the present time.

        A grain that has left the scene has no position: NaN.
        """
        position, velocity, angle, spin = (
            np.stack([field.to_numpy()[:, : self.mobile] for field in fields], axis=-1)
            for fields in (self.place, self.now, self.angle, self.spin_now)
        )
        if self.turns == 1:
            angle, spin = angle[..., 0], spin[..., 0]
        if self.periodic:
            whole = float(self.period.to_numpy()[0])
            position[..., -1] -= whole * np.round(position[..., -1] / whole)
        if self.may_leave:
            position[self.present.to_numpy()[:, : self.mobile] == 0.0] = np.nan
        return {"position": position, "velocity": velocity, "angle": angle, "spin": spin}

    def fields(self) -> list[ti.Field]:
        """All arrays of the grains, each once: some have two names."""
        held = (held if isinstance(held, list) else [held] for held in vars(self).values())
        return list({id(field): field for fields in held for field in fields if isinstance(field, ti.Field)}.values())

    @ti.func
    def at(self, w, i):
        """The place (m) of grain i, a list with an entry for each axis."""
        return [field[w, i] for field in ti.static(self.place)]

    @ti.func
    def push(self, w, i, force: ti.template(), torque):
        """Add a force (N) and torque (N m), lists, on grain i. Written out: Taichi takes `+=` on a field as atomic."""
        for a in ti.static(range(self.axes)):
            self.force[a][w, i] = self.force[a][w, i] + force[a]
        for k in ti.static(range(self.turns)):
            self.torque[k][w, i] = self.torque[k][w, i] + torque[k]

    @ti.func
    def fastest(self, w):
        """The highest speed (m/s) of a world's grains."""
        highest = ti.cast(0.0, self.real)
        for i in range(self.units.moving()):
            v = [field[w, i] for field in ti.static(self.velocity)]
            highest = ti.max(highest, dot(v, v))
        return ti.sqrt(highest)

    @ti.func
    def between(self, w, i, j):
        """The centre of grain i less that of j (m), with the digits of places."""
        return self.nearest([self.place[a][w, i] - self.place[a][w, j] for a in ti.static(range(self.axes))])

    @ti.func
    def nearest(self, apart: ti.template()):
        """The difference (m) of two places, to the nearest image where space repeats itself along the last axis."""
        if ti.static(not self.periodic):
            return apart
        else:
            along, whole, half = apart[self.axes - 1], self.period[0], self.period[1]
            along = ti.select(along > half, along - whole, ti.select(along < -half, along + whole, along))
            return [apart[a] if ti.static(a < self.axes - 1) else along for a in ti.static(range(self.axes))]

    @ti.func
    def fold(self, w, i):
        """Bring grain i back where it has gone past the end of a space that repeats itself.

        Done where lists are built, so that no step has to; in between it goes no farther than these bear.
        """
        if ti.static(self.periodic):
            last = ti.static(self.axes - 1)
            along, whole, half = self.place[last][w, i], self.period[0], self.period[1]
            if along > half:
                self.place[last][w, i] = along - whole
            elif along < -half:
                self.place[last][w, i] = along + whole

    @ti.func
    def remove(self, w, i):
        """Take a grain out of the scene, to rest far away from all others: no two may be in one place."""
        self.present[w, i] = 0.0
        for a in ti.static(range(self.axes)):
            self.place[a][w, i] = FAR
            self.velocity[a][w, i], self.now[a][w, i] = 0.0, 0.0
        self.place[0][w, i] = 2.0 * FAR + 10.0 * i
        for k in ti.static(range(self.turns)):
            self.spin[k][w, i], self.spin_now[k][w, i] = 0.0, 0.0
