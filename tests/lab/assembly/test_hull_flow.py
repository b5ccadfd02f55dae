"""Potential flow about whole hulls in space against closed forms, energy, Haskind, strips; and what is refused."""

import sys
from dataclasses import replace
from importlib.resources import files
from math import pi
from pathlib import Path

import numpy as np
import pytest

from lab.assembly.hull_flow import Flow
from lab.assembly.hull_tables import PANEL, whole_form, whole_table
from lab.assembly.lines.offsets import read_offsets
from lab.assembly.scene import vessels
from lab.assembly.ship import hull_table
from lab.preset.find import load
from solvers.ship.naval.form import Form, prism
from solvers.ship.naval.lewis_hull import Particulars, lewis_hull
from solvers.ship.potential.mesh import BETWEEN, STANDING, hull_mesh
from solvers.ship.potential.radiation import extrapolated, hydrodynamics
from solvers.ship.potential.strips import strips
from solvers.ship.section import Section, box
from solvers.ship.water import Water
from tests.oracles import s175
from tests.oracles.presets import error_of

WATER = Water()
LENGTH, BREADTH, DRAUGHT = 1.0, 0.34, 0.11
BARGE = prism(box(BREADTH, 0.3), LENGTH)
FEW = 4  # panels between two knuckles, where roll is not looked at closely
RADIUS = 0.5
NEEDED = "needs Capytaine: pip install -e '.[ship3d]'"


@pytest.fixture(scope="module")
def library():
    return pytest.importorskip("capytaine", reason=NEEDED)


def hemisphere(stations: int = 21, corners: int = 40) -> Form:
    """A sphere floating half under water, with an upright collar above."""
    along = -np.cos(np.pi * np.arange(stations) / (stations - 1))
    sections = []
    for xi in along:
        r = RADIUS * np.sqrt(max(0.0, 1.0 - xi**2))
        if r < 1e-6:
            sections.append(None)
            continue
        turn = np.linspace(0.0, 0.5 * np.pi, corners)
        side = np.column_stack([r * np.sin(turn), RADIUS - r * np.cos(turn)])
        side = np.vstack([side, [r, 1.5 * RADIUS]])
        sections.append(Section(np.vstack([side, (side[1:] * [-1.0, 1.0])[::-1]])))
    return Form(RADIUS * (1.0 + along), tuple(sections))


def test_mesh_is_closed_and_holds_the_displacement():
    for form, draught, volume in ((BARGE, DRAUGHT, LENGTH * BREADTH * DRAUGHT), (hemisphere(), RADIUS, None)):
        mesh = hull_mesh(form, draught, 0.05)
        corners = mesh.corners[mesh.panels]
        area = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        middle = corners.mean(axis=1)
        wanted, close = (volume, 1e-9) if volume else (2.0 / 3.0 * pi * RADIUS**3, 0.02)
        for axis in (0, 2):
            assert 2.0 * (area[:, axis] * middle[:, axis]).sum() == pytest.approx(wanted, rel=close)
        assert area[:, 0].sum() == pytest.approx(0.0, abs=1e-9)
        x, y, z = mesh.inner().T
        assert not z.any()
        assert (y > 0.0).all()
        assert (y < np.interp(x, mesh.stations[::-1], mesh.rings[::-1, -1, 0])).all()


def test_hemisphere_is_that_of_hulme(library):
    """Sway: A and B over the displaced mass and ω at Ka = 0.5, 1 (Hulme 1982, J. Fluid Mech. 121, table 2).

    For ω → ∞ in heave exactly 1/2, half of a sphere in unbounded water, and 0.2732 in sway. What is left is the volume
    that flat panels cut off, 1.1 %.
    """
    mass, number = WATER.density * 2.0 / 3.0 * pi * RADIUS**3, np.array([0.5, 1.0])
    flow = Flow(hull_mesh(hemisphere(41, 80), RADIUS, 0.05, FEW), 0.0, WATER)
    table = flow.table(np.sqrt(number * WATER.gravity / RADIUS))
    assert table.added_mass[:, 1, 1] / mass == pytest.approx([0.6439, 0.5740], rel=0.02)
    assert table.damping[:, 1, 1] / mass / table.frequency == pytest.approx([0.0987, 0.3535], rel=0.03)
    added = table.infinite_added_mass / mass
    assert added[[0, 1], [0, 1]] == pytest.approx(0.2732, rel=0.02)
    assert added[2, 2] == pytest.approx(0.5, rel=0.02)
    assert np.abs(added[3:, 3:]).max() < 2e-3  # it turns without moving water


