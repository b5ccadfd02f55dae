"""Openings of ships in presets: what is refused, and what the solver is told."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.measures import inflow
from lab.preset.find import load
from lab.recording.layout import names_of, tables_of
from lab.report import water

OPEN = "ship/barge-open-hatch-quick"
DRY = {"grains": False, "material": False}

REFUSED = {
    "inflow.hatch.points: an opening has two ends": {"inflow.hatch.points": [["0 mm", "140 mm"]]},
    "inflow.hatch.points: its two ends are the same": {"inflow.hatch.points": [["0 mm", "140 mm"], ["0 mm", "140 mm"]]},
    r"inflow.hatch.points: \[170 mm, 100 mm\] is under water at rest": {
        "inflow.hatch.points": [["170 mm", "100 mm"], ["170 mm", "130 mm"]]
    },
    r"inflow.hatch.points: \[-110 mm, 150 mm\] is outside of the hull": {
        "inflow.hatch.points": [["-110 mm", "150 mm"], ["0 mm", "140 mm"]]
    },
    'inflow.hatch.room: there is no tank "hold"; take tank or room': {"inflow.hatch.room": "hold"},
    "inflow.hatch.length: it is longer than the room, 500 mm": {"inflow.hatch.length": "0.6 m"},
    'inflow: "frozen" water keeps its volume; take water.model = "sph", particles, or "level"': {
        "water.model": "frozen"
    },
    'gauges: water.model = "level" knows none': {
        "water.model": "level",
        "gauges": {"side": {"kind": "level", "y": "0 mm"}},
    },
    'parts.wall: water.model = "level" goes round no parts': {
        "water.model": "level",
        "parts.wall": {"points": [["0 mm", "20 mm"], ["0 mm", "60 mm"]], "tank": "room"},
    },
    'ship.coupling: "staggered" is not stable with level water that enters': {
        "water.model": "level",
        "ship.coupling": "staggered",
    },
    'water.swing_damping: has no meaning for water.model = "level"': {
        "water.model": "level",
        "water.swing_damping": 0.1,
    },
    'water.added_mass: has no meaning for water.model = "level"': {
        "water.model": "level",
        "water.added_mass": "layer",
    },
    "inflow: goes with water, and there is none": {"water": False},
    "inflow.hatch.discharge": {"inflow.hatch.discharge": 0.0},
}


@pytest.mark.parametrize("sentence", REFUSED)
def test_what_cannot_be_is_refused(sentence):
    with pytest.raises(LabError, match=sentence):
        load(OPEN, REFUSED[sentence])


def test_a_room_has_a_place_for_each_particle_that_fills_it():
    """It is empty at first, so that she floats as without it; so many squares of a spacing wait as it has area for."""
    preset = load(OPEN, DRY).resolved
    scene, _ = build(preset)
    fluid, room = scene.fluid, np.array(preset.tanks["room"].corners)
    area, spacing = float(np.prod(np.ptp(room, axis=0))), fluid.water.spacing
    assert fluid.waiting == (0, int(area / spacing**2)) and not fluid.present.any()
    assert scene.vessels[0].ship.body.mass == pytest.approx(1000.0 * 0.34 * 0.11)
    assert scene.vessels[0].reserve == pytest.approx(1000.0 * 0.34 * 0.03)
    assert scene.fluid.inlets[0].share == 1.0 and scene.fluid.inlets[0].room == 1


def test_some_water_may_be_in_the_room():
    preset = load(OPEN, {**DRY, "tanks.room.depth": "20 mm"}).resolved
    fluid = build(preset)[0].fluid
    assert pytest.approx(float(fluid.particles["volume"][0][fluid.present].sum()), rel=1e-9) == 0.02 * 0.32
    whole = float(fluid.particles["volume"][0].sum())
    assert whole == pytest.approx(0.115 * 0.32, abs=fluid.water.spacing**2)


def test_level_water_has_a_mark_for_each_place_and_the_volume_of_what_is_there():
    """Marks are for pictures; what is in the room at first is exact, and a hold of grains has nothing to do with it."""
    scene, _ = build(load(OPEN, {"water.model": "level", "tanks.room.depth": "20 mm", "run.repeats": 2}).resolved)
    particles = build(load(OPEN, {"tanks.room.depth": "20 mm", "run.repeats": 2}).resolved)[0].fluid
    assert scene.fluid.areas(2) == pytest.approx(np.tile([0.0, 0.02 * 0.32], (2, 1)), rel=1e-9)
    assert scene.fluid.waiting == particles.waiting and scene.fluid.water.density == 1000.0
    assert scene.fluid.moved == 0 and not scene.is_long


def test_reports_say_that_level_water_has_no_particles_and_an_exact_volume():
    """No speed of sound, no layers, no models of particles; what has entered is known without an error."""
    for model, error in (("level", None), ("sph", 1e3 * 0.5 * 0.005**2)):
        preset = load(OPEN, {"water.model": model}).resolved
        scene, names = build(preset)[0], {"inlet": ["hatch"]}
        told = dict(water.described(preset, scene)) | dict(water.models(scene))
        assert ("level at any heel" in told["water"]) == (model == "level")
        assert ("sound" in told, "kernel" in told, bool(water.accuracy(preset))) == (model == "sph",) * 3
        recording = SimpleNamespace(series={"inflow_volume": np.full((3, 1, 1), 0.0102)}, preset=preset, names=names)
        found = inflow.measure(recording)["entered_hatch"]
        assert found.value == pytest.approx(10.2) and found.uncertainty == pytest.approx(error)


def test_its_spacing_does_not_change_the_step_of_level_water():
    """Marks are for pictures: beside grains, and without, the step is that of the grains, or of the ship."""
    for cargo in ({}, DRY):
        sizes = ("5 mm", "2.5 mm")
        steps = [
            build(load(OPEN, {"water.model": "level", "water.spacing": one, **cargo}).resolved)[0] for one in sizes
        ]
        assert steps[0].step == steps[1].step and steps[0].fluid.substeps == 1


def test_its_quantities_are_recorded():
    preset = load(OPEN).resolved
    series = {quantity.name: quantity.per for quantity in tables_of(preset, False)["series"]}
    assert series["sunk"] == "world" and series["inflow_volume"] == series["inflow_rate"] == "inlet"
    assert names_of(preset)["inlet"] == ["hatch"]
    assert "sunk" not in {quantity.name for quantity in tables_of(load("ship/barge-3dof").resolved, False)["series"]}
