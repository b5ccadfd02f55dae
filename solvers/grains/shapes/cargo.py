"""Named outlines of cargoes, from the table `cargo.toml`."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources

import numpy as np

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.spectrum import draw, spectrum
from solvers.machine.errors import Unavailable


@dataclass(frozen=True)
class Cargo:
    """A cargo's outline: descriptors relative to R0, and phases (rad), None if they are to be drawn at random.

    `diameter` (m) is a typical one of the disc of equal area.
    """

    name: str
    source: str
    diameter: float
    descriptors: tuple[float, ...]
    phases: tuple[float, ...] | None = None

    def outline(self, random: np.random.Generator, diameter: float | None = None) -> Contour:
        """An outline about its centroid with the area of a disc of `diameter` (m); unknown phases are drawn."""
        if self.phases is None:
            contour = draw(1.0, np.array(self.descriptors), random)
        else:
            contour = Contour(1.0, self.descriptors, self.phases)
        return contour.centred().with_diameter(diameter or self.diameter)


def cargo(name: str) -> Cargo:
    """The cargo of this name; raises Unavailable if there is none."""
    if name not in cargoes():
        raise Unavailable(f"there is no cargo {name}; there are {', '.join(cargoes())}.")
    return cargoes()[name]


@cache
def cargoes() -> dict[str, Cargo]:
    """All cargoes by name."""
    text = (resources.files("solvers.grains.shapes") / "cargo.toml").read_text("utf-8")
    return {name: _cargo(name, entry) for name, entry in tomllib.loads(text).items()}


def _cargo(name: str, entry: dict) -> Cargo:
    known = name, entry["source"], 1e-3 * entry["diameter_mm"]
    if "spectrum" in entry:
        return Cargo(*known, tuple(spectrum(**entry["spectrum"])))
    return Cargo(*known, tuple(entry["descriptors"]), tuple(np.radians(entry["phases_deg"])))
