"""A run ready to start: its preset, its folder, its scene, and where its grains begin."""

from collections.abc import Mapping
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path

import numpy as np

from lab.assembly.drawn import classes
from lab.assembly.grains import fixed_of, radii_of
from lab.assembly.scene import build, volumes
from lab.assembly.water import particles
from lab.preset.fields import marked
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from lab.recording import Outlines, new_recording
from lab.runs.beds import settling
from solvers.machine.runtime import available_cores, choose_arch
from solvers.scene import Scene
from solvers.time.schedules import choose_schedule, units_a_world


def outlines_of(preset: Preset, scene: Scene) -> Outlines | None:
    """The outlines of a preset's irregular grains, None if all are discs."""
    shapes = scene.grains.shapes if scene.grains else None
    return Outlines(shapes.outlines, classes(preset), shapes.which) if shapes else None


@dataclass(frozen=True)
class Run:
    """A run ready to start: its preset, the folder of its recording, its scene, initial positions (W, n, 2) m."""

    loaded: LoadedPreset
    folder: Path
    scene: Scene
    position: np.ndarray

    @property
    def shared(self) -> tuple:
        """The values that must be equal for two runs to share a batch."""
        preset = self.loaded.resolved
        alike = tuple(attrgetter(key)(preset) for key in marked(Preset, "alike"))
        return self.scene.shared(), settling(preset), preset.duration, alike

    @property
    def can_share(self) -> bool:
        """Whether it may share a batch; not in schedule per-band, which divides a world by the number of threads."""
        return self.device()["schedule"] != "per-band"

    def device(self, worlds: int = 0) -> dict[str, object]:
        """The device for a batch of `worlds` worlds (0: the run's own): `arch`, `schedule`, on the CPU `threads`."""
        settings, own, count = self.loaded.resolved.run, self.scene.worlds, particles(self.scene)
        responds, worlds = self.scene.responds, worlds or own
        threads, asked = settings.threads or available_cores(), (self.scene.particles > 0, worlds * count)
        arch = "cpu" if responds and settings.arch == "auto" else choose_arch(settings.arch, settings.precision, *asked)
        schedule = choose_schedule(settings.schedule, arch, worlds, count, threads, responds)
        if arch != "cpu":
            return {"arch": arch, "schedule": schedule}
        units = worlds * units_a_world(schedule, worlds, count, threads)
        return {"arch": arch, "schedule": schedule, "threads": min(threads, units)}

    def make_recording(self, steered: bool = False, device: Mapping[str, object] | None = None) -> None:
        """Create the recording without rows; device: of the batch, None: of this run. Raises LabError."""
        preset, scene = self.loaded.resolved, self.scene
        new_recording(
            self.folder,
            preset=self.loaded.name,
            given=self.loaded.given_text,
            resolved=preset,
            radius=radii_of(scene),
            outline=scene.outline,
            step=scene.step,
            **volumes(scene),
            kind=scene.grains.kind if scene.grains else None,
            fixed=fixed_of(scene),
            open_edges=scene.open_edges,
            parts={name: part.line for name, part in preset.parts.items()},
            shapes=outlines_of(preset, scene),
            machine=self.device() if device is None else device,
            steered=steered,
        )


def prepare(loaded: LoadedPreset, folder: Path) -> Run:
    """Prepare a run of this preset with its recording in `folder`.

    Raises LabError if the grains or the step do not fit, Unavailable if this machine lacks the device.
    """
    choose_arch(loaded.resolved.run.arch, loaded.resolved.run.precision)
    return Run(loaded, folder, *build(loaded.resolved))
