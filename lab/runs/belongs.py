"""Check that the recording in a run's folder belongs to the run, before rows are added to it."""

import numpy as np

from lab.assembly.water import volumes_of
from lab.base.errors import Unusable
from lab.recording import open_recording
from lab.runs.batch import Run

TOLERANCE = 1e-9  # relative; processors may round the sizes of the grains differently


def check_belongs(run: Run) -> None:
    """Raise Unusable if the recording in a run's folder was made from another scene."""
    with open_recording(run.folder) as recording:
        volume = volumes_of(run.scene.drops, run.scene.worlds)
        pairs = (recording.radius, run.scene.radius), (recording.volume, volume)
        pairs = *pairs, (recording.outline, run.scene.outline)
        equal = all(a.shape == b.shape and np.allclose(a, b, rtol=TOLERANCE, atol=0.0) for a, b in pairs)
        if not equal or len(recording.parts) != len(run.scene.parts):
            raise Unusable(
                f"{recording.path} does not belong to the preset in it: start the run again, in another folder."
            )
