"""Forces that are found again from recorded places: closed forms, those of the run itself, and what is painted."""

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import open_footage
from lab.paint.forces.chains import THICKEST, chains, paint_chains
from lab.paint.page.theme import THEMES
from lab.paint.painter import Camera
from lab.preset.find import load
from lab.recording.contacts.again import Again
from lab.recording.contacts.stress import pressures
from solvers.grains.pressing import NOBODY
from solvers.simulation import Simulation
from tests.oracles.synthetic import DIAMETER, frame, recorder, sample

RADIUS = DIAMETER / 2
YOUNG, POISSON = 3.2e9, 0.28  # of the preset's material
DEEP = np.array([4e-6, 2e-6, 1e-6])  # m: overlaps of the lowest grain and the floor, and of the grains above it


def column(lost: bool = False) -> np.ndarray:
    """Places (1, 4, 2) m of three grains one above the other with these overlaps, and of one by itself, or gone."""
    low = RADIUS - DEEP[0]
    second = low + 2.0 * RADIUS - DEEP[1]
    alone = (np.nan, np.nan) if lost else (0.03, 0.05)
    return np.array([[(0.0, low), (0.0, second), (0.0, second + 2.0 * RADIUS - DEEP[2]), alone]])


def hertz() -> np.ndarray:
    """F = (4/3) E* √R_eff ξ^(3/2) at these overlaps, between grain and wall and between two grains."""
    modulus = YOUNG / (2.0 * (1.0 - POISSON**2))
    size = np.sqrt([RADIUS, RADIUS / 2.0, RADIUS / 2.0])
    return 4.0 / 3.0 * modulus * size * DEEP**1.5


@pytest.mark.slow  # those of Hertz are found below
def test_forces_found_again_are_those_of_the_run():
    loaded = load("tilting/quick", {"run.repeats": 1, "grains.count": 40, "run.threads": 1})
    scene, position = build(loaded.resolved)
    made = Simulation(scene, position, threads=1)
    made.advance(round(0.12 / made.dt))
    snapshot = {name: values.astype(np.float32).astype(float) for name, values in made.snapshot().items()}
    told, radius, outline = made.pressing(), scene.grains.radius, scene.outline
    made.close()

    class Recorded:
        kind, open_edges, fixed, shapes = np.zeros(radius.shape), (), np.zeros((0, 3)), None

    Recorded.radius, Recorded.outline = radius, outline
    again = Again(loaded.resolved, Recorded)
    (found,) = again.read(0.12, snapshot["position"], snapshot["angle"])
    again.close()
    assert len(told.force) > 20
    told, found = (
        {tuple(sorted(pair)): force for pair, force in zip(one.grains.tolist(), np.hypot(*one.force.T), strict=True)}
        for one in (told, found)
    )
    largest = float(max(told.values()))
    for pair in told.keys() | found.keys():
        assert told.get(pair, 0.0) == pytest.approx(float(found.get(pair, 0.0)), abs=2e-3 * largest, rel=1e-2)


@pytest.fixture(scope="module")
def standing(tmp_path_factory):
    """Footage of the column, in its last frame without the grain by itself."""
    folder = tmp_path_factory.mktemp("standing")
    with recorder(folder, radius=np.full((1, 4), RADIUS)) as writer:
        for now, lost in ((0.0, False), (1.0, True)):
            writer.sample(sample(now))
            writer.frame(frame(now, position=column(lost)))
    with open_footage(folder) as footage:
        yield footage


@pytest.mark.parametrize("row", [0, 1])
def test_forces_and_pressures_of_a_column_are_those_of_hertz(standing, row):
    (bed,) = choose_beds(standing)
    found, place = bed.pressing(row), bed.position(row)
    force = dict(zip(map(tuple, np.sort(found.grains, axis=1)), np.hypot(*found.force.T), strict=True))
    asked = dict(zip([(NOBODY, 0), (0, 1), (1, 2)], hertz(), strict=True))
    assert force == pytest.approx(asked, rel=1e-3)  # places in 32 bits
    pressed = pressures(found, place, bed.radius)
    low, middle, top = hertz()
    of_column = np.array([low + middle, middle + top, top]) / (4.0 * np.pi * RADIUS**2)
    assert pressed == pytest.approx([*of_column, 0.0], rel=2e-3)  # arms are shorter by half an overlap


