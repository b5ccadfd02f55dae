"""What is known of the air in a tank with water: its sums (`census`), and each of its particles (`state`)."""

from solvers.machine.quantity import Quantity, directions

SERIES = (
    Quantity("air_centre", "m", directions, "centre of mass of the air in the tank"),
    Quantity("air_kinetic", "J", label="kinetic energy of the air, relative to the tank"),
    Quantity("air_mean_pressure", "Pa", label="mean pressure of the air, over that outside"),
    Quantity("air_volume", "m^3", label="volume of the air"),
    Quantity("air_excess", "1", label="largest deviation of the air's density from that at rest"),
)
FRAMES = (
    Quantity("air_place", "m", directions, "place of each particle of air in the tank", per="puff"),
    Quantity("air_velocity", "m/s", directions, "velocity of each particle of air, relative to the tank", per="puff"),
    Quantity("air_pressure", "Pa", label="pressure of each particle of air, over that outside", per="puff"),
)