def radiated(flow: Flow, omega: float) -> np.ndarray:
    """b = k/(8π ρ g c_g) ∫|X|² dβ over all headings (Newman 1962), of a hull alike fore and aft: a quarter of them."""
    place, weight = np.polynomial.legendre.leggauss(6)
    force = np.array([flow.excitation(omega, beta) for beta in 0.25 * pi * (1.0 + place)])
    whole = 4.0 * 0.25 * pi * weight @ np.abs(force) ** 2
    return omega**2 / (8.0 * pi * WATER.density * WATER.gravity**2 * WATER.group_speed(omega)) * whole


def of_anti_roll_tank(between: int, size: float = 0.65) -> tuple[Flow, float]:
    """The flow about a ship with bilges, by panels of a size in draughts, and √(g/T)."""
    given = load("ship/anti-roll-tank").resolved.ship
    form, height = whole_form(given), given.about[1] - float(given.corners[:, 1].min())
    mesh = hull_mesh(form, given.draught, size * given.draught, between)
    return Flow(mesh, height - given.draught, WATER), float(np.sqrt(WATER.gravity / given.draught))


def test_damping_is_the_energy_of_the_waves_made(library):
    """The far field against pressures on the hull."""
    flow, omega = Flow(hull_mesh(BARGE, DRAUGHT, 0.06, FEW), 0.0, WATER), 6.0
    far, table = radiated(flow, omega), flow.table([omega])
    near = table.damping[0].diagonal()
    assert far[[1, 2, 4]] == pytest.approx(near[[1, 2, 4]], rel=0.05)
    miss = np.abs(table.haskind[0] - table.excitation[0])[[1, 2]] / np.abs(table.excitation[0])[[1, 2]]
    assert miss.max() < 0.03
    assert table.added_mass[0] == pytest.approx(table.added_mass[0].T, abs=0.01 * np.abs(table.added_mass[0]).max())


def test_roll_of_a_round_hull_is_right_beside_irregular_frequencies(library):
    """At 1.1 √(g/T), where a lid inside her took 30 % of roll's damping; at 1.15 heave's jumps without points.

    A box of her length L, breadth B and draught T has its first standing wave at ω² = g k coth kT, k² = π²/L² + π²/B².
    """
    given = load("ship/anti-roll-tank").resolved.ship
    flow, unit = of_anti_roll_tank(BETWEEN)
    depth = pi * given.draught * np.hypot(1.0 / given.length, 1.0 / np.ptp(given.corners[:, 0]))
    assert np.sqrt(depth / np.tanh(depth)) == pytest.approx(1.15, abs=0.002)
    table = flow.table([1.1 * unit, 1.15 * unit])
    near = table.damping[0].diagonal()
    assert radiated(flow, 1.1 * unit)[1:4] == pytest.approx(near[1:4], rel=0.04)
    miss = np.abs(table.haskind[1] - table.excitation[1]) / np.abs(table.excitation[1])
    assert miss[1:4].max() < 0.03


@pytest.mark.slow
def test_roll_converges_with_panels_around_the_bilges(library):
    """In second order, so that a third and more panels tell the limit: 4 panels between knuckles miss a fifth of it."""
    found = []
    for between in (4, 8, 12):
        flow, unit = of_anti_roll_tank(between)
        found.append(flow.table([1.1 * unit]).damping[0, 3, 3])
    coarse, fine, finest = found
    limit = finest + (finest - fine) / (12.0**2 / 8.0**2 - 1.0)
    order_two = (1.0 / 4.0**2 - 1.0 / 8.0**2) / (1.0 / 8.0**2 - 1.0 / 12.0**2)
    assert (fine - coarse) / (finest - fine) == pytest.approx(order_two, rel=0.2)
    assert finest == pytest.approx(limit, rel=0.035)
    assert coarse < 0.85 * limit


