"""What is known of the grains: their sums (`diagnostics`), and each of them (`state`)."""

from solvers.machine.quantity import Quantity, directions, rotations

# Of an open tank, all but the last are of the grains in it.
SERIES = (
    Quantity("centre_of_mass", "m", directions, "centre of mass of the grains in the tank"),
    Quantity("kinetic", "J", label="kinetic energy of the grains, relative to the tank"),
    Quantity("rotational", "J", label="kinetic energy of the grains' spin, relative to the tank"),
    Quantity("potential", "J", label="potential energy of the grains above the earth's origin"),
    Quantity("elastic", "J", label="elastic energy of the contacts"),
    Quantity("contacts", "1", label="number of contacts"),
    Quantity("overlap", "1", label="deepest overlap, in radii"),
    Quantity("spilled", "1", label="number of grains that have left the tank"),
)
# What the watch asks and no recording has: the number of a grain that has left a closed tank.
ESCAPED = Quantity("escaped", "1", label="number of a grain outside the tank", never=-1.0)
FRAMES = (
    Quantity("position", "m", directions, "place of each grain in the tank", per="grain"),
    Quantity("velocity", "m/s", directions, "velocity of each grain, relative to the tank", per="grain"),
    Quantity("angle", "rad", rotations, "angle of each grain, relative to the tank", per="grain"),
    Quantity("spin", "rad/s", rotations, "spin of each grain, relative to the tank", per="grain"),
)
