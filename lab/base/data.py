"""Where data lie: shipped presets, benchmarks of the source, and measured series, which are in a user's folder."""

import os
from pathlib import Path

PRESETS = Path(__file__).parents[2] / "presets"  # beside the lab; not found by its name, which a user's folder may have
BENCHMARKS = PRESETS.with_name("benchmarks")  # in the source alone
FOLDER = "CARGOLAB_DATA"  # the environment variable that names the folder of measured series
PREFIX = f"${FOLDER}/"  # begins the name of a file in that folder


def data_file(name: str) -> Path | None:
    """The file of that path in the folder; None if it is not there."""
    folder = os.environ.get(FOLDER)
    path = Path(folder or "", name)
    return path if folder and path.is_file() else None
