"""A wet bed in the picture frames: how deep it is, how much water there is, where it stands, and its pressure.

A bed is as deep as one of even porosity, from the floor on, with the same centre of mass, in a rectangular tank H =
2 z_c: throws and holes of single grains hardly move it. Its porosity is ε = 1 − V_s/V(H).
Each particle of water stands for the area a = A/n of the water in the plane, and takes up a/ε with the grains in it:
Σ a/ε is what lies below the mean surface of the water, on the bed or in it.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lab.assembly.water import mixture_of
from lab.preset.sections.wet.states import depth_of_area
from lab.recording import Recording
from solvers.mixture.start import amount, bed_depth, porosity_map

BAND = 1.0  # of the spacing of the water in the bed: how far from half the bed's depth pressures are averaged
LEAST = 4  # particles of water in that band


@dataclass(frozen=True, eq=False)
class WetBed:
    """What the frames of a recording of wet cargo say of its bed and its water; arrays are (F, W) unless told."""

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
    def densities(self) -> np.ndarray:
        """Densities (W, n) of the grains, kg/m³."""
        preset = self.recording.preset
        kinds = [preset.material, *(other.material for other in preset.others.values())]
        return np.array([kind.density for kind in kinds])[self.recording.kind]

    @cached_property
    def solids(self) -> np.ndarray:
        """Areas (W, n) that the grains' volumes take in the plane, m²."""
        return 4.0 / 3.0 * np.pi * self.recording.radius**3 / self.recording.preset.thickness

    @cached_property
    def grains_mass(self) -> np.ndarray:
        """Mass (W,) of the grains in the plane, kg/m."""
        return (self.densities * self.solids).sum(axis=1)

    @cached_property
    def water(self) -> np.ndarray:
        """The area (W,) of the water in the plane, m²."""
        preset, outline = self.recording.preset, self.recording.outline
        mixture, position = mixture_of(preset), self.position(0)
        found = []
        for w, (places, solid, mass) in enumerate(zip(position, self.solids, self.grains_mass, strict=True)):
            if mixture.moisture is not None:
                found.append(mixture.moisture / (1.0 - mixture.moisture) * mass / preset.water.density)
                continue
            bed = porosity_map(places, solid, outline, preset.liquid)
            given = float(self.recording.volume[w].sum())
            found.append(amount(mixture, bed, outline, places, solid, given))
        return np.array(found)

    @cached_property
    def depth(self) -> np.ndarray:
        """Depth (m) of the bed by its centre of mass."""
        frames = range(len(self.time))
        return np.array([self._depths(self.position(frame)) for frame in frames])

    def _depths(self, position: np.ndarray) -> np.ndarray:
        outline = self.recording.outline
        return np.array([bed_depth(outline, *one) for one in zip(position, self.solids, strict=True)])

    @cached_property
    def porosity(self) -> np.ndarray:
        """Mean porosity of the bed."""
        outline, solid = self.recording.outline, self.solids.sum(axis=1)
        return np.array([[1.0 - s / depth_of_area.area(outline, d) for s, d in zip(solid, row, strict=True)]
                         for row in self.depth])  # fmt: skip
