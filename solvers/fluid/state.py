"""The particles of water: their arrays, in blocks of lanes, and what is published of each for its neighbours."""

import numpy as np
import taichi as ti

from solvers.fluid.given import Air, Water
from solvers.fluid.terms.end_walls import MODES
from solvers.machine.memory import KINDS
from solvers.machine.quantity import PLANE, SPACE
from solvers.machine.state import Axis, State, roomy
from solvers.space.axes import named

# Particles in a block: in the plane two AVX2 registers, or one of AVX-512, of 32-bit numbers; in space one of AVX2, as
# there are twice the sums, and a block of 16 sees a quarter more neighbours that are none of most of its lanes
LANES = {PLANE: 16, SPACE: 8}
# Blocks for each full one, for those that a sparse surface leaves half empty; and for each strip, whose last block is
SPARE, OF_STRIP = {PLANE: 1.5, SPACE: 1.25}, {PLANE: 2, SPACE: 1}
LONG = 2**18  # lanes from which on arrays are no more than an eighth too long; in space they always are
ROOM = 16384  # lanes for which there is room at least: tanks up to there, all together, share compiled kernels
BESIDE = 64.0  # lanes of walls for the root of those of water: four rows round a tank that is longer than it is high
COUNT, FLUID, WALLS = range(3)  # of the numbers that differ between tanks: particles, blocks that they may use, walls'
FAR = 1e6  # m, where unused lanes are
DENSEST = 0.2  # deviation of the density within the water at which a run is stopped
DENSEST_SPRAY = 0.5  # that of drops, and of the surface: a drop that hits a wall at Mach 0.2 is compressed by a fifth
DENSEST_AIR = 30.0  # that of air, which a slow speed of sound makes soft: trapped under an impact it all but vanishes
THINNEST = -0.8  # density deviation of air down to which it is drawn out; a particle cannot stand for a larger void
INSIDE = 0.75  # smallest eigenvalue above which no surface is near (Marrone, Colagrossi, Le Touzé & Graziani 2010)
SPRAY = 0.2  # smallest eigenvalue below which water is spray, which bears no suction (Marrone et al. 2010)
UNUSED = -1  # number of an unused lane


