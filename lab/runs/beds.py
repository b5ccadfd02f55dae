"""Settle beds, and keep them in a store, so that each bed is settled only once.

A stored bed holds the entries of one world's solver state that settling changed, under a hash of everything that
determines them; a run from it has the same bits as a run from a newly settled bed. The store is the folder `beds` in
the user's cache, or in the folder that the environment variable CARGOLAB_CACHE names. It holds at most 256 MiB; the
least recently used beds are deleted first. A file that cannot be read counts as missing.
"""

import os
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import NamedTemporaryFile

import numpy as np

from lab.assembly.grains import filling_outline
from lab.assembly.scene import build
from lab.base.caches import cache_folder
from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.preset.schema import Preset
from lab.preset.units import show
from lab.runs.bed_key import bed_key
from solvers.grains.bed.filling import levelled
from solvers.grains.materials import Material
from solvers.machine.quantity import PLANE
from solvers.machine.state import Axes, of_world
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.outline import clear_of_walls

LARGEST_STORE = 2**28  # bytes
ABANDONED = 3600.0  # s after which a half-written file is deleted

Start = Callable[[Scene, np.ndarray], Simulation]
Bed = dict[str, np.ndarray]

FREE = 0.9  # least distance of a grain of a settled bed from a wall, in its radius


@dataclass(frozen=True)
class Settling:
    """How beds are settled: tank `outline`, kind of surface, residual energy at rest, time `limit` (s).

    `settle` false: the grains start where they are placed. `reuse` false: the store is not used. `disc_step` (s): round
    irregular grains first settle as discs, with this step, and then as they are. `friction`: that of grains and walls
    while the grains are poured; None: their own.
    """

    outline: tuple[tuple[float, float], ...]
    surface: str
    rest: float
    limit: float
    settle: bool = True
    reuse: bool = True
    disc_step: float | None = None
    friction: float | None = None


def settling(preset: Preset) -> Settling:
    """The settling of a preset's beds. Worlds that settle in one batch must agree in it."""
    run, grains = preset.run, preset.grains
    if grains is None:
        return Settling(preset.hold.corners, "", run.rest, run.settle_limit, settle=False)
    outline = tuple(map(tuple, filling_outline(preset).tolist()))
    disc_step = build(_of_discs(preset))[0].step if grains.settled_as == "discs" else None
    friction = 0.0 if grains.surface == "undisturbed" else grains.poured_friction
    how = grains.surface, run.rest, run.settle_limit, run.settles, grains.reuse_bed, disc_step, friction
    return Settling(outline, *how)


def _of_discs(preset: Preset) -> Preset:
    """The preset with discs in place of its round outlines."""
    grains = replace(preset.grains, diameter=preset.mean_diameter, shares="number", settled_as="outlines")
    return replace(preset, shapes={}, grains=grains)


def settled(scene: Scene, position: np.ndarray, how: Settling, start: Start, progress: Progress) -> Simulation:
    """A simulation of `scene` with its beds settled, from `position` (W, n, 2) m; the clock stands at zero.

    The beds come from the store if it has all of them. `start` makes a simulation from a scene and positions. Raises
    BadState from the watch, LabError if a bed does not fit under its tank's lid. Without grains nothing settles.
    """
    simulation = start(scene, position)
    if not scene.grains:  # water starts at rest
        return simulation
    if not how.settle:
        progress.note("The grains start where they were placed, without settling (run.settle = false, or no gravity).")
        return simulation
    store = BedStore() if how.reuse else None
    keys = [bed_key(simulation, w, position[w], how) for w in range(len(position))] if store else []
    if store and lay(simulation, [store.load(key) for key in keys]):
        progress.note(f"The settled bed was reused from {store.folder}; grains.reuse_bed = false settles it again.")
        return simulation
    if how.disc_step:
        simulation.close()
        simulation = start(scene, _settled_as_discs(scene, position, how, start, progress))
    elif how.friction is not None or how.outline != _corners(scene) or scene.hold or scene.mixture:
        simulation.close()
        simulation = start(*_poured(scene, position, how, start, progress))
    try:
        before = simulation.state() if store else {}
        rests = _settle(simulation, how, "settling", progress)
        if not rests:
            progress.warn(
                f"The grains still moved after {how.limit:g} s of settling; raise run.settle_limit or run.rest."
            )
        elif store:
            beds = made(before, simulation.state(), simulation.axes(), len(position))
            for key, bed in zip(keys, beds, strict=True):
                store.save(key, bed)
    except BaseException:
        simulation.close()
        raise
    return simulation


def _settled_as_discs(
    scene: Scene, position: np.ndarray, how: Settling, start: Start, progress: Progress
) -> np.ndarray:
    """Positions (W, n, 2) m of settled discs of the same sizes, from the store if they are in it."""
    discs = scene.holding(replace(scene.grains, shapes=None), step=how.disc_step)
    simulation = settled(discs, position, replace(how, disc_step=None), start, progress)
    try:
        return simulation.snapshot()["position"]
    finally:
        simulation.close()


def _settle(simulation: Simulation, how: Settling, stage: str, progress: Progress) -> bool:
    def report(time: float) -> None:
        progress.reach(time)
        progress.watch(simulation)

    progress.start(stage, how.limit)
    progress.watch(simulation)  # show the grains before the kernels are compiled, which takes some seconds
    rests = simulation.settle(how.rest, how.limit, report)
    progress.finish()
    return rests


