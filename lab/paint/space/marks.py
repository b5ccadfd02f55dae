"""Marks that turn with their spheres."""

import numpy as np

from lab.paint.footage import Bed
from lab.paint.space.stance import turned_axes

SEED = 7  # of the axes at whose ends spheres have their marks


class TurningAxes:
    """The axes at whose ends the spheres of a bed have their marks.

    A recording has the turn of a sphere as the integral of its spin over time, ∫ ω dt (n, 3). Turns about several axes
    do not add up, so they are composed from frame to frame, as if each axis stood still between two frames: the error
    of a turn of φ whose axis swings by δ meanwhile is of the order φ δ.
    """

    def __init__(self, bed: Bed) -> None:
        self._bed, self._frame = bed, 0
        self._turned = not bed.empty and bed.angle(0).ndim == 2
        if self._turned:
            axes = np.random.default_rng(SEED).normal(size=(len(bed.radius), 3))
            self._start = self._axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)

    def at(self, row: float) -> np.ndarray | None:
        """Unit vectors (n, 3) in a frame or between two; None where turns are not recorded."""
        if not self._turned:
            return None
        whole = int(row)
        if whole < self._frame:
            self._frame, self._axes = 0, self._start
        for frame in range(self._frame, whole):
            self._axes = self._onwards(frame, frame + 1)
        self._frame = whole
        return self._onwards(whole, row) if row > whole else self._axes

    def _onwards(self, one: float, two: float) -> np.ndarray:
        """The axes, which are those in the frame `one`, at a later place of the film."""
        return turned_axes(self._axes, np.nan_to_num(self._bed.angle(two) - self._bed.angle(one)))
