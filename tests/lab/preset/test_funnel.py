"""A funnel by its angle and outlet: its walls, what does not go, and the bed that plates typed by hand would have."""

import numpy as np
import pytest

import lab
from lab.base.errors import LabError
from lab.preset.find import load
from lab.preset.outline import area
from lab.preset.recorded import resolved_from, to_table
from lab.report.cargo.grains import cautions
from lab.report.explain import _funnel

# Of 45 deg, so that its corners are whole millimetres: outlet 20, at 40, up to 100
SMALL = {
    "tank": {"width": "160 mm", "height": "120 mm", "roughness": False},
    "tank.funnel": {"angle": "45 deg", "outlet": "20 mm", "tip": "40 mm", "top": "100 mm"},
    "grains": {"diameter": "4 mm", "count": 60},
    "run": {"repeats": 2, "duration": "0.4 s", "accuracy": "draft", "threads": 1},
    "record": {"picture_rate": "50 Hz"},
}
GATE = {"move": ["0 mm", "-60 mm"], "start": "0.2 s", "speed": "10 m/s", "acceleration": "50 m/s^2"}
PLATES = {
    "left": {"points": [["-70 mm", "100 mm"], ["-10 mm", "40 mm"]]},
    "right": {"points": [["70 mm", "100 mm"], ["10 mm", "40 mm"]]},
    "gate": {"points": [["-10 mm", "40 mm"], ["10 mm", "40 mm"]], **GATE},
}
REGION = [["-10 mm", "40 mm"], ["10 mm", "40 mm"], ["70 mm", "100 mm"], ["-70 mm", "100 mm"]]


def small(**changes):
    return load("funnel/discharge", SMALL | changes).resolved


@pytest.mark.parametrize(("angle", "width"), [(30.0, None), (45.0, 0.1), (60.0, 0.12), (20.0, 0.021)])
def test_its_room_is_a_trapezium_below_a_rectangle_and_turned_a_cone_below_a_cylinder(angle, width):
    outlet, tip, top = 0.02, 0.04, 0.1
    slope = np.tan(np.radians(angle))
    high = 0.5 * (width - outlet) / slope if width else top - tip
    half = 0.5 * width if width else 0.5 * outlet + high * slope
    given = {"tank.funnel.angle": f"{angle} deg", "tank.width": "300 mm"}
    given |= {"tank.funnel.width": f"{width} m"} if width else {}
    preset = small(**given)
    barrel = top - tip - high
    assert area(preset.grains.region) == pytest.approx(high * (0.5 * outlet + half) + 2.0 * half * barrel, rel=1e-9)
    turned = small(**given, **{"tank.turned": True})
    cone = np.pi / 3.0 * high * (half**2 + half * 0.5 * outlet + 0.25 * outlet**2)
    room = turned.tank.solid.within(np.array(turned.grains.region))
    assert room == pytest.approx(cone + np.pi * half**2 * barrel, rel=1e-6)


def test_its_parts_and_grains_are_those_of_the_plates_that_it_stands_for():
    made, typed = small(), small(**{"tank.funnel": False, "parts": PLATES, "grains.region": REGION})
    assert list(made.parts) == ["funnel-port", "funnel-starboard", "funnel-gate"]
    for one, other in zip(made.parts.values(), typed.parts.values(), strict=True):
        assert one.points == other.points
    assert made.grains == typed.grains and made.parts["funnel-gate"].move == (0.0, pytest.approx(-0.06))
    assert resolved_from(to_table(made)) == made


def test_its_outlet_moves_lips_gate_and_grains():
    wide = small(**{"tank.funnel.outlet": "30 mm", "tank.funnel.opens": "0.1 s"})
    gate = wide.parts["funnel-gate"]
    assert gate.points == ((-0.015, 0.04), (0.015, 0.04)) and gate.start == 0.1
    assert wide.parts["funnel-port"].points[-1] == gate.points[0] == wide.grains.region[0]


def test_a_region_of_ones_own_stays():
    assert small(**{"grains.region": REGION[:3], "grains.count": 9}).grains.region == (
        (-0.01, 0.04),
        (0.01, 0.04),
        (0.07, 0.1),
    )


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"angle": "90 deg"}, "tank.funnel.angle: must be less than 90 deg (got 90 deg)"),
        ({"angle": "0 deg"}, "tank.funnel.angle: must be greater than 0"),
        ({"angle": False}, "tank.funnel.angle: "),
        ({"outlet": "0 mm"}, "tank.funnel.outlet: must be greater than 0"),
        ({"width": "15 mm"}, "tank.funnel.outlet: must be less than its width, 15 mm (got 20 mm)"),
        ({"outlet": "120 mm"}, "tank.funnel: stands out of the tank at"),
        ({"angle": "60 deg"}, "tank.funnel: stands out of the tank at"),
        ({"top": "130 mm"}, "tank.funnel: stands out of the tank at"),
        ({"tip": "0 mm"}, "tank.funnel.tip: must be higher than the tank's floor, 0 m (got 0 m)"),
        ({"tip": "100 mm"}, "tank.funnel.tip: must be lower than its upper end, 100 mm (got 100 mm)"),
        ({"angle": "20 deg", "width": "100 mm"}, "tank.funnel.width: its walls reach it 149.9 mm high"),
    ],
)
def test_a_funnel_that_is_none_is_refused_in_a_sentence(changes, said):
    with pytest.raises(LabError) as refusal:
        small(**{f"tank.funnel.{key}": value for key, value in changes.items()})
    assert str(refusal.value).startswith(said) and "\n" not in str(refusal.value)


def test_one_that_does_not_go_with_the_tank_is_refused():
    with pytest.raises(LabError, match=r"^parts\.funnel-gate: tank\.funnel has a part of this name"):
        small(**{"parts.funnel-gate": PLATES["gate"]})
    with pytest.raises(LabError, match=r"^tank\.funnel: no funnel stands in a tank that is a mesh, or turned about x"):
        load("space/drum-quick", {"tank.funnel": SMALL["tank.funnel"]})


@pytest.mark.parametrize(("diameter", "said"), [("4 mm", None), ("8 mm", "it may arch"), ("24 mm", "cannot pass")])
def test_a_narrow_outlet_is_told(diameter, said):
    preset = small(**{"grains.diameter": diameter, "grains.count": 4, "grains.spread": 0.0})
    lines = dict(_funnel(preset))
    assert "walls 45 deg from the vertical over an outlet of 20 mm, 40 mm to 100 mm high" in lines["funnel"]
    assert said in lines["warning"] if said else "warning" not in lines


@pytest.mark.slow
def test_the_bed_is_that_of_the_plates_bit_for_bit_and_runs_out(tmp_path):
    typed = {"tank.funnel": False, "parts": PLATES, "grains.region": REGION}
    made, by_hand = (
        lab.run("funnel/discharge", tmp_path / name, video=False, plots=False, quiet=True, **changes)
        for name, changes in (("made", SMALL), ("typed", SMALL | typed))
    )
    for name in ("position", "spin"):
        assert np.array_equal(made.recording.frames[name][-1], by_hand.recording.frames[name][-1])
    assert made.measures["outlet_width"].value == pytest.approx(5.0, rel=0.03)  # mean diameters as drawn
    assert made.measures["passed_fraction"].value > 20.0
    assert any("outlet is 4.5 of the largest grains wide" in said for said in cautions(made.recording))
    assert not any("outlet" in said for said in cautions(by_hand.recording))
