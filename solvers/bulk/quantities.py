"""What is known of the bulk: its sums (`diagnostics`), and each of its points (`state`)."""

from solvers.machine.quantity import Quantity, directions

SERIES = (
    Quantity(
        "centre_of_mass", "m", directions, "centre of mass of the bulk in the tank, each of several by its length"
    ),
    Quantity(
        "kinetic", "J", label="kinetic energy of the bulk, that of velocity gradients included, relative to the tank"
    ),
    Quantity("potential", "J", label="potential energy of the bulk above the earth's origin"),
    Quantity("elastic", "J", label="elastic energy of the bulk"),
    Quantity(
        "bulk_losses",
        "J",
        ("walls", "yielding", "opening", "volume", "grid"),
        "energy lost so far: at walls, by yielding, by opening, to the control of volume, and by way of the grid",
    ),
    Quantity("bulk_sliding", "1", label="share of the bulk's mass that slides: its friction is called on in full"),
    Quantity("bulk_crowding", "1", label="mean density on the grid over that of the points, less one"),
)
# What the watch asks and no recording has
CHECKED = (
    Quantity("bulk_escaped", "1", label="number of a point outside the grid", never=-1.0),
    Quantity("bulk_densest", "1", label="greatest compression of a point"),
)
FRAMES = (
    Quantity("bulk_position", "m", directions, "place of each point of the bulk in the tank", per="point"),
    Quantity("bulk_velocity", "m/s", directions, "velocity of each point, relative to the tank", per="point"),
    Quantity("bulk_pressure", "Pa", label="pressure at each point", per="point"),
    Quantity("bulk_friction", "1", label="mobilised friction at each point, shear stress over μ_s p", per="point"),
    Quantity("bulk_strain", "1", label="plastic shear strain of each point since the start", per="point"),
)
