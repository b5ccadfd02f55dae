"""The results so far in one JSON file, from which an interrupted benchmark continues."""

import json
import math
from collections.abc import Mapping
from pathlib import Path

from lab.base.errors import LabError
from lab.recording import versions


class Records:
    """Records by name in a file; those of other versions, or of the other choice of fast or full, are ignored.

    Raises LabError if the file was not written by this class.
    """

    def __init__(self, path: Path, fast: bool) -> None:
        self.path = path
        self._made_by = {"fast": fast, "versions": versions()}
        self._records: dict[str, dict] = {}
        if path.exists():
            self._records = _read(path)

    def __getitem__(self, name: str) -> dict:
        return self._records[name]

    def __contains__(self, name: str) -> bool:
        return self._records.get(name, {}).get("made_by") == self._made_by

    def keep(self, name: str, record: Mapping[str, object]) -> None:
        """Write a record to the disk, in place of an older one."""
        self._records[name] = plain({"made_by": self._made_by, **record})
        self.path.parent.mkdir(parents=True, exist_ok=True)
        new = self.path.with_suffix(".new")
        new.write_text(json.dumps(self._records, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        new.replace(self.path)


def plain(value: object) -> object:
    """The value with None for numbers that JSON lacks: NaN and infinities."""
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _read(path: Path) -> dict[str, dict]:
    try:
        records = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        records = None
    if not isinstance(records, dict) or not all(isinstance(record, dict) for record in records.values()):
        raise LabError(f"{path} holds no results of this bench: remove it or choose another folder with --out.")
    return records
