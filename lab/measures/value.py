"""A measured number with its unit, its scatter over beds and the uncertainty of its own measurement."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from lab.base.errors import LabError
from lab.base.notebook.html import paragraph, table, titled
from lab.base.text import one_line
from lab.measures.written import number

LEVEL = 0.95  # of intervals

HEADS = "measure", "mean ± std over beds", "note"

NAME = re.compile(r"[A-Za-z0-9_]{1,60}")


@dataclass(frozen=True, repr=False)
class Value:
    """A measured number. Every world of a run is one bed, and the number is measured in each of them.

    value: mean over the worlds in which it was found, None if in none; std: their sample standard
    deviation, None if found in fewer than two; uncertainty: of the measurement in one world, if the measure
    knows it, and `kind` its name, one of KINDS (see docs/numbers.md). It does not tell how far beds differ.
    worlds: one number for each world, None where not found; note: what a reader must know about this number.
    """

    value: float | None
    unit: str
    std: float | None = None
    uncertainty: float | None = None
    worlds: tuple[float | None, ...] = ()
    note: str = ""
    kind: str = ""

    @property
    def n(self) -> int:
        """Number of beds in which it was found."""
        return sum(world is not None for world in self.worlds)

    @property
    def standard_error(self) -> float | None:
        """Of the mean over beds; None with fewer than two."""
        return None if self.std is None or self.n < 2 else self.std / self.n**0.5

    @property
    def interval(self) -> tuple[float, float] | None:
        """Confidence interval of the mean over beds, at LEVEL (Student 1908); None with fewer than two beds."""
        if self.standard_error is None or self.value is None:
            return None
        half = half_width(self.standard_error, self.n - 1)
        return self.value - half, self.value + half

    def __str__(self) -> str:
        """As the lab writes it: "31.6 ± 4.0 deg (11 beds)"."""
        return number(self)

    def __repr__(self) -> str:
        return f"<Value {one_line(self)}>"

    def _repr_html_(self) -> str:
        return titled(one_line(self), *([paragraph(self.note)] if self.note else []))

    def as_json(self) -> dict[str, object]:
        """For summary.json; docs/numbers.md says what each key is."""
        return {
            "value": self.value,
            "unit": self.unit,
            "std": self.std,
            "n": self.n,
            "standard_error": self.standard_error,
            "interval_95": None if self.interval is None else list(self.interval),
            "uncertainty": self.uncertainty,
            "uncertainty_kind": self.kind,
            "worlds": list(self.worlds),
            "note": self.note,
        }

    @classmethod
    def from_json(cls, data: Mapping) -> "Value":
        """The inverse of `as_json`. Raises ValueError, KeyError or TypeError for data of another form."""
        worlds, kind, note = tuple(data["worlds"]), data.get("uncertainty_kind") or "", data.get("note", "")
        numbers = data["value"], data["std"], data["uncertainty"], *worlds
        if not all(isinstance(x, int | float | None) for x in numbers):
            raise ValueError("a measure has a value that is no number")
        if not all(isinstance(text, str) for text in (data["unit"], note, kind)):
            raise ValueError("a measure has a unit or a note that is no text")
        return cls(data["value"], data["unit"], data["std"], data["uncertainty"], worlds, note, kind)


class NotMeasured(LabError, KeyError):
    """A run has no such measure. Also a KeyError, so that `get` and `in` work."""

    __str__ = Exception.__str__  # a KeyError would put its sentence in quotes


class Measures(dict[str, Value]):
    """The measures of a run by name; a name may be written as the lab prints it, "critical angle"."""

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        lines = [f"{one_line(name.replace('_', ' ')):<{width}}  {one_line(value)}" for name, value in self.items()]
        return "\n".join(lines) or "no measures"

    def _repr_html_(self) -> str:
        return table(HEADS, ((name, value, value.note) for name, value in self.items()))

    def __missing__(self, name: object) -> Value:
        """The measure of a name with blanks. Raises NotMeasured, which names those that there are."""
        plain = str(name).replace(" ", "_")
        if plain != name and plain in self:
            return self[plain]
        near = get_close_matches(plain[:100], self, n=1)
        has = f"did you mean {near[0]}?" if near else f"it has {', '.join(self) or 'none'}."
        raise NotMeasured(f"this run has no measure {str(name)[:100]!r}; {has}")


# Kinds of a measure's own uncertainty, and what each is.
KINDS = {
    "detector": "how far from the onset of a step its detector may have found it",
    "fit": "half the 68 % confidence interval of a line fitted to one bed",
    "averaging": "standard error of a mean over time, from the means of blocks of it",
    "cycles": "standard error of a mean over cycles, from their scatter",
    "halves": "half the difference between the two halves of the time looked at",
    "coherence": "standard error of a transfer function, from its coherence and the number of independent pieces",
    "resolution": "half the distance to the next value that the samples can tell apart",
    "sampling": "standard error of a share of points drawn at random",
    "creep": "how far the bed still moves where the number is read",
}


def half_width(error: float, freedom: float) -> float:
    """Half the confidence interval at LEVEL, from a standard error and its degrees of freedom (Student)."""
    from scipy.special import stdtrit  # slow to import

    return float(stdtrit(freedom, 0.5 + 0.5 * LEVEL)) * error


def read_values(table: Mapping) -> dict[str, Value]:
    """The measures of a summary.json by name. Raises ValueError, KeyError or TypeError for data of another form."""
    if not all(NAME.fullmatch(name) for name in table):  # files are named after them
        raise ValueError("a measure has a name that none has")
    return {name: Value.from_json(data) for name, data in table.items()}


def over_worlds(
    numbers: Sequence[float],
    unit: str,
    *,
    uncertainties: Sequence[float] = (),
    kind: str = "",
    note: str = "",
    missing: str = "not found",
) -> Value:
    """The Value of one number for each world (W,); NaN where it was not found, for which `missing` gives the reason.

    uncertainties (W,): of each world's number, all of one `kind`; their root mean square is reported.
    Raises ValueError for uncertainties without a kind.
    """
    if len(uncertainties) and kind not in KINDS:
        raise ValueError(f"the uncertainty of a measure needs its kind, one of {', '.join(KINDS)} (got {kind!r})")
    numbers = np.asarray(numbers, dtype=float)
    found = np.isfinite(numbers)
    worlds = tuple(float(x) if ok else None for x, ok in zip(numbers, found, strict=True))
    notes = [note] if note else []
    if not found.all():
        lost = f" in {np.sum(~found)} of {len(found)} worlds" if len(found) > 1 else ""
        notes.append(missing + lost)
    return Value(
        value=float(numbers[found].mean()) if found.any() else None,
        unit=unit,
        std=float(numbers[found].std(ddof=1)) if found.sum() > 1 else None,
        uncertainty=_root_mean_square(np.asarray(uncertainties, dtype=float)),
        worlds=worlds,
        note="; ".join(notes),
        kind=kind,
    )


def _root_mean_square(numbers: np.ndarray) -> float | None:
    numbers = numbers[np.isfinite(numbers)]
    return float(np.sqrt(np.mean(numbers**2))) if len(numbers) else None
