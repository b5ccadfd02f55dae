"""Holds as meshes of triangles, and STL files of them."""

from pathlib import Path

import numpy as np

from solvers.tank.solids.mesh import Mesh

BOX = np.array([[-0.1, 0.0], [0.1, 0.0], [0.1, 0.2], [-0.1, 0.2]])
L_SHAPED = np.array([[-0.1, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1], [0.0, 0.2], [-0.1, 0.2]])
# Levels z (m) of a hold, with half its breadth and half its length there: a tank top, hopper sides, upright sides
HOPPER = ((0.0, 0.08, 0.14), (0.06, 0.14, 0.2), (0.2, 0.14, 0.2))


def drawn_out(outline: np.ndarray, along: float, open_top: bool = False, turned: float = 0.0) -> Mesh:
    """A prism (m, 2) m of which the edge on top may be left out, turned (rad) about the axis z."""
    count, half = len(outline), 0.5 * along
    corners = np.concatenate([np.column_stack([outline, np.full(count, x)]) for x in (-half, half)])
    top = outline[:, 1].max()
    triangles = []
    for k in range(count):
        after = (k + 1) % count
        if not (open_top and outline[k, 1] == top and outline[after, 1] == top):
            triangles += [(k, k + count, after), (after, k + count, after + count)]
    fan = [(0, k, k + 1) for k in range(1, count - 1)] if count == 4 else [(0, 1, 2), (0, 2, 3), (0, 3, 5), (3, 4, 5)]
    triangles += fan + [(c + count, b + count, a + count) for a, b, c in fan]
    cos, sin = np.cos(turned), np.sin(turned)
    corners = np.column_stack(
        [cos * corners[:, 0] - sin * corners[:, 2], corners[:, 1], sin * corners[:, 0] + cos * corners[:, 2]]
    )
    return inward(corners, np.array(triangles))


def hold(levels: tuple, open_top: bool = False) -> Mesh:
    """A hold of four sides through rectangles at levels, with a floor and, unless it is open, a lid."""
    rings = [[(-b, z, -h), (b, z, -h), (b, z, h), (-b, z, h)] for z, b, h in levels]
    corners, triangles = np.array(rings).reshape(-1, 3), [(0, 1, 2), (0, 2, 3)]
    for ring in range(len(levels) - 1):
        for k in range(4):
            a, b = 4 * ring + k, 4 * ring + (k + 1) % 4
            triangles += [(a, a + 4, b), (b, a + 4, b + 4)]
    if not open_top:
        last = 4 * (len(levels) - 1)
        triangles += [(last, last + 2, last + 1), (last, last + 3, last + 2)]
    return inward(corners, np.array(triangles))


def inward(corners: np.ndarray, triangles: np.ndarray) -> Mesh:
    """The mesh with its triangles turned inward; they are turned all one way as given."""
    mesh = Mesh(corners, triangles)
    return mesh if mesh.volume(BOX, 1.0) > 0.0 else Mesh(corners, triangles[:, ::-1])


def write_stl(path: Path, mesh: Mesh, scale: float = 1e3, outward: bool = True) -> Path:
    """A binary STL file in x, y, z with m · scale."""
    points = scale * mesh.points[..., [2, 0, 1]]
    points = points[:, ::-1] if outward else points
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("mark", "<u2")])
    rows = np.zeros(len(points), kind)
    rows["corners"] = points
    path.write_bytes(b"\0" * 80 + np.uint32(len(points)).tobytes() + rows.tobytes())
    return path


def fine_box(low: np.ndarray, high: np.ndarray, count: int, random: np.random.Generator) -> Mesh:
    """A closed box whose six walls are of count × count squares of two triangles, at random places within each wall."""
    grid = np.stack(np.meshgrid(*[np.arange(count + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    on = (grid == 0) | (grid == count)
    shaken = grid + np.where(on.sum(axis=1, keepdims=True) == 1, random.uniform(-0.3, 0.3, grid.shape), 0.0) * ~on
    number = np.ravel_multi_index(grid.T, (count + 1,) * 3).reshape((count + 1,) * 3)
    triangles = []
    for axis in range(3):
        for end in (0, count):
            wall = np.moveaxis(number, axis, 0)[end]
            a, b, c, d = (part.ravel() for part in (wall[:-1, :-1], wall[1:, :-1], wall[1:, 1:], wall[:-1, 1:]))
            both = [np.column_stack([a, b, c]), np.column_stack([a, c, d])]
            triangles += both if (end == 0) == (axis != 1) else [one[:, ::-1] for one in both]
    used, triangles = np.unique(np.concatenate(triangles), return_inverse=True)
    return inward(low + (high - low) / count * shaken[used], triangles.reshape(-1, 3))
