"""What is known of water between grains."""

from solvers.machine.quantity import Quantity

FRAMES = (
    Quantity(
        "water_porosity",
        "1",
        label="share of the room about each particle of water that is water",
        per="water_particle",
    ),
)
