"""What is known of a ship further, per metre of her length (`motion.floating_ships`)."""

from solvers.machine.quantity import Quantity

SERIES = (
    Quantity(
        "ship_works",
        "J/m",
        ("waves", "radiation", "viscosity", "cargo"),
        "work so far: of the waves, against radiation, against viscosity, of the cargo on the ship",
    ),
    Quantity("capsized", "s", label="time at which the ship capsized", never=-1.0),
    Quantity("flooded", "s", label="time at which the ship flooded", never=-1.0),
)
OF_INFLOW = (
    Quantity("sunk", "s", label="time at which the ship sank, with more water aboard than she can bear", never=-1.0),
)
