"""Convert quantities as users write them ("3.2e9 Pa", "0.3 deg/s", "30 %") to SI numbers and back.

The lab has its own short list of units. Pint's default registry treats angles as pure numbers, so "3 deg/s" would pass
for a frequency and 60 rpm would be 6.28 Hz; here an angle is a dimension.
"""

import math
import re
from functools import cache
from typing import NamedTuple

from lab.base.errors import LabError

DEFINITIONS = """
nano- = 1e-9 = n-
micro- = 1e-6 = µ- = \u03bc- = u-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
kilo- = 1e3 = k-
mega- = 1e6 = M-
giga- = 1e9 = G-
meter = [length] = m = metre
gram = [mass] = g
second = [time] = s
radian = [angle] = rad
degree = 0.017453292519943295 * radian = deg
revolution = 6.283185307179586 * radian = rev
minute = 60 * second = min
hour = 3600 * second = h
rpm = revolution / minute
hertz = 1 / second = Hz
newton = 1000 * gram * meter / second ** 2 = N
pascal = newton / meter ** 2 = Pa
bar = 1e5 * pascal
joule = newton * meter = J
tonne = 1e6 * gram = t
knot = 1852 * meter / hour = kn
percent = 0.01 = %
"""


class Kind(NamedTuple):
    """How messages describe an SI unit: what it measures, the usual unit, an example."""

    name: str
    unit: str
    example: str


KINDS = {
    "1": Kind("a pure number", "1", "0.25"),
    "m": Kind("a length", "mm", "3 mm"),
    "kg": Kind("a mass", "g", "0.15 g"),
    "s": Kind("a time", "s", "0.5 s"),
    "rad": Kind("an angle", "deg", "20 deg"),
    "rad/s": Kind("an angular rate", "deg/s", "3 deg/s"),
    "Hz": Kind("a frequency", "Hz", "1.5 Hz"),
    "1/s": Kind("a rate", "1/s", "100 1/s"),  # after Hz, by which a wrong unit of both is named
    "m/s": Kind("a speed", "m/s", "1 m/s"),
    "m/s^2": Kind("an acceleration", "m/s^2", "9.81 m/s^2"),
    "kg/m^3": Kind("a density", "kg/m^3", "1319 kg/m^3"),
    "N": Kind("a force", "N", "1 N"),
    "Pa": Kind("a pressure", "Pa", "3.2e9 Pa"),
    "J": Kind("an energy", "J", "1 J"),
    "N/m": Kind("a surface tension", "N/m", "0.072 N/m"),
    "m^2": Kind("an area", "m^2", "1500 m^2"),
    "m^4": Kind("a volumetric moment", "m^4", "13900 m^4"),
    "m^3/kg": Kind("a stowage factor", "m^3/t", "1.3 m^3/t"),
    "kg m": Kind("a moment of mass", "t m", "800 t m"),
    "m^3": Kind("a volume", "mm^3", "0.002 mm^3"),
    "m^2/s": Kind("a kinematic viscosity", "m^2/s", "1e-6 m^2/s"),
    "N s/m": Kind("a damping coefficient", "N s/m", "20 N s/m"),
}
MEASURED = {"deg": "rad", "mm": "m", "mN": "N", "µJ": "J", "Hz": "Hz", "s": "s", "Pa": "Pa", "%": "1"}  # of measures
PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
# Units shown with a prefix, and the smallest power of ten of that prefix.
PREFIXED = {"m": -9, "s": -9, "Pa": 0, "N": -9, "J": -9, "Hz": 0}

NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
FACTOR = re.compile(r"\s*([*/·]?)\s*([^\W\d]+|[%°]|1(?=\s*/))(?:\s*(?:\^|\*\*)\s*(-?[1-9]))?")
TYPOGRAPHY = str.maketrans({"\N{MINUS SIGN}": "-", "²": "^2", "³": "^3"})
LONGEST, MOST_FACTORS = 100, 1000  # characters of a quantity; factors kept, of units as they are written

