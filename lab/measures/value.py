"""A measured number with its unit and its errors."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Value:
    """A number a person can use, measured in every world.

    value: mean over the worlds in which it was found, None if in none; std: their sample standard
    deviation, None if found in fewer than two; uncertainty: of one world's measurement, as far as
    the measure knows it; worlds: one number a world, None where not found; note: what a reader must
    know about this run's number.
    """

    value: float | None
    unit: str
    std: float | None = None
    uncertainty: float | None = None
    worlds: tuple[float | None, ...] = ()
    note: str = ""


def over_worlds(
    numbers: Sequence[float],
    unit: str,
    *,
    uncertainties: Sequence[float] = (),
    note: str = "",
    missing: str = "not found",
) -> Value:
    """The Value of one number a world (W,), NaN where there is none, which `missing` explains.

    uncertainties (W,): of each world's number; their root mean square is reported.
    """
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
    )


def _root_mean_square(numbers: np.ndarray) -> float | None:
    numbers = numbers[np.isfinite(numbers)]
    return float(np.sqrt(np.mean(numbers**2))) if len(numbers) else None
