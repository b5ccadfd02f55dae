"""The lab in processes of its own that are killed or lack something: how each ended, and what it left."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path

import h5py

from lab.recording import FILE_NAME

PATIENCE = 600.0  # s: a process that takes longer counts as hanging
SETTINGS = {
    "tank.width": "24 mm",
    "tank.height": "24 mm",
    "grains.count": 16,
    "motion.tilt.rate": "60 deg/s",
    "motion.tilt.angle": "20 deg",
    "motion.tilt.hold": "1 s",
    "run.repeats": 2,
    "run.threads": 1,
    "record.checkpoint_every": "0 s",
    "record.picture_rate": "50 Hz",
}
SET = [word for key, value in SETTINGS.items() for word in ("--set", f"{key}={value}")]
RUN = ("run", "tilting/quick", "--no-video", *SET)
# What comes before is Python, too: it takes something from the process.
COMMAND = "\nimport sys\nfrom lab.cli import main\nmain(sys.argv[1:], prog_name='cargolab')"


@dataclass(frozen=True)
class Ended:
    """How a process ended: its exit code, or minus the signal that killed it, and what it said on stderr."""

    code: int
    said: str

    @property
    def done(self) -> bool:
        """Whether it did what it was asked for."""
        return self.code == 0

    @property
    def in_a_sentence(self) -> bool:
        """Whether it said in a sentence why it could not."""
        last = (self.said.strip().splitlines() or [""])[-1]
        return self.code in (1, 2) and last.startswith("cargolab: ") and "Traceback" not in self.said


def begin(
    arguments: Sequence[object], before: str = "", environment: Mapping[str, str] | None = None, code: str = COMMAND
) -> subprocess.Popen:
    """Start the command with these arguments, or other `code`, after the Python in `before`."""
    line = [sys.executable, "-c", before + code, *map(str, arguments)]
    nothing = subprocess.DEVNULL
    # A session of its own: its workers go with it when it is killed with all its own.
    return subprocess.Popen(
        line,
        env=os.environ | dict(environment or {}),
        stdin=nothing,
        stdout=nothing,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
        start_new_session=True,
    )


def end(process: subprocess.Popen) -> Ended:
    """Wait for a process; one that hangs is killed."""
    try:
        said = process.communicate(timeout=PATIENCE)[1]
    except subprocess.TimeoutExpired:
        kill(process, all_at_once=True)
        return Ended(-signal.SIGALRM, "it hung")
    return Ended(process.returncode, said)


def call(
    arguments: Sequence[object], before: str = "", environment: Mapping[str, str] | None = None, code: str = COMMAND
) -> Ended:
    """Run the command with these arguments to its end."""
    return end(begin(arguments, before, environment, code))


def kill(process: subprocess.Popen, all_at_once: bool) -> None:
    """Kill a process, with those that it has started or else so that they find out, and wait for the end of all."""
    others = [one for one in _children(process.pid) if one != process.pid]
    process.kill()
    for one in others if all_at_once else ():
        with suppress(ProcessLookupError):
            os.kill(one, signal.SIGKILL)
    process.communicate()
    until = time.monotonic() + PATIENCE
    while any(_lives(one) for one in others) and time.monotonic() < until:
        time.sleep(0.05)


def _children(process: int) -> list[int]:
    """A process and all that it has started (Linux)."""
    try:
        lists = [path.read_text().split() for path in Path(f"/proc/{process}/task").glob("*/children")]
    except OSError:
        lists = []
    return [process, *(one for children in lists for child in children for one in _children(int(child)))]


def _lives(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def bits(folder: Path) -> dict[str, str]:
    """A digest of every data set of a folder's recording and of its status."""
    found = {}

    def keep(name: str, item: object) -> None:
        if isinstance(item, h5py.Dataset):
            value = item[()]
            content = value.tobytes() if hasattr(value, "tobytes") else value
            found[name] = blake2b(content, digest_size=16).hexdigest()

    with h5py.File(folder / FILE_NAME, "r") as file:
        file.visititems(keep)
        found["status"] = bytes(file.attrs["status"]).decode()
    return found
