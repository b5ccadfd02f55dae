"""Check that the recording in a run's folder belongs to the run, before rows are added to it."""

import numpy as np

from lab.base.errors import Useless
from lab.recording import open_recording
from lab.runs.launch import Run

ALIKE = 1e-9  # relative tolerance for sizes of grains, which processors may round differently


def check_belongs(run: Run) -> None:
    """Raise Useless if the recording in a run's folder is not of the run's scene."""
    with open_recording(run.folder) as recording:
        pairs = (recording.radius, run.scene.radius), (recording.outline, run.scene.outline)
        alike = all(a.shape == b.shape and np.allclose(a, b, rtol=ALIKE, atol=0.0) for a, b in pairs)
        if not alike or len(recording.parts) != len(run.scene.parts):
            raise Useless(
                f"{recording.path} is not of the preset that it holds: start the run anew, in another folder."
            )
