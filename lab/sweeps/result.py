"""The result of a sweep: a row of numbers for each point, and the same as labelled data over the sweep's axes."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lab.base.errors import LabError
from lab.base.notebook import html
from lab.base.text import one_line
from lab.measures.value import Value
from lab.preset.python.keys import about, value_of
from lab.report.notebook import WithPictures
from lab.report.numbers import number
from lab.report.summary import headlines
from lab.sweeps.grid import Sweep, read_sweep
from lab.sweeps.point import Point

if TYPE_CHECKING:
    import pandas
    import xarray

QUANTITY = re.compile(r"([-+.0-9eE]+)\s*(\D.*)?")
SHOWN = 4  # measures in a table of a notebook
DIAMETERS = "d"  # the unit of a length in mean diameters of the grains, which for pint were days

Row = dict[str, object]


@dataclass(repr=False)
class SweepResult(WithPictures):
    """The result of a sweep: its folder, a row of numbers for each point, and the folders of the points' runs."""

    folder: Path
    rows: list[dict[str, object]] = field(repr=False)
    summary_text: str = field(repr=False)

    @cached_property
    def points(self) -> list[Path]:
        """The folder of each point's run, in the order of the rows."""
        return [point_folder(self.folder, number) for number in range(len(self.rows))]

    def dataset(self) -> "xarray.Dataset":
        """The measures over the swept keys: of each its mean over beds `NAME`, `NAME_std` and `NAME_n`.

        Coordinates are the keys, in SI where they are numbers; a measure's own uncertainty is `NAME_uncertainty`. Where
        a point has no such number it is NaN, its `n` is 0, and `status` says why. Raises LabError.
        """
        sweep = read_sweep(self.folder)
        return dataset(sweep, _points(sweep, self.folder))

    def frame(self) -> "pandas.DataFrame":
        """The same as a table of pandas, a row a point; `frame.attrs["units"]` has the units of its columns."""
        found = self.dataset()
        frame = found.to_dataframe().reset_index()
        frame.attrs["units"] = {
            name: found[name].attrs["units"] for name in frame.columns if "units" in found[name].attrs
        }
        return frame

    def __repr__(self) -> str:
        return f"<SweepResult of {len(self.rows)} points in {self.folder}>"

    def _repr_html_(self) -> str:
        sweep = read_sweep(self.folder)
        points = _points(sweep, self.folder)
        shown = headlines({key: value for point in points for key, value in point.measures.items()}, SHOWN)
        heads = [*sweep.axes, *(key.replace("_", " ") for key in shown), "status"]
        rows = (
            [
                *map(one_line, point.setting.values()),
                *(number(point.measures[key]) if key in point.measures else "" for key in shown),
                point.status,
            ]
            for point in points
        )
        return html.titled(f"Sweep of {sweep.name}", html.paragraph(self.folder), html.table(heads, rows))


def point_folder(folder: Path, number: int) -> Path:
    """The folder of a point's run."""
    return folder / "points" / f"{number:03}"


def _points(sweep: Sweep, folder: Path) -> list[Point]:
    return [Point(setting, point_folder(folder, number)) for number, setting in enumerate(sweep.settings)]


def dataset(sweep: Sweep, points: Sequence[Point]) -> "xarray.Dataset":
    """The measures of the points of a sweep over its axes (see `SweepResult.dataset`)."""
    import xarray  # slow to import

    axes, shape = tuple(sweep.axes), tuple(map(len, sweep.axes.values()))

    def grid(values: Sequence, **attributes: object) -> tuple:
        return axes, np.array(values).reshape(shape), attributes

    measures = {key: value for point in points for key, value in point.measures.items()}
    variables = {"status": grid([point.status for point in points], long_name="status of the run")}
    for name, known in measures.items():
        found = [point.measures.get(name) or Value(None, known.unit) for point in points]
        said, units = name.replace("_", " "), _units(known.unit)
        own = {"std": "standard deviation over beds"} | ({"uncertainty": known.kind} if known.kind else {})
        variables[name] = grid([_number(one.value) for one in found], long_name=said, **units)
        for part, what in own.items():
            values = [_number(getattr(one, part)) for one in found]
            variables[f"{name}_{part}"] = grid(values, long_name=f"{what} of {said}", **units)
        variables[f"{name}_n"] = grid([one.n for one in found], long_name=f"number of beds of {said}")
    coordinates = {key: (key, *_axis(sweep, key)) for key in axes}
    return xarray.Dataset(variables, coordinates, {"preset": sweep.name})


def _number(value: float | None) -> float:
    return np.nan if value is None else float(value)


def _units(unit: str) -> dict[str, str]:
    """The attributes that say the unit of a measure, one that pint reads."""
    if unit == DIAMETERS:
        return {"units": "1", "relative_to": "mean diameter of the grains"}
    return {"units": unit or "1"}


def _axis(sweep: Sweep, key: str) -> tuple[np.ndarray, dict[str, object]]:
    """The values of a swept key, numbers in SI where all are numbers, else as they were asked for; attributes."""
    step = int(np.prod([len(values) for values in list(sweep.axes.values())[list(sweep.axes).index(key) + 1 :]]))
    asked = sweep.axes[key]
    try:
        told = about(key)
        found = [value_of(sweep.points[k * step].resolved, key) for k in range(len(asked))]
    except LabError:  # a key of an earlier version
        told, found = {}, [None]
    attributes = {"long_name": str(told.get("sentence", key))}
    if all(isinstance(one, int | float) and not isinstance(one, bool) for one in found):
        return np.array(found), attributes | {"units": told["unit"] or "1"}
    said = [one if isinstance(one, str) else json.dumps(one) for one in asked]
    return np.array([*map(one_line, said)], dtype=str), attributes


def numeric(values: Sequence) -> tuple[np.ndarray, str] | None:
    """Values of a key as numbers with their common unit ("" for none), or None if they are not of this kind."""
    numbers, units = [], set()
    for value in values:
        found = QUANTITY.fullmatch(value) if isinstance(value, str) else None
        if isinstance(value, bool) or not (found or isinstance(value, int | float)):
            return None
        try:
            numbers.append(float(found[1] if found else value))
        except ValueError:  # 1-2
            return None
        units.add((found[2] or "") if found else "")
    return (np.array(numbers), units.pop()) if len(units) == 1 else None


def table(axes: Mapping[str, Sequence], points: Sequence[Point], folder: Path) -> list[Row]:
    """One row per point: the swept keys in their units, status, and mean, std, n, own uncertainty of each measure."""
    scales = {key: numeric(values) for key, values in axes.items()}
    measures = {key: value for point in points for key, value in point.measures.items()}
    rows = []
    for k, point in enumerate(points):
        row: Row = {"point": k, "folder": point.folder.relative_to(folder).as_posix(), "status": point.status}
        for key, value in point.setting.items():
            scale = scales[key]
            unit = f" ({scale[1]})" if scale and scale[1] else ""
            row[key + unit] = float(numeric([value])[0][0]) if scale and isinstance(value, str) else _plain(value)
        for key, known in measures.items():
            value = point.measures.get(key) or Value(None, known.unit)
            row[key if known.unit == "1" else f"{key} ({known.unit})"] = value.value
            row[f"{key} std"], row[f"{key} n"] = value.std, value.n
            if known.kind:
                row[f"{key} {known.kind} uncertainty"] = value.uncertainty
        rows.append(row)
    return rows


def _plain(value: object) -> object:
    """A value of a key as a text or a number."""
    return value if isinstance(value, str | int | float) else json.dumps(value)
