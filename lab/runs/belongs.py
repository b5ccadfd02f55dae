"""Check that the recording in a run's folder belongs to the run, before its numbers are taken or rows are added."""

from pathlib import Path

import numpy as np

from lab.assembly.grains import radii_of
from lab.assembly.water import air_volumes_of, volumes_of
from lab.base.errors import LabError, Unusable
from lab.preset.schema import Preset
from lab.recording import FILE_NAME, open_recording
from lab.runs.alike import alike, apart
from lab.runs.run import Run

TOLERANCE = 1e-9  # relative; processors may round the sizes of the grains differently


def check_asked(folder: Path, asked: Preset, by: str) -> None:
    """Raise LabError if a folder holds a recording of another preset than is `asked` for; `by`: this sweep, and so on.

    A folder's place says nothing about what was run there: the folder may have been used before, copied or renamed.
    """
    if not (folder / FILE_NAME).exists():
        return
    with open_recording(folder) as recording:
        recorded = recording.preset
    if not alike(recorded, asked):
        raise LabError(
            f"{folder} holds another run than {by} asks for, with another {apart(recorded, asked)}: remove that folder "
            "to run it anew."
        )


def check_belongs(run: Run) -> None:
    """Raise Unusable if the recording in a run's folder was made from another preset or another scene."""
    with open_recording(run.folder) as recording:
        pairs = (
            (recording.radius, radii_of(run.scene)),
            (recording.volume, volumes_of(run.scene)),
            (recording.air_volume, air_volumes_of(run.scene)),
            (recording.outline, run.scene.outline),
        )
        equal = all(a.shape == b.shape and np.allclose(a, b, rtol=TOLERANCE, atol=0.0) for a, b in pairs)
        asked = run.loaded.resolved
        if not equal or len(recording.parts) != len(run.scene.parts) or not alike(recording.preset, asked):
            raise Unusable(
                f"{recording.path} does not belong to the preset in it: start the run again, in another folder."
            )
