"""How much of the cargo an open tank has lost, and the tilts at which the losses begin and turn sharply upwards.

spilled_fraction: share of the movable grains that have left the tank at the last sample (Spandonidis
2016, 5.3.2, figure 5.16 right); the fixed grains of rough walls do not count. It is exact for its bed.
spill_start_angle: the tilt at which this share first reaches START. Error: half the tilt between one
grain less and one grain more.
spill_upturn_angle: the tilt at which slow losses turn into fast ones, which the source takes for the
angle of repose. A liquid that fills a tank of width L to the depth h loses the wedge L^2/2 d(phi) of its
area L h when the tank tilts by d(phi). So the share times 2h/L is the angle by which the surface has turned
in the tank; h is twice the height of the settled centre of mass. On this scale the upturn is the onset of
the first step of at least MAIN that the detector of `critical_angle` finds. In a tank three times as wide
as deep that is a loss of 5 %; the source saw slow losses of 2 %. Error: that of the detector.

Both angles are of the way out, in a tilting tank only.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.critical_angle import MAIN, find_steps
from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, level, mark
from lab.measures.motion import is_tilt, outward_leg
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import ROLL

OF = "grains"
START = 0.01  # of the movable grains


def applies(recording: Recording) -> bool:
    """The tank is open, and the grains are in it and not in a hull."""
    grains = recording.preset.grains
    return len(recording.open_edges) > 0 and (grains is None or grains.room is None)


def measure(recording: Recording) -> dict[str, Value]:
    """spilled_fraction (%), spill_start_angle and spill_upturn_angle (deg)."""
    found = {"spilled_fraction": over_worlds(100 * spilled_share(recording)[-1], "%")}
    if is_tilt(recording):
        worlds = range(recording.worlds)
        starts = np.array([_start(*spill_curve(recording, w), recording.radius.shape[1]) for w in worlds])
        upturns = np.array([_upturn(recording, w) for w in worlds])
        few = f"less than {100 * START:g} % spilled"
        found |= {
            "spill_start_angle": over_worlds(
                starts[:, 0], "deg", uncertainties=starts[:, 1], kind="resolution", missing=few
            ),
            "spill_upturn_angle": over_worlds(
                upturns[:, 0],
                "deg",
                uncertainties=upturns[:, 1],
                kind="detector",
                missing="no sharp upturn of the losses",
            ),
        }
    return found


def spilled_share(recording: Recording) -> np.ndarray:
    """Spilled over movable grains (T, W)."""
    return recording.series["spilled"] / recording.radius.shape[1]


def spill_curve(recording: Recording, world: int) -> tuple[np.ndarray, np.ndarray]:
    """Tilt (T',), deg, and share spilled (T',) on the way out."""
    tilt = recording.series["pose"][:, world, ROLL]
    leg = outward_leg(tilt)
    turned = leg.direction * (tilt[: leg.end] - tilt[0])
    return np.degrees(turned), spilled_share(recording)[: leg.end, world]


def _start(tilt: np.ndarray, share: np.ndarray, count: int) -> tuple[float, float]:
    """Tilt at which the share first reaches START, and its error; NaN if it never does."""
    if share[-1] < START:
        return np.nan, np.nan
    before, at, after = (np.argmax(share >= START + grains / count - 1e-12) for grains in (-1, 0, 1))
    after = after if share[-1] >= START + 1 / count - 1e-12 else len(share) - 1
    spacing = float(np.median(np.diff(tilt)))
    return float(tilt[at]), float(tilt[after] - tilt[before]) / 2 + spacing


def _upturn(recording: Recording, world: int) -> tuple[float, float]:
    """Onset of the first main step of the losses and its error (deg); NaN without one."""
    tilt, share = spill_curve(recording, world)
    floor, width = recording.outline[:, 1].min(), np.ptp(recording.outline[:, 0])
    depth = 2 * (recording.series["centre_of_mass"][0, world, 1] - floor)
    steps = find_steps(tilt, np.degrees(share * 2 * depth / width))
    return next(((step.onset, step.error) for step in steps if step.give >= MAIN), (np.nan, np.nan))


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Share of the grains that an open tank has lost: against the tilt, or against time."""
    if not recording.series["spilled"].any():
        return
    ((axes,),) = sheet.panels()
    tilts = is_tilt(recording)
    time, share = recording.series["time"], spilled_share(recording)
    for world in range(recording.worlds):
        curve = spill_curve(recording, world) if tilts else (time, share[:, world])
        label = None if world else f"each of {recording.worlds} beds" if recording.worlds > 1 else "bed"
        axes.plot(curve[0], 100 * curve[1], color=BLUE, lw=1.0, alpha=0.8, drawstyle="steps-post", label=label)
    mark(sheet, axes, values.get("spill_start_angle"), f"first {100 * START:g} %", GREEN, ":")
    mark(sheet, axes, values.get("spill_upturn_angle"), "sharp upturn", VERMILION)
    axes.set_xlabel("tilt (deg)" if tilts else "time (s)")
    axes.set_xlim(left=0)
    level(sheet, axes, values.get("spilled_fraction"), "at the end", GREY)
    axes.set_ylim(bottom=0)
    axes.set_ylabel("spilled grains (% of all movable)")


FIGURES = {"spilled": draw}
