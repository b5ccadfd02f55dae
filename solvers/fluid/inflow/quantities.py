"""What is known of water that enters a ship by her openings."""

from solvers.machine.quantity import Quantity

SERIES = (
    Quantity(
        "inflow_volume",
        "m^3",
        label="volume of the water that has entered by each opening, less what has left by it",
        per="inlet",
    ),
    Quantity("inflow_rate", "m^3/s", label="flow into the room behind each opening of the ship", per="inlet"),
    Quantity("inflow_energy", "J", label="energy that water brought as it entered, less what it took along"),
)
