"""What is wrong with a run of water by its own account: the energy that nothing explains, and its compression.

water_residual: the largest |E(t) − E(0) + viscous + diffusive + stored − work| of the run, over the energy exchanged by
then, |work| + viscous + |diffusive| + the largest kinetic energy. E is the kinetic, potential and elastic energy over
the earth, `viscous` and `diffusive` are what viscosity and the diffusion of density have taken, `stored` the energy in
the wall particles, `work` that of the walls (Antuono, Marrone, Colagrossi & Bouscasse 2015, for δ-SPH). It is zero
up to the error of the time step.
water_density_deviation: the largest |ρ/ρ0 − 1|. Up to some 1 % the water counts as incompressible; impacts may exceed
it for a moment. water_dense: the largest share of the water that deviates by more than 3 %.
Error: none of their own.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, band, note
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

OF = "water"
TAKEN = "water_viscous", "water_diffusive"


def applies(recording: Recording) -> bool:
    """Every recording of water has its energies."""
    return True


def measure(recording: Recording) -> dict[str, Value]:
    """water_residual, water_density_deviation and water_dense (%)."""
    series = recording.series
    exchanged = sum(np.abs(series[name]) for name in ("water_work", *TAKEN))
    exchanged = exchanged + np.maximum.accumulate(series["water_kinetic"], axis=0)
    worst = np.abs(residual(recording)).max(axis=0)
    most = exchanged.max(axis=0)
    share = np.divide(100.0 * worst, most, out=np.full_like(most, np.nan), where=most > 0.0)
    return {
        "water_residual": over_worlds(share, "%", note="of the energy exchanged", missing="nothing moves"),
        "water_density_deviation": over_worlds(100.0 * series["water_density_deviation"].max(axis=0), "%"),
        "water_dense": over_worlds(100.0 * series["water_dense"].max(axis=0), "%"),
    }


def residual(recording: Recording) -> np.ndarray:
    """Energy (T, W), J, that nothing accounts for."""
    series = recording.series
    gained = series["water_total"] - series["water_total"][0]
    given = series["water_work"] + (series["inflow_energy"] if recording.preset.inflow else 0.0)
    return gained + sum(series[name] for name in TAKEN) + series["water_wall_energy"] - given


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The energies in time: kinetic, taken by the models, work of the walls, and what nothing accounts for."""
    time, series = recording.series["time"], recording.series
    if not series["water_kinetic"].any():
        return
    (upper,), (lower,) = sheet.panels(heights=(2, 1))
    band(upper, time, series["water_kinetic"], BLUE, "kinetic, relative to the tank")
    band(upper, time, sum(series[name] for name in TAKEN), VERMILION, "taken by viscosity and diffusion")
    band(upper, time, series["water_work"], GREEN, "work of the walls")
    upper.set_ylabel("energy (J)")
    band(lower, time, residual(recording), GREY)
    note(sheet, lower, values.get("water_residual"), "largest residual")
    lower.set_ylabel("residual (J)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(time[0], time[-1])


FIGURES = {"water_energy": draw}
