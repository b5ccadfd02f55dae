"""Which measures a preset's runs have, found out before any is run.

All measures are applied to a rehearsal: a recording with the preset's own times and motions, in which the grains do not
move. Their values mean nothing; which of them exist, and in which unit, is the same as in a run.
"""

import json
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from lab.assembly.scene import build
from lab.measures import measure_all
from lab.measures.value import Value
from lab.preset.find import LoadedPreset
from lab.preset.schema import Resolved
from lab.recording import Recorder, new_recording, open_recording
from lab.recording.layout import GRAIN_FRAMES, SERIES, SHIP_SERIES
from solvers.grains.observe import Observer
from solvers.scene import Scene
from solvers.simulation import Simulation

GRAINS = 50  # recorded at most
ROLL = 0.1  # rad, amplitude of a ship's roll in the rehearsal
POSE = [Observer.NAMES.index(name) for name in ("pose_y", "pose_z", "pose_angle")]


def rehearsed(loaded: LoadedPreset) -> dict[str, Value]:
    """The measures of a preset by name, with their units; their numbers mean nothing. Raises LabError (`build`)."""
    preset = loaded.resolved
    preset = preset.model_copy(update={"run": replace(preset.run, repeats=1)})
    scene, position = build(preset)
    with TemporaryDirectory(prefix="cargolab-") as folder:
        _record(Path(folder), loaded, preset, scene, position)
        with open_recording(folder) as recording, warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # such as for the mean of an empty array
            return measure_all(recording)


def _record(folder: Path, loaded: LoadedPreset, preset: Resolved, scene: Scene, position: np.ndarray) -> None:
    """Write the recording of the rehearsal."""
    count, parts = min(GRAINS, scene.radius.shape[1]), {name: part.points for name, part in preset.parts.items()}
    new_recording(
        folder,
        preset=loaded.name,
        given=loaded.given_text,
        resolved=json.loads(preset.model_dump_json()),
        radius=scene.radius[:, :count],
        outline=scene.outline,
        step=scene.step,
        fixed=scene.fixed,
        open_edges=scene.open_edges,
        parts=parts,
    )
    rate, grains = preset.record.series_rate, {name: np.zeros((1, count, *s)) for name, s in GRAIN_FRAMES.items()}
    grains["position"] = position[:, :count]
    a_frame = max(1, round(rate / preset.record.picture_rate))
    row = {name: np.ones((1, *shape)) for name, shape in SERIES.items()}
    if scene.vessels:
        row |= {name: np.full((1, *shape), -1.0) for name, shape in SHIP_SERIES.items()}
    frame = grains | {"part": np.zeros((1, len(parts), 2))}
    times = np.arange(max(1, round(preset.run.duration * rate)) + 1) / rate
    with Recorder(folder) as recorder:
        for k, (time, pose) in enumerate(zip(times, _poses(preset, scene, position, times), strict=True)):
            recorder.sample(row | {"time": time, "pose": pose})
            if k % a_frame == 0:
                recorder.frame(frame | {"time": time, "pose": pose})


def _poses(preset: Resolved, scene: Scene, position: np.ndarray, times: np.ndarray) -> Iterator[np.ndarray]:
    """Pose (1, 3) of the tank at each time (s); a ship, whose motion is not known yet, rolls slowly."""
    if scene.vessels or not scene.motions[0]:
        yield from (np.array([[0.0, 0.0, ROLL * np.sin(time)]]) * bool(scene.vessels) for time in times)
        return
    simulation = Simulation(scene, position, preset.run.threads, arch="cpu")
    try:
        for time in times:
            simulation.observer.observe(float(time), 1.0)
            yield simulation.observer.rows.to_numpy()[:, POSE].astype(float)
    finally:
        simulation.close()
