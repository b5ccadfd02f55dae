"""How a shaken bed answers in the steady state: amplitude and phase of its centre of mass.

Least-squares fit, in the tank's frame, of the coordinate that the motion drives (y for sway and
roll, z for heave) and of z to
    c + e t + a cos(wt) + b sin(wt) + a2 cos(2wt) + b2 sin(2wt),    w = 2 pi f,
with f the driving frequency. The drift e takes up the creep of the bed, which would otherwise disturb
the oscillation. The fit covers the last half of the time after the soft start, cut to an even number
of whole periods, at least two, so that the terms do not disturb each other.

response_amplitude: sqrt(a^2 + b^2) of the driven coordinate;
response_phase: its phase minus the phase of the recorded motion of the tank, 0 to 360 deg. At 180 deg
the bed moves against the tank: a bed that stays where it is in space does so;
response_amplitude_z: sqrt(a2^2 + b2^2) of z, which rises twice a period as the bed heaps on either
side (Spandonidis 2016, 5.2.2: z at twice the frequency of y, phase close to 180 deg).
Error: half the difference between the two halves of the window, which tells how unsteady the bed is.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.centre_of_mass import draw_shift, shift
from lab.measures.drawing import DRIVE, GREEN, GREY, PERIODS, Sheet, band, close_up, middle_of, note, swing
from lab.measures.motion import HARMONIC, driving, is_tilt
from lab.measures.steady import SHORT, STILL, amplitude_value, harmonics, phase_value, steady_part
from lab.measures.value import Value
from lab.recording import Recording

OF = "grains"
FOLLOWS = "the bed follows the tank"


def applies(recording: Recording) -> bool:
    """A harmonic motion drives the tank."""
    return driving(recording) is not None


def measure(recording: Recording) -> dict[str, Value]:
    """response_amplitude, response_amplitude_z (mm) and response_phase (deg)."""
    steady = steady_part(recording, recording.series["time"])
    if steady is None:
        answers = np.full((3, 2, recording.worlds), np.nan, dtype=complex)
    else:
        answers = 1e3 * np.array([_answer(recording, part) for part in steady.parts])
    missing = SHORT if steady is None else FOLLOWS
    return {
        "response_amplitude": amplitude_value(answers[:, 0], "mm", missing=missing),
        "response_phase": phase_value(answers[:, 0], 1e3 * STILL * recording.mean_diameter, missing),
        "response_amplitude_z": amplitude_value(answers[:, 1], "mm", missing=missing),
    }


def _answer(recording: Recording, part: slice) -> np.ndarray:
    """Complex amplitudes (2, W), m: of the driven coordinate against the drive, and of z at 2f."""
    name, settings = driving(recording)
    time, frequency = recording.series["time"][part], settings.frequency
    centre = recording.series["centre_of_mass"][part]
    drive = harmonics(time, recording.series["pose"][part][:, :, HARMONIC[name]], frequency, (1, 2))[0]
    along = harmonics(time, centre[:, :, 1 if name == "heave" else 0], frequency, (1, 2))[0]
    height = harmonics(time, centre[:, :, 1], frequency, (1, 2))[1]
    return np.stack([along * np.exp(-1j * np.angle(drive)), height])


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The shift of the centre of mass below the motion of the tank; on the right the last periods, to see the phase."""
    if is_tilt(recording):
        return
    name, settings = driving(recording)
    time, moved = recording.series["time"], shift(recording)
    panels = sheet.panels(heights=(1, 2), widths=(3, 2))
    label, scale = DRIVE[name]
    pose = scale * recording.series["pose"][:, :, HARMONIC[name]]
    for column, begin in ((0, time[0]), (1, close_up(time, settings.frequency))):
        shown = time >= begin
        band(panels[0][column], time[shown], pose[shown], GREY)
        draw_shift(panels[1][column], time[shown], moved[shown])
        panels[1][column].set_xlim(begin, time[-1])
    steady = steady_part(recording, time)
    if steady is not None:
        axis, right = 1 if name == "heave" else 0, panels[1][1]
        middle, begin = middle_of(moved[steady.rows, :, axis]), max(begin, time[steady.rows.start])
        swing(sheet, right, middle, values.get("response_amplitude"), "amplitude", GREEN, (begin, time[-1]))
        note(sheet, right, values.get("response_phase"), "phase")
    panels[0][0].set_ylabel(label)
    panels[0][1].set_title(f"last {PERIODS} periods")
    panels[1][1].set_ylabel("")


FIGURES = {"shift": draw}