@pytest.mark.slow
def test_tables_in_space_are_at_the_limit_of_many_panels(library):
    """Roll's damping and excitation to 0.5 and 0.1 %; without extrapolation they are 2.6 and 1 % too small."""
    given, frequency = load("ship/anti-roll-tank").resolved.ship, np.array([0.8, 1.1])
    coarse, fine = (of_anti_roll_tank(between, PANEL)[0] for between in (BETWEEN, 2 * BETWEEN))
    unit = of_anti_roll_tank(FEW)[1]
    limit = extrapolated(coarse.table(frequency * unit), fine.table(frequency * unit))
    found = whole_table(replace(given, hydrodynamics="hull"), WATER, frequency * unit)
    assert found.damping[:, 3, 3] == pytest.approx(limit.damping[:, 3, 3], rel=5e-3)
    assert np.abs(found.excitation[:, 3]) == pytest.approx(np.abs(limit.excitation[:, 3]), rel=1e-3)


@pytest.mark.slow
def test_a_long_hull_is_her_section_in_roll_too(library):
    """What 24 draughts of her have more than 16 has no ends: her section's, by another Green function, at 1.1 √(g/T).

    With 4 panels between knuckles her damping in roll would be a fifth less.
    """
    given = load("ship/anti-roll-tank").resolved.ship
    section, draught, omega = Section(given.corners), given.draught, 1.1 * np.sqrt(WATER.gravity / given.draught)
    rise = given.about[1] - float(given.corners[:, 1].min()) - draught
    lengths = 16.0 * draught, 24.0 * draught
    ends = [
        Flow(hull_mesh(prism(section, length), draught, 0.8 * draught), rise, WATER).table([omega])
        for length in lengths
    ]
    alone = hydrodynamics(section, WATER, given.heave, [omega], about=given.about, count=160)

    for of in (lambda one: one.damping[0].diagonal(), lambda one: np.abs(one.excitation[0])):
        short, long = (of(one)[1:4] for one in ends)
        assert (long - short) / (lengths[1] - lengths[0]) == pytest.approx(of(alone), rel=0.03)


@pytest.fixture(scope="module")
def lines():
    """The S175's own lines."""
    return read_offsets(Path(str(files("presets"))) / "ship" / "s175.csv")


def test_lines_of_the_s175_have_her_hydrostatics(lines):
    """Another program's of the same lines."""
    found = lines.hydrostatics(9.5, Water(1025.0))
    assert found.displacement == pytest.approx(s175.DISPLACEMENT, rel=2e-3)
    assert (found.kb, found.km) == pytest.approx((s175.KB, s175.KM), rel=1e-3)
    assert found.lcb == pytest.approx(s175.LCB, abs=0.1)


def test_strips_of_the_s175_are_those_of_another_code(lines):
    """Sway, heave and roll within 7 %, pitch and yaw 10 %: two codes of strips on the same lines."""
    found = strips(lines, 9.5, Water(1025.0), s175.FREQUENCY, 9.55, 40)
    for ours, theirs in ((found.added_mass, s175.ADDED_MASS), (found.damping, s175.DAMPING)):
        over = ours.diagonal(axis1=1, axis2=2)[:, 1:] / 1e6 / theirs
        assert over[:, :3] == pytest.approx(np.ones((4, 3)), abs=0.07)
        assert over[:, 3:] == pytest.approx(np.ones((4, 2)), abs=0.1)
    assert np.abs(found.excitation[:, 1:3]) / 1e6 == pytest.approx(s175.FORCE, rel=0.025)


@pytest.mark.slow
def test_lewis_hull_of_the_s175_in_space(library):
    """All six degrees of freedom; waves shorter than the ship are scattered as strips scatter them."""
    particulars = Particulars(175.0, 25.4, 9.5, 15.4, 0.569, kb=5.207, midship=0.966)
    hull, salt, frequency = lewis_hull(particulars, 21), Water(1025.0), [0.524, 1.047]
    table = Flow(hull_mesh(hull, 9.5, 0.6 * 9.5), 0.05, salt).table(frequency)
    size = np.abs(table.excitation)
    assert (np.abs(table.haskind - table.excitation) / size)[:, 1:4].max() < 5e-3
    by_strips = np.abs(strips(hull, 9.5, salt, frequency, 9.55, 60).excitation)
    assert size[1, 1:3] == pytest.approx(by_strips[1, 1:3], rel=0.04)
    for one in table.added_mass:
        scale = np.sqrt(np.outer(one.diagonal(), one.diagonal()))
        assert (np.abs(one - one.T) / scale).max() < 0.02
    for one in table.damping:  # no motion takes energy from calm water
        assert np.linalg.eigvalsh(0.5 * (one + one.T)).min() > -1e-3 * one.diagonal()[1]


