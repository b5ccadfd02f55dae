"""Bodies that float and hulls in presets: what follows from their keys, and what is refused."""

import pytest

from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.preset.schema import resolve

BOX = [["-500 mm", "600 mm"], ["500 mm", "600 mm"], ["500 mm", "1.6 m"], ["-500 mm", "1.6 m"]]
ROOM = [["-400 mm", "700 mm"], ["-50 mm", "700 mm"], ["-50 mm", "1.5 m"], ["-400 mm", "1.5 m"]]
OTHER = [["50 mm", "700 mm"], ["400 mm", "700 mm"], ["400 mm", "1.5 m"], ["50 mm", "1.5 m"]]


def given(**box) -> dict:
    """A preset with a solid box in a tank of water, with these keys of the box."""
    return {
        "format": 3,
        "title": "box",
        "tank": {"width": "3 m", "height": "2 m", "thickness": "2 m"},
        "water": {"depth": "1.2 m", "spacing": "50 mm"},
        "parts": {"box": {"closed": True, "points": BOX, **box}},
        "run": {"duration": "1 s"},
    }


def test_an_even_body_has_the_mass_centre_and_inertia_of_its_section():
    """m = ρ a² t, I = m a²/6, about the middle."""
    free = resolve(given(density="600 kg/m^3")).parts["box"].solved(0, 2.0).free
    assert free.mass == pytest.approx(1200.0)
    assert free.inertia == pytest.approx(200.0)
    assert free.centre == pytest.approx((0.0, 1.1))


def test_the_density_of_a_hull_is_that_of_its_walls():
    """With walls of a tenth: 1 − 0.8² of the area, and a²/6 (1 − 0.8⁴)/(1 − 0.8²) of the mass."""
    preset = resolve(given(density="1000 kg/m^3", wall="100 mm"))
    free = preset.parts["box"].solved(0, 2.0).free
    assert preset.rooms == ("box.inside",)
    assert free.mass == pytest.approx(2000.0 * (1.0 - 0.64))
    assert free.inertia == pytest.approx(free.mass / 6.0 * (1.0 - 0.8**4) / (1.0 - 0.8**2))


def test_a_room_of_its_own_shifts_the_centre_of_the_walls():
    """One room left of the middle, 0.35 by 0.8: the walls' centre goes right by 0.225 · 0.28/0.72."""
    rooms = {"port": {"points": ROOM, "depth": "200 mm"}}
    free = resolve(given(density="900 kg/m^3", wall="100 mm", rooms=rooms)).parts["box"].solved(0, 2.0).free
    assert free.centre[0] == pytest.approx(0.225 * 0.28 / 0.72)


HOLE = {"points": [["0 mm", "650 mm"], ["200 mm", "650 mm"]]}