def test_forces_are_told_by_the_numbers_of_the_grains(standing):
    """Whatever the order in which the run holds them."""
    (bed,) = choose_beds(standing)
    bed.pressing(0)
    made = standing._again._simulation
    usual, numbering = made.pressing(), made.grains.numbering
    order, kept = np.array([2, 0, 3, 1]), numbering.number
    numbering.number = kept[:, order]
    assert made.pressing().grains[:, 0].tolist() == order[usual.grains[:, 0]].tolist()
    numbering.number = kept


def test_grains_that_lie_in_each_other_are_refused_in_one_sentence(standing):
    choose_beds(standing)[0].pressing(0)
    with pytest.raises(LabError, match=r"at 2 s: grains lie in each other\.$"):
        standing._again.read(2.0, np.full((1, 4, 2), 0.02), np.zeros((1, 4)))


def test_chains_are_as_thick_as_their_forces_and_reach_to_the_contacts(standing):
    """Painted over nothing, the line from a grain to its contact covers its length times its thickness."""
    (bed,) = choose_beds(standing)
    found, place = bed.pressing(0), bed.position(0)
    _, arms, thickness, typical = chains(found, place, typical=float(hertz().max()))
    assert typical == pytest.approx(hertz().max())
    order = np.argsort(np.hypot(*found.force.T))[::-1]
    assert thickness[: len(order)][order] == pytest.approx(hertz() / hertz().max(), rel=1e-3)
    assert np.abs(arms[:, 0]).max() < 1e-9 and np.hypot(*arms.T) == pytest.approx(RADIUS, rel=2e-3)
    scale = 40_000.0
    picture = np.zeros((900, 200, 3), dtype=np.uint8)
    camera = Camera(scale, (100.0, 600.0))
    paint_chains(picture, camera, bed, 0, typical, (255, 255, 255))
    painted = picture[..., 0] / 255.0
    width = {pair: painted[round(600.0 - scale * z)].sum() for pair, z in ((0, 0.5 * RADIUS), (1, 1.7 * RADIUS))}
    for k, share in enumerate(hertz()[:2] / hertz().max()):
        assert width[k] == pytest.approx(2.0 * THICKEST * RADIUS * scale * share, rel=0.03)


def test_a_film_of_forces_says_how_thick_a_line_is_and_pales_the_grains(standing):
    beds = choose_beds(standing)
    plain, forces = (
        Film(beds, choose_look(standing, width=640, height=360, frame="tank", colour="cargo", overlay=overlay))
        for overlay in ("none", "forces")
    )
    before, after = plain.picture(0), forces.picture(0)
    assert "note" in forces.written and "note" not in plain.written
    x, y = np.rint(forces.tank_camera(0, 0).pixels(np.array([[0.03, 0.05]]))[0]).astype(int)
    assert after[y, x].astype(int).sum() > before[y, x].astype(int).sum() + 60  # the grain without contacts
    red = THEMES["light"].force
    at = np.argwhere(np.abs(after.astype(int) - red).max(axis=2) < 12)
    box_of = forces.written["note"]
    assert (at[:, 1] < box_of[0]).any() and (np.abs(at[:, 0] - 0.5 * (box_of[1] + box_of[3])) < 4).any()


def test_the_pressure_in_grains_has_one_scale_for_the_film(standing):
    film = Film(choose_beds(standing), choose_look(standing, width=640, height=360, colour="pressure"))
    scale = film._bar
    assert scale.label == "pressure in grains (kPa)"
    (bed,) = choose_beds(standing)
    values = scale.values(bed, 0)
    assert (np.diff(values) < 0.0).all() and values[3] == 0.0 and values[0] <= 1.05 * scale.high
