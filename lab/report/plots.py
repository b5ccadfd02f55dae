"""The figures of a run, as they would stand in a paper: mean over the worlds, their spread as a band.

A new figure is a function `(recording, values) -> Figure | None` and a line in FIGURES; None where
it does not apply. A quantity of the series that says `plot` is drawn against time without more.
Import this module only where figures are drawn: Matplotlib is slow to load.
"""

import textwrap
from collections.abc import Mapping
from functools import partial
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.base.errors import LabError
from lab.measures import (
    contact_number,
    critical_angle,
    flow_rate,
    heap_angle,
    hysteresis,
    ship_roll,
    spectrum,
    spilled,
    surface_slope,
    top_altitude,
    wall_force,
    wave,
)
from lab.measures.motion import HARMONIC, driving, is_tilt, outward_leg
from lab.measures.outlet import find_outlet, passed
from lab.measures.steady import steady_part
from lab.measures.value import Value
from lab.preset.ship import axis_motion, axis_place, recorded_ship
from lab.recording import Recording
from lab.recording.ship_end import End, ends
from lab.report.numbers import number
from solvers.machine.quantity import Quantity

# Okabe and Ito's colours, told apart by colour-blind readers as well.
BLUE, VERMILION, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#777777"
STYLE = {
    "font.size": 9,
    "text.parse_math": False,  # titles are texts of people
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "legend.framealpha": 0.9,
    "legend.edgecolor": "none",
    "legend.fancybox": False,
    "legend.fontsize": 8,
    "lines.linewidth": 1.5,
    "savefig.dpi": 180,
}
SIZE = (6.4, 4.2)  # inches
BELOW = "outside lower center"  # of a legend, where no curve can run through it
POINTS = 1500  # of a curve; more cannot be seen
PERIODS = 4  # shown close up
MARGIN = 0.02  # of the time shown: what is left behind the loss of a ship
TITLE = 88  # letters in a line
AXIS = 36  # letters in a line beside an axis
LEAST_PORTRAIT = 20  # samples
HIGHEST_ROLL = 3.0  # Hz
QUIETEST = 1e-4  # of the largest peak: where a spectrum's scale begins

ANGLES = {  # of a ship's deck and openings, in her curve of righting levers
    "deck_immersion_angle": {"color": GREEN, "ls": "--"},
    "downflooding_angle": {"color": VERMILION, "ls": "-"},
}
DRIVE = {
    "sway": ("sway of the\ntank (mm)", 1e3),
    "heave": ("heave of the\ntank (mm)", 1e3),
    "roll": ("roll of the\ntank (deg)", np.degrees(1.0)),
}


def quantity_figure(quantity: Quantity, recording: Recording, _values: Mapping[str, Value]) -> Figure:
    """A quantity of the series against time, a panel for each component."""
    time, values = recording.series["time"], recording.series[quantity.name]
    figure, panels = _figure(recording, heights=(1,) * quantity.width)
    for k, (axes, unit) in enumerate(zip(panels[:, 0], quantity.units, strict=True)):
        _band(axes, time, values[..., k] if quantity.components else values, BLUE)
        said = quantity.components[k] if quantity.components else textwrap.fill(quantity.label, AXIS)
        axes.set_ylabel(said if unit == "1" else f"{said} ({unit})")
    panels[-1, 0].set_xlabel("time (s)")
    panels[-1, 0].set_xlim(time[0], time[-1])
    if quantity.components:
        panels[0, 0].set_title(quantity.label)
    return figure


def write_plots(recording: Recording, values: Mapping[str, Value], folder: Path | str) -> dict[str, Path]:
    """Draw every figure that applies as PNG in `folder`; returns the files by name.

    Raises LabError when the folder cannot be written.
    """
    drawn, figures = {}, dict(FIGURES)
    for quantity in recording.series.quantities.values():
        if quantity.plot:
            figures[quantity.name] = partial(quantity_figure, quantity)
    with matplotlib.rc_context(STYLE):
        for name, draw in figures.items():
            figure = draw(recording, values) if len(recording.series["time"]) > 1 else None
            if figure is None:
                continue
            drawn[name] = Path(folder) / f"{name}.png"
            try:
                figure.savefig(drawn[name])
            except OSError as error:
                reason = error.strerror or error
                raise LabError(f"{folder} cannot be written ({reason}): choose another folder.") from error
    return drawn


