"""Checkpoints: the complete state of the solver, from which an interrupted run continues bit for bit.

A checkpoint is written under another name and renamed once it is on the disk, so a process killed at any time leaves a
complete one. It is deleted when the run is complete.
"""

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lab.base.errors import LabError, Unusable
from lab.base.files import replacing, unfinished
from lab.base.trust import check_archive, check_progress

FORMAT = "cargo-shift-lab checkpoint 7"
FILE_NAME = "checkpoint.npz"


@dataclass(frozen=True)
class Checkpoint:
    """The state of a batch of runs.

    state: of the simulation (`Simulation.state`); runs: folders of the runs whose worlds it holds, in order, relative
    to the checkpoint's folder; rows: numbers of rows of the series and of the frames in each recording; warnings,
    notes: those given so far.
    """

    state: Mapping[str, np.ndarray]
    runs: tuple[str, ...]
    rows: tuple[int, int]
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def write(self, folder: Path) -> None:
        """Write the checkpoint; an earlier one is replaced only if that succeeds. Raises LabError."""
        path = folder / FILE_NAME
        about = {"format": FORMAT, "runs": self.runs, "rows": self.rows}
        about |= {"warnings": self.warnings, "notes": self.notes, "digest": _digest(self.state)}
        try:
            with replacing(path) as part, part.open("wb") as file:
                np.savez(file, about=np.array(json.dumps(about)), **{f"state/{k}": v for k, v in self.state.items()})
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise LabError(f"{path} cannot be written ({os.strerror(error.errno)}): make room there.") from error


def read_checkpoint(folder: Path) -> Checkpoint | None:
    """Read the checkpoint in a folder; None if there is none. Raises LabError if it cannot be read."""
    path = folder / FILE_NAME
    if not path.exists():
        return None
    try:
        check_archive(path)
        with np.load(path, allow_pickle=False) as file:
            about = json.loads(str(file["about"]))
            state = {name.removeprefix("state/"): file[name] for name in file.files if name != "about"}
            if about["format"] != FORMAT:
                raise Unusable(f"{path} was made by another version of the lab: start the run again.")
            if about["digest"] != _digest(state):
                raise ValueError("its digest does not match")
            series, frames = about["rows"]
            check_progress(about["runs"], (series, frames), (about["warnings"], about["notes"]))
            messages = tuple(about["warnings"]), tuple(about["notes"])
            return Checkpoint(state, tuple(about["runs"]), (series, frames), *messages)
    except Unusable:
        raise
    except Exception as error:  # a damaged zip file raises many kinds of errors
        raise Unusable(f"{path} is damaged: start the run again.") from error


def _digest(state: Mapping[str, np.ndarray]) -> str:
    """Hash of names, shapes and all bytes of a state."""
    digest = hashlib.blake2b(digest_size=16)
    for name in sorted(state):
        values = np.ascontiguousarray(state[name])
        digest.update(f"{name} {values.dtype} {np.shape(state[name])}".encode())
        digest.update(values.tobytes())
    return digest.hexdigest()


def remove_checkpoint(folder: Path) -> None:
    """Remove the checkpoint and the unfinished one of a killed run, if there are any."""
    for path in (folder / FILE_NAME, unfinished(folder / FILE_NAME)):
        path.unlink(missing_ok=True)
