"""What is known of the air in a tank with water: its sums (`diagnostics`), and each of its particles (`state`)."""

from solvers.machine.quantity import Quantity, directions

SERIES = (
    Quantity("air_centre", "m", directions, "centre of mass of the air in the tank"),
    Quantity("air_kinetic", "J", label="kinetic energy of the air, relative to the tank"),
    Quantity("air_mean_pressure", "Pa", label="mean pressure of the air, over that outside"),
    Quantity("air_volume", "m^3", label="volume of the air"),
    Quantity("air_density_deviation", "1", label="largest relative deviation of the air's density, |ρ/ρ0 − 1|"),
)
FRAMES = (
    Quantity("air_position", "m", directions, "position of each particle of air in the tank", per="air_particle"),
    Quantity(
        "air_velocity", "m/s", directions, "velocity of each particle of air, relative to the tank", per="air_particle"
    ),
    Quantity("air_pressure", "Pa", label="pressure of each particle of air, over that outside", per="air_particle"),
)
