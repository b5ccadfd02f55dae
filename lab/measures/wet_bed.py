"""A wet bed in the picture frames: how deep it is, how much water there is, where it stands, and its pressure.

A bed is as deep as an even one with the same centre of mass (`solvers.mixture.bed.bed_depth`), in a rectangular tank
H = 2 z_c. Its porosity is ε = 1 − V_s/V(H). Each particle of water stands for the share a = A/n of the water's area A,
and takes up a/ε with the grains in it: Σ a/ε is what lies below the mean surface of the water, in the bed or over it.
"""

from dataclasses import dataclass
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from lab.assembly.water import mixture_of
from lab.preset.kept.content import FIRST
from lab.preset.sections.wet.states import share_of
from lab.recording import Recording
from solvers.machine.quantity import ROLL
from solvers.mixture.bed import area_up_to, bed_depth, depth_up_to
from solvers.mixture.start import amount, porosity_map

COLUMN = 2.0  # mean diameters
TOUCHES = 1.1  # mean diameters from a grain to another that it lies on
LEAST = 2  # of these: grains with fewer are thrown


@dataclass(frozen=True, eq=False)
class WetBed:
    """What the frames of a recording of wet cargo say of its bed and its water; (F, W) unless told otherwise."""

    recording: Recording

    @cached_property
    def time(self) -> np.ndarray:
        """Times (F,) of the frames, s."""
        return self.recording.frames["time"][:]

    @cached_property
    def floor(self) -> float:
        """Height (m) of the tank's lowest point."""
        return float(self.recording.outline[:, 1].min())

    @cached_property
    def middle(self) -> float:
        """Middle (m) of the tank's width."""
        return 0.5 * float(self.recording.outline[:, 0].min() + self.recording.outline[:, 0].max())

    def read(self, name: str, frame: int) -> np.ndarray:
        """A quantity of a frame in 64 bits."""
        return self.recording.frames[name][frame].astype(float)

    @cached_property
    def solids(self) -> np.ndarray:
        """Areas (W, n) that the grains' volumes take in the plane, m²."""
        return 4.0 / 3.0 * np.pi * self.recording.radius**3 / self.recording.preset.thickness

    @cached_property
    def dry(self) -> np.ndarray:
        """Mass (W,) of the grains in the plane, kg/m."""
        preset = self.recording.preset
        kinds = [preset.material, *(other.material for other in preset.others.values())]
        density = np.array([kind.density for kind in kinds])[self.recording.kind]
        return (density * self.solids).sum(axis=1)

    @cached_property
    def water(self) -> np.ndarray:
        """Area (W,) of the water in the plane, m²; it is as much as was laid between the grains of the first frame."""
        preset, share = self.recording.preset, share_of(self.recording.preset.water)
        if share and share[0] == "moisture":
            return share[1] / (1.0 - share[1]) * self.dry / preset.water.density
        mixture, outline, found = mixture_of(preset), self.recording.outline, []
        for place, solid in zip(self.read("position", 0), self.solids, strict=True):
            bed = porosity_map(place, solid, outline, preset.liquid)
            found.append(amount(mixture, bed, outline, place, solid, 0.0))
        return np.array(found)

    @cached_property
    def depth(self) -> np.ndarray:
        """Depth (m) of the bed, by its centre of mass."""
        outline, frames = self.recording.outline, range(len(self.time))
        beds = (zip(self.read("position", frame), self.solids, strict=True) for frame in frames)
        return np.array([[bed_depth(outline, *bed) for bed in worlds] for worlds in beds])

    @cached_property
    def porosity(self) -> np.ndarray:
        """Mean porosity of the bed."""
        outline, solid = self.recording.outline, self.solids.sum(axis=1)
        areas = [[area_up_to(outline, deep) for deep in worlds] for worlds in self.depth]
        return 1.0 - solid / np.array(areas)

    @cached_property
    def tops(self) -> np.ndarray:
        """Height (F, W, C), m, of the highest grain that touches others in columns from port to starboard; NaN: none.

        They are COLUMN mean diameters wide.
        """
        beds, outline = self.recording.radius, self.recording.outline
        size = COLUMN * float(self.recording.mean_diameter.mean())
        count = max(3, int(np.ptp(outline[:, 0]) / size))
        places = (self.read("position", frame) for frame in range(len(self.time)))
        return np.array([[_tops(*bed, outline, count) for bed in zip(place, beds, strict=True)] for place in places])

    def taken(self, frame: int) -> np.ndarray:
        """What each particle of water (W, n) takes up with the grains in it, m²."""
        porosity = self.read("water_porosity", frame)
        return self.water[:, None] / porosity.shape[1] / np.maximum(porosity, 1e-3)

    @cached_property
    def level(self) -> np.ndarray:
        """Mean height (m) of the water's surface over the floor, on the bed or in it."""
        outline, frames = self.recording.outline, range(len(self.time))
        sums = (self.taken(frame).sum(axis=1) for frame in frames)
        return np.array([[depth_up_to(outline, area) for area in worlds] for worlds in sums])

    @cached_property
    def free(self) -> np.ndarray:
        """Mean depth (m) of the water over the bed: that of the particles above its surface, each as high as wide.

        The share of a particle's square above the bed in its column counts. The tops of the grains there are lowered so
        far that they have the bed's depth in the mean, since the highest of a few grains is higher than the rest.
        """
        outline, width, found = self.recording.outline, float(np.ptp(self.recording.outline[:, 0])), []
        for frame in range(len(self.time)):
            place, taken, over = self.read("water_position", frame), self.taken(frame), []
            for w, tops in enumerate(self.tops[frame]):
                lower = np.nanmean(tops) - self.floor - self.depth[frame, w]
                side, known = np.sqrt(taken[w]), np.where(np.isfinite(tops), tops - lower, self.floor)
                share = (place[w, :, 0] - outline[:, 0].min()) / width
                top = known[np.clip((share * len(known)).astype(int), 0, len(known) - 1)]
                above = np.clip((place[w, :, 1] - top) / side + 0.5, 0.0, 1.0)
                over.append(float(np.nansum(above)) * self.water[w] / len(side) / width)
            found.append(over)
        return np.array(found)

    @cached_property
    def gravity(self) -> np.ndarray:
        """What presses the water on the floor (m/s²): g cos φ, and the heave of the tank or ship."""
        series, run = self.recording.series, self.recording.preset.run
        roll, time = self.recording.frames["pose"][:][..., ROLL], series["time"]
        found = run.gravity * np.cos(roll)
        preset = self.recording.preset
        if (preset.motion.heave or preset.ship) and len(time) > 2:
            felt = np.gradient(series["pose_rate"][..., 1], time, axis=0)
            found = found + np.stack([np.interp(self.time, time, column) for column in felt.T], axis=1)
        return found