# From units as they are written to SI. Pint takes long to import and over each unit, so those of most presets are here;
# a test asks it for the same.
USUAL = {
    ("", "1"): 1.0,
    ("%", "1"): 0.01,
    ("mm", "m"): 1e-3,
    ("cm", "m"): 1e-2,
    ("nm", "m"): 1e-9,
    ("km", "m"): 1e3,
    ("mm^3", "m^3"): 1e-9,
    ("mm/s", "m/s"): 1e-3,
    ("ms", "s"): 1e-3,
    ("min", "s"): 60.0,
    ("deg", "rad"): 0.017453292519943295,
    ("deg/s", "rad/s"): 0.017453292519943295,
    ("kHz", "Hz"): 1e3,
    ("g", "kg"): 1e-3,
    ("kN", "N"): 1e3,
    ("N/m^2", "Pa"): 1.0,
    ("kPa", "Pa"): 1e3,
    ("MPa", "Pa"): 1e6,
    ("GPa", "Pa"): 1e9,
    ("m^3/t", "m^3/kg"): 1e-3,
}
SAME = {"1/s": "Hz"}  # SI units of one dimension
# The SI unit of a unit as it is written, of those that a message names without asking Pint
SYMBOLS = {unit: SAME.get(symbol, symbol) for unit, symbol in [*USUAL, *zip(KINDS, KINDS, strict=True)]}
SYMBOLS = {unit: symbol for unit, symbol in SYMBOLS.items() if unit not in ("", "1")}
_factors: dict[tuple[str, str], float] = dict(USUAL)
QUOTED, LONGEST_PATH = 40, 100  # characters of a user's text, and of a path, that an error quotes


@cache
def _registry():
    from pint import UnitRegistry  # takes a third of a second; `--help` does not need it

    registry = UnitRegistry(None)
    for line in DEFINITIONS.strip().splitlines():
        registry.define(line)
    return registry


def kind(symbol: str) -> Kind:
    """What the SI unit `symbol` measures, in words."""
    return KINDS.get(symbol, Kind(f"a quantity in {symbol}", symbol, f"1 {symbol}"))


def needed(symbol: str) -> str:
    """The clause of an error message that asks for a quantity: 'a length is needed, e.g. "3 mm"'."""
    name, _, example = kind(symbol)
    return f"{name} is needed, e.g. {example}" if symbol == "1" else f'{name} is needed, e.g. "{example}"'


def quoted(value: object) -> str:
    """A user's value on one line, shortened for an error message."""
    try:
        text = str(value).lower() if isinstance(value, bool) else str(value)
    except ValueError:  # an integer of more than 4300 digits
        return "the number"
    text = text if len(text) <= QUOTED else f"{text[:QUOTED]}…"
    text = "".join(c if c.isprintable() else "?" for c in text)
    return f'"{text}"' if isinstance(value, str) else text


def shown_path(path: object) -> str:
    """A path on one line; of a long path only its end."""
    text = "".join(c if c.isprintable() else "?" for c in str(path))
    return text if len(text) <= LONGEST_PATH else f"…{text[-LONGEST_PATH:]}"


def parse(value: object, symbol: str) -> float:
    """Parse a text such as "3 mm" into a number in the SI unit `symbol`.

    Plain numbers are accepted only if `symbol` is "1". Raises LabError: a wrong dimension, no unit, an unknown unit,
    text that is no quantity, or a number that is not finite.
    """
    if isinstance(value, str):
        number, unit = _split(value, symbol)
        number *= _factor(unit, value, symbol)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        if symbol != "1":
            raise LabError(f"{quoted(value)} has no unit; {needed(symbol)}.")
        number = _as_float(value)
    else:
        raise LabError(f"{quoted(value)} is not a quantity; {needed(symbol)}.")
    if not math.isfinite(number):
        raise LabError(f"{quoted(value)} is not a finite number; {needed(symbol)}.")
    return number


def known_unit(unit: str) -> bool:
    """Whether the lab knows a unit as it is written; "" is that of a pure number."""
    try:
        return _unit(unit, unit, "1") is not None
    except LabError:
        return False


def in_unit(text: str, unit: str, key: str) -> float:
    """Parse a text such as "0.72 rad" into a number in `unit`, the unit of a measure. Raises LabError."""
    symbol = MEASURED.get(unit)
    try:
        if symbol:
            return parse(text, symbol) / parse(f"1 {unit}", symbol)
        return parse(text.removesuffix(unit), "1")
    except LabError as error:
        raise LabError(f"{key}: {error}") from None