def test_bilges_have_their_panels_whatever_the_size():
    given = load("ship/anti-roll-tank").resolved.ship
    for size in (0.4, 1.5):
        mesh = hull_mesh(whole_form(given), given.draught, size * given.draught)
        assert mesh.rings.shape[1] == 1 + 3 * BETWEEN
    waves = np.ptp(mesh.stations) * STANDING / given.draught / pi  # half lengths of the shortest standing wave
    assert len(np.unique(mesh.inner()[:, 0])) > 1.5 * waves


def test_points_within_take_irregular_frequencies_away(library):
    """Above √(g/T) a box without them has a heave damping that jumps, even below zero; with them, it falls evenly."""
    flow, frequency = Flow(hull_mesh(BARGE, DRAUGHT, 0.06, FEW), 0.0, WATER), (9.8, 10.2, 10.6)
    damping = flow.table(frequency).damping[:, 2, 2]
    assert (damping > 0.0).all()
    assert (np.diff(damping) < 0.0).all()


def test_a_missing_library_is_told_in_one_sentence(monkeypatch):
    monkeypatch.setitem(sys.modules, "capytaine", None)
    preset = load("ship/barge-two-tanks", {"ship.hydrodynamics": "hull", "ship.draught": "107 mm"}).resolved
    told = error_of(lambda: hull_table(preset.ship, preset.sea, preset.run.gravity))
    assert told.startswith("ship.hydrodynamics: needs Capytaine")
    assert "ship3d" in told


def test_strips_of_a_prism_change_nothing():
    preset = load("ship/barge-two-tanks").resolved
    section = hull_table(preset.ship, preset.sea, preset.run.gravity)
    strips = hull_table(replace(preset.ship, hydrodynamics="strips"), preset.sea, preset.run.gravity)
    assert strips.damping == pytest.approx(section.damping, abs=1e-6 * np.abs(section.damping).max())


def test_a_hull_from_offsets_floats_in_waves(tmp_path):
    """The barge once more, by a file of her offsets: the same vessel."""
    file = tmp_path / "barge.csv"
    places = [(x, z) for x in (0, 1.273, 2.546) for z in (0, 0.9)]
    file.write_text("\n".join(["station,z,half_breadth", *(f"{x},{z},0.5" for x, z in places)]))
    changes = {"ship.hydrodynamics": "strips", "ship.offsets": str(file)}
    offsets, prism_of = (vessels(load("ship/barge-two-tanks", c).resolved)[0].ship for c in (changes, {}))
    assert offsets.radiation.added_mass == pytest.approx(prism_of.radiation.added_mass, rel=1e-6, abs=1e-6)
    assert offsets.load.excess == pytest.approx(prism_of.load.excess, rel=1e-4, abs=1e-3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"ship.hydrodynamics": "strips", "ship.length": False, "tank.length": False}, "ship.length: missing"),
        ({"ship.offsets": "OFFSETS"}, "ship.offsets: is not used"),
        ({"ship.hydrodynamics": "strips", "ship.offsets": "OFFSETS"}, "ship.breadth: her section is 1 m wide"),
        ({"ship.hydrodynamics": "strips", "ship.offsets": "LOW"}, "ship.offsets: her stations end 700 mm over"),
        ({"ship.hydrodynamics": "boat"}, "ship.hydrodynamics: 'boat' is unknown"),
    ],
)
def test_wrong_hulls_are_told(changes, words, tmp_path):
    file = tmp_path / "small.csv"
    rows = [f"{x},{z},{0.4}" for x in (0, 1, 2) for z in (0, 0.9)]
    file.write_text("\n".join(["station,z,half_breadth", *rows]))
    low = tmp_path / "low.csv"
    low.write_text("\n".join(["station,z,half_breadth", *(f"{x},{z},0.5" for x in (0, 1, 2) for z in (0, 0.7))]))
    files = {"OFFSETS": str(file), "LOW": str(low)}
    changes = {key: files.get(value, value) for key, value in changes.items()}

    def build():
        preset = load("ship/barge-two-tanks", changes).resolved
        return hull_table(preset.ship, preset.sea, preset.run.gravity)

    assert words.replace("'", '"') in error_of(build).replace("'", '"')
