"""Quantities in and out: what is understood, and what is refused in one sentence."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lab.base.errors import LabError
from lab.preset import units
from lab.preset.units import KINDS, USUAL, parse, show


@pytest.mark.parametrize(
    ("text", "symbol", "number"),
    [
        ("3.2e9 Pa", "Pa", 3.2e9),
        ("3.2 GPa", "Pa", 3.2e9),
        ("0.3 deg/s", "rad/s", math.radians(0.3)),
        ("60 rpm", "rad/s", 2 * math.pi),
        ("20°", "rad", math.radians(20)),
        ("3mm", "m", 0.003),
        ("-90 mm", "m", -0.09),
        ("\N{MINUS SIGN}90 mm", "m", -0.09),
        ("3 µm", "m", 3e-6),
        ("4 ms", "s", 0.004),
        ("2 minutes", "s", 120.0),
        ("9.81 m/s^2", "m/s^2", 9.81),
        ("9.81 m s^-2", "m/s^2", 9.81),
        ("9.81 m/s²", "m/s^2", 9.81),
        ("20 N s/m", "N s/m", 20.0),
        ("1.319 g/cm^3", "kg/m^3", 1319.0),
        ("2 1/s", "Hz", 2.0),
        ("30 %", "1", 0.3),
        ("0.25", "1", 0.25),
        (0.25, "1", 0.25),
        (3, "1", 3.0),
        ("4 kg/s", "N s/m", 4.0),
        ("2 N/m", "N/m", 2.0),
    ],
)
def test_parse(text, symbol, number):
    assert parse(text, symbol) == pytest.approx(number, rel=1e-14)


@pytest.mark.parametrize(
    ("value", "symbol", "words"),
    [
        ("3 mm", "rad/s", '"3 mm" is a length, but deg/s (an angular rate) is needed'),
        ("3 deg/s", "Hz", "is an angular rate, but Hz"),
        ("1 Hz", "rad/s", "is a frequency, but deg/s"),
        ("60 rpm", "Hz", "is an angular rate"),
        ("30 deg", "1", "is an angle, but a pure number"),
        ("30 %", "m", "is a pure number, but mm (a length)"),
        ("1 kg m^2", "m", "is of another kind"),
        ("3", "m", "has no unit"),
        (3, "m", "has no unit"),
        (0, "m", "has no unit"),
        ("3 mmm", "m", "unknown unit"),
        ("5 Pas", "Pa", "unknown unit"),
        ("3 Mm mm", "m", "is an area"),
        ("0,3 mm", "m", "cannot be read"),
        ("mm", "m", "cannot be read"),
        ("", "m", "cannot be read"),
        ("3 m/", "m", "cannot be read"),
        ("2 m**9**9**9", "m", "cannot be read"),
        ("3 (m)", "m", "cannot be read"),
        ("1" * 5000, "1", "cannot be read"),
        ("3 " + "m " * 500_000, "m", "cannot be read"),
        ("nan m", "m", "not a finite number"),
        ("-inf", "1", "not a finite number"),
        (math.nan, "1", "not a finite number"),
        (math.inf, "1", "not a finite number"),
        ("1e999 m", "m", "not a finite number"),
        (10**400, "1", "not a finite number"),
        pytest.param(10**5000, "1", "not a finite number", id="5000 digits"),
        (True, "1", "true is not a quantity"),
        ([1], "1", "is not a quantity"),
        (None, "m", "is not a quantity"),
    ],
)
def test_refused_in_one_sentence(value, symbol, words):
    with pytest.raises(LabError) as caught:
        parse(value, symbol)
    sentence = str(caught.value)
    assert words in sentence
    assert sentence.endswith(".") and "\n" not in sentence and len(sentence) < 200


@pytest.mark.parametrize(
    ("value", "symbol", "text"),
    [
        (0.003, "m", "3 mm"),
        (-0.18, "m", "-180 mm"),
        (0.99999999, "m", "1 m"),
        (1.47e-9, "m", "1.47 nm"),
        (0.0, "m", "0 m"),
        (1e-20, "m", "1e-11 nm"),
        (3.2e6, "Pa", "3.2 MPa"),
        (math.radians(45), "rad", "45 deg"),
        (math.radians(0.3), "rad/s", "0.3 deg/s"),
        (1e-6, "s", "1 µs"),
        (1500.0, "s", "1500 s"),
        (17800.0, "kg/m^3", "17800 kg/m^3"),
        (0.25, "1", "0.25"),
        (math.nan, "m", "nan mm"),
        (2.0, "N/m", "2 N/m"),
    ],
)
def test_show(value, symbol, text):
    assert show(value, symbol) == text


@given(st.floats(min_value=-1e290, max_value=1e290), st.sampled_from(list(KINDS)))  # 1e300 m³ are too many mm³
def test_shown_quantities_can_be_parsed_again(value, symbol):
    assert parse(show(value, symbol), symbol) == pytest.approx(value, rel=1e-3, abs=1e-300)


@given(st.text() | st.integers() | st.floats(), st.sampled_from(list(KINDS)))
def test_only_lab_errors_escape(value, symbol):
    try:
        assert math.isfinite(parse(value, symbol))
    except LabError as error:
        assert "\n" not in str(error)


@given(st.from_regex(r"[-+]?[0-9]{1,3}(\.[0-9]*)?(e[0-9]{1,3})? ?[a-zA-Z%°/*^ 0-9-]{0,12}", fullmatch=True))
def test_near_quantities_give_only_lab_errors(text):
    try:
        assert math.isfinite(parse(text, "m/s"))
    except LabError as error:
        assert "\n" not in str(error)


@pytest.mark.parametrize(("unit", "symbol"), USUAL)
def test_the_factors_of_usual_units_are_those_that_pint_finds(unit, symbol, monkeypatch):
    monkeypatch.setattr(units, "_factors", {})
    assert units._factor(unit, unit, symbol) == USUAL[unit, symbol]


def refused(unit, symbol):
    try:
        parse(f"3 {unit}", symbol)
    except LabError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("unit", units.SYMBOLS)
def test_a_wrong_kind_of_unit_is_said_in_the_words_that_pint_gives(unit, monkeypatch):
    found = {symbol: refused(unit, symbol) for symbol in KINDS}
    monkeypatch.setattr(units, "SYMBOLS", {})
    assert found == {symbol: refused(unit, symbol) for symbol in KINDS}
