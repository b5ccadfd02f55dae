"""What a run leaves behind: one HDF5 file, written as the run goes on and readable at any moment.

`new_recording` makes the file, a `Recorder` adds to it, also to one that a dead run has left, and `open_recording`
reads it. What is in it is laid out from the quantities that the solvers declare; every row has a checksum
(docs/recordings.md). The file is written in HDF5's single-writer/multiple-reader mode (SWMR): every flush leaves a
whole file behind, so a run that is killed, or that still goes on, can be read up to its last flush. Of a run that
goes on other programs must ask for that mode, too: `h5py.File(path, "r", swmr=True)`. A run that was killed leaves
HDF5's mark of a writer on its file, with which HDF5 refuses it; whatever reads the recording in the lab, or goes on
with it, clears the mark, and so does HDF5's own `h5clear -s recording.h5`.
"""

from lab.recording.layout import FILE_NAME, WAVES
from lab.recording.outlines import Outlines
from lab.recording.reader import Recording, open_recording
from lab.recording.writer import BUFFER_BYTES, FLUSH_EVERY, Recorder, new_recording, versions

__all__ = [
    "BUFFER_BYTES",
    "FILE_NAME",
    "FLUSH_EVERY",
    "WAVES",
    "Outlines",
    "Recorder",
    "Recording",
    "new_recording",
    "open_recording",
    "versions",
]
