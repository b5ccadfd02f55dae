"""The request for a calibration, and the file that stores it."""

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

from lab.base.errors import LabError
from lab.base.files import write_text

FORMAT = "cargo-shift-lab calibration 1"
FILE_NAME = "asked.json"  # marks a folder as that of a calibration
SWEEP = "sweep.json"  # as that of a sweep


@dataclass(frozen=True)
class Request:
    """A request: preset, target and range as texts as the user gave them; the overrides as nested tables."""

    preset: str
    target: str
    vary: str
    overrides: dict = field(default_factory=dict)


def read_request(folder: Path) -> Request:
    """Read the request of the calibration in a folder. Raises LabError."""
    path = folder / FILE_NAME
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        if content.pop("format") != FORMAT or not all(
            isinstance(content[k], str) for k in ("preset", "target", "vary")
        ):
            raise ValueError("another format")
        return Request(**{**content, "overrides": dict(content["overrides"])})
    except OSError as error:
        raise LabError(f"{path} cannot be read ({error.strerror}): name the folder of a calibration.") from error
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise LabError(f"{path} is damaged: calibrate again in another folder.") from error


def check_folder(request: Request, folder: Path) -> None:
    """Raise LabError if the folder holds another calibration."""
    if (folder / FILE_NAME).exists() and read_request(folder) != request:
        raise LabError(f"{folder} holds another calibration than the requested one: choose another folder with --out.")


def write_request(request: Request, folder: Path) -> None:
    """Write the request to the calibration's folder. Raises LabError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        content = json.dumps({"format": FORMAT, **asdict(request)}, indent=1)
        write_text(folder / FILE_NAME, content + "\n")
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror or error}): make room there.") from error
