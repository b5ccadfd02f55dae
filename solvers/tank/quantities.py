"""What is known of the tank: how it moves and what loads it (`motion.sampler`), and its parts (`walls`).

A tank on an axle has further ones (`motion.axle`), and so have bodies that float (`motion.free`). Files of quantities
import no Taichi, for those who read recordings need none.
"""

from solvers.machine.quantity import Quantity, directions, freedoms

POSE = Quantity("pose", "m, m, rad", freedoms, "place and roll of the tank in the earth's axes")
POSE_RATE = Quantity("pose_rate", "m/s, m/s, rad/s", freedoms, "velocity and rate of roll of the tank")
WALL_FORCE = Quantity(
    "wall_force", "N, N, N m", freedoms, "force of the cargo on the tank, in the tank's axes", mean=True
)
SERIES = (POSE, POSE_RATE, WALL_FORCE)
FRAMES = (
    POSE,
    Quantity("part", "m", directions, "displacement of each moving part in the tank", per="part"),
    Quantity("part_turn", "rad", label="angle by which each part has turned in the tank", per="part", never=0.0),
)
FRAMES_OF_BODIES_IN_SPACE = (
    Quantity("part_pitch_yaw", "rad", ("pitch", "yaw"), "pitch and yaw of each part in the tank", per="part"),
)
OF_FACES = (
    Quantity(
        "face_force",
        "N, N, N m",
        freedoms,
        "force of the cargo on each face of a tank in space, in the tank's axes",
        mean=True,
        per="face",
    ),
)
OF_PARTS = (
    Quantity(
        "part_load",
        "N, N, N m",
        freedoms,
        "force of the cargo on each part, in the tank's axes",
        mean=True,
        per="part",
    ),
)
OF_BODIES = (
    Quantity(
        "body_place",
        "m, m, rad",
        freedoms,
        "centre of mass of each floating body in the tank, and how far it has turned",
        per="body",
    ),
    Quantity(
        "body_velocity",
        "m/s, m/s, rad/s",
        freedoms,
        "velocity of the centre of mass of each floating body over the earth, and its rate of turning",
        per="body",
    ),
    Quantity(
        "body_energy", "J", label="kinetic and potential energy of each floating body, over the earth", per="body"
    ),
    Quantity("body_work", "J", label="work of all that pushes each floating body, since its release", per="body"),
    Quantity("contact_elastic", "J", label="elastic energy of the contacts of floating bodies"),
    Quantity("contact_lost", "J", label="energy that contacts of floating bodies have taken since the start"),
)
OF_AXLE = (
    Quantity("axle_moment", "N m", label="moment of the cargo on the whole tank about the axle", mean=True),
    Quantity("axle_slide", "m", label="place of the sliding mass along its rail"),
    Quantity("axle_energy", "J", label="kinetic and potential energy of the tank and the sliding mass, empty"),
    Quantity(
        "axle_works",
        "J",
        ("cargo", "slide", "friction", "damping"),
        "work so far: of the cargo on the tank, of the slide, against friction, against damping",
    ),
)
