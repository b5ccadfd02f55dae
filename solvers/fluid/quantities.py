"""What is known of the water: its sums and gauges (`diagnostics`), and each of its particles (`state`)."""

from solvers.machine.quantity import Quantity, directions, freedoms

SERIES = (
    Quantity("water_centre", "m", directions, "centre of mass of the water in the tank"),
    Quantity(
        "water_momentum",
        "N s",
        directions,
        "momentum of the water, and of the air with it, over the earth, in the tank's axes",
    ),
    Quantity("water_kinetic", "J", label="kinetic energy of the water, and of the air with it, relative to the tank"),
    Quantity(
        "water_potential", "J", label="potential energy of the water, and of the air with it, above the earth's origin"
    ),
    Quantity("water_elastic", "J", label="elastic energy of compression"),
    Quantity(
        "water_total",
        "J",
        label="energy of the water, and of the air with it, over the earth: kinetic, potential and elastic",
    ),
    Quantity("water_viscous", "J", label="energy that viscosity has taken since the start"),
    Quantity("water_diffusive", "J", label="energy that diffusion of density has taken since the start"),
    Quantity("water_work", "J", label="work of the walls on the water, and on the air, since the start"),
    Quantity("water_wall_energy", "J", label="energy stored in the wall particles since the start"),
    Quantity("water_density_deviation", "1", label="largest relative deviation of the density, |ρ/ρ0 − 1|"),
    Quantity("water_dense", "1", label="share of the water whose density deviates by more than 3 %"),
    Quantity("gauge_pressure", "Pa", label="pressure at each gauge", per="gauge"),
    Quantity("gauge_peak", "Pa", label="highest pressure at each gauge since the last sample", per="gauge"),
    Quantity("edge_force", "N", directions, "force of the water on each edge of the tank", mean=True, per="edge"),
    Quantity("part_force", "N, N, N m", freedoms, "force of the water on each part in it", mean=True, per="part"),
    Quantity(
        "part_work", "J", label="work of each part on the water since the start, by its motion in the tank", per="part"
    ),
    Quantity("room_water", "kg", label="mass of the water in each room of a hull", per="room"),
    Quantity(
        "opening_flow",
        "kg/s",
        label="water that flows into the room behind each opening of a hull, the later one of two rooms",
        per="opening",
    ),
    Quantity("level_depth", "m", label="depth of the water above the floor at each level gauge", per="level"),
)
# What the watch asks and no recording has: the number of a particle that has left the tank.
ESCAPED = Quantity("water_escaped", "1", label="number of a particle outside the tank", never=-1.0)
FRAMES = (
    Quantity("water_position", "m", directions, "position of each particle of water in the tank", per="water_particle"),
    Quantity(
        "water_velocity", "m/s", directions, "velocity of each particle, relative to the tank", per="water_particle"
    ),
    Quantity("water_pressure", "Pa", label="pressure of each particle of water", per="water_particle"),
)
