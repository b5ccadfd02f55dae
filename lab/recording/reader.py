"""Read recordings: the file is checked when it is opened, arrays are read on demand."""

import json
from contextlib import ExitStack
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lab.base.errors import Unusable
from lab.base.trust import attributes, check_recording, finite, of_texts, text, wide
from lab.base.turn import in_turn
from lab.preset.kept.recorded import content
from lab.recording import older
from lab.recording.checks import Checks
from lab.recording.layout import (
    CHECKS,
    FILE_NAME,
    GROUPS,
    PARTS,
    TABLES,
    names_of,
    quantities_of,
    sizes_of,
    tables_of,
)
from lab.recording.opening import opened
from lab.recording.outlines import GROUP, read_outlines
from lab.recording.outlines import TABLES as OF_SHAPES
from lab.recording.tables import Frames, Series, reading
from solvers.machine.quantity import Quantity

if TYPE_CHECKING:
    import xarray

    from lab.preset.schema import Preset
    from lab.recording.contacts.table import Contacts

TABLE_KINDS = dict(zip(TABLES, (Series, Frames, Series), strict=True))


class Recording:
    """A recording opened for reading, a context manager; arrays are read on demand.

    path, folder; name: of the preset; given: its TOML text; preset: the Preset itself, in SI; resolved: the same as
    a table; content: what of it the tables follow from;
    status, created, versions, machine, step (s), wall_s, grain_steps;
    radius (W, n) m, n is 0 without grains; kind (W, n): 0 for the preset's material, then the preset's kinds in order;
    volume (W, n) m² of the particles of water in the plane, air_volume (W, n) of those of air, n is 0 without any;
    outline (m, 2) m; fixed (k, 3): y, z, radius m; open_edges; parts: polylines (m, 2) m by name;
    names: of the gauges of pressure, level and force and of the parts, in the order of their columns, by owner;
    shapes: the Outlines of irregular grains, None if all are discs.
    series: "time" (T,) s and the other quantities by name, whole arrays (T, W, ...).
    frames: "time" (F,) s and the other quantities by name, (F, W, ...), read from the file by indexing:
    `recording.frames["position"][-1]`. quantities: unit, label and axes of each quantity.
    steering: the user's actions as (time (s), control, value in SI), None if the run was not steered.

    Every table ends with its shortest array; with `sound`, before its first damaged row. Raises LabError if the file is
    missing, of another kind or damaged. Damaged rows are reported when they are read.
    """

    def __init__(self, path: Path | str, *, sound: bool = False) -> None:
        self.path = Path(path)
        if self.path.is_dir():
            self.path = self.path / FILE_NAME
        self.folder, self._again = self.path.parent, None
        self._file, self.form = opened(self.path)
        with ExitStack() as otherwise, reading(self.path):
            otherwise.callback(self._file.close)
            self._checked = check_recording(self._file, GROUPS, (PARTS,))
            stored = attributes(self._file)
            self.name, self.status, self.created = (str(stored[name]) for name in ("preset", "status", "created"))
            self.versions = json.loads(stored["versions"])
            self.machine = json.loads(stored["machine"])
            self.step, self.wall_s = float(stored["step"]), float(stored["wall_s"])
            self.grain_steps = int(stored["grain_steps"])
            self.given = self._stored("preset/given", text)
            self.resolved = json.loads(self._stored("preset/resolved", text))
            self.content = content(self.resolved)
            self.radius, self.kind = self._grains()
            self.volume, self.air_volume, self.bulk_volume = map(self._volumes, ("water", "air", "bulk"))
            self.outline, self.fixed = self._stored("tank/outline"), self._stored("tank/fixed")
            self.open_edges = tuple(int(edge) for edge in self._stored("tank/open_edges"))
            self.parts = {name: self._stored(f"{PARTS}/{name}") for name in self._file[PARTS]}
            self.names = names_of(self.content, self.parts)
            shaped = GROUP in self._file
            self.shapes = (
                read_outlines({name: self._stored(f"{GROUP}/{name}") for name in OF_SHAPES}) if shaped else None
            )
            self._check_contents()
            tables = self._tables()
            self.series, self.frames = tables["series"], tables["frames"]
            self._steering = tables.get("steering")
            for table in tables.values() if sound else ():
                table.keep_sound()
            otherwise.pop_all()  # no error: the file stays open

    def _stored(self, name: str, read=lambda data: data[()]) -> object:
        """The content of a data set that does not grow. Raises Unusable if it is damaged."""
        if name not in self._checked:
            raise ValueError(f"{name} is missing")
        try:
            return read(self._checked[name])
        except (OSError, RuntimeError, ValueError) as error:
            raise Unusable(
                f"{self.path}: {name} is damaged, and without it the recording cannot be used: record the run again."
            ) from error

    def _grains(self) -> tuple[np.ndarray, np.ndarray]:
        """Radii (W, n), m, and kinds (W, n) of the grains; n is 0 without grains."""
        if "grains" in self.content.matters:
            return self._stored("grains/radius"), self._stored("grains/kind")
        none = self.content.repeats, 0
        return np.zeros(none), np.zeros(none, dtype=np.uint8)

    def _volumes(self, phase: str) -> np.ndarray:
        """Volumes (W, n), m², of the particles of water or air, or the points of bulk; n is 0 without it."""
        if phase in self.content.matters:
            return self._stored(f"{phase}/volume")
        return np.zeros((len(self.radius), 0))

    def _tables(self) -> dict[str, Frames]:
        """The tables by name. Raises ValueError or KeyError if one is not as the lab writes it."""
        sizes = self.sizes
        wanted = tables_of(self.content, "steering" in self._file)
        found = {}
        for name, known in wanted.items():
            group, checks = self._file[name], None
            if self.form == older.WITHOUT_CHECKS:
                quantities = older.quantities(group, known)
            else:
                checks = Checks(self._file[f"{CHECKS}/{name}"])
                quantities = quantities_of(group, known)
            found[name] = TABLE_KINDS[name](group, quantities, sizes, checks, self.path)
        return found

    def _check_contents(self) -> None:
        """Raise ValueError if something is not as a Recorder writes it."""
        worlds_and_grains, some = self.radius.shape, "grains" in self.content.matters
        wet = "water" in self.content.matters
        sound = {
            "a number of its attributes": all(np.isfinite([self.step, self.wall_s])) and self.step > 0.0,
            "attribute versions": of_texts(self.versions),
            "attribute machine": isinstance(self.machine, dict),
            "preset/resolved": some == self.content.material,
            "grains/radius": finite(self.radius, 2) and (self.radius.size > 0) == some and (self.radius > 0.0).all(),
            "water/volume": finite(self.volume, 2) and (self.volume.size > 0) == wet and (self.volume > 0.0).all(),
            "air/volume": finite(self.air_volume, 2) and (self.air_volume > 0.0).all(),
            "bulk/volume": finite(self.bulk_volume, 2) and (self.bulk_volume > 0.0).all(),
            "the number of worlds": len({len(v) for v in (self.radius, self.volume, self.air_volume, self.bulk_volume)})
            < 2,
            "grains/kind": self.kind.shape == worlds_and_grains and self.kind.dtype == np.uint8,
            "shapes/which": self.shapes is None or self.shapes.which.shape == worlds_and_grains,
            "tank/outline": finite(self.outline, 2, columns=2) and len(self.outline) > 2 and wide(self.outline),
            "tank/fixed": finite(self.fixed, 2, columns=3),
            "tank/open_edges": all(0 <= edge < len(self.outline) for edge in self.open_edges),
            "tank/parts": all(finite(line, 2, columns=2) and len(line) > 1 for line in self.parts.values()),
        }
        for name, is_sound in sound.items():
            if not is_sound:
                raise ValueError(f"{name} is not what the lab writes there")

    @cached_property
    def preset(self) -> "Preset":
        """The preset, with what follows from its keys. Raises Unusable if it is none."""
        from lab.preset.recorded import from_table  # loads the solvers, which arrays do not need

        with reading(self.path):
            return from_table(self.resolved)

    @property
    def sizes(self) -> dict[str, int]:
        """How many worlds, grains, particles, parts and gauges there are, by the owners of quantities."""
        return sizes_of(self.names, self.radius, self.volume, self.air_volume, self.bulk_volume)

    @property
    def version(self) -> str:
        """The version of the lab that began it, "unknown" if the file does not say."""
        return self.versions.get("cargo-shift-lab", "unknown")

    @property
    def quantities(self) -> dict[str, Quantity]:
        """The quantities of the series and of the frames, by name."""
        return {**self.series.quantities, **self.frames.quantities}

    def tree(self) -> "xarray.DataTree":
        """All that is recorded as one tree of labelled data: `tree["series"]["wall_force"]`, `tree["frames/position"]`.

        Nodes are series, frames, tank and each matter; axes and coordinates as of `labelled`. What is in the tables is
        read, and checked, where it is asked for, so the recording must stay open. Raises LabError then for rows that
        are damaged.
        """
        from lab.recording.tree.nodes import tree

        return tree(self)

    def labelled(self, frames: slice | None = None) -> "xarray.Dataset":
        """The series, or the given frames, as arrays with named axes, units and labels.

        Axes are time, world, grain, water_particle, air_particle, part, gauge, level and edge; components lie along
        `axis` (y, z), `freedom` (y, z, roll) or NAME_component. Raises LabError if the rows are damaged.
        """
        from lab.recording.labelled import labelled

        return labelled(self, frames)

    @in_turn
    def contacts(self, frame: int = -1, world: int = 0) -> "Contacts":
        """The contacts of the grains of a bed in a frame, and their forces, found again from places.

        Who touches what, where, which way and how hard (`table`, `write`, `labelled`), the stress in grains and their
        coordination number. Raises NotRecorded without grains or frames, LabError where grains lie in each other.
        """
        from lab.recording.contacts.table import again_of, contacts_of  # with Taichi, which finds them

        if self._again is None:
            self._again = again_of(self)
        return contacts_of(self, self._again, frame, world)

    @property
    def steering(self) -> list[tuple[float, str, float]] | None:
        """The user's actions in order, None if the run was not steered."""
        if self._steering is None:
            return None
        time, name, value = (self._steering[column].tolist() for column in ("time", "name", "value"))
        return [(t, word.decode(errors="replace"), v) for t, word, v in zip(time, name, value, strict=True)]

    @property
    def worlds(self) -> int:
        """W, the number of worlds."""
        return len(self.radius)

    @property
    def mean_diameter(self) -> np.ndarray:
        """Mean grain diameter of each world (W,), m."""
        return 2.0 * self.radius.mean(axis=1)

    @property
    def complete(self) -> bool:
        """Whether the run reached its end."""
        return self.status == "complete"

    def layout(self, name: str) -> tuple[tuple[int, ...], np.dtype]:
        """Shape and data type of a data set as stored in the file."""
        with reading(self.path):
            data = self._file[self.stored_as(name)]
            return data.shape, data.dtype

    def stored_as(self, name: str) -> str:
        """The path of a data set in the file, where one of an earlier format may have another name."""
        group, _, column = name.rpartition("/")
        return f"{group}/{older.stored(self._file[group]).get(column, column)}"

    def close(self) -> None:
        """Close the file; arrays that were not read before can no longer be read."""
        if self._again is not None:
            self._again.close()
            self._again = None
        self._file.close()

    def __repr__(self) -> str:
        from lab.recording.tree.shown import line

        return line(self)

    def _repr_html_(self) -> str:
        from lab.recording.tree.shown import html

        return html(self)

    def __enter__(self) -> "Recording":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def open_recording(path: Path | str, *, sound: bool = False) -> Recording:
    """Open a recording by its file or its run's folder. Raises LabError (see `Recording`)."""
    return Recording(path, sound=sound)
