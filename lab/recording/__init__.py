"""The recording of a run: one HDF5 file, written during the run and readable at any time.

`new_recording` creates the file, `Recorder` appends to it (also after an interruption), and `open_recording` reads it.
The layout follows from the quantities that the solvers declare; every row has a checksum (docs/recordings.md).

The file is written in HDF5's single-writer/multiple-reader mode (SWMR). Every flush leaves a complete file, so the
recording of a killed or running run can be read up to its last flush. Other programs must open the file of a running
run in the same mode: `h5py.File(path, "r", swmr=True)`. A killed run leaves HDF5's writer flag set, and HDF5 refuses to
open such a file. The lab clears the flag when it reads or continues the recording; `h5clear -s recording.h5`, which
comes with HDF5, clears it as well.
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
