"""The colours, marks and finish of the grains of beds in their cargoes' looks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from lab.paint.cargo.looks import looks

if TYPE_CHECKING:
    from lab.paint.footage import Bed

SHIFT = 0.10  # how much darker every other band of the starting layers is, so that a shift shows
BANDS = 5  # bands over the depth of a bed


def aboard_of(bed: Bed) -> np.ndarray:
    """The cargo (n,) of each grain of a bed."""
    return bed.footage.cargo.names(bed.footage.kind[bed.world], bed.shape if bed.footage.shapes else None)


@dataclass
class CargoColours:
    """The colours, marks and finish of the grains of beds; every other band of the starting layers is a little darker.

    names: of the cargoes aboard.
    """

    beds: Sequence[Bed]
    names: list[str] = field(init=False)

    def __post_init__(self) -> None:
        self._kept: dict[Bed, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        found = [name for bed in self.beds for name in np.unique(aboard_of(bed))]
        self.names = list(dict.fromkeys(found))

    def colours(self, bed: Bed, frame: int) -> np.ndarray:
        """Colours (n, 3) of the grains in 0..255."""
        return self._of(bed)[0]

    def marks(self, bed: Bed) -> np.ndarray:
        """Colours (n, 3) of the marks of the grains."""
        return self._of(bed)[1]

    def finish(self, bed: Bed) -> np.ndarray:
        """The finish (n, 8) of the grains: rows of `Finish`."""
        return self._of(bed)[2]

    def _of(self, bed: Bed) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        if bed not in self._kept:
            aboard = aboard_of(bed)
            shade = np.random.default_rng(0).uniform(-1.0, 1.0, len(aboard)) * self._each(aboard, "vary")[:, 0]
            shade -= SHIFT * _bands(bed)
            colour = np.clip((1.0 + shade[:, None]) * self._each(aboard, "colour"), 0.0, 255.0)
            finish = (
                np.concatenate([looks()[name].finish.rows(1) for name in aboard]) if len(aboard) else np.zeros((0, 8))
            )
            self._kept[bed] = colour, self._each(aboard, "mark"), finish
        return self._kept[bed]

    @staticmethod
    def _each(aboard: np.ndarray, what: str) -> np.ndarray:
        """What the look of each grain (n,) has of this, as rows."""
        used, which = np.unique(aboard, return_inverse=True)
        return np.array([np.atleast_1d(getattr(looks()[name], what)) for name in used], dtype=float)[which]


def _bands(bed: Bed) -> np.ndarray:
    """0 or 1 (n,) in turn by height at the start, at least two diameters each."""
    height = bed.position(0)[:, 1]
    low, high = np.nanmin(height, initial=np.inf), np.nanmax(height, initial=-np.inf)
    band = max((high - low) / BANDS, 2.0 * bed.diameter)
    return np.nan_to_num(np.floor((height - low) / band) % 2)