def _tops(place: np.ndarray, radius: np.ndarray, outline: np.ndarray, count: int) -> np.ndarray:
    """The tops (C,), m, of the highest grains at `place` (n, 2) m that touch others, in so many columns."""
    from scipy.spatial import cKDTree  # slow to import

    there = np.isfinite(place).all(axis=1)
    place, radius = place[there], radius[there]
    near = cKDTree(place).query_ball_point(place, 2.0 * TOUCHES * float(radius.mean()), return_length=True)
    lies = near > LEAST  # itself is among them
    low, width = float(outline[:, 0].min()), float(np.ptp(outline[:, 0]))
    column = np.clip((count * (place[lies, 0] - low) / width).astype(int), 0, count - 1)
    found = np.full(count, np.nan)
    np.fmax.at(found, column, place[lies, 1] + radius[lies])
    return found


_found: WeakKeyDictionary[Recording, WetBed] = WeakKeyDictionary()  # numbers and figures need the same


def wet_bed(recording: Recording) -> WetBed:
    """The wet bed of a recording."""
    if recording not in _found:
        _found[recording] = WetBed(recording)
    return _found[recording]


def is_wet(recording: Recording) -> bool:
    """Whether grains and as much water as at the start share the tank, and there are frames of them."""
    entered = any(inlet.room == FIRST for inlet in recording.preset.inflow.values())
    return recording.content.wet and not entered and len(recording.frames["time"]) > 1
