"""`cargolab roll-damping`: the S175 by her lines and by her particulars, in a sea, and what it refuses."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from lab.base.errors import LabError
from lab.cli import main
from lab.naval.rolling import sea
from lab.naval.rolling.damping import Asked, compute, prepare
from lab.naval.rolling.preset_sea import in_her_sea
from lab.preset.find import load
from solvers.ship.damping.components import NAMES

LINES = Path("presets/ship/s175.csv")
OF_LINES = Asked(file=LINES, draught=9.5, kg=9.52, period=20.0, keels=(0.4, 43.75))
PLAIN = {"length": 175.0, "breadth": 25.4, "draught": 9.5, "block": 0.58, "midship": 0.95, "kg": 9.52, "gm": 1.0}


@pytest.fixture(scope="module")
def s175():
    rolling = prepare(OF_LINES)
    return compute(OF_LINES, rolling)


def test_both_ways_agree_on_the_s175(s175):
    """Her lines and her particulars: all but the small friction and waves within a third at 10 deg (eddies by fits)."""
    asked = Asked(**PLAIN, period=20.0, keels=(0.4, 43.75))
    rough = compute(asked, prepare(asked))
    at = int(np.argmin(np.abs(s175.amplitudes - np.radians(10.0))))
    for name in ("eddies", "keel drag", "keel pressure"):
        k = NAMES.index(name)
        assert rough.parts[at, k] == pytest.approx(s175.parts[at, k], rel=0.45), name
    assert rough.total[at] == pytest.approx(s175.total[at], rel=0.2)


def test_waves_of_the_s175_are_near_the_published_ones(s175):
    """B_W at no speed and 20 s: 1.481 MN m s (rolldecay-estimators, S175); other lines and GM: within a fifth."""
    assert s175.parts[0, NAMES.index("waves")] == pytest.approx(1.481e6, rel=0.2)


def test_a_damping_on_a_preset_takes_as_much_as_the_components(s175):
    """B₁ and B₂ with the waves: within the misfit that is told, which is below a fifth."""
    assert s175.off < 0.2
    viscous = s175.total - s175.parts[:, NAMES.index("waves")]
    line = s175.linear + 8.0 / (3.0 * np.pi) * s175.rolling.frequency * s175.amplitudes * s175.quadratic
    assert np.abs(line / viscous - 1.0).max() <= s175.off + 1e-9


@pytest.fixture(scope="module")
def barge(tmp_path_factory):
    """A box, whose stations are alike, so that potential flow is solved for one of them."""
    path = tmp_path_factory.mktemp("box") / "box.csv"
    rows = [f"{x},{z},{y}" for x in (0, 65, 130) for z, y in ((0, 12.5), (1, 13.5), (14, 13.5))]
    path.write_text("station,z,half_breadth\n" + "\n".join(rows) + "\n")
    return Asked(file=path, draught=8.0, kg=9.0, period=11.0, keels=(0.4, 40.0), hours=3.0)


def test_she_rolls_more_in_waves_of_her_own_period(barge):
    found, numbers = compute(barge, prepare(barge)), {}
    for period in (7.0, 11.0):
        asked = replace(barge, sea=(2.0, period))
        numbers[period] = sea.told(asked, found, sea.in_sea(asked, found))
    assert numbers[11.0]["significant roll deg"] > 2.0 * numbers[7.0]["significant roll deg"]
    assert numbers[11.0]["viscous zeta in this sea"] > numbers[7.0]["viscous zeta in this sea"]


def test_long_waves_roll_her_by_their_slope(barge):
    """At a tenth of her frequency roll per metre is the slope of the waves, k = ω²/g, within 3 %."""
    found = compute(barge, prepare(barge))
    ship = sea.afloat(found, 0.2 * found.rolling.frequency)
    size = np.abs(ship.response(found.linear)[0, 2])
    slow = ship.table.frequency[0]
    quasistatic = slow**2 / 9.81 / (1.0 - (slow / found.rolling.frequency) ** 2)
    assert size == pytest.approx(quasistatic, rel=0.03)


def test_a_presets_ship_rolls_in_her_sea_with_linearised_damping():
    """With linear damping alone roll is as the height of the sea; quadratic damping takes more of a higher one.

    The run of ship/barge-empty in 20 mm at 5 rad/s has a significant roll of 3.90 ± 0.47 deg.
    """
    sea_of = {"waves.kind": "jonswap", "waves.amplitude": False, "run.duration": "10 s"}
    preset = {
        (height, quadratic): load(
            "ship/barge-empty", sea_of | {"waves.height": f"{height} mm", "ship.quadratic_damping": quadratic}
        ).resolved
        for height in (10, 20)
        for quadratic in (0.0, 0.3)
    }
    found = {key: in_her_sea(one, "section").significant for key, one in preset.items()}
    assert found[20, 0.0] == pytest.approx(2.0 * found[10, 0.0], rel=1e-6)
    assert found[20, 0.3] < 1.99 * found[10, 0.3] and found[20, 0.3] < found[20, 0.0]
    assert np.degrees(found[20, 0.3]) == pytest.approx(3.90, abs=2.0 * 0.47)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"kg": None}, "--kg: missing"),
        ({"block": None}, "--block: missing"),
        ({"period": None}, "--period: missing"),
        ({"gyradius": 9.0}, "--gyradius: follows"),
        ({"keels": (43.75, 0.4)}, "--keels"),
        ({"keels": (0.4, 400.0)}, "--keels"),
        ({"radius": 12.0}, "--radius"),
        ({"file": LINES, "gm": 1.0}, "the file of her hull tells"),
        ({"breadth": 60.0}, "B/d is 6.32"),
    ],
)
def test_what_is_missing_or_wrong_is_told_in_a_sentence(changes, said):
    whole = {**PLAIN, "period": 20.0, **changes}
    with pytest.raises(LabError, match=said):
        asked = Asked(**whole)
        compute(asked, prepare(asked))


def test_a_sea_needs_lines_and_waves_that_do_not_break(s175):
    asked = Asked(**PLAIN, period=20.0, sea=(4.0, 12.0))
    with pytest.raises(LabError, match="lines"):
        sea.in_sea(asked, compute(asked, prepare(asked)))
    with pytest.raises(LabError, match="height, then peak period"):
        sea.in_sea(replace(OF_LINES, sea=(12.0, 4.0)), s175)


def test_the_command_writes_its_tables_and_figures(tmp_path):
    words = [f"--{name}={value}" for name, value in PLAIN.items()]
    how = ["--period=20", "--keels", "0.4", "43.75", "--amplitude", "5", "--out", str(tmp_path), "--json"]
    told = CliRunner().invoke(main, ["roll-damping", *words, *how], catch_exceptions=False)
    assert told.exit_code == 0, told.output
    found = json.loads(told.output)["roll-damping"]
    assert [row["amplitude deg"] for row in found] == [5.0]
    assert {path.name for path in tmp_path.iterdir()} == {"roll-damping.csv", "roll-damping.png"}
