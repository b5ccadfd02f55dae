"""The axes of a surface: what turns and moves them if that is asked, and what refuses a hull that is not in hers.

x forward, y to starboard, z up, the middle plane at y = 0. The file's x and z are kept.
"""

from dataclasses import dataclass

import numpy as np

from lab.base.errors import LabError
from lab.naval.surfaces.mesh import Mesh

LONGEST = 600.0  # m; the longest ship had 458
CENTRED = 1e-3  # of an extent: a hull this close to the middle is in it


@dataclass(frozen=True)
class Axes:
    """How a file's axes become the hull's: metres in its unit, the axis that is up in it, the place (m) of the origin.

    The origin is given with z up. `mirror` and `close` ask for what a half hull and one without a deck lack.
    """

    scale: float = 1.0
    up: str = "z"
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    mirror: bool = False
    close: bool = False

    def placed(self, triangles: np.ndarray) -> np.ndarray:
        """A file's triangles (n, 3, 3) in the hull's axes, in m."""
        turned = triangles if self.up == "z" else triangles[..., [0, 2, 1]] * [1.0, -1.0, 1.0]
        return turned * self.scale - np.array(self.origin)


def check_size(mesh: Mesh) -> None:
    """Raise LabError for a hull that is longer than any ship, or far from the origin."""
    longest = float(mesh.extent.max())
    if longest > LONGEST:
        raise LabError(
            f"{mesh.name}: is {longest:.6g} m long, longer than any ship; if the file is in millimetres, give "
            "--scale 0.001."
        )
    off = float(np.maximum(mesh.low, -mesh.high).max())
    if off > longest:
        aft, low, middle = mesh.low[0], mesh.low[2], 0.5 * (mesh.low[1] + mesh.high[1])
        raise LabError(
            f"{mesh.name}: lies {off:.6g} m from its origin, further than it is long; move the origin to the hull, as "
            f"with --origin {_number(aft)} {_number(middle)} {_number(low)}, which is her aft end, middle and lowest "
            "point."
        )


def check_middle(mesh: Mesh) -> None:
    """Raise LabError for a closed hull whose middle plane is not y = 0. One whose sides differ is let pass."""
    middle, slack = 0.5 * (mesh.low + mesh.high), CENTRED * mesh.extent
    off = np.maximum(np.abs(middle), np.abs(mesh.centre)) > slack  # where box and centre are not both at 0
    if not off[1]:
        return
    beside = mesh.low[1] > -slack[1] or mesh.high[1] < slack[1]
    if not beside and abs(middle[1] - mesh.centre[1]) > slack[1] and off[2]:
        return
    reach = f"reaches from y {mesh.low[1]:.7g} to {mesh.high[1]:.7g} m"
    if not off[2]:
        text = "and z from as far below 0 as above; if y is up in the file, give --up y"
    elif not off[0] and mesh.extent[1] > mesh.extent[0]:
        text = "and is alike on both sides of x = 0; turn her so that x is forward"
    else:
        whole = f"--origin 0 {_number(middle[1])} 0 puts her middle there"
        half = "if this is half of her, give --mirror, if she is whole, " if beside else ""
        text = f"and her middle has to be at y = 0; {half}{whole}"
    raise LabError(f"{mesh.name}: {reach}, {text}.")


def _number(value: float) -> str:
    return f"{value + 0.0:.8g}"