def show(value: float, symbol: str) -> str:
    """Format a number in the SI unit `symbol` for reading: show(0.003, "m") is "3 mm"."""
    unit = kind(symbol).unit
    if symbol in PREFIXED and math.isfinite(value):
        return _with_prefix(value, symbol)
    if symbol == "1":
        return _digits(value)
    return f"{_digits(value / _factor(unit, unit, symbol))} {unit}"


def _split(text: str, symbol: str) -> tuple[float, str]:
    text = text.strip().translate(TYPOGRAPHY)
    match = NUMBER.match(text)
    if match and len(text) <= LONGEST:
        return float(match[0]), text[match.end() :].strip()
    if re.match(r"[+-]?(nan|inf)", text, re.IGNORECASE):
        raise LabError(f"{quoted(text)} is not a finite number; {needed(symbol)}.")
    raise LabError(f"{quoted(text)} cannot be read; {needed(symbol)}.")


def _factor(unit: str, value: str, symbol: str) -> float:
    """The factor from `unit` to `symbol`; `value` is the text that errors quote."""
    if unit == symbol != "1":
        return 1.0
    if (unit, symbol) in _factors:
        return _factors[unit, symbol]
    if not unit and symbol != "1":
        raise LabError(f"{quoted(value)} has no unit; {needed(symbol)}.")
    told = SYMBOLS.get(unit)
    if told and told != SAME.get(symbol, symbol):
        raise LabError(f"{_wrong_kind(value, KINDS[told].name, symbol)}.")
    given = _unit(unit, value, symbol)
    if given.dimensionality != _si(symbol).dimensionality:
        raise LabError(f"{_mismatch(value, given, symbol)}.")
    try:
        factor = (1 * given).to(_si(symbol)).magnitude
    except OverflowError:
        factor = math.inf
    if len(_factors) < MOST_FACTORS:
        _factors[unit, symbol] = factor
    return factor


def _unit(text: str, value: str, symbol: str):
    """A pint unit from "N s/m": names with powers, joined by a space (product), "*" or "/"."""
    unit, place = _registry().Unit(""), 0
    while place < len(text):
        match = FACTOR.match(text, place)
        if match is None or (place == 0 and match[1]):
            raise LabError(f"{quoted(value)} cannot be read; {needed(symbol)}.")
        operator, name, power = match.groups()
        place = match.end()
        if name == "1":
            continue
        factor = _named(name)
        if factor is None:
            raise LabError(f"{quoted(value)} has an unknown unit; {needed(symbol)}.")
        exponent = int(power or 1)
        unit *= factor ** (-exponent if operator == "/" else exponent)
    return unit


def _named(name: str):
    """The pint unit of one name, or None. Only words have a plural: "Pas" may well mean "Pa s"."""
    registry = _registry()
    name = {"%": "percent", "°": "degree"}.get(name, name)
    found = registry.parse_unit_name(name)
    if not found:
        return None
    plural = name.endswith("s") and registry.parse_unit_name(name[:-1]) == found
    return None if plural and len(name) <= 4 else registry.Unit(name)


def _mismatch(value: str, given, symbol: str) -> str:
    what = next((k.name for s, k in KINDS.items() if _si(s).dimensionality == given.dimensionality), None)
    return _wrong_kind(value, what, symbol)


def _wrong_kind(value: str, what: str | None, symbol: str) -> str:
    name, unit, example = kind(symbol)
    is_what = f"is {what}" if what else "is of another kind"
    if symbol == "1":
        return f"{quoted(value)} {is_what}, but {needed(symbol)}"
    return f'{quoted(value)} {is_what}, but {unit} ({name}) is needed, e.g. "{example}"'


@cache
def _si(symbol: str):
    return _unit("" if symbol == "1" else symbol, symbol, symbol)


def _as_float(value: float) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _digits(value: float) -> str:
    """Four significant digits, with an exponent only from ten million on."""
    text = f"{value:.4g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < 1e7 else text


def _with_prefix(value: float, symbol: str) -> str:
    power = 3 * (int(f"{value:.3e}".split("e")[1]) // 3)
    power = min(max(power, PREFIXED[symbol]), 0 if symbol == "s" else 9)
    return f"{_digits(value / 10.0**power)} {PREFIXES[power]}{symbol}"
