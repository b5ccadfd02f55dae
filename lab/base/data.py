"""Measured series that are not shipped: they are in the folder that the environment variable CARGOLAB_DATA names."""

import os
from pathlib import Path

FOLDER = "CARGOLAB_DATA"
PREFIX = f"${FOLDER}/"  # begins the name of a file in that folder


def data_file(name: str) -> Path | None:
    """The file of that path in the folder; None if it is not there."""
    folder = os.environ.get(FOLDER)
    path = Path(folder or "", name)
    return path if folder and path.is_file() else None
