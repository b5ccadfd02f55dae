"""The material points of the bulk: places, velocities and their gradients, stresses and volumes."""

import numpy as np
import taichi as ti

from solvers.bulk.given import Bulk
from solvers.machine.quantity import PLANE
from solvers.machine.state import Axis, State

# Of the stress's deviator: its components along y and z, across x, and the shear; what is along x follows
ALONG_Y, ALONG_Z, SHEAR = range(3)


@ti.data_oriented
class Points:
    """Material points in W worlds, in the tank's axes.

    `place` (m), `velocity` (m/s, half a step behind) and `gradient` of it (1/s), row by row; `volume` (m²) now and
    `free` of stress, `mass` (kg/m); `deviator` (Pa) of the stress; `strain`: the plastic shear strain so far, `use`:
    how much of the friction is called on, |s|/(μ_s p).
    """

    axes = PLANE

    def __init__(self, arrays: State, bulk: Bulk):
        self.worlds, self.count, self.real, self.exact = bulk.worlds, bulk.count, arrays.real, arrays.exact
        own = arrays.under("bulk")
        self.each = each = Axis("world", self.worlds), Axis("point", self.count)
        self.place = own.reals(each, "y", "z", kind=own.place)
        self.velocity = own.reals(each, "v_y", "v_z")
        self.gradient = own.reals(each, "v_y_y", "v_y_z", "v_z_y", "v_z_z")
        self.deviator = own.reals(each, "s_yy", "s_zz", "s_yz")
        self.volume, self.free, self.mass = own.reals(each, "volume", "free", "mass")
        self.strain, self.use = own.reals(each, "strain", "use")

    @ti.func
    def kinetic(self, w, i, quarter_y, quarter_z):
        """Kinetic energy (J/m) of a point and of the velocity about it; `quarter`: of a cell's side squared (m²)."""
        square = self.velocity[0][w, i] * self.velocity[0][w, i] + self.velocity[1][w, i] * self.velocity[1][w, i]
        of_y = self.gradient[0][w, i] * self.gradient[0][w, i] + self.gradient[2][w, i] * self.gradient[2][w, i]
        of_z = self.gradient[1][w, i] * self.gradient[1][w, i] + self.gradient[3][w, i] * self.gradient[3][w, i]
        return 0.5 * self.mass[w, i] * (square + quarter_y * of_y + quarter_z * of_z)

    def fields(self) -> list[ti.Field]:
        """The arrays that a step changes."""
        return [*self.place, *self.velocity, *self.gradient, *self.deviator, self.volume, self.strain, self.use]

    def put(self, points: np.ndarray, sideways: float, modulus: float) -> None:
        """Place the points at rest, under their pressures; `sideways`: the stress across over that along z."""
        for axis in range(self.axes):
            self._set(self.place[axis], points["position"][..., axis])
        for field in (*self.velocity, *self.gradient, self.strain, self.use):
            field.fill(0.0)
        # Of a bed whose pressure is the mean of 1 and twice what is sideways; the deviator sums up to zero with x
        upright = 3.0 / (1.0 + 2.0 * sideways) * points["pressure"]
        self._set(self.deviator[ALONG_Y], points["pressure"] - sideways * upright)
        self._set(self.deviator[ALONG_Z], points["pressure"] - upright)
        self.deviator[SHEAR].fill(0.0)
        self._set(self.free, points["volume"])
        self._set(self.volume, points["volume"] / (1.0 + points["pressure"] / modulus))
        self._set(self.mass, points["mass"])

    @staticmethod
    def _set(field: ti.Field, values: np.ndarray) -> None:
        field.from_numpy(np.ascontiguousarray(values, dtype=field.to_numpy().dtype))

    def read(self, *fields: ti.Field) -> list[np.ndarray]:
        """The values (W, n) of fields."""
        return [field.to_numpy().astype(float) for field in fields]
