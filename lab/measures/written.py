"""How a measured number is written: ± is the standard deviation over beds and nothing else (docs/numbers.md)."""

from dataclasses import replace
from math import floor, log10

SMALL = 1e-3  # smaller numbers are written with a power of ten
# Units of grains that grow too small for ships: of each a thousand times the one before
LADDERS = [["mN", "N", "kN", "MN", "GN"], ["µJ", "mJ", "J", "kJ", "MJ", "GJ"], ["mN m", "N m", "kN m", "MN m", "GN m"]]
LONG = 1e5  # larger numbers are written in the next unit of a ladder
ROUNDING = 1e-9  # of the value: a smaller scatter is rounding error


def number(value) -> str:
    """A value, as docs/numbers.md says: "25.0 ± 1.3 deg (4 beds)", "24.96 deg (1 bed; detector 0.25 deg)"."""
    if value.value is None:
        return "none"
    value = _readable(value)
    unit = with_blank(value.unit)
    if value.std is not None:
        return f"{plus_minus(value.value, value.std)}{unit}{_beds(value)}"
    return f"{_alone(value)}{unit}{_beds(value, own(value))}"


def own(value) -> str:
    """The measure's own uncertainty with its name, "detector 0.25 deg"; "" where there is none."""
    if value.uncertainty is None:
        return ""
    return f"{value.kind or 'own uncertainty'} {value.uncertainty:.2g}{with_blank(value.unit)}"


def plus_minus(value: float, std: float) -> str:
    """A mean and its standard deviation over beds, to two digits of the latter: "25.0 ± 1.3"."""
    if not std or std < ROUNDING * abs(value):
        return f"{value:.4g} ± 0"
    digits, power = digits_of(std), 0
    if max(abs(value), std) < SMALL:
        power = floor(log10(max(abs(value), std)))
        value, std, digits = value / 10.0**power, std / 10.0**power, digits + power
    text = f"{value:.{digits}f} ± {std:.{digits}f}"
    return f"({text})e{power:+03d}" if power else text


def with_error(value: float, error: float, unit: str = "", sign: str = "") -> str:
    """A mean and its standard error: "3.0 ± 1.0 deg (s.e.)"; `sign` is "+" for differences."""
    if not error or error < ROUNDING * abs(value):
        return f"{value:{sign}.4g} ± 0{with_blank(unit)} (s.e.)"
    digits = digits_of(error)
    return f"{value:{sign}.{digits}f} ± {error:.{digits}f}{with_blank(unit)} (s.e.)"


def _readable(value):
    """The same number in the unit of its ladder in which it is not too long to read."""
    ladder = next((ladder for ladder in LADDERS if value.unit in ladder), None)
    while ladder and abs(value.value) >= LONG and value.unit != ladder[-1]:
        parts = {name: getattr(value, name) for name in ("value", "std", "uncertainty")}
        less = {name: None if part is None else 1e-3 * part for name, part in parts.items()}
        value = replace(value, unit=ladder[ladder.index(value.unit) + 1], **less)
    return value


def digits_of(error: float) -> int:
    """Number of decimals that show two digits of an error."""
    return max(0, 1 - floor(log10(error)))


def _alone(value) -> str:
    """A number of a single bed, with as many digits as its own uncertainty allows."""
    error = value.uncertainty
    if not error or error < ROUNDING * abs(value.value) or max(abs(value.value), error) < SMALL:
        return f"{value.value:.4g}"
    return f"{value.value:.{digits_of(error)}f}"


def with_blank(unit: str) -> str:
    """A unit as it follows a number; nothing for a pure one."""
    return "" if unit in ("", "1") else f" {unit}"


def _beds(value, more: str = "") -> str:
    """In brackets: the number of beds in which it was found, then `more`."""
    count, all_beds = value.n, len(value.worlds)
    said = f"{count} of {all_beds} beds" if count < all_beds else f"{count} bed{'s' if count != 1 else ''}"
    parts = [said] * bool(all_beds) + [more] * bool(more)
    return f" ({'; '.join(parts)})" if parts else ""
