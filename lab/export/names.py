"""The names of the formats, what opens them, and where they are written; nothing is loaded for these."""

from dataclasses import dataclass


@dataclass(frozen=True)
class About:
    """A format: what opens it; `place`: of its file or folder beside a recording; whether it is a folder.

    keeps: whether it holds the recording as it is: all worlds, in the tank's axes, with the pose beside them.
    """

    opens: str
    place: str
    folder: bool = False
    keeps: bool = False


NAMES = {
    "vtkhdf": About("ParaView, VTK", "vtkhdf", folder=True),
    "gsd": About("OVITO, HOOMD", "recording.gsd"),
    "xyz": About("OVITO and most programs for particles", "recording.xyz"),
    "csv": About("spreadsheets, pandas, R", "csv", folder=True),
    "netcdf": About("xarray, Matlab, Julia", "recording.nc", keeps=True),
    "html": About("any browser", "player.html"),
}
FRAMES = "earth", "tank"  # of reference