def shift_figure(recording: Recording, values: Mapping[str, Value]) -> Figure:
    """Shift of the centre of mass: against the tilt, or against time beside the tank's motion."""
    if is_tilt(recording):
        return _shift_against_tilt(recording, values)
    return _shift_against_time(recording)


def energy_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Energies in time: kinetic and elastic on a logarithmic scale, below the potential."""
    time, series = recording.series["time"], recording.series
    kinetic = 1e6 * (series["kinetic"] + series["rotational"])
    if not kinetic.any():
        return None
    figure, ((upper,), (lower,)) = _figure(recording, heights=(2, 1))
    _range(upper, time, kinetic, BLUE, "kinetic, relative to the tank")
    _range(upper, time, 1e6 * series["elastic"], VERMILION, "elastic")
    upper.set_yscale("log")
    upper.set_ylabel("energy (µJ)")
    figure.legend(loc=BELOW, ncols=2)
    potential = 1e6 * (series["potential"] - series["potential"][0])
    _band(lower, time, potential, GREY)
    lower.set_ylabel("potential,\nchange (µJ)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(time[0], time[-1])
    return figure


def slope_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Inclination of the free surface against the tilt, both counted in the direction of the tilt."""
    if not surface_slope.applies(recording):
        return None
    frames, slope, error = surface_slope.surface_course(recording)
    if not np.isfinite(slope).any():
        return None
    figure, ((axes,),) = _figure(recording)
    pose = recording.frames["pose"][:][frames, :, 2]
    for world in range(recording.worlds):
        leg = outward_leg(pose[:, world])
        tilt = np.degrees(leg.direction * pose[:, world])
        _surface(axes, tilt, slope[:, world], error[:, world], leg.end, named=not world)
    reach = [0, np.degrees(np.abs(pose).max())]
    axes.plot(reach, reach, color=GREY, ls=":", lw=1.0, label="bed fixed to the tank")
    _mark(axes, values.get("critical_angle"), "critical angle", VERMILION)
    axes.set_xlabel("tilt (deg)")
    axes.set_ylabel("inclination of the surface\nagainst the horizontal (deg)")
    figure.legend(loc=BELOW, ncols=2)
    return figure