@pytest.mark.parametrize(
    ("keys", "key", "remedy"),
    [
        ({"release": "1 s"}, "parts.box.release", "give its density"),
        ({"mass": "3 kg", "density": "600 kg/m^3"}, "parts.box.mass", "give one of the two"),
        ({"density": "600 kg/m^3", "closed": False}, "parts.box.closed", "set closed = true"),
        ({"density": "600 kg/m^3", "sway": {"amplitude": "1 mm", "frequency": "1 Hz"}}, "parts.box.sway", "leave this"),
        ({"density": "60 kg/m^3"}, "parts.box.density", "take smaller particles"),
        ({"density": "-3 kg/m^3"}, "parts.box.density", "greater than 0"),
        ({"wall": "100 mm", "density": "3000 kg/m^3"}, "parts.box.density", "make it lighter"),
        ({"wall": "20 mm"}, "parts.box.wall", "take smaller particles"),
        ({"wall": "600 mm"}, "parts.box.wall", "thinner wall"),
        ({"rooms": {"port": {"points": ROOM}}}, "parts.box.rooms", "thickness of its wall"),
        ({"openings": {"hole": HOLE}}, "parts.box.openings", "thickness of its wall"),
        (
            {"wall": "100 mm", "rooms": {"a": {"points": ROOM}, "b": {"points": ROOM}}},
            "parts.box.rooms.b",
            "leave a wall",
        ),
        ({"wall": "120 mm", "rooms": {"a": {"points": ROOM}}}, "parts.box.rooms.a.points", "move its corners"),
        (
            {"wall": "100 mm", "openings": {"hole": {"points": [["0 m", "1 m"], ["0.1 m", "1 m"]]}}},
            "parts.box.openings.hole.points",
            "in the middle of the wall",
        ),
        (
            {"density": "600 kg/m^3", "points": [[y, z.replace("600 mm", "-200 mm")] for y, z in BOX]},
            "parts.box.points",
            "keep it inside",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence_with_key_and_remedy(keys, key, remedy):
    with pytest.raises(LabError) as caught:
        resolve(given(**keys))
    told = str(caught.value)
    assert told.startswith(key) and remedy in told and "\n" not in told


def test_two_rooms_and_an_opening_between_them_are_taken():
    rooms = {"port": {"points": ROOM}, "starboard": {"points": OTHER}}
    hole = {"points": [["0 m", "1 m"], ["0 m", "1.2 m"]], "opens": "2 s"}
    preset = resolve(given(wall="100 mm", density="900 kg/m^3", rooms=rooms, openings={"door": hole}))
    assert preset.rooms == ("box.port", "box.starboard") and preset.openings == ("box.door",)


def laden(**changes) -> dict:
    """A preset with grains in the port room of a hull, with these keys of the grains."""
    rooms = {"port": {"points": ROOM}, "starboard": {"points": OTHER}}
    grains = {"room": "box.port", "diameter": "40 mm", "depth": "300 mm", **changes}
    material = {"density": "1200 kg/m^3", "young": "0.1 GPa", "poisson": 0.3, "restitution": 0.5, "friction": 0.4}
    preset = given(wall="100 mm", density="400 kg/m^3", rooms=rooms) | {"grains": grains, "material": material}
    preset["tank"]["thickness"] = "40 mm"
    return preset


def test_grains_in_a_room_of_a_hull_fill_that_room():
    """The tank stays that of the water; the grains lie in the room, aboard the hull."""
    scene, position = build(resolve(laden()))
    room = scene.tanks[scene.hold]
    assert scene.hold == 1 and room.aboard == 0 and scene.fills == (scene.fluid.count, 0)
    assert scene.grains.count == pytest.approx(0.35 * 0.3 / 0.04**2, rel=0.25)
    below = position[0][position[0][:, 1] < 1.5]  # what does not fit in lies above, to be poured
    assert len(below) and room.holds(below).all()


def test_a_hull_that_her_cargo_sinks_is_refused_by_her_weight_with_it():
    """Walls of 400 kg/m³ on 0.44 m² float; grains of gold on top of these do not."""
    preset = laden()
    preset["material"]["density"] = "19300 kg/m^3"
    with pytest.raises(LabError, match=r"^parts.box.density: this hull with .* kg of grains is heavier"):
        build(resolve(preset))


DOOR = {"hole": {"points": [["0 m", "1 m"], ["0 m", "1.2 m"]]}}


def soaked(**changes) -> dict:
    """As `laden`, with an opening into the room of the grains, and changes of the tables of the preset."""
    preset = laden(diameter="20 mm", depth="200 mm")
    preset["parts"]["box"]["openings"] = DOOR
    return preset | changes


def test_an_opening_into_the_room_of_the_grains_makes_a_mixture():
    """Without it there is none, and the water stays where it was."""
    dry, wet = resolve(laden()), resolve(soaked())
    assert wet.soaks and not wet.wet and not dry.soaks
    scene, _ = build(wet)
    assert scene.mixture.level is None and scene.fluid.water.alpha > build(dry)[0].fluid.water.alpha
    assert build(dry)[0].mixture is None and scene.fills == build(dry)[0].fills


@pytest.mark.parametrize(
    ("changes", "key", "remedy"),
    [
        ({"air": {}}, "air", "leave this out"),
        ({"shapes": {"rice": {"cargo": "rice"}}}, "shapes", "leave this out"),
    ],
)
def test_what_cannot_be_with_wet_grains_in_a_hull_is_refused(changes, key, remedy):
    with pytest.raises(LabError) as caught:
        resolve(soaked(**changes))
    told = str(caught.value)
    assert told.startswith(key) and remedy in told and "\n" not in told


def test_a_shelf_among_wet_grains_is_a_sieve():
    preset = soaked()
    shelf = {"tank": "box.port", "points": [["-300 mm", "1 m"], ["-200 mm", "1 m"]]}
    preset["parts"]["shelf"] = shelf
    with pytest.raises(LabError, match=r"^parts.shelf: .* set parts.shelf.sieve = true"):
        resolve(preset)
    shelf["sieve"] = True
    assert resolve(preset).soaks


@pytest.mark.parametrize(
    ("change", "key", "remedy"),
    [
        (lambda p: p["grains"].update(room="box.hold"), "grains.room", "the rooms are box.port, box.starboard"),
        (lambda p: p["parts"]["box"].pop("density"), "grains.room", "give parts.box.density"),
        (lambda p: p["parts"]["box"].update(openings=DOOR), "water.spacing", "take at least 80 mm"),
        (lambda p: p["parts"]["box"]["rooms"]["port"].update(depth="0.1 m"), "parts.box.rooms.port.depth", "leave it"),
        (lambda p: p.update(motion={"roll": {"amplitude": "1 deg", "frequency": "1 Hz"}}), "grains.room", "at rest"),
        (lambda p: p["run"].update(integrator="gear"), "run.integrator", "leave it out"),
        (lambda p: p["grains"].update(depth="2 m"), "grains.depth", "less than the tank's height"),
    ],
)
def test_a_room_that_cannot_hold_grains_is_refused(change, key, remedy):
    preset = laden()
    change(preset)
    with pytest.raises(LabError) as caught:
        resolve(preset)
    told = str(caught.value)
    assert told.startswith(key) and remedy in told and "\n" not in told
