"""Cargo in its own colours: which cargo a grain is, and how its grains look.

A grain is what `video.cargo` says, else the cargo that gave its outline, else the one of its material's density.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

import numpy as np

from lab.paint.raster.grains import Finish

if TYPE_CHECKING:
    from lab.preset.schema import Preset

UNKNOWN = "stone"  # what a material is taken for whose density is none of the list's


@dataclass(frozen=True)
class Look:
    """The look of one cargo; colours in 0..255, density: lowest and highest, kg/m³."""

    colour: tuple[int, int, int]
    vary: float
    mark: tuple[int, int, int]
    finish: Finish
    density: tuple[float, float] | None = None


@cache
def looks() -> Mapping[str, Look]:
    """The looks of all cargoes by name."""
    table = tomllib.loads(files("lab.paint.cargo").joinpath("looks.toml").read_text(encoding="utf-8"))
    return {
        name: Look(
            tuple(said["colour"]),
            said["vary"],
            tuple(said["mark"]),
            Finish(**said["finish"]),
            tuple(said["density"]) if "density" in said else None,
        )
        for name, said in table.items()
    }


def of_density(density: float) -> str:
    """The cargo that a material of this density (kg/m³) is taken for."""
    for name, look in looks().items():
        if look.density and look.density[0] <= density <= look.density[1]:
            return name
    return UNKNOWN


@dataclass(frozen=True)
class Stowage:
    """The cargoes of a preset: the one that it names, those of its shapes (None: by kind), and those of its kinds."""

    named: str | None = None
    by_shape: tuple[str | None, ...] = ()
    by_kind: tuple[str, ...] = (UNKNOWN,)

    @classmethod
    def of(cls, preset: Preset) -> Stowage:
        """The cargoes of a preset."""
        if preset.material is None:
            return cls(preset.video.cargo)
        kinds = (of_density(preset.material.density), *(of_density(kind.density) for kind in preset.kinds.values()))
        shapes = tuple(shape.cargo for shape in preset.shapes.values())
        return cls(preset.video.cargo, tuple(name if name in looks() else None for name in shapes), kinds)

    def names(self, kind: np.ndarray, shape: np.ndarray | None) -> np.ndarray:
        """The cargo (n,) of grains of these kinds (n,) and classes of outlines (n,), None for discs."""
        if self.named:
            return np.full(len(kind), self.named)
        by_kind = np.asarray(self.by_kind)[np.minimum(kind, len(self.by_kind) - 1)]
        if shape is None or not any(self.by_shape):
            return by_kind
        by_shape = np.array([name or "" for name in self.by_shape])[shape]
        return np.where(by_shape == "", by_kind, by_shape)
