"""Where data lie: shipped presets and their posters, benchmarks of the source, and measured series of a user's."""

import os
from pathlib import Path

PRESETS = Path(__file__).parents[2] / "presets"  # beside the lab; not found by its name, which a user's folder may have
GALLERY = Path("renders/gallery/presets")  # where `cargolab gallery` writes posters, and the source keeps them
BENCHMARKS = PRESETS.with_name("benchmarks")  # in the source alone
FOLDER = "CARGOLAB_DATA"  # the environment variable that names the folder of measured series
PREFIX = f"${FOLDER}/"  # begins the name of a file in that folder


def poster(name: str) -> Path | None:
    """The poster of a preset: from the user's gallery here, else the one that came with the lab; None without any."""
    folders = GALLERY, PRESETS / "posters", PRESETS.parent / GALLERY  # setup.py copies the third to the second
    paths = (folder / f"{name.replace('/', '-')}.webp" for folder in folders)
    return next((path for path in paths if path.is_file()), None)


def data_file(name: str) -> Path | None:
    """The file of that path in the folder; None if it is not there."""
    folder = os.environ.get(FOLDER)
    path = Path(folder or "", name)
    return path if folder and path.is_file() else None
