"""Experiments of other authors that the source simulates for validation."""

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from lab.report.plots import BLUE, GREY
from lab.studies.reproduce.experiment import Experiment, Told, counted, observed
from lab.studies.reproduce.runs import Batch, Outcome

DROP, THEN = 0.05, 9.81  # s, when the floor begins to fall; m/s²


def stack(found: Mapping[str, Sequence[Outcome]]) -> Told:
    """The stack falls with its floor, which falls faster than free."""
    one = found["stack"][0]
    rows = [
        observed("the top falls by", "", counted(one["top_fall"]), None),
        observed("it lags behind free fall, as walls rub", "within 7 % of the experiment", _lag(one), None),
    ]
    return Told(rows, _figure(one))


def swelling(found: Mapping[str, Sequence[Outcome]]) -> Told:
    """Whether the middle of the bed breathes at a frequency of its own."""
    one = found["shaken"][0]
    rows = [
        observed("the middle rises and falls by", "", counted(one["swelling_amplitude"]), None),
        observed(
            "at", "a frequency of its own, within 7 % of the experiment", counted(one["swelling_frequency"]), None
        ),
    ]
    return Told(rows)


def _lag(one: Outcome) -> str:
    time = float(one.recording.series["time"][-1]) - DROP
    free = 500.0 * THEN * time**2
    return f"{100.0 * (1.0 - one['top_fall'].value / free):.1f} % of {free:.0f} mm"


def _figure(one: Outcome) -> Figure:
    series = one.recording.series
    time, middle = series["time"], 1e3 * series["centre_of_mass"][:, 0, 1]
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.add_subplot()
    axes.plot(time, middle - middle[0], color=BLUE, label="centre of mass of the stack")
    fallen = time > DROP
    axes.plot(time[fallen], -500.0 * THEN * (time[fallen] - DROP) ** 2, color=GREY, ls=":", label="free fall")
    axes.set_xlabel("time (s)")
    axes.set_ylabel("altitude, change (mm)")
    axes.legend()
    return figure


EXPERIMENTS = [
    Experiment(
        "stack-fall",
        "Guided fall of a stack",
        "4.5, after Duran (2000)",
        "a triangular stack of 1.5 mm aluminium discs in a cell 36 mm wide, its floor dropped at 3 g: simulation and"
        " experiment differ by about 7 %.",
        lambda quick: {"stack": Batch("validation/stack-fall", {"run.accuracy": "draft"} if quick else {})},
        stack,
        "draft accuracy",
        ("stack", 0.8),
        "The measured altitudes are a figure of the source without numbers.",
    ),
    Experiment(
        "swelling",
        "Swelling under horizontal shaking",
        "4.5, after Pöschel and Rosenkranz (1997)",
        "grains of 0.1 mm, 15 mm deep in a box of 60 mm that is shaken sideways, swell in the middle; the frequency at "
        "which they do differs by about 7 % from the experiment.",
        lambda quick: {"shaken": Batch("validation/swelling-quick", {"run.duration": "3 s"} if quick else {})},
        swelling,
        "grains of 1 mm for 0.1 (the full report, too: the fine ones take a week), 3 s for 5",
        ("shaken", 0.9),
        "The source gives neither amplitude nor frequency of the drive, nor the material: no number can be compared.",
    ),
]