def snug(wanted: int, usual: int, parts: int = 8) -> int:
    """As `roomy` for long arrays: at least the `usual` length, and too long by no more than one of `parts`."""
    step = max(1, (1 << max(0, wanted - 1).bit_length()) // (2 * parts))
    return max(usual, -(-wanted // step) * step)


def allowed(eigenvalue: np.ndarray) -> np.ndarray:
    """The density deviation (n,) at which a run is stopped, by the particles' smallest `eigenvalue` (n,)."""
    return np.where(eigenvalue < INSIDE, DENSEST_SPRAY, DENSEST)


@ti.data_oriented
class Particles:
    """Particles in `stride` blocks a world: `fluid_blocks` of which `used` are in use, then `wall_blocks`.

    Of either there are lengths that many tanks have in common; `sizes` are the numbers of the scene. Fields (W ·
    stride, lanes), in the tank's axes. `place` (m); `velocity` (m/s), over the earth; `deviation` s = ρ/ρ0 − 1; `mass`
    (kg per metre of thickness) and `number` belong to a particle for good and move with it from block to block.
    `volume` (m²) and `pressure` (Pa) are published at the start of a step. `rate` and `rate_of_walls` (1/s) are those
    of s, and the `rate` of wall particles how fast water closes on them (`DivergenceCorrection`); `acceleration` (m/s²)
    is that of the last kick; `gradient` (1/m) the renormalised gradient of s; `eigenvalue` the smallest one of Σ V_j
    r_ji ⊗ ∇W, 1 within water; `carried` (N/m) the momentum that shifts bring (`shifting`). Of two phases, `gas` is 1
    for particles of air, 0 for those of water, `eigenvalue` is of the own phase, and wall particles have the pressure
    that water sees in `pressure`, that which air sees in `pressure_of_air`, and the water's `share` of what they see.
    Between grains `volume` is that of grains and water together, of which `porosity` is the water's share, 0 as long as
    it is not known.

    With `lanes` 1, for processors that move each particle by a thread of its own, a block is a particle. The usual room
    is shared `among` so many worlds, 0: those that there are.
    """

    def __init__(
        self,
        arrays: State,
        axes: int,
        worlds: int,
        count: int,
        lanes: int,
        walls: int,
        strips: int,
        shifting,
        air: Air | None = None,
        among: int = 0,
        end_walls: bool = False,
        porous: bool = False,
    ):
        self.axes, self.worlds, self.count, self.lanes = axes, worlds, count, lanes
        self.real, self.exact, self.where = arrays.real, arrays.exact, arrays.place
        spared = int(SPARE[axes] * -(-count // lanes)) + OF_STRIP[axes] * strips
        sizes = count, count if lanes == 1 else spared, -(-walls // lanes)
        fitted = snug if axes > PLANE or sizes[FLUID] * lanes > LONG else roomy
        self.fluid_blocks = fitted(sizes[FLUID], roomy(1, ROOM // lanes // (among or worlds)))
        self.walls, beside = sizes[WALLS], roomy(1, int(BESIDE * (self.fluid_blocks * lanes) ** 0.5) // lanes)
        self.wall_blocks = fitted(self.walls, beside) if walls else 0
        self.stride = self.fluid_blocks + self.wall_blocks
        blocks, own = Axis("block", worlds * self.stride), arrays.under("water")
        # What walls have none of; of several worlds walls stand between the blocks of water
        alone = axes > PLANE and (among or worlds) == 1
        self.of_water = Axis("block", self.fluid_blocks if alone else blocks.length), Axis("lane", lanes)
        self.sizes = own.holding("sizes", np.array(sizes), "size", ti.i32)
        each = blocks, Axis("lane", lanes)
        self.place = own.wide(each, *named("place", self.axes), kind=own.place)
        self.velocity = own.wide(each, *named("velocity", self.axes))
        self.deviation, self.mass = own.wide(self.of_water, "deviation", "mass")
        (self.number,) = own.wide(each, "number", kind=ti.i32)
        self.volume, self.pressure, self.eigenvalue = own.wide(each, "volume", "pressure", "eigenvalue")
        (self.firm,) = own.wide(each, "firm")
        (self.rate,) = own.wide(each, "rate", kept=False)
        (self.rate_of_walls,) = own.wide(self.of_water, "rate_of_walls", kept=False)
        self.acceleration = own.wide(self.of_water, *named("acceleration", self.axes))
        if shifting.acts:
            (self.eigenvalue_before,) = own.wide(each, "eigenvalue_before", kept=False)
            self.shift = own.wide(each, *named("shift", self.axes), kept=False)
        if shifting.carries:
            self.carried = own.wide(each, *named("carried", self.axes), kept=False)
        self.gradient = own.wide(self.of_water, *named("gradient", self.axes))
        self.two = air is not None
        self.noted: list[ti.Field] = (
            [self.eigenvalue] if shifting.acts else []
        )  # of the step before, as the next one needs it
        if air and air.tension > 0.0:
            stresses = "stress_yy", "stress_yz", "stress_zz"
            self.stress = own.wide(each, *stresses)
            self.stress_before = own.wide(each, *(f"{name}_before" for name in stresses), kept=False)
            self.noted += self.stress
        if self.two:
            (self.gas,) = own.wide(each, "gas")
            self.pressure_of_air, self.share = own.wide(each, "pressure_of_air", "share", kept=False)
        self.end_wall_modes = []  # by mode and axis, m/s: how water passes the end walls (`EndWallFriction`)
        if end_walls:
            self.end_wall_modes = [own.wide(each, *named(f"end_wall_{n}", self.axes)) for n in range(MODES)]
            self.noted += [field for mode in self.end_wall_modes for field in mode]
        self.porous = porous
        if porous:
            (self.porosity,) = own.wide(each, "porosity")
            self.noted.append(self.porosity)
        self.built = own.wide(each, *named("built", self.axes), kind=own.place)
        self.each_world = Axis("world", worlds)
        (self.used,) = own.integers((self.each_world,), "used", below=self.fluid_blocks + 1)

    @property
    def moved(self) -> list[ti.Field]:
        """The arrays that belong to particles and are carried from block to block."""
        return [*self.given, *self.noted]

    @property
    def given(self) -> list[ti.Field]:
        """Those of them that a scene tells."""
        always = [*self.place, *self.velocity, self.deviation, self.mass, self.number]
        return [*always, self.gas] if self.two else always

    def fields(self) -> list[ti.Field]:
        """All arrays that a step changes."""
        return [*self.moved, *self.acceleration, self.used]

    def put(self, start: np.ndarray, water: Water, present: np.ndarray) -> None:
        """Fill the blocks in the order of the numbers with those particles (W, n) that are `present` (n,) at the start.

        Each is as it starts (`given.particles`).
        """
        number, start = np.flatnonzero(present), start[:, present]
        density = water.density
        if self.two:
            density = np.where(start["gas"], water.air.density, water.density)
        mass = density * (1.0 + start["deviation"]) * start["volume"]
        along = [start[name][..., axis] for name in ("position", "velocity") for axis in range(start[name].shape[-1])]
        columns = [*along, start["deviation"], mass, np.broadcast_to(number, mass.shape)]
        columns += [*([start["gas"]] if self.two else []), start["volume"]]
        fills = [*[FAR] * self.axes, *[0.0] * self.axes, 0.0, 0.0, UNUSED, *([0.0] if self.two else []), 0.0]
        for field, values, fill in zip([*self.given, self.volume], columns, fills, strict=True):
            whole = self.by_world(field.to_numpy())
            whole[:, : self.fluid_blocks * self.lanes] = fill
            whole[:, : len(number)] = values
            field.from_numpy(whole.reshape(-1, self.lanes))
        for field in (*self.acceleration, *(field for mode in self.end_wall_modes for field in mode)):
            field.fill(0.0)
        if self.porous:
            unused = self.number.to_numpy() == UNUSED
            self.porosity.from_numpy(unused.astype(KINDS[self.porosity.dtype]))
        self.used.fill(-(-len(number) // self.lanes))

    def put_walls(self, slots: np.ndarray, blocks: np.ndarray, volume: np.ndarray, firm: np.ndarray, solids) -> None:
        """Place the walls of tanks in these `slots` of their `blocks`, and after them those of the `solids` in them."""
        held = [np.zeros(len(blocks) * self.lanes, kind) for kind in (float, float, int)]
        held[2][:] = UNUSED
        held[0][slots], held[1][slots], held[2][slots] = volume, firm, np.arange(len(slots))
        of_tanks = blocks, *(one.reshape(-1, self.lanes) for one in held)
        both = zip(of_tanks, (solids.places, solids.volumes, solids.firm, solids.numbers), strict=True)
        places, *rest = (np.concatenate([tank, body]) if len(body) else tank for tank, body in both)
        fields = *self.place, self.volume, self.firm, self.number
        for field, values in zip(fields, [*np.moveaxis(places, 2, 0), *rest], strict=True):
            whole = field.to_numpy().reshape(self.worlds, self.stride, self.lanes)
            whole[:, self.fluid_blocks : self.fluid_blocks + self.walls] = values
            field.from_numpy(whole.reshape(-1, self.lanes))

    def by_world(self, values: np.ndarray) -> np.ndarray:
        """The lanes of each world in a row, (W, stride · lanes), or those of water alone."""
        return values.reshape(self.worlds, -1)

    def read(self, *fields: ti.Field) -> list[np.ndarray]:
        """Values (W, n) of these fields in the order of the particles' numbers; NaN of those that have not entered."""
        wet = slice(0, self.fluid_blocks * self.lanes)
        number = self.by_world(self.number.to_numpy())[:, wet]
        worlds, slots = np.nonzero(number != UNUSED)
        found = [np.full((self.worlds, self.count), np.nan, KINDS[field.dtype]) for field in fields]
        for rows, field in zip(found, fields, strict=True):
            rows[worlds, number[worlds, slots]] = self.by_world(field.to_numpy())[:, wet][worlds, slots]
        return found

    # Lanes are gone through in loops, which LLVM unrolls: 16 accesses for each load, written out, would make Taichi's
    # compilation, whose time grows as the square of a kernel's length, take more than twice as long.

    @ti.func
    def load(self, field: ti.template(), b):
        """The lanes of a block as a vector."""
        values = ti.Vector([ti.cast(0.0, field.dtype) for _ in ti.static(range(self.lanes))])
        for lane in range(self.lanes):
            values[lane] = field[b, lane]
        return values

    @ti.func
    def store(self, field: ti.template(), b, values):
        """Write the lanes of a block."""
        for lane in range(self.lanes):
            field[b, lane] = values[lane]

    @ti.func
    def offset(self, b, origin: ti.template(), axis: ti.template()):
        """Places of a block along an axis less the number `origin`, in the precision of `real`."""
        values = self.zeros()
        for lane in range(self.lanes):
            values[lane] = ti.cast(self.place[axis][b, lane] - origin, self.real)
        return values

    @ti.func
    def long(self, values):
        """Lanes of `real` numbers with the digits of places; lane by lane, since whole vectors cannot be cast."""
        whole = ti.Vector([ti.cast(0.0, self.where) for _ in ti.static(range(self.lanes))])
        for lane in range(self.lanes):
            whole[lane] = ti.cast(values[lane], self.where)
        return whole

    @ti.func
    def short(self, values):
        """Lanes of places with the digits of `real`."""
        part = self.zeros()
        for lane in range(self.lanes):
            part[lane] = ti.cast(values[lane], self.real)
        return part

    @ti.func
    def filled(self, b):
        """1 in lanes in use, 0 in others."""
        mass = self.load(self.mass, b)
        return ti.select(mass > 0.0, self.ones(), self.zeros())

    @ti.func
    def borne(self, b, density):
        """The mass of water in a volume of the mixture (kg/m³), from the water's own `density`."""
        if ti.static(self.porous):
            return density * self.load(self.porosity, b)
        else:
            return density

    @ti.func
    def filling_mass(self, b, lane):
        """The mass (kg/m) that a particle would have if water filled all of its volume."""
        if ti.static(self.porous):
            return self.mass[b, lane] / self.porosity[b, lane]
        else:
            return self.mass[b, lane]

    @ti.func
    def gases(self, b):
        """1 in lanes with air, 0 in those with water."""
        if ti.static(self.two):
            return self.load(self.gas, b)
        else:
            return self.zeros()

    @ti.func
    def gas_at(self, b, lane):
        """1 for a particle of air, 0 for one of water."""
        if ti.static(self.two):
            return self.gas[b, lane]
        else:
            return ti.cast(0.0, self.real)

    @ti.func
    def zeros(self):
        """A vector of lanes of zeros."""
        return ti.Vector([ti.cast(0.0, self.real) for _ in ti.static(range(self.lanes))])

    @ti.func
    def ones(self):
        """A vector of lanes of ones."""
        return ti.Vector([ti.cast(1.0, self.real) for _ in ti.static(range(self.lanes))])
