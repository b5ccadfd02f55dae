"""Force and moment of the cargo on the tank: on its walls, fixed grains and parts together.

The cargo is a sheet one grain thick, and the forces are those of this sheet. A hull of length l holds l/d such
sheets, d the grains' diameter. Axes are y and z of the tank. The moment is about the middle of the floor, positive
as roll is (port side down). Each sample is the mean over the time since the sample before.

mean_force_y, mean_force_z, mean_moment: means over the steady part (`steady_part`; of a tilt over the whole run).
Error: standard error of the means of blocks, a driving period each where there is one.
largest_force, largest_moment: the largest of the same samples. A peak shorter than the sampling interval is
averaged.
carried_weight: the mean vertical force in the earth frame, divided by the weight of the grains in the tank. It is 1
if the momentum of the cargo is the same at the beginning and at the end, as in a bed at rest or over whole periods of
a steady motion; so it checks the run. Grains are spheres of the preset's density; a spilled grain counts as a mean one.

For a tank driven at one frequency w = 2 pi f, `harmonics` is fitted to the force along the motion: F_y of sway, F_z
of heave. For roll it is the moment about the centre c of the roll, M + c_z F_y - c_y F_z, which does all the work on
the cargo. With F and Y the complex amplitudes of force and motion:
force_amplitude (roll: moment_amplitude): |F|. force_phase (roll: moment_phase): the phase of F minus that of Y.
effective_mass (sway and heave): Re(F/Y)/w^2 divided by the mass of the cargo. It is 1 if the cargo moves as one with
the tank, as the added mass of a liquid cargo is counted (F = -A Y'' - B Y'; Faltinsen & Timokha 2009, "Sloshing").
cargo_damping: B = -Im(F/Y)/w, the resistance in phase with the velocity. The work done on the cargo in a period is
pi w B |Y|^2; it is zero for a frozen cargo. For roll it is per radian. The moment of roll in phase with the angle
contains a part of gravity, so roll has no effective mass.
Error of these: half the difference between the two halves of the steady part.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, DRIVE, GREEN, GREY, PERIODS, VERMILION, Sheet, band, close_up, level
from lab.measures.driven_load import between, transfer, with_halves
from lab.measures.motion import HARMONIC, driving
from lab.measures.steady import BLOCKS, SHORT, Steady, amplitude_value, averaged, phase_value, steady_part
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import PLANE, ROLL

OF = "grains"
SHEET = "of a sheet one grain thick"
EMPTY = "no grain is left in the tank"
LEAST_SAMPLES = 2 * BLOCKS


def said(recording: Recording) -> str:
    """What the forces are of; nothing in space, where they are of the whole tank."""
    return SHEET if recording.content.axes == PLANE else ""


def applies(recording: Recording) -> bool:
    """Walls have been pushed, for some time."""
    return bool(recording.series["wall_force"].any()) and len(recording.series["time"]) > LEAST_SAMPLES


def measure(recording: Recording) -> dict[str, Value]:
    """Means and largest values (mN, mN m); carried_weight; of a driven tank its share that moves with it."""
    series = recording.series
    steady = steady_part(recording, series["time"])
    rows = steady or Steady(slice(1, len(series["time"])), BLOCKS)  # the first sample is the mean of nothing yet
    force = 1e3 * series["wall_force"]
    size = np.hypot(force[..., 0], force[..., 1])
    found = {
        "mean_force_y": averaged(force[..., 0], rows, "mN", note=said(recording)),
        "mean_force_z": averaged(force[..., 1], rows, "mN", note=said(recording)),
        "mean_moment": averaged(force[..., ROLL], rows, "mN m", note=said(recording)),
        "largest_force": over_worlds(size[rows.rows].max(axis=0), "mN", note=said(recording)),
        "largest_moment": over_worlds(np.abs(force[rows.rows, :, ROLL]).max(axis=0), "mN m", note=said(recording)),
    }
    weight = cargo_weight(recording)
    with np.errstate(divide="ignore", invalid="ignore"):
        carried = -_vertical(recording) / np.where(weight > 0, weight, np.nan)
    found["carried_weight"] = averaged(carried, rows, "1", missing=EMPTY)
    if driving(recording) is not None:
        found |= _driven(recording, steady, weight)
    return found


def cargo_weight(recording: Recording) -> np.ndarray:
    """Weight (T, W) of the grains in the tank, N."""
    mass, gravity = grain_mass(recording), recording.preset.run.gravity
    return gravity * mass.sum(axis=1) * (1 - recording.series["spilled"] / recording.radius.shape[1])


def grain_mass(recording: Recording) -> np.ndarray:
    """Mass (W, n) of each grain, a sphere, kg."""
    preset = recording.preset
    kinds = [preset.material.density, *(other.material.density for other in preset.others.values())]
    return 4 / 3 * np.pi * np.array(kinds)[recording.kind] * recording.radius**3


def _vertical(recording: Recording) -> np.ndarray:
    """Upward force on the tank (T, W) in the earth frame, N."""
    force, angle = recording.series["wall_force"], between(recording.series["pose"][..., ROLL])
    return np.sin(angle) * force[..., 0] + np.cos(angle) * force[..., 1]


def _driven(recording: Recording, steady: Steady | None, weight: np.ndarray) -> dict[str, Value]:
    """The values that belong to the driving frequency."""
    name, settings = driving(recording)
    kind, unit, per = ("moment", "mN m", "N m s") if name == "roll" else ("force", "mN", "N s/m")
    omega = 2 * np.pi * settings.frequency
    shape = 3, recording.worlds
    force, ratio = np.full(shape, np.nan, dtype=complex), np.full(shape, np.nan, dtype=complex)
    if steady is not None:
        force, ratio = np.moveaxis([transfer(recording, part) for part in steady.parts], 0, 1)
    answer = np.abs(force) * np.exp(1j * np.angle(ratio))
    found = {
        f"{kind}_amplitude": amplitude_value(1e3 * answer, unit, note=said(recording), missing=SHORT),
        f"{kind}_phase": phase_value(answer, np.zeros(recording.worlds), SHORT),
    }
    if name != "roll":
        mass = np.where(weight[-1] > 0, weight[-1], np.nan) / recording.preset.run.gravity
        found["effective_mass"] = with_halves(ratio.real / omega**2 / mass, "1", SHORT)
    found["cargo_damping"] = with_halves(-ratio.imag / omega, per, SHORT, said(recording))
    return found


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Force and moment of the cargo on the tank; of a driven tank the last periods beside its motion."""
    drive, time = driving(recording), recording.series["time"][1:]
    force = 1e3 * recording.series["wall_force"][1:]
    heights, begin = ((2, 1), time[0]) if drive is None else ((1, 2, 1), close_up(time, drive[1].frequency))
    panels = sheet.panels(heights=heights)
    shown = time >= begin
    if drive is not None:
        label, scale = DRIVE[drive[0]]
        moved = scale * recording.series["pose"][1:][shown][:, :, HARMONIC[drive[0]]]
        band(panels[0][0], time[shown], moved, GREY)
        panels[0][0].set_ylabel(label)
        panels[0][0].set_title(f"last {PERIODS} periods")
    upper, lower = panels[-2][0], panels[-1][0]
    band(upper, time[shown], force[shown, :, 0], BLUE, "y, to starboard")
    band(upper, time[shown], force[shown, :, 1], VERMILION, "z, up")
    settled = -1e3 * cargo_weight(recording)[0].mean()
    upper.axhline(settled, color=GREY, ls=":", lw=1.0, label="weight of the cargo at the start")
    level(sheet, upper, values.get("mean_force_z"), "mean of z", VERMILION, (begin, time[-1]))
    upper.set_ylabel("force on the\ntank (mN)")
    panels[0][0].set_title(said(recording), loc="right", fontsize=8, color=GREY)
    band(lower, time[shown], force[shown, :, ROLL], GREEN, "moment about the middle of the floor")
    level(sheet, lower, values.get("mean_moment"), "mean moment", GREEN, (begin, time[-1]))
    lower.set_ylabel("moment\n(mN m)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(begin, time[-1])


FIGURES = {"force": draw}
