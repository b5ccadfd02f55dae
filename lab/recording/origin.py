"""Where a recording comes from: the versions of the lab and of what it builds on, the machine, the reference points."""

import os
import platform
from functools import cache
from importlib import metadata
from typing import TYPE_CHECKING

import numpy as np

from lab import __version__
from lab.plugins.loading import hashes
from lab.recording.layout import fixed_text

if TYPE_CHECKING:
    from lab.preset.schema import Preset

PACKAGES = ("taichi", "numpy", "scipy", "h5py")


def versions() -> dict[str, str]:
    """Versions of the lab, of Python, of the packages that the results depend on, and hashes of plug-ins, by name."""
    plugged = {f"plug-in {name}": digest for name, digest in hashes.items()}
    return {"cargo-shift-lab": __version__, "python": platform.python_version(), **_of_packages(), **plugged}


@cache
def _of_packages() -> dict[str, str]:
    found = {}
    for package in PACKAGES:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
    return found


def reference_points(preset: "Preset") -> dict[str, object]:
    """Attributes on the reference point of the poses and, for a ship, of sway and heave (see `axis_motion`)."""
    found = {"pose_is_of": fixed_text("the origin of the tank's axes")}
    if ship := preset.ship:
        from lab.preset.sections.ship import axis_place

        found["ship_axis"] = np.array(ship.about)
        found["ship_axis_in_tank"] = np.subtract(ship.about, ship.hold)
        found["sway_and_heave_are_of"] = fixed_text(f"the ship's axis, {axis_place(ship)}")
    return found


def this_machine() -> dict[str, object]:
    """The system, the processor and its cores."""
    processor = platform.processor() or platform.machine()
    return {"system": platform.platform(), "processor": processor, "cores": os.cpu_count()}
