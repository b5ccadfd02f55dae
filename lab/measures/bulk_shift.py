"""Where bulk went: its centre of mass in the tank's frame, and what it lost on the way.

bulk_shift: displacement of the centre sideways from the start to the last sample, in % of the tank's width; of several
tanks that of all bulk, each tank by its length, in % of the width of all;
bulk_shift_NAME: of several tanks that in one alone, in % of its own width, up to the last picture;
bulk_largest_shift: the largest at any time, as an amount;
bulk_half_range: of a tank driven at one frequency half the range of the shift, the mean of the last PERIODS periods;
bulk_rise: how much higher than at the start the centre lies at the end (mm), in the tank's frame. Of a bed that is
moved to and fro for long it shows whether volume is lost.
bulk_carried: the mean force on the tank along the earth's vertical over the weight; it checks the run, and is 1 where
the bulk has the same momentum at the beginning and at the end.
bulk_sliding: the largest share of the mass that slides at once (%).
bulk_volume_work: the energy that the control of volume puts in, over what friction takes (%): a term of the method,
which should be small.
Error: of the half range, half the difference of the first and the last of these periods; others have none of their own.
What bulk cannot do, and how far it is from grains, is told in `docs/physics/bulk.md`.
"""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, PURPLE, VERMILION, Sheet, band
from lab.measures.driven_load import between
from lab.measures.loose import loose_mass
from lab.measures.motion import driving
from lab.measures.value import Value, over_worlds
from lab.preset.sections.bulk.beds import beds_of, slices, width_of
from lab.recording import Recording
from solvers.machine.quantity import ROLL

OF = "bulk"
PERIODS = 3
FEW = "fewer than three periods"
ROUNDED = 1e-3  # of a period, by which three of them may be longer than the run: frequencies are given with few digits
LITTLE = 1e-9  # of the weight times the width: friction that has taken less has taken nothing


def applies(recording: Recording) -> bool:
    """Every recording of bulk has a centre of mass."""
    return True


def measure(recording: Recording) -> dict[str, Value]:
    """bulk_shift, bulk_largest_shift, bulk_half_range (%), bulk_rise (mm), bulk_carried and so on."""
    series = recording.series
    moved, losses = shift(recording), series["bulk_losses"][-1]
    height = 1e3 * (series["centre_of_mass"][-1, :, 1] - series["centre_of_mass"][0, :, 1])
    taken = losses[:, :2].sum(axis=1)
    least = LITTLE * weight(recording) * width(recording)
    share = np.where(taken > least, -100.0 * losses[:, 3] / np.maximum(taken, least), np.nan)
    found = {
        "bulk_shift": over_worlds(moved[-1], "%", note="of the tank's width"),
        **_by_tanks(recording),
        "bulk_largest_shift": over_worlds(np.abs(moved).max(axis=0), "%", note="of the tank's width"),
        "bulk_rise": over_worlds(height, "mm"),
        "bulk_carried": over_worlds(carried(recording), "1"),
        "bulk_sliding": over_worlds(100.0 * series["bulk_sliding"].max(axis=0), "%"),
        "bulk_volume_work": over_worlds(share, "%", missing="friction took nothing"),
    }
    if driving(recording) is not None:
        found["bulk_half_range"] = _half_range(recording, moved)
    return found


def shift(recording: Recording) -> np.ndarray:
    """Displacement (T, W) of the centre sideways from the start, in % of the tank's width."""
    centre = recording.series["centre_of_mass"][..., 0]
    return 100.0 * (centre - centre[0]) / width(recording)


def width(recording: Recording) -> float:
    """The width (m) of all tanks in one."""
    return width_of(beds_of(recording.preset))


def _by_tanks(recording: Recording) -> dict[str, Value]:
    """The shift in each of several tanks; nothing of one alone."""
    beds, place = beds_of(recording.preset), recording.frames["bulk_position"]
    if len(beds) == 1 or not len(place):
        return {}
    moved = np.array(place[-1][..., 0], dtype=float) - place[0][..., 0]
    found = {}
    for bed, own in zip(beds, slices(beds, recording.bulk_volume[0]), strict=True):
        mass = recording.bulk_volume[:, own]
        share = 100.0 * (mass * moved[:, own]).sum(axis=1) / np.maximum(mass.sum(axis=1), 1e-300) / width_of((bed,))
        found[f"bulk_shift_{bed.name}"] = over_worlds(share, "%", note="of its own width, in the last picture")
    return found


def weight(recording: Recording) -> float:
    """The weight (N) of the bulk in the slab."""
    return float(loose_mass(recording)[0]) * recording.preset.run.gravity


def carried(recording: Recording) -> np.ndarray:
    """The mean upward force (W,) on the tank, downwards, over the weight."""
    force, angle = recording.series["wall_force"][1:], between(recording.series["pose"][..., ROLL])[1:]
    vertical = np.sin(angle) * force[..., 0] + np.cos(angle) * force[..., 1]
    return -vertical.mean(axis=0) / weight(recording)


def _half_range(recording: Recording, moved: np.ndarray) -> Value:
    """Half the range of the shift (T, W), the mean of the last periods."""
    time, period = recording.series["time"], 1.0 / driving(recording)[1].frequency
    ends = time[-1] - period * np.arange(PERIODS + 1)
    if ends[-1] < time[0] - ROUNDED * period:
        return over_worlds(np.full(recording.worlds, np.nan), "%", missing=FEW)
    parts = [0.5 * np.ptp(moved[(time > begin - 1e-9) & (time <= end + 1e-9)], axis=0) for end, begin in pairwise(ends)]
    uncertainty = 0.5 * np.abs(parts[0] - parts[-1])
    said = "of the tank's width, over the last three periods"
    return over_worlds(np.mean(parts, axis=0), "%", uncertainties=uncertainty, kind="halves", note=said)


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The shift with what moves the tank, how much slides, and where the energy went."""
    series, time = recording.series, recording.series["time"]
    (upper,), (middle,), (lower,) = sheet.panels(heights=(3, 1, 2))
    band(upper, time, shift(recording), BLUE, "sideways")
    rise = series["centre_of_mass"][..., 1] - series["centre_of_mass"][0, :, 1]
    band(upper, time, 100.0 * rise / width(recording), VERMILION, "upwards")
    upper.set_ylabel("shift of the centre of mass\n(% of the tank's width)")
    band(middle, time, 100.0 * series["bulk_sliding"], GREY)
    middle.set_ylabel("sliding\n(% of mass)")
    losses, own = series["bulk_losses"], weight(recording) * width(recording)
    names = (BLUE, "friction at walls"), (VERMILION, "friction within"), (GREEN, "end of contact")
    for k, (colour, name) in enumerate(names):
        band(lower, time, 100.0 * losses[..., k] / own, colour, name)
    band(lower, time, 100.0 * losses[..., 3] / own, GREY, "control of volume")
    band(lower, time, 100.0 * losses[..., 4] / own, PURPLE, "by way of the grid")
    lower.set_ylabel("energy lost\n(% of weight × width)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(time[0], time[-1])


FIGURES = {"bulk": draw}
