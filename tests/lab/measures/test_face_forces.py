"""Forces on the faces of a tank in space: which face is where, and that a bed at rest bears on them as it must."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.measures.face_forces import normals, said
from solvers.grains.bed.filling import start_positions
from solvers.tank.solids.solid import Prism, Turned
from tests.oracles.scenes import box, material, simulation

HOPPER = np.array([[-0.1, 0.0], [0.1, 0.0], [0.3, 0.2], [-0.3, 0.2]])
RADIUS, COUNT, WIDE, ALONG, G = 3e-3, 300, 0.06, 0.05, 9.81
FLOOR, STARBOARD, LID, PORT, END_1, END_2 = range(6)


def seen(outline, solid):
    names = {"face": solid.faces(outline)}
    preset = SimpleNamespace(tank=SimpleNamespace(solid=solid))
    return SimpleNamespace(names=names, outline=outline, preset=preset)


def test_faces_look_outwards():
    found = normals(seen(HOPPER, Prism(0.4)))
    assert [name for name, _ in found] == ["edge 1", "edge 2", "edge 3", "edge 4", "end 1", "end 2"]
    diagonal = np.sqrt(0.5)
    expected = [[0, -1, 0], [diagonal, -diagonal, 0], [0, 1, 0], [-diagonal, -diagonal, 0], [0, 0, -1], [0, 0, 1]]
    np.testing.assert_allclose([outwards for _, outwards in found], expected, atol=1e-15)
    assert [said(outwards) for _, outwards in found[::2]] == ["the floor", "above", "towards −x"]


def test_a_slice_has_no_ends_and_what_is_turned_no_normals():
    assert len(normals(seen(HOPPER, Prism(0.4, periodic=True)))) == 4
    assert all(outwards is None for _, outwards in normals(seen(HOPPER, Turned())))


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_a_bed_at_rest_bears_on_each_face_as_it_must(friction):
    """Together the faces bear the weight, opposite ones are pushed alike, and without friction the floor bears all."""
    outline, solid = box(WIDE, 0.1), Prism(ALONG)
    radius = np.full(COUNT, RADIUS)
    place = start_positions(radius, outline, np.random.default_rng(1), solid=solid)
    grain = material(friction=friction, restitution=0.3)
    law = "mindlin"
    run = simulation(
        place[None],
        RADIUS,
        outline,
        grain,
        solid=solid,
        tangential=law,
        stiffness_scale=1e-3,
        start_speed=0.5,
        gravity=G,
    )
    run.settle(1e-10, 5.0)
    run.observe()
    run.advance(2000)
    rows = run.observe()
    run.arrays.release()
    force, weight = rows["face_force"][0], COUNT * grain.density * 4.0 / 3.0 * np.pi * RADIUS**3 * G
    np.testing.assert_allclose(force.sum(axis=0), rows["wall_force"][0], atol=1e-12)
    np.testing.assert_allclose(force[:, 1].sum(), -weight, rtol=1e-3)
    for one, other, axis in ((PORT, STARBOARD, 0), (END_1, END_2, 2)):
        assert force[one, axis] < -0.05 * weight
        horizontal = force[one, axis] + force[other, axis]
        assert abs(horizontal) < (1e-3 if friction == 0.0 else 0.1) * weight  # the floor's friction may hold a part
    on_floor = -force[FLOOR, 1] / weight
    assert on_floor == pytest.approx(1.0, abs=1e-3) if friction == 0.0 else 0.3 < on_floor < 0.98
    assert not force[LID].any()
