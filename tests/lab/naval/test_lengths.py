"""Lengths of a hull: between perpendiculars and in the waterline, and what hangs on them."""

from importlib.resources import files
from pathlib import Path

import pytest
from click.testing import CliRunner

from lab.assembly.lines.offsets import read_offsets
from lab.cli.naval import hull
from lab.naval.lengths import between
from lab.naval.loaded import Loaded, Wind
from lab.naval.weights import Weights
from solvers.ship.naval.form import prism
from solvers.ship.section import box
from solvers.ship.water import Water

SEA = Water(1025.0)
S175 = Path(str(files("presets"))) / "ship" / "s175.csv"  # 175 m between perpendiculars, a counter of 1.6625 m behind
BOX = "station,z,half_breadth\n" + "".join(f"{x},{z},13.5\n" for x in (0, 65, 130) for z in (0, 14))


def test_coefficients_are_of_the_length_between_perpendiculars():
    """Of the S175 Cb = V/(L B T) and MCT = Δ BM_L/(100 L) with her own 175 m, not with her stations' 176.66 m."""
    lines = read_offsets(S175)
    bare, found = (form.hydrostatics(9.5, SEA) for form in (lines, between(lines, 175.0, None, 0.0)))
    assert found.block == pytest.approx(found.volume / (175.0 * 25.4 * 9.5), rel=1e-9)
    assert found.mct == pytest.approx(found.displacement * found.bml / 17_500.0, rel=1e-9)
    assert found.block == pytest.approx(24_609.62 / (1.025 * 175.0 * 25.4 * 9.5), rel=3e-3)  # her published weight
    assert bare.mct / found.mct == pytest.approx(175.0 / 176.6625, rel=1e-9)


def test_draughts_are_those_at_the_perpendiculars_asked_for(tmp_path):
    """A box trims over her whole length; 20 m aft of her forward end she has what lies between."""
    for name, text in {"box.csv": BOX, "weights.csv": "name,mass,lcg,tcg,vcg\nall,31000,64,0,9\n"}.items():
        (tmp_path / name).write_text(text)
    given = [str(tmp_path / "box.csv"), "--weights", str(tmp_path / "weights.csv"), "--out", str(tmp_path / "out")]
    draught = 31e3 / (1.025 * 27.0 * 130.0)
    slope = 12.0 * draught / 130.0**2  # of a box with G 1 m aft
    for more, (aft, fore) in (((), (0.0, 130.0)), (("--lbp", "100", "--ap", "10"), (10.0, 110.0))):
        answer = CliRunner().invoke(hull, [*given, *more])
        told = [draught + slope * (65.0 - x) for x in (aft, fore)]
        assert f"aft {told[0]:.3f}, forward {told[1]:.3f} m" in answer.output
        assert f"at {aft:g} and {fore:g} m, {fore - aft:g} m apart" in answer.output
    for options, words in (
        (("--lbp", "175"), "--lbp: 175 m is no length of a hull whose stations reach over 130 m"),
        (("--lwl", "20"), "--lwl: 20 m is no length"),
        (("--lbp", "100", "--ap", "-65"), "--lbp: her perpendiculars would be at -65 and 35 m"),
        (("--lbp", "100", "--ap", "nan"), "--lbp: her perpendiculars would be at nan"),
        (("--ap", "10"), "--ap: says where the length between perpendiculars begins; give --lbp, too."),
    ):
        assert words in str(CliRunner().invoke(hull, [*given, *options]).exception)


def test_weather_criterion_has_the_length_in_the_waterline():
    """C = 0.373 + 0.023 B/d − 0.043 L/100, and the block coefficient, by the length given, else the stations'."""
    form = prism(box(27.0, 14.0), 130.0)
    load, wind = Weights(31_000.0, 65.0, 0.0, 9.0, 0.0), Wind(1500.0, 10.0)
    for lwl, length in ((None, 130.0), (134.0, 134.0)):
        ship = Loaded(form, SEA, load, wind=wind, lwl=lwl).exposed
        factor = 0.373 + 0.023 * 27.0 / ship.draught - 0.043 * length / 100.0
        assert ship.period == pytest.approx(2.0 * factor * 27.0 / ship.metacentric_height**0.5, rel=1e-9)
        assert ship.block == pytest.approx(130.0 / length, rel=1e-9)
