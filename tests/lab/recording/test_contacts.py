"""The contacts of a recording as data: closed forms of a column of grains, the table, and what is not recorded."""

import csv

import numpy as np
import pytest

from lab.base.errors import NotRecorded
from lab.measures.contact_number import contact_number
from lab.recording import open_recording
from lab.recording.contacts.stress import pressures, stresses
from solvers.grains.pressing import NOBODY, Pressing
from tests.lab.paint.test_forces import DEEP, RADIUS, column, hertz
from tests.oracles.recorded_water import record_pool
from tests.oracles.synthetic import frame, recorder, sample

LOST = 0.35e-6  # m, of a place of some cm in 32 bits: half its last bit at each end


@pytest.fixture(scope="module")
def standing(tmp_path_factory):
    """The recording of three grains one above the other, and of one by itself, which is gone in the last frame."""
    folder = tmp_path_factory.mktemp("standing")
    with recorder(folder, radius=np.full((1, 4), RADIUS)) as writer:
        for now, lost in ((0.0, False), (1.0, True)):
            writer.sample(sample(now, contacts=[3.0], spilled=[1.0 if lost else 0.0]))
            writer.frame(frame(now, position=column(lost)))
        writer.close("complete")
    with open_recording(folder) as recording:
        yield recording


def test_a_column_has_the_overlaps_and_forces_of_hertz_along_the_vertical(standing):
    found = standing.contacts(0)
    order = np.argsort(found.place[:, 1])
    assert [sorted(pair) for pair in found.grains[order].tolist()] == [[-1, 0], [0, 1], [1, 2]]
    assert found.kind[order].tolist() == ["wall", "grain", "grain"]
    assert found.overlap[order] == pytest.approx(DEEP, abs=LOST)
    assert found.normal_force[order] == pytest.approx(hertz(), rel=1.5 * LOST / DEEP[2])
    up = np.where(found.grains[order, 0] >= found.grains[order, 1], 1.0, -1.0)
    assert found.normal[order] == pytest.approx(np.column_stack([0.0 * up, up]), abs=1e-6)
    assert (found.time, found.world, len(found)) == (0.0, 0, 3)


def test_the_stress_of_a_column_is_vertical_and_the_coordination_is_that_of_the_measure(standing):
    """σ_zz = (R f_below + R f_above) / V; a grain by itself has none. Z = 2 contacts / grains."""
    found = standing.contacts(0)
    low, middle, top = found.normal_force[np.argsort(found.place[:, 1])]
    upright = np.array([low + middle, middle + top, top, 0.0]) * RADIUS / (4.0 / 3.0 * np.pi * RADIUS**3)
    assert found.stress[:, 1, 1] == pytest.approx(upright, rel=2.0 * DEEP[0] / RADIUS)
    assert np.abs(found.stress[:, 0]).max() < 1e-5 * upright.max()
    assert found.pressure == pytest.approx(found.stress[:, 1, 1] / 3.0, rel=1e-5)
    assert found.mean_stress[1, 1] == pytest.approx(upright.mean(), rel=2.0 * DEEP[0] / RADIUS)
    assert found.number.tolist() == [2, 2, 1, 0]
    for row, at in ((0, 2 * 3 / 4), (-1, 2 * 3 / 3)):  # one grain has left the tank
        assert standing.contacts(row).coordination == at == contact_number(standing)[row, 0]


def test_the_stress_of_slanted_forces_is_that_of_love_and_weber():
    """Two grains that press each other at 30 deg: σ = (f a / V) n ⊗ n in both, a the arm to the contact."""
    n, arm, force = np.array([np.cos(np.pi / 6), np.sin(np.pi / 6)]), 0.9 * RADIUS, 2.0
    place = np.array([arm * n, -arm * n])
    pressing = Pressing(np.array([[0, 1]]), np.zeros((1, 2)), force * n[None])
    asked = force * arm / (4.0 / 3.0 * np.pi * RADIUS**3) * np.outer(n, n)
    found = stresses(pressing, place, np.full(2, RADIUS))
    assert found == pytest.approx(np.array([asked, asked]), rel=1e-12)
    assert pressures(pressing, place, np.full(2, RADIUS)) == pytest.approx([np.trace(asked) / 3.0] * 2, rel=1e-12)
    alone = Pressing(np.array([[0, NOBODY]]), np.zeros((1, 2)), force * n[None])
    assert stresses(alone, place, np.full(2, RADIUS)) == pytest.approx(np.array([asked, 0.0 * asked]), rel=1e-12)


def test_the_table_is_written_and_labelled(standing, tmp_path):
    found = standing.contacts(0)
    lines = found.write(tmp_path / "contacts.csv").read_text().splitlines()
    assert lines[0] == "# bed 0, 0 s; place m, overlap m, normal_force N"
    rows = list(csv.DictReader(lines[1:]))
    assert [row["kind"] for row in rows] == found.kind.tolist() and list(rows[0]) == list(found.table())
    assert [float(row["normal_force"]) for row in rows] == pytest.approx(found.normal_force, rel=1e-6)
    data = found.labelled()
    assert data["normal_force"].attrs["units"] == "N" and data["normal_force"].dims == ("contact",)
    assert data["normal"].sel(axis="z").values == pytest.approx(found.normal[:, 1])
    assert data["stress"].sel(axis="z", arm="z").values == pytest.approx(found.stress[:, 1, 1])
    assert float(data["coordination"]) == found.coordination and float(data["time"]) == 0.0


def test_what_is_not_recorded_says_so_and_what_finds_it(standing):
    with pytest.raises(NotRecorded, match="tangential_force is not recorded: it depends on how each contact"):
        _ = standing.contacts(0).tangential_force
    with pytest.raises(AttributeError, match=r"no forces, but grains, kind, place"):
        _ = standing.contacts(0).forces
    with pytest.raises(
        NotRecorded, match=r"no \"normal_force\" in its frames.*`recording\.contacts\(frame\)` finds it"
    ):
        standing.frames["normal_force"]
    with pytest.raises(NotRecorded, match=r"no bed 1; its beds are 0 to 0"):
        standing.contacts(0, world=1)
    with pytest.raises(NotRecorded, match=r"has no \[7\]"):
        standing.contacts(7)


def test_a_pool_has_no_contacts(tmp_path):
    record_pool(tmp_path, [0.0], {})
    with open_recording(tmp_path) as recording, pytest.raises(NotRecorded, match=r"a preset with \[grains\] has some"):
        recording.contacts()
