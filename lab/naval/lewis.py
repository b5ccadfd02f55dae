"""`cargolab lewis`: offsets of a hull of Lewis sections with a ship's particulars."""

from collections.abc import Mapping
from pathlib import Path

from lab.assembly.lines.offsets import rows_of, text_of
from lab.base.errors import LabError
from lab.base.files import write_text
from solvers.machine.errors import Unavailable
from solvers.ship.naval.lewis_hull import Particulars, lewis_hull
from solvers.ship.water import Water

LARGEST = 1000.0  # m, or of a coefficient
SALT = Water(1025.0)


def write_lewis(path: Path, particulars: Mapping[str, float | None]) -> str:
    """Write the offsets of a hull of Lewis sections; returns what she is. Raises LabError for what no such hull has."""
    for name, value in particulars.items():
        if value is not None and not 0.0 < value < LARGEST:
            raise LabError(f"--{name}: must be above 0 and below {LARGEST:g} (got {value:g}).")
    if particulars["depth"] <= particulars["draught"]:
        raise LabError("--depth: must be more than the draught.")
    try:
        form = lewis_hull(Particulars(**particulars))
    except Unavailable as error:
        raise LabError(f"{path.name}: {error}") from None
    try:
        write_text(path, text_of(list(rows_of(form))))
    except OSError as error:
        raise LabError(f"{path} cannot be written ({error.strerror}): choose another place.") from error
    one = form.hydrostatics(particulars["draught"], SALT)
    return (
        f"{path}: {one.volume:.5g} m³; Cb {one.block:.3f}, Cm {one.midship:.3f}, Cw {one.plane:.3f}; "
        f"KB {one.kb:.3f}, BM {one.bm:.3f}, KM {one.km:.3f} m"
    )
