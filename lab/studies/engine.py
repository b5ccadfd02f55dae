"""What reproduce, verify and bench share: cases chosen by name, and results kept as JSON with what made them."""

import json
import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from datetime import date
from pathlib import Path

from lab import __version__
from lab.base.errors import LabError
from lab.recording import versions
from lab.report.page import processor


@dataclass(frozen=True)
class Made:
    """What made a result: version of the lab, date, processor, command and packages; "" for what is not known."""

    version: str
    date: str = ""
    processor: str = ""
    command: str = ""
    packages: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def now(cls, command: str) -> "Made":
        """Of what this process makes."""
        return cls(__version__, str(date.today()), processor(), command, versions())

    @property
    def words(self) -> str:
        """For a reader: "version 0.2.0, 2026-11-23, AMD EPYC"."""
        return ", ".join([f"version {self.version}", *filter(None, (self.date, self.processor))])


def choose(names: Collection[str], known: Iterable[str], what: str, usual: Collection[str] | None = None) -> list[str]:
    """The known names that begin like one of `names`, in their order; without names the `usual` ones, or all.

    Raises LabError, which lists all, for a name that begins none; `what` they are is part of its sentence.
    """
    known = list(known)
    for name in names:
        if not any(one.startswith(name) for one in known):
            raise LabError(f"there is no {what} {name}; there are {', '.join(known)}.")
    if names:
        return [one for one in known if one.startswith(tuple(names))]
    return [one for one in known if usual is None or one in usual]


class Kept:
    """Results by name in a JSON file, each with what made it.

    A result is `in` it if it was made with the same packages and the same choices (`asked`). Raises LabError if the
    file is none of these.
    """

    def __init__(self, path: Path, command: str, asked: object) -> None:
        self.path, self.asked, self.made = path, asked, Made.now(command)
        self.results: dict[str, dict] = read(path)

    def __getitem__(self, name: str) -> dict:
        return self.results[name]

    def __contains__(self, name: str) -> bool:
        found = self.results.get(name, {})
        return found.get("asked") == self.asked and found.get("made", {}).get("packages") == self.made.packages

    def keep(self, name: str, result: Mapping[str, object]) -> None:
        """Put a result on the disk, in place of an older one."""
        self.results[name] = {"asked": self.asked, "made": asdict(self.made), **result}
        write(self.path, self.results)


def read(path: Path) -> dict[str, dict]:
    """The results in a file, none if there is no file. Raises LabError."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except (OSError, ValueError):
        found = None
    if not isinstance(found, dict) or not all(isinstance(one, dict) for one in found.values()):
        raise LabError(f"{path} holds no results: remove it, or choose another folder with --out.")
    return found


def write(path: Path, results: Mapping[str, object]) -> None:
    """Write results, atomically; a number that JSON lacks becomes null."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part")
    text = json.dumps(plain(results), indent=1, ensure_ascii=False, allow_nan=False)
    part.write_text(text + "\n", encoding="utf-8")
    part.replace(path)


def plain(value: object) -> object:
    """The value with None for numbers that JSON lacks, NaN and infinities, and plain numbers for numpy's."""
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
