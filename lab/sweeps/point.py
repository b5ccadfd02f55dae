"""A point of a sweep, as the summary of its run tells it."""

import json
from collections.abc import Mapping
from pathlib import Path

from lab.base.errors import LabError
from lab.base.text import one_line
from lab.measures.value import read_values


class Point:
    """One point of a sweep: its setting and, if it was run, its status, measures by name and warnings."""

    def __init__(self, setting: Mapping[str, object], folder: Path) -> None:
        self.setting, self.folder = setting, folder
        self.status, self.measures, self.warnings, self.version = "not run", {}, [], ""
        path = folder / "summary.json"
        try:
            data = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError):  # missing, or half written by a killed run
            return
        except RecursionError as error:
            raise _damaged(path) from error
        try:
            self.measures = read_values(data["measures"])
            self.status, self.warnings = data["status"], list(data["warnings"])
            self.version = data.get("version", "an earlier one")  # which did not write it
            if not all(isinstance(text, str) for text in (self.status, self.version, *self.warnings)):
                raise ValueError("its status, its version or a warning is not a text")
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise _damaged(path) from error

    @property
    def caption(self) -> str:
        """The setting in a few words; a dotted key is shortened to its last part."""
        return one_line(", ".join(f"{key.split('.')[-1]} {value}" for key, value in self.setting.items()))


def _damaged(path: Path) -> LabError:
    return LabError(f"{path} is damaged: remove it and resume the sweep.")
