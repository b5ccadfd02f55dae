"""The request of a calibration, and the file that keeps it."""

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

from lab.base.errors import LabError

FORMAT = "cargo-shift-lab calibration 1"
FILE_NAME = "asked.json"  # marks a folder as that of a calibration


@dataclass(frozen=True)
class Asked:
    """The request, as texts; the overrides as nested tables."""

    preset: str
    target: str
    vary: str
    overrides: dict = field(default_factory=dict)


def read_asked(folder: Path) -> Asked:
    """Read the request of the calibration in a folder. Raises LabError."""
    path = folder / FILE_NAME
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        if content.pop("format") != FORMAT or not all(
            isinstance(content[k], str) for k in ("preset", "target", "vary")
        ):
            raise ValueError("another form")
        return Asked(**{**content, "overrides": dict(content["overrides"])})
    except OSError as error:
        raise LabError(f"{path} cannot be read ({error.strerror}): name the folder of a calibration.") from error
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise LabError(f"{path} is damaged: calibrate anew in another folder.") from error


def check_folder(asked: Asked, folder: Path) -> None:
    """Raise LabError if the folder holds another calibration."""
    if (folder / FILE_NAME).exists() and read_asked(folder) != asked:
        raise LabError(f"{folder} holds another calibration than is asked for: choose another folder with --out.")


def write_asked(asked: Asked, folder: Path) -> None:
    """Write the request to the calibration's folder. Raises LabError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        content = json.dumps({"format": FORMAT, **asdict(asked)}, indent=1)
        (folder / FILE_NAME).write_text(content + "\n", encoding="utf-8")
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror or error}): make room there.") from error
