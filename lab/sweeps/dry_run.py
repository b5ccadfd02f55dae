"""Find the measures that a preset's runs will have, without running it.

All measures are applied to the recording of a dry run, which has the preset's times and motions but grains that do not
move. The values mean nothing; the names and units of the measures are the same as in a run.
"""

import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from lab.assembly.bulk import points_of
from lab.assembly.grains import fixed_of, radii_of
from lab.assembly.scene import build
from lab.assembly.water import air_volumes_of, volumes_of
from lab.base.turn import in_turn
from lab.measures import measure_all
from lab.measures.value import Value
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from lab.recording import Recorder, new_recording, open_recording
from lab.recording.layout import names_of, rows_of, sizes_of, tables_of
from solvers.machine.quantity import parted
from solvers.scene import Scene
from solvers.simulation import Simulation

GRAINS = 50  # largest number of grains, or of particles of water, that is recorded
ROLL = 0.1  # amplitude (rad) of a ship's roll


@in_turn
def available_measures(loaded: LoadedPreset) -> dict[str, Value]:
    """The measures of a preset by name, with their units; their values mean nothing. Raises LabError (`build`)."""
    preset = loaded.resolved
    preset = replace(preset, run=replace(preset.run, repeats=1))
    scene, position = build(preset)
    with TemporaryDirectory(prefix="cargolab-") as folder:
        _record(Path(folder), loaded, preset, scene, position)
        with open_recording(folder) as recording, warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # such as for the mean of an empty array
            return measure_all(recording)


def _record(folder: Path, loaded: LoadedPreset, preset: Preset, scene: Scene, position: np.ndarray) -> None:
    """Write the recording of the dry run."""
    radius, parts = radii_of(scene)[:, :GRAINS], {name: part.line for name, part in preset.parts.items()}
    volume, air = (of(scene)[:, :GRAINS] for of in (volumes_of, air_volumes_of))
    bulk = points_of(scene)[:, :GRAINS] if preset.bulk else None
    new_recording(
        folder,
        preset=loaded.name,
        given=loaded.given_text,
        resolved=preset,
        radius=radius,
        outline=scene.outline,
        step=scene.step,
        volume=volume,
        air=air,
        bulk=bulk,
        fixed=fixed_of(scene),
        open_edges=scene.open_edges,
        parts=parts,
    )
    rate, sizes = preset.record.series_rate, sizes_of(names_of(preset, parts), radius, volume, air, bulk)
    a_frame = max(1, round(rate / preset.record.picture_rate))
    tables = tables_of(preset, steered=False)
    series, frames = tables["series"], tables["frames"]
    never = {quantity.name: quantity.never for quantity in series if quantity.never is not None}
    row = {name: np.full(shape, never.get(name, 1.0)) for name, (shape, _) in rows_of(series, sizes).items()}
    frame = {name: np.zeros(shape) for name, (shape, _) in rows_of(frames, sizes).items()}
    if preset.grains:
        frame["position"] = position[:, :GRAINS]
    if preset.water:
        frame["water_position"] = scene.fluid.particles["position"][:, : volume.shape[1]]
    times = np.arange(max(1, round(preset.duration * rate)) + 1) / rate
    with Recorder(folder) as recorder:
        for k, (time, pose) in enumerate(zip(times, _poses(preset, scene, position, times), strict=True)):
            recorder.sample(row | {"time": time, "pose": pose})
            if k % a_frame == 0:
                recorder.frame(frame | {"time": time, "pose": pose})


def _poses(preset: Preset, scene: Scene, position: np.ndarray, times: np.ndarray) -> Iterator[np.ndarray]:
    """Pose (1, 3) of the tank at each time (s); one that responds to its load rolls slowly."""
    answers = bool(scene.vessels or scene.axles)
    if answers or not scene.motions[0]:
        yield from (np.array([[0.0, 0.0, ROLL * np.sin(time)]]) * answers for time in times)
        return
    simulation = Simulation(scene, position, preset.run.threads, arch="cpu")
    try:
        for time in times:
            simulation.sampler.sample(float(time), 1.0)
            yield parted(simulation.sampler.rows.to_numpy(), simulation.sampler.quantities)["pose"].astype(float)
    finally:
        simulation.close()
