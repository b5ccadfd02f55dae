"""The outlines of irregular grains in a recording: their Fourier descriptors, and the outline of each grain."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from solvers.grains.shapes.contour import Contour

GROUP = "shapes"
TABLES = ("radius", "descriptors", "phases", "kind", "which")


@dataclass(frozen=True)
class Outlines:
    """K outlines about their centroids, each with the area of a disc of radius 1.

    `kind` (K,): the class of each outline, an index into the preset's shapes; `which` (W, n): the index of each grain's
    outline, to be scaled by the grain's radius.
    """

    contours: tuple[Contour, ...]
    kind: np.ndarray
    which: np.ndarray


def outline_tables(outlines: Outlines) -> dict[str, np.ndarray]:
    """The arrays to store: `radius` (K,) R0, `descriptors` (K, N), `phases` (K, N) rad, `kind`, `which`.

    Outlines with fewer than N descriptors are padded with zeros.
    """
    most = max(len(contour.descriptors) for contour in outlines.contours)
    filled = {name: np.zeros((len(outlines.contours), most)) for name in ("descriptors", "phases")}
    for name, rows in filled.items():
        for row, contour in zip(rows, outlines.contours, strict=True):
            row[: len(contour.descriptors)] = getattr(contour, name)
    return {
        "radius": np.array([contour.radius for contour in outlines.contours]),
        **filled,
        "kind": np.asarray(outlines.kind, dtype="u2"),
        "which": np.asarray(outlines.which, dtype="i4"),
    }


def read_outlines(tables: Mapping[str, np.ndarray]) -> Outlines:
    """The outlines stored in tables made by `outline_tables`. Raises ValueError if they are invalid."""
    kind, which = tables["kind"], tables["which"]
    if len(kind) != len(tables["radius"]) or which.size == 0 or not 0 <= which.min() <= which.max() < len(kind):
        raise ValueError(f"{GROUP} is not what the lab writes there")
    rows = zip(tables["radius"], tables["descriptors"], tables["phases"], strict=True)
    return Outlines(tuple(Contour(float(r), d[: _needed(d)], p[: _needed(d)]) for r, d, p in rows), kind, which)


def _needed(descriptors: np.ndarray) -> int:
    """Number of descriptors without the zeros that pad the table."""
    return int(np.flatnonzero(descriptors)[-1]) + 1 if np.any(descriptors) else 0
