"""The falling stack beside free fall."""

from matplotlib.figure import Figure

from lab.report.plots import BLUE, GREY, canvas
from lab.studies.reproduce.experiment import Found, Row, observed

DROP, THEN = 0.05, 9.81  # s, when the floor of the stack begins to fall; m/s²


def stack_lag(found: Found) -> list[Row]:
    """How far the stack lags behind free fall."""
    one = found["stack"][0]
    free = 500.0 * THEN * (float(one.recording.series["time"][-1]) - DROP) ** 2
    said = f"{100.0 * (1.0 - one['top_fall'].value / free):.1f} % of {free:.0f} mm"
    return [observed("it lags behind free fall, as walls rub", "within 7 % of the experiment", said, None)]


def stack(found: Found) -> Figure:
    """The centre of mass of the falling stack beside free fall."""
    series = found["stack"][0].recording.series
    time, middle = series["time"], 1e3 * series["centre_of_mass"][:, 0, 1]
    figure, axes = canvas((6.4, 3.2))
    axes.plot(time, middle - middle[0], color=BLUE, label="centre of mass of the stack")
    fallen = time > DROP
    axes.plot(time[fallen], -500.0 * THEN * (time[fallen] - DROP) ** 2, color=GREY, ls=":", label="free fall")
    axes.set(xlabel="time (s)", ylabel="altitude, change (mm)")
    axes.legend()
    return figure