def spilled_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Share of the grains that an open tank has lost: against the tilt, or against time."""
    if not recording.series["spilled"].any():
        return None
    figure, ((axes,),) = _figure(recording)
    tilts = is_tilt(recording)
    time, share = recording.series["time"], spilled.spilled_share(recording)
    for world in range(recording.worlds):
        curve = spilled.spill_curve(recording, world) if tilts else (time, share[:, world])
        label = None if world else f"each of {recording.worlds} beds" if recording.worlds > 1 else "bed"
        axes.plot(curve[0], 100 * curve[1], color=BLUE, lw=1.0, alpha=0.8, drawstyle="steps-post", label=label)
    _mark(axes, values.get("spill_start_angle"), f"first {100 * spilled.START:g} %", GREEN, ":")
    _mark(axes, values.get("spill_upturn_angle"), "sharp upturn", VERMILION)
    axes.set_xlabel("tilt (deg)" if tilts else "time (s)")
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.set_ylabel("spilled grains (% of all movable)")
    figure.legend(loc=BELOW, ncols=2)
    return figure


def hysteresis_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """The shift against the tilt, out and back: what the bed keeps where the tank is upright again."""
    if not hysteresis.applies(recording):
        return None
    figure, ((axes,),) = _figure(recording)
    for world, diameter in enumerate(recording.mean_diameter):
        tilt, shift, end = hysteresis.loop(recording, world)
        out, back = slice(end), slice(end - 1, None)
        names = (None, None) if world else ("way out", "way back")
        axes.plot(*_thinned(tilt[out], shift[out] / diameter), color=BLUE, lw=1.2, alpha=0.8, label=names[0])
        axes.plot(*_thinned(tilt[back], shift[back] / diameter), color=VERMILION, lw=1.2, alpha=0.8, label=names[1])
    remains, kept = values.get("remaining_shift"), values.get("kept_shift")
    for world, left in enumerate(remains.worlds if remains else ()):
        if left is not None:
            label = None if world or kept is None or kept.value is None else f"kept: {kept.value:.0f} % of the largest"
            axes.plot(0, left, "o", color=VERMILION, ms=4, label=label, clip_on=False, zorder=3)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_xlabel("tilt (deg)")
    axes.set_ylabel("shift of the centre of mass\ndownhill (mean diameters)")
    _millimetres(axes, 1e3 * recording.mean_diameter.mean())
    figure.legend(loc=BELOW, ncols=2)
    return figure


def force_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Force and moment of the cargo on the tank; of a driven tank the last periods beside its motion."""
    if not wall_force.applies(recording):
        return None
    drive, time = driving(recording), recording.series["time"][1:]
    force = 1e3 * recording.series["wall_force"][1:]
    heights, begin = ((2, 1), time[0]) if drive is None else ((1, 2, 1), _closer(time, drive[1]))
    figure, panels = _figure(recording, heights=heights)
    shown = time >= begin
    if drive is not None:
        label, scale = DRIVE[drive[0]]
        moved = scale * recording.series["pose"][1:][shown][:, :, HARMONIC[drive[0]]]
        _band(panels[0][0], time[shown], moved, GREY)
        panels[0][0].set_ylabel(label)
        panels[0][0].set_title(f"last {PERIODS} periods")
    upper, lower = panels[-2][0], panels[-1][0]
    _band(upper, time[shown], force[shown, :, 0], BLUE, "y, to starboard")
    _band(upper, time[shown], force[shown, :, 1], VERMILION, "z, up")
    weight = wall_force.cargo_weight(recording)
    if weight is not None:
        settled = -1e3 * weight[0].mean()
        upper.axhline(settled, color=GREY, ls=":", lw=1.0, label="weight of the cargo at the start")
    upper.set_ylabel("force on the tank\n(mN, a sheet of\none grain's thickness)")
    _band(lower, time[shown], force[shown, :, 2], GREEN, "moment about the middle of the floor")
    lower.set_ylabel("moment\n(mN m)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(begin, time[-1])
    figure.legend(loc=BELOW, ncols=2)
    return figure


def spectrum_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Amplitude spectrum of the centre of mass of a driven bed over its steady part."""
    if not spectrum.applies(recording):
        return None
    time = recording.series["time"]
    steady, frequency = steady_part(recording, time), driving(recording)[1]["frequency"]
    if steady is None:
        return None
    centre = 1e3 * recording.series["centre_of_mass"][steady.rows]
    centre = centre[:, np.isfinite(centre).all(axis=(0, 2))]
    if not centre.any():
        return None
    figure, ((axes,),) = _figure(recording)
    highest = 0.0
    for axis, colour, name in ((0, BLUE, "y, to starboard"), (1, VERMILION, "z, up")):
        frequencies, amplitudes = spectrum.amplitude_spectrum(time[steady.rows], centre[..., axis])
        kept = (frequencies > 0) & (frequencies < 5.6 * frequency)
        _range(axes, frequencies[kept], amplitudes[kept], colour, name)
        highest = max(highest, amplitudes[kept].max(initial=0.0))
    axes.set_yscale("log")
    axes.set_ylim(QUIETEST * highest, 2 * highest)
    axes.set_xlim(0, 5.6 * frequency)
    for order in spectrum.ORDERS:
        axes.axvline(order * frequency, color=GREY, ls=":", lw=0.8)
        name = {0.5: "f/2", 1.0: "f"}.get(order, f"{order:g}f")
        axes.annotate(
            name,
            (order * frequency, 1),
            (2, -2),
            xycoords=axes.get_xaxis_transform(),
            textcoords="offset points",
            va="top",
            color=GREY,
            fontsize=8,
        )
    axes.set_xlabel(f"frequency (Hz), driven at f = {frequency:.3g} Hz")
    axes.set_ylabel("amplitude of the centre of mass\nin the tank (mm)")
    figure.legend(loc=BELOW, ncols=2)
    return figure


def wave_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Elevation of the free surface at both walls and in the middle, and the first sloshing mode."""
    if not wave.applies(recording):
        return None
    places, mode = wave.wave_course(recording)
    time, drive = recording.frames["time"][:], driving(recording)
    begin = time[0] if drive is None else _closer(time, drive[1])
    figure, panels = _figure(recording, heights=(3, 2))
    shown = time >= begin
    for k, colour in enumerate((BLUE, GREY, VERMILION)):
        name = f"{wave.PLACES[k]} wall" if k != 1 else wave.PLACES[k]
        _band(panels[0][0], time[shown], 1e3 * places[shown][:, :, k], colour, name)
    panels[0][0].set_ylabel("elevation of\nthe surface (mm)")
    if drive is not None:
        panels[0][0].set_title(f"last {PERIODS} periods")
    _band(panels[1][0], time[shown], 1e3 * mode[shown], GREEN, "first mode cos(πy/L), higher at port")
    panels[1][0].set_ylabel("mode (mm)")
    panels[1][0].set_xlabel("time (s)")
    panels[1][0].set_xlim(begin, time[-1])
    figure.legend(loc=BELOW, ncols=4)
    return figure


def altitude_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """The top of the cargo in time: its highest grain, and the height most grains stay below."""
    count = len(recording.frames["time"])
    if count < 2 or not top_altitude.applies(recording):
        return None
    tops = 1e3 * np.array([top_altitude.altitudes(recording, frame) for frame in range(count)])
    figure, ((axes,),) = _figure(recording)
    time = recording.frames["time"][:]
    _band(axes, time, tops[..., 0], BLUE, "highest grain")
    _band(axes, time, tops[..., 1], VERMILION, f"{top_altitude.BULK:g} % of the grains lie lower")
    axes.set_xlabel("time (s)")
    axes.set_xlim(time[0], time[-1])
    axes.set_ylabel("altitude of the top\nin the tank (mm)")
    figure.legend(loc=BELOW, ncols=2)
    return figure


def heap_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """The heap under an outlet in time: how steep it lies, and below how many of the grains have passed."""
    if not flow_rate.applies(recording):
        return None
    outlet, time = find_outlet(recording), recording.frames["time"][:]
    flanks = [heap_angle.heap(recording, outlet, frame)[0][:, :, 0] for frame in range(len(time))]
    figure, ((upper,), (lower,)) = _figure(recording, heights=(2, 1))
    _band(upper, time, np.degrees(np.mean(flanks, axis=2)), BLUE)
    upper.set_ylabel("angle of the heap (deg)")
    upper.set_ylim(bottom=0)
    _band(lower, time, 100 * passed(recording, outlet).mean(axis=2), VERMILION)
    lower.set_ylabel("below the\noutlet (%)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(time[0], time[-1])
    return figure


def contact_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Mean coordination number in time."""
    if not contact_number.applies(recording):
        return None
    figure, ((axes,),) = _figure(recording)
    time, number = recording.series["time"], contact_number.contact_number(recording)
    _band(axes, time, number, BLUE, _mean_label(recording.worlds))
    axes.set_xlabel("time (s)")
    axes.set_xlim(time[0], time[-1])
    axes.set_ylabel("contacts of a grain")
    if recording.worlds > 1:
        figure.legend(loc=BELOW)
    return figure


def roll_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Roll of a ship in time, with loose and with frozen cargo; below her sway and heave and the shift of the cargo."""
    if not ship_roll.applies(recording):
        return None
    time, moved = recording.series["time"], axis_motion(recorded_ship(recording.preset), recording.series["pose"])
    moves = recorded_ship(recording.preset).freedom != "roll"
    figure, panels = _figure(recording, heights=(2, 1, 1) if moves else (2, 1))
    upper, lower = panels[0, 0], panels[-1, 0]
    alone = ship_roll.frozen(recording)
    if alone is not None:
        upper.plot(*_thinned(alone[0], np.degrees(alone[1])), color=GREY, lw=0.9, label="cargo frozen")
    for world, end in enumerate(ends(recording.series)):
        turned = np.degrees(moved[:, world, 2])
        upper.plot(*_thinned(time, turned), color=BLUE, lw=1.0, label=None if world else "cargo loose")
        if end:
            _mark_end(upper, end, recording.worlds)
    upper.set_ylabel("roll about the axis\n(deg), positive to port")
    if moves:
        _band(panels[1, 0], time, 1e3 * moved[..., 0], BLUE, "sway of the axis")
        _band(panels[1, 0], time, 1e3 * moved[..., 1], GREEN, "heave of the axis")
        panels[1, 0].set_ylabel("sway, heave\n(mm)")
    centre = 1e3 * recording.series["centre_of_mass"][..., 0]
    _band(lower, time, centre - centre[0], VERMILION)
    lower.set_ylabel("shift of the\ncargo (mm)")
    lower.set_xlabel(f"time (s); axis: {axis_place(recorded_ship(recording.preset))}")
    lower.set_xlim(time[0], time[-1] + (MARGIN * np.ptp(time) if any(ends(recording.series)) else 0.0))
    figure.legend(loc=BELOW, ncols=4)
    return figure


def _mark_end(axes: Axes, end: End, worlds: int) -> None:
    """The time at which a ship was lost; in words where there is but one."""
    axes.axvline(end.time, color=VERMILION, lw=1.0)
    axes.plot(end.time, np.degrees(end.roll), "x", color=VERMILION)
    if worlds == 1:
        words = {"xycoords": axes.get_xaxis_transform(), "textcoords": "offset points", "ha": "right", "va": "bottom"}
        axes.annotate(end.words, (end.time, 1.0), (0, 2), color=VERMILION, fontsize=8, **words)


def portrait_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Phase portrait of a ship's roll, the last half of the run darker."""
    if not ship_roll.applies(recording):
        return None
    figure, ((axes,),) = _figure(recording)
    roll, rate = (np.degrees(recording.series[name][..., 2]) for name in ("pose", "pose_rate"))
    half = len(roll) // 2
    alone = ship_roll.frozen(recording)
    if alone is not None and len(alone[1]) > LEAST_PORTRAIT:
        later = slice(len(alone[1]) // 2, None)
        turned = np.degrees(alone[1])
        axes.plot(turned[later], np.gradient(turned, alone[0])[later], color=GREY, lw=0.8, label="cargo frozen")
    for world in range(recording.worlds):
        axes.plot(*_thinned(roll[: half + 1, world], rate[: half + 1, world]), color=BLUE, lw=0.5, alpha=0.3)
        label = None if world else "cargo loose, last half"
        axes.plot(*_thinned(roll[half:, world], rate[half:, world]), color=BLUE, lw=0.9, label=label)
    axes.set_xlabel("roll (deg)")
    axes.set_ylabel("rate of roll (deg/s)")
    figure.legend(loc=BELOW, ncols=2)
    return figure


def roll_spectrum_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Amplitude spectrum of a ship's roll over the last half of the run."""
    if not ship_roll.applies(recording) or any(ends(recording.series)):
        return None
    time, roll = recording.series["time"], np.degrees(recording.series["pose"][..., 2])
    half = len(time) // 2
    if len(time) - half < LEAST_PORTRAIT:
        return None
    frequencies, amplitudes = spectrum.amplitude_spectrum(time[half:], roll[half:])
    if not amplitudes.any():
        return None
    figure, ((axes,),) = _figure(recording)
    kept = (frequencies > 0.0) & (frequencies < HIGHEST_ROLL)
    _range(axes, 2.0 * np.pi * frequencies[kept], amplitudes[kept], BLUE, "roll")
    axes.set_yscale("log")
    axes.set_ylim(QUIETEST * amplitudes.max(), 2.0 * amplitudes.max())
    driven = ship_roll.wave_frequency(recording)
    if driven is not None:
        axes.axvline(driven, color=GREY, ls=":", lw=0.8, label="waves")
    axes.set_xlabel("frequency (rad/s)")
    axes.set_ylabel("amplitude of roll (deg)")
    figure.legend(loc=BELOW, ncols=2)
    return figure


def lever_figure(recording: Recording, values: Mapping[str, Value]) -> Figure | None:
    """Righting lever of a ship against her heel, her cargo frozen as it lay at the start, or slid to its repose.

    Upright lines: where the edge of her deck, and an opening, meet the still waterline at constant displacement.
    """
    levers = ship_roll.levers(recording) if ship_roll.applies(recording) else None
    if levers is None:
        return None
    figure, ((axes,),) = _figure(recording)
    heel, lever, relaxed = levers
    axes.plot(np.degrees(heel), 1e3 * lever, color=GREY, label="cargo frozen")
    if relaxed is not None:
        steep = np.degrees(recorded_ship(recording.preset).repose)
        axes.plot(np.degrees(heel), 1e3 * relaxed, color=BLUE, label=f"cargo slid to a repose of {steep:.3g} deg")
    axes.axhline(0, color=GREY, lw=0.8)
    largest = np.degrees(np.abs(recording.series["pose"][..., 2]).max())
    axes.axvline(largest, color=VERMILION, ls=":", lw=1.0, label="largest roll of the run")
    for name, style in ANGLES.items():
        value = values.get(name)
        if value is not None:
            axes.axvline(value.value, lw=1.0, label=f"{name.replace('_', ' ')} {value.value:.1f} deg", **style)
    axes.set_xlabel("heel (deg)")
    axes.set_ylabel("righting lever GZ (mm)")
    figure.legend(loc=BELOW, ncols=2)
    return figure


FIGURES = {
    "roll": roll_figure,
    "portrait": portrait_figure,
    "roll-spectrum": roll_spectrum_figure,
    "lever": lever_figure,
    "heap": heap_figure,
    "spilled": spilled_figure,
    "shift": shift_figure,
    "slope": slope_figure,
    "hysteresis": hysteresis_figure,
    "altitude": altitude_figure,
    "wave": wave_figure,
    "spectrum": spectrum_figure,
    "force": force_figure,
    "contacts": contact_figure,
    "energy": energy_figure,
}


def _shift_against_tilt(recording: Recording, values: Mapping[str, Value]) -> Figure:
    figure, ((axes,),) = _figure(recording)
    worlds, diameters = recording.worlds, recording.mean_diameter
    curves = [critical_angle.shift_curve(recording, world) for world in range(worlds)]
    curves = [(tilt, shift / d) for (tilt, shift), d in zip(curves, diameters, strict=True)]
    if worlds > 1:
        for world, curve in enumerate(curves):
            label = None if world else f"each of {worlds} beds"
            axes.plot(*_thinned(*curve), color=BLUE, alpha=0.4, lw=0.7, label=label)
    common = np.linspace(0, min(tilt[-1] for tilt, _ in curves), POINTS)
    together = np.stack([np.interp(common, *curve) for curve in curves], axis=1)
    _band(axes, common, together, BLUE, _mean_label(worlds))
    _mark(axes, values.get("first_slip_angle"), "first slip", GREEN, ":")
    _mark(axes, values.get("critical_angle"), "critical angle", VERMILION)
    found = values["critical_angle"].worlds if "critical_angle" in values else ()
    for onset, curve in zip(found, curves, strict=False):
        if onset is not None:
            axes.plot(onset, np.interp(onset, *curve), "o", color=VERMILION, ms=3.5)
    axes.set_xlabel("tilt (deg)")
    axes.set_xlim(0, max(tilt[-1] for tilt, _ in curves))
    axes.set_ylabel("shift of the centre of mass\ndownhill (mean diameters)")
    _millimetres(axes, 1e3 * diameters.mean())
    figure.legend(loc=BELOW, ncols=2)
    return figure


def _shift_against_time(recording: Recording) -> Figure:
    """Tank above, bed below; on the right the last periods, where their phase can be seen."""
    drive, time = driving(recording), recording.series["time"]
    centre = recording.series["centre_of_mass"]
    moved = 1e3 * (centre - centre[0])
    if drive is None:
        figure, ((axes,),) = _figure(recording)
        _shift_curves(axes, time, moved)
        axes.set_xlim(time[0], time[-1])
        figure.legend(loc=BELOW, ncols=2)
        return figure
    figure, panels = _figure(recording, heights=(1, 2), widths=(3, 2))
    name, settings = drive
    label, scale = DRIVE[name]
    pose = scale * recording.series["pose"][:, :, HARMONIC[name]]
    for column, begin in ((0, time[0]), (1, _closer(time, settings))):
        shown = time >= begin
        _band(panels[0][column], time[shown], pose[shown], GREY)
        _shift_curves(panels[1][column], time[shown], moved[shown])
        panels[1][column].set_xlim(begin, time[-1])
    panels[0][0].set_ylabel(label)
    panels[0][1].set_title(f"last {PERIODS} periods")
    panels[1][1].set_ylabel("")
    figure.legend(*panels[1][0].get_legend_handles_labels(), loc=BELOW, ncols=2)
    return figure


def _shift_curves(axes: Axes, time: np.ndarray, moved: np.ndarray) -> None:
    """Shift (T, W, 2), mm, against time."""
    _band(axes, time, moved[:, :, 0], BLUE, "y, to starboard")
    _band(axes, time, moved[:, :, 1], VERMILION, "z, up")
    axes.set_ylabel("shift of the centre of mass\nin the tank (mm)")
    axes.set_xlabel("time (s)")


def _surface(axes: Axes, tilt: np.ndarray, slope: np.ndarray, error: np.ndarray, end: int, named: bool) -> None:
    """Inclination (K,) with its error over the tilt of one world; dashed from row `end` on."""
    line = {"color": BLUE, "lw": 0.9, "alpha": 0.8}
    axes.plot(tilt[:end], slope[:end], label="surface, band: uncertainty of the fit" if named else None, **line)
    axes.fill_between(tilt[:end], (slope - error)[:end], (slope + error)[:end], color=BLUE, alpha=0.12, lw=0)
    back = slice(end - 1, None)
    label = "way back" if named and np.ptp(tilt[back]) > 1 else None
    axes.plot(tilt[back], slope[back], ls="--", label=label, **line)


def _figure(recording: Recording, heights: tuple = (1,), widths: tuple = (1,)) -> tuple[Figure, np.ndarray]:
    """A figure with the preset's title, and its panels by row and column."""
    figure = Figure(figsize=SIZE, layout="constrained")
    panels = figure.subplots(
        len(heights),
        len(widths),
        squeeze=False,
        sharex="col",
        sharey="row",
        height_ratios=heights,
        width_ratios=widths,
    )
    count = f"{recording.radius.shape[1]} grains"
    if recording.worlds > 1:
        count = f"{recording.worlds} beds of {count} (bands: ± std over beds)"
    title = textwrap.fill(f"{recording.preset['title']}: {count}", TITLE)
    figure.suptitle(title, x=0.02, ha="left", fontsize=9.5)
    return figure, panels


def _closer(time: np.ndarray, settings: Mapping) -> float:
    """Where the last periods of a driven run begin (s)."""
    return max(time[-1] - PERIODS / settings["frequency"], time[0])


def _band(axes: Axes, x: np.ndarray, curves: np.ndarray, colour: str, label: str | None = None) -> None:
    """Mean of curves (T, W) over x (T,), with their standard deviation as a band; NaN in a world is left out."""
    x, curves = _thinned(x, curves)
    known = np.ma.masked_invalid(curves)
    mean = known.mean(axis=1).filled(np.nan)
    axes.plot(x, mean, color=colour, label=label)
    if curves.shape[1] > 1:
        std = np.ma.filled(known.std(axis=1, ddof=1), 0.0)
        axes.fill_between(x, mean - std, mean + std, color=colour, alpha=0.2, lw=0)


def _range(axes: Axes, x: np.ndarray, curves: np.ndarray, colour: str, label: str) -> None:
    """Median of positive curves (T, W) over x (T,), with all of them as a band."""
    x, curves = _thinned(x, np.where(curves > 0, curves, np.nan))
    middle = np.ma.median(np.ma.masked_invalid(curves), axis=1)
    said = f"{label}: median, band: all beds" if curves.shape[1] > 1 else label
    axes.plot(x, np.ma.filled(middle, np.nan), color=colour, label=said, lw=1.0)
    if curves.shape[1] > 1:
        low, high = np.fmin.reduce(curves, axis=1), np.fmax.reduce(curves, axis=1)
        axes.fill_between(x, low, high, color=colour, alpha=0.2, lw=0)


def _mark(axes: Axes, value: Value | None, name: str, colour: str, style: str = "-") -> None:
    """An upright line at a measured angle, its number in the legend; solid with a band, ± the std over beds."""
    if value is None or value.value is None:
        return
    axes.axvline(value.value, color=colour, lw=1.0, ls=style, label=f"{name} {number(value)}")
    if style == "-" and value.std is not None:
        axes.axvspan(value.value - value.std, value.value + value.std, color=colour, alpha=0.12, lw=0)


def _mean_label(worlds: int) -> str:
    return f"mean ± std of {worlds} beds" if worlds > 1 else "bed"


def _millimetres(axes: Axes, scale: float) -> None:
    """A second scale on the right, in mm."""
    right = axes.secondary_yaxis("right", functions=(lambda y: y * scale, lambda y: y / scale))
    right.set_ylabel("(mm)", rotation=0, ha="left", va="bottom", y=1.0)
    right.spines["right"].set_visible(True)


def _thinned(x: np.ndarray, curves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """At most about POINTS rows of both."""
    stride = max(1, len(x) // POINTS)
    return x[::stride], curves[::stride]
