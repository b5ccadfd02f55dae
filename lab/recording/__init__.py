"""What a run leaves behind: one HDF5 file, written as the run goes on and readable at any moment.

`new_recording` makes the file, a `Recorder` adds to it, `mend_recording` readies what a dead run left for another
Recorder, and `open_recording` reads it. The file is written in HDF5's single-writer/multiple-reader mode (SWMR):
every flush leaves a whole file behind, so a run that is killed, or that still goes on, can be read up to its last
flush. Other programs must ask for that mode too: `h5py.File(path, "r", swmr=True)`.
"""

from lab.recording.layout import FILE_NAME, GRAIN_FRAMES, SERIES, WAVES
from lab.recording.outlines import Outlines
from lab.recording.reader import Recording, open_recording
from lab.recording.writer import BUFFER_BYTES, FLUSH_EVERY, Recorder, mend_recording, new_recording, versions

__all__ = [
    "BUFFER_BYTES",
    "FILE_NAME",
    "FLUSH_EVERY",
    "GRAIN_FRAMES",
    "SERIES",
    "WAVES",
    "Outlines",
    "Recorder",
    "Recording",
    "mend_recording",
    "new_recording",
    "open_recording",
    "versions",
]
