"""The force of the cargo on each face of a tank in space: floor, sides, end walls, cones.

Faces are the edges of the outline, numbered from that between its first two corners, and the end walls; each has the
edges and points round it. Means are over the steady part (`steady_part`; of a tilt and of what runs out over the whole
run). Error: standard error of the means of blocks.

push_on_FACE: of a flat face, the part of the force square to it, positive outwards, as a bulkhead is loaded.
weight_on_FACE: the part of the force along z, downwards: of a floor what lies on it, of a side what friction hangs on
it. Their sum is the weight of the cargo at rest; in a silo the sides bear most of it (Janssen 1895).
"""

import numpy as np

from lab.measures.steady import BLOCKS, Steady, averaged, steady_part
from lab.measures.value import Value
from lab.recording import Recording
from solvers.tank.solids.solid import ENDS, Prism

UP = 1  # of y, z, x
LEAST_SAMPLES = 2 * BLOCKS


def applies(recording: Recording) -> bool:
    """The faces of a tank in space have been pushed, for some time."""
    series = recording.series
    return "face_force" in series and bool(series["face_force"].any()) and len(series["time"]) > LEAST_SAMPLES


def measure(recording: Recording) -> dict[str, Value]:
    """push_on_FACE of flat faces and weight_on_FACE (mN)."""
    steady = steady_part(recording, recording.series["time"])
    rows = steady or Steady(slice(1, len(recording.series["time"])), BLOCKS)  # the first is the mean of nothing yet
    force, found = 1e3 * recording.series["face_force"][..., :3], {}
    for number, (name, outwards) in enumerate(normals(recording)):
        key, pushed = name.replace(" ", "_"), force[:, :, number]
        if not pushed.any():  # an open edge
            continue
        if outwards is not None:
            found[f"push_on_{key}"] = averaged(pushed @ outwards, rows, "mN", note=said(outwards))
        found[f"weight_on_{key}"] = averaged(-pushed[..., UP], rows, "mN", note=said(outwards))
    return found


def normals(recording: Recording) -> list[tuple[str, np.ndarray | None]]:
    """The faces by name with their normals (3,) outwards, None of those that are turned."""
    names = recording.names["face"]
    if not isinstance(recording.preset.tank.solid, Prism):
        return [(name, None) for name in names]
    ahead = np.roll(recording.outline, -1, axis=0) - recording.outline
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    found = [np.array([z, -y, 0.0]) for y, z in ahead]
    found += [np.array([0.0, 0.0, side]) for side in (-1.0, 1.0)] if ENDS[0] in names else []
    return list(zip(names, found, strict=True))


def said(outwards: np.ndarray | None) -> str:
    """Where a face is, for a reader; nothing of one that is turned."""
    if outwards is None:
        return ""
    axis = int(np.abs(outwards).argmax())
    side = int(outwards[axis] > 0.0)
    return (("towards −y", "towards y"), ("the floor", "above"), ("towards −x", "towards x"))[axis][side]
