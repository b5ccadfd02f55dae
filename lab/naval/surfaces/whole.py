"""From a mesh to a closed body: halves mirrored, flat holes closed if that is asked, triangles turned outward."""

import numpy as np

from lab.base.errors import LabError
from lab.naval.surfaces.mesh import Mesh, with_faces

MIDDLE = 1e-5  # of the largest extent: a half hull's corners this close to y = 0 lie in her middle plane
FLAT = 1e-4  # of the largest extent: by so much the rim of a flat hole may leave its plane


def mirrored(mesh: Mesh) -> Mesh:
    """The whole hull of one half, without the half's wall in the middle. Raises LabError for one with both sides."""
    slack = MIDDLE * float(mesh.extent.max())
    low, high = mesh.low[1], mesh.high[1]
    if min(abs(low), abs(high)) > slack:
        raise LabError(
            f"{mesh.name}: --mirror is for a half hull that ends at y = 0, and this one reaches from y {low:.7g} to "
            f"{high:.7g} m; leave it out, or move her with --origin."
        )
    corners, count = mesh.corners.copy(), len(mesh.corners)
    middle = np.abs(corners[:, 1]) <= slack
    corners[middle, 1] = 0.0
    faces = mesh.faces[~middle[mesh.faces].all(axis=1)]
    twin = np.where(middle, np.arange(count), np.arange(count) + count)
    corners = np.concatenate([corners, corners * [1.0, -1.0, 1.0]])
    return with_faces(corners, np.concatenate([faces, twin[faces][:, ::-1]]), mesh.name)


def closed(mesh: Mesh) -> Mesh:
    """The mesh with a flat lid on each of its holes. Raises LabError for a hole that is not flat."""
    corners, faces = mesh.corners, [mesh.faces]
    for rim in _rims(mesh):
        points = mesh.corners[rim]
        if not _flat(points, mesh):
            raise LabError(
                f"{mesh.name}: the hole with a rim of {len(rim)} edges, {_place(points)}, is not flat, so --close does "
                "not know its lid; close it where the hull was drawn."
            )
        middle = np.full(len(rim), len(corners))
        corners = np.concatenate([corners, points.mean(axis=0)[None]])
        faces.append(np.column_stack([rim, np.roll(rim, -1), middle]))
    return with_faces(corners, np.concatenate(faces), mesh.name)


def body(mesh: Mesh) -> Mesh:
    """The mesh as a single closed body whose triangles are turned outward.

    Raises LabError for one with holes, with edges of more than two triangles, or of several bodies.
    """
    mesh = _without_flaps(mesh)
    edges, times, owner = _edges(mesh)
    if (times > 2).any():
        _refuse_crowded(mesh, edges, times)
    if (times < 2).any():
        _refuse_open(mesh)
    pairs = np.argsort(owner, kind="stable").reshape(-1, 2)  # both uses of each edge, among the 3 n sides
    return _outward(mesh, pairs)