def _poured(
    scene: Scene, position: np.ndarray, how: Settling, start: Start, progress: Progress
) -> tuple[Scene, np.ndarray]:
    """The scene, and where its grains lie (W, n, 2) m once they are poured into a closed tank that stands still.

    Its walls reach as high as the grains. Those of a hull that floats, or in water, are poured without it. Without
    friction they pack as densely as shaking would; an undisturbed bed is then levelled. In the returned scene irregular
    grains have the angles at which they lie.
    """
    pouring, grains = scene.poured(np.array(how.outline)), scene.grains
    hold = scene.tanks[scene.hold]
    if how.friction is not None:
        changed = {name: _rubbing(getattr(grains, name), how.friction) for name in ("grain", "wall", "others")}
        unlike = tuple((pair, replace(met, friction=how.friction)) for pair, met in grains.unlike)
        pouring = pouring.holding(replace(grains, **changed, unlike=unlike))
    simulation = start(pouring, position)
    try:
        _settle(simulation, how, "pouring", progress)
        snapshot = simulation.snapshot()
    finally:
        simulation.close()
    poured, inner = snapshot["position"], grains.radius
    if grains.shapes:
        inner = inner * np.array([outline.smallest_radius for outline in grains.shapes.outlines])[grains.shapes.which]
        scene = scene.holding(replace(grains, shapes=replace(grains.shapes, angle=snapshot["angle"])))
    if how.surface == "undisturbed":
        beds = zip(poured, grains.radius, strict=True)
        poured = np.stack([levelled(bed, radius, pouring.outline, grains.fixed) for bed, radius in beds])
    if not hold.open_edges and how.outline != _corners(scene):  # else they cannot be beyond the walls
        for bed, radius in zip(poured, inner, strict=True):
            if not np.all(clear_of_walls(bed[:, :PLANE], hold.outline, FREE * radius)):
                top = show(float((bed[:, 1] + radius).max() - hold.outline[:, 1].min()), "m")
                raise LabError(f"grains: the bed is up to {top} high, too high for the tank; ask for fewer grains.")
    return scene, poured


def _rubbing(materials: Iterable[Material], friction: float) -> tuple[Material, ...]:
    """The materials with another coefficient of friction."""
    return tuple(replace(material, friction=friction) for material in materials)


def _corners(scene: Scene) -> tuple[tuple[float, float], ...]:
    return tuple(map(tuple, scene.tanks[scene.hold].outline.tolist()))


def made(
    before: Mapping[str, np.ndarray], after: Mapping[str, np.ndarray], axes: Mapping[str, Axes], worlds: int
) -> list[Bed]:
    """The bed of each world: its part of the entries of the state that settling changed.

    Entries that it did not change, such as the motions' numbers, belong to the scene and not to the bed.
    """
    changed = [name for name in after if not _same(before[name], after[name])]
    return [{name: of_world(after[name], axes[name], worlds, w) for name in changed} for w in range(worlds)]


def lay(simulation: Simulation, beds: list[Bed | None]) -> bool:
    """Copy beds into the worlds of a new simulation; returns False if one is missing or has other shapes."""
    if any(bed is None for bed in beds):
        return False
    state = {name: np.array(values) for name, values in simulation.state().items()}
    axes = simulation.axes()
    for w, bed in enumerate(beds):
        if not bed.keys() <= state.keys():
            return False
        for name, values in bed.items():
            place = of_world(state[name], axes[name], len(beds), w)
            if place.shape != values.shape:
                return False
            place[...] = values
    simulation.restore(state)
    return True


def _same(a: np.ndarray, b: np.ndarray) -> bool:
    return a.shape == b.shape and a.tobytes() == b.tobytes()


class BedStore:
    """Beds by key, one file each, in a folder that several processes may use at the same time."""

    def __init__(self, folder: Path | None = None):
        self.folder = folder or cache_folder() / "beds"

    def load(self, key: str) -> Bed | None:
        """The bed of that key; None if missing or unreadable."""
        path = self._path(key)
        try:
            with np.load(path, allow_pickle=False) as file:
                bed = {name: file[name] for name in file.files}
            os.utime(path)  # marks it as used now
        except Exception:  # a damaged file, in whatever way, counts as missing
            return None
        return bed if str(bed.pop("key", "")) == key else None

    def save(self, key: str, bed: Bed) -> None:
        """Store a bed if the disk allows; the file is replaced atomically."""
        with suppress(OSError):
            self.folder.mkdir(parents=True, exist_ok=True)
            with NamedTemporaryFile(dir=self.folder, suffix=".part", delete=False) as file:
                half = Path(file.name)
                try:
                    np.savez_compressed(file, key=np.array(key), **bed)
                except BaseException:
                    half.unlink(missing_ok=True)
                    raise
            half.replace(self._path(key))
            self._tidy()

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}.npz"

    def _tidy(self) -> None:
        """Delete the least recently used beds until the rest is small enough, and abandoned half-written files."""
        now, kept = time.time(), 0
        found = []
        for path in self.folder.iterdir():
            with suppress(OSError):  # another process has deleted it first
                found.append((path.stat().st_mtime, path.stat().st_size, path))
        for used, size, path in sorted(found, reverse=True):
            if path.suffix == ".part":
                stale = now - used > ABANDONED
            else:
                kept += size
                stale = kept > LARGEST_STORE
            if stale:
                with suppress(OSError):
                    path.unlink()
