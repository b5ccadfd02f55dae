"""The figures of a run, as they would stand in a paper: mean over the worlds, their spread as a band.

A new figure is a function `(recording, values) -> Figure | None` and a line in FIGURES; None where
it does not apply. Import this module only where figures are drawn: Matplotlib is slow to load.
"""

from collections.abc import Mapping
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.errors import LabError
from lab.measures import critical_angle, surface_slope
from lab.measures.motion import HARMONIC, driving, is_tilt, outward_leg
from lab.measures.value import Value
from lab.recording import Recording

# Okabe and Ito's colours, told apart by colour-blind readers as well.
BLUE, VERMILION, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#777777"
STYLE = {
    "font.size": 9,
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

DRIVE = {
    "sway": ("sway of the\ntank (mm)", 1e3),
    "heave": ("heave of the\ntank (mm)", 1e3),
    "roll": ("roll of the\ntank (deg)", np.degrees(1.0)),
}


def write_plots(recording: Recording, values: Mapping[str, Value], folder: Path | str) -> dict[str, Path]:
    """Draw every figure that applies as PNG in `folder`; returns the files by name.

    Raises LabError when the folder cannot be written.
    """
    drawn = {}
    with matplotlib.rc_context(STYLE):
        for name, draw in FIGURES.items():
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
    figure.legend(loc=BELOW, ncols=3)
    return figure


FIGURES = {"shift": shift_figure, "slope": slope_figure, "energy": energy_figure}


def _shift_against_tilt(recording: Recording, values: Mapping[str, Value]) -> Figure:
    figure, ((axes,),) = _figure(recording)
    worlds, diameters = recording.worlds, recording.mean_diameter
    curves = [critical_angle.shift_curve(recording, world) for world in range(worlds)]
    curves = [(tilt, shift / d) for (tilt, shift), d in zip(curves, diameters, strict=True)]
    _way_back(axes, recording)
    if worlds > 1:
        for world, curve in enumerate(curves):
            label = None if world else f"each of {worlds} beds"
            axes.plot(*_thinned(*curve), color=BLUE, alpha=0.4, lw=0.7, label=label)
    common = np.linspace(0, min(tilt[-1] for tilt, _ in curves), POINTS)
    together = np.stack([np.interp(common, *curve) for curve in curves], axis=1)
    _band(axes, common, together, BLUE, "mean ± std" if worlds > 1 else "bed")
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
    figure.legend(loc=BELOW, ncols=3)
    return figure


def _way_back(axes: Axes, recording: Recording) -> None:
    """The shift after the tilt was largest, while the tank turns back, dashed."""
    for world, diameter in enumerate(recording.mean_diameter):
        tilt = recording.series["pose"][:, world, 2]
        leg = outward_leg(tilt)
        back = leg.direction * np.degrees(tilt[leg.end - 1 :])
        y = recording.series["centre_of_mass"][:, world, 0]
        shift = -leg.direction * (y[leg.end - 1 :] - y[0]) / diameter
        if np.ptp(back) > 1:
            label = None if world else "way back"
            axes.plot(*_thinned(back, shift), color=GREY, ls="--", lw=0.9, label=label)


def _shift_against_time(recording: Recording) -> Figure:
    """Tank above, bed below; on the right the last periods, where their phase can be seen."""
    drive, time = driving(recording), recording.series["time"]
    centre = recording.series["centre_of_mass"]
    moved = 1e3 * (centre - centre[0])
    if drive is None:
        figure, ((axes,),) = _figure(recording)
        _shift_curves(axes, time, moved)
        axes.legend()
        return figure
    figure, panels = _figure(recording, heights=(1, 2), widths=(3, 2))
    name, settings = drive
    label, scale = DRIVE[name]
    pose = scale * recording.series["pose"][:, :, HARMONIC[name]]
    closer = max(time[-1] - PERIODS / settings["frequency"], 0.0)
    for column, begin in ((0, 0.0), (1, closer)):
        shown = time >= begin
        _band(panels[0][column], time[shown], pose[shown], GREY)
        _shift_curves(panels[1][column], time[shown], moved[shown])
        panels[1][column].set_xlim(begin, time[-1])
    panels[0][0].set_ylabel(label)
    panels[0][1].set_title(f"last {PERIODS} periods")
    panels[1][1].set_ylabel("")
    panels[1][0].legend(loc="best", ncols=2)
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
    axes.plot(tilt[:end], slope[:end], label="surface ± error of the fit" if named else None, **line)
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
        count = f"{recording.worlds} beds of {count}"
    figure.suptitle(f"{recording.preset['title']}: {count}", x=0.02, ha="left", fontsize=9.5)
    return figure, panels


def _band(axes: Axes, x: np.ndarray, curves: np.ndarray, colour: str, label: str | None = None) -> None:
    """Mean of curves (T, W) over x (T,), with their standard deviation as a band."""
    x, curves = _thinned(x, curves)
    mean = curves.mean(axis=1)
    axes.plot(x, mean, color=colour, label=label)
    if curves.shape[1] > 1:
        std = curves.std(axis=1, ddof=1)
        axes.fill_between(x, mean - std, mean + std, color=colour, alpha=0.2, lw=0)


def _range(axes: Axes, x: np.ndarray, curves: np.ndarray, colour: str, label: str) -> None:
    """Median of positive curves (T, W) over x (T,), with all of them as a band."""
    x, curves = _thinned(x, np.where(curves > 0, curves, np.nan))
    axes.plot(x, np.median(curves, axis=1), color=colour, label=label, lw=1.0)
    if curves.shape[1] > 1:
        low, high = curves.min(axis=1), curves.max(axis=1)
        axes.fill_between(x, low, high, color=colour, alpha=0.2, lw=0)


def _mark(axes: Axes, value: Value | None, name: str, colour: str, style: str = "-") -> None:
    """An upright line at a measured angle, its number in the legend; solid with a band of error."""
    if value is None or value.value is None:
        return
    error = value.uncertainty if value.std is None else value.std
    label = f"{name} {value.value:.1f} ± {error:.1f} deg"
    axes.axvline(value.value, color=colour, lw=1.0, ls=style, label=label)
    if style == "-":
        axes.axvspan(value.value - error, value.value + error, color=colour, alpha=0.12, lw=0)


def _millimetres(axes: Axes, scale: float) -> None:
    """A second scale on the right, in mm."""
    right = axes.secondary_yaxis("right", functions=(lambda y: y * scale, lambda y: y / scale))
    right.set_ylabel("(mm)", rotation=0, ha="left", va="bottom", y=1.0)
    right.spines["right"].set_visible(True)


def _thinned(x: np.ndarray, curves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """At most about POINTS rows of both."""
    stride = max(1, len(x) // POINTS)
    return x[::stride], curves[::stride]