def _without_flaps(mesh: Mesh) -> Mesh:
    """The mesh without pairs of triangles that lie on each other and look away from each other: they hold nothing.

    Where a stem or a skeg has no thickness the two sides of a hull are such pairs.
    """
    order = np.argsort(mesh.faces, axis=1)
    way = np.linalg.det(np.eye(3)[order])  # 1 or −1: whether the corners rise in their order round the triangle
    _, same, times = np.unique(np.sort(mesh.faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    sums = np.bincount(same.ravel(), way)
    flaps = (times == 2) & (np.abs(sums) < 0.5)
    return with_faces(mesh.corners, mesh.faces[~flaps[same.ravel()]], mesh.name) if flaps.any() else mesh


def _sides(faces: np.ndarray) -> np.ndarray:
    """The sides (3 n, 2) of faces (n, 3) in their direction: first all first sides, then all second, all third."""
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def _edges(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges (e, 2), how many triangles each has (e,), and of each side of a triangle its edge (3 n,)."""
    low, high = np.sort(_sides(mesh.faces), axis=1).T
    count = len(mesh.corners)
    edges, owner, times = np.unique(low * count + high, return_inverse=True, return_counts=True)
    return np.column_stack(np.divmod(edges, count)), times, owner.ravel()


def _rims(mesh: Mesh) -> list[np.ndarray]:
    """The corners of each hole in their order round it. Raises LabError where rims touch each other."""
    edges, times, _ = _edges(mesh)
    beside: dict[int, list[int]] = {}
    for a, b in edges[times == 1].tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    for corner, others in beside.items():
        if len(others) != 2:
            raise LabError(f"{mesh.name}: two holes touch at {_point(mesh.corners[corner])}; close them one by one.")
    rims = []
    while beside:
        rim, here = [], next(iter(beside))
        while here is not None:
            rim.append(here)
            here = next((one for one in beside.pop(here) if one in beside), None)
        rims.append(np.array(rim))
    return rims


def _flat(points: np.ndarray, mesh: Mesh) -> bool:
    """Whether points (k, 3) lie in one plane."""
    away = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    return float(np.abs(away.U[:, 2] * away.S[2]).max()) <= FLAT * float(mesh.extent.max())


def _refuse_open(mesh: Mesh) -> None:
    """Raise LabError for the holes of a surface: how many, where the largest is, and what would close it."""
    rims = _rims(mesh)
    largest = max(rims, key=lambda rim: float(np.ptp(mesh.corners[rim], axis=0).sum()))
    points = mesh.corners[largest]
    slack = MIDDLE * float(mesh.extent.max())
    if min(abs(mesh.low[1]), abs(mesh.high[1])) <= slack and (np.abs(points[:, 1]) <= slack).sum() > 2:
        remedy = "if it is half a hull, give --mirror"
    elif all(_flat(mesh.corners[rim], mesh) for rim in rims):
        remedy = "if a flat deck or transom is missing there, give --close"
    else:
        remedy = "close it where the hull was drawn"
    holes = "a hole" if len(rims) == 1 else f"{len(rims)} holes, the largest"
    raise LabError(
        f"{mesh.name}: the surface has {holes} with a rim of {len(largest)} edges, {_place(points)}; {remedy}."
    )


def _refuse_crowded(mesh: Mesh, edges: np.ndarray, times: np.ndarray) -> None:
    """Raise LabError for edges of more than two triangles, which bodies that touch have, and faces that are double."""
    crowded = np.flatnonzero(times > 2)
    a, b = mesh.corners[edges[crowded[0]]]
    double = len(mesh.faces) - len(np.unique(np.sort(mesh.faces, axis=1), axis=0))
    if double:
        remedy = f"{double} triangles are in the file twice: delete them"
    else:
        remedy = "bodies touch there, or a wall stands inside: join them to one body, without inner walls"
    raise LabError(
        f"{mesh.name}: {times[crowded[0]]} triangles meet in the edge from {_point(a)} to {_point(b)}, where only two "
        f"can ({len(crowded)} such edge{'s' * (len(crowded) > 1)} in all); {remedy}."
    )


def _outward(mesh: Mesh, pairs: np.ndarray) -> Mesh:
    """The mesh turned outward; `pairs` (e, 2): the two sides of each edge. Raises LabError for several bodies."""
    from scipy.sparse import coo_array  # slow to import
    from scipy.sparse.csgraph import breadth_first_order, connected_components

    count, begins = len(mesh.faces), _sides(mesh.faces)[:, 0]
    one, other = (pairs % count).T
    against = begins[pairs[:, 0]] == begins[pairs[:, 1]]  # neighbours that run along their edge the same way
    links = coo_array((np.ones(len(one)), (one, other)), shape=(count, count)).tocsr()
    bodies, number = connected_components(links, directed=False)
    if bodies > 1:
        _refuse_bodies(mesh, number, bodies)
    faces = mesh.faces.copy()
    if against.any():
        turned = np.zeros(count, dtype=bool)
        differs = {(a, b) for a, b in zip(one[against].tolist(), other[against].tolist(), strict=True)}
        order, parent = breadth_first_order(links, 0, directed=False)
        for face in order[1:].tolist():
            before = int(parent[face])
            turned[face] = turned[before] ^ ((before, face) in differs or (face, before) in differs)
        faces[turned] = faces[turned][:, ::-1]
        if ((turned[one] ^ turned[other]) != against).any():
            raise LabError(f"{mesh.name}: the surface has no inside, as a Klein bottle has none; draw it anew.")
    found = Mesh(mesh.corners, faces, mesh.name)
    return found if found.volume > 0.0 else Mesh(mesh.corners, faces[:, ::-1], mesh.name)


def _refuse_bodies(mesh: Mesh, number: np.ndarray, bodies: int) -> None:
    """Raise LabError for several bodies, `number` (n,) of each face, and say where the second largest is."""
    sizes = [np.ptp(mesh.corners[np.unique(mesh.faces[number == k])], axis=0).sum() for k in range(bodies)]
    second = mesh.corners[np.unique(mesh.faces[number == np.argsort(sizes)[-2]])]
    raise LabError(
        f"{mesh.name}: holds {bodies} bodies that do not hang together, the second largest {_place(second)}; join it "
        "to the hull as one body, or leave it out."
    )


def _point(point: np.ndarray) -> str:
    return "({:.5g}, {:.5g}, {:.5g}) m".format(*(np.round(point, 6) + 0.0))


def _place(points: np.ndarray) -> str:
    """Where points (k, 3) lie."""
    low, high = (np.round(one, 6) + 0.0 for one in (points.min(axis=0), points.max(axis=0)))
    spans = [
        f"{name} {a:.5g}" if f"{a:.5g}" == f"{b:.5g}" else f"{name} {a:.5g} to {b:.5g}"
        for name, a, b in zip("xyz", low, high, strict=True)
    ]
    return f"{', '.join(spans)} m"
