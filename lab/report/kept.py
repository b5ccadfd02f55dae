"""Results kept as JSON beside what made them: version, date, processor, command."""

import json
import math
import platform
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path

from lab import __version__
from lab.base.errors import LabError
from lab.base.files import write_text
from lab.recording import versions


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
        """Of what this process makes by a command of the lab, such as "bench speed"."""
        return cls(__version__, str(date.today()), processor(), f"cargolab {command}", versions())

    @property
    def words(self) -> str:
        """For a reader: "version 0.2.0, 2026-11-23, AMD EPYC, Zen 4"; what was not kept is said."""
        kept = {"date": self.date, "processor": self.processor}
        lacking = " and ".join(name for name, value in kept.items() if not value)
        return ", ".join([self.when, *filter(None, [self.processor, lacking and f"{lacking} not recorded"])])

    @property
    def when(self) -> str:
        """Without the processor: "version 0.2.0, 2026-11-23"."""
        return ", ".join([f"version {self.version}", *filter(None, [self.date])])


def processor(listed: Path = Path("/proc/cpuinfo")) -> str:
    """The processor by its maker's name, of AMD's with the generation, which their names leave out."""
    try:
        lines = listed.read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    fields = dict(tuple(part.strip() for part in line.split(":", 1)) for line in reversed(lines) if ":" in line)
    name = fields.get("model name", "")
    generation = "" if "Zen" in name else _generation(fields.get("cpu family", ""), fields.get("model", ""))
    return ", ".join(filter(None, (name or platform.machine(), generation if name.startswith("AMD") else "")))


def _generation(family: str, model: str) -> str:
    """AMD's generation by family and model, as its Processor Programming References number them; "" if not known."""
    if not (family.isdigit() and model.isdigit()):
        return ""
    if family == "25":
        return "Zen 4" if 0x10 <= int(model) < 0x20 or int(model) >= 0x60 else "Zen 3"
    return {"23": "Zen 2" if int(model) >= 0x30 else "Zen", "26": "Zen 5"}.get(family, "")


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
    """Write results, atomically, a line each; a number that JSON lacks becomes null."""
    path.parent.mkdir(parents=True, exist_ok=True)
    style = {"ensure_ascii": False, "allow_nan": False, "separators": (",", ":")}
    rows = [f"{json.dumps(name, **style)}:{json.dumps(one, **style)}" for name, one in plain(results).items()]
    write_text(path, "{" + ",".join(f"\n{row}" for row in rows) + "\n}\n")


def plain(value: object) -> object:
    """The value with None for numbers that JSON lacks, NaN and infinities, and plain numbers for numpy's."""
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
