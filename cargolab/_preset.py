"""A preset in Python: checked when it is made and whenever a key is set."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from lab import dotted
from lab.preset.python.written import asked

if TYPE_CHECKING:
    from lab.preset.find import LoadedPreset
    from lab.report.cost import Cost
    from lab.runs.runner import Result
    from lab.sweeps.result import SweepResult


class Preset:
    """An experiment as a checked object: `cargolab.Preset("tilting/quick")`, or a path, a table, a text in TOML.

    Keys are dotted; a value is a text with its unit, a quantity of pint, or a number without unit:
    `preset["grains.diameter"] = "4 mm"`, `preset.changed(material__friction=0.4)`. Reading a key gives its value in SI.
    Every change is checked as a run would check it. Raises cargolab.Error, one sentence, and keeps what it was.
    """

    def __init__(self, of: "str | Path | Mapping | Preset", /, **overrides: object) -> None:
        self._base, changes = asked(of)
        self._changes = changes | dotted(overrides)
        self._loaded = self._load(self._changes)

    def _load(self, changes: Mapping) -> "LoadedPreset":
        from lab.preset.find import load

        return load(self._base, changes)

    def asked(self) -> tuple[str, dict[str, object]]:
        """The name or path that it is made from, and the changes to it."""
        return self._base, dict(self._changes)

    @property
    def name(self) -> str:
        """The name; of a file, its own without the ending."""
        return self._loaded.name

    @property
    def title(self) -> str:
        """The title."""
        return self._loaded.resolved.title

    @property
    def text(self) -> str:
        """The whole preset as TOML, with what it is based on and all changes."""
        return self._loaded.given_text

    @property
    def values(self) -> object:
        """All keys with their defaults, as attributes in SI: `preset.values.grains.diameter`."""
        return self._loaded.resolved

    def __getitem__(self, key: str) -> object:
        """The value of a dotted key in SI; None where it is left out. Raises cargolab.Error for an unknown key."""
        from lab.preset.python.keys import value_of

        return value_of(self._loaded.resolved, key)

    def quantity(self, key: str) -> object:
        """The value of a key as a quantity of pint's application registry."""
        from pint import get_application_registry

        return get_application_registry().Quantity(self[key], self.schema(key)["unit"])

    def __setitem__(self, key: str, value: object) -> None:
        """Set a key, and check the whole. `False` leaves an inherited key out."""
        self.change({key: value})

    def change(self, changes: Mapping | None = None, /, **overrides: object) -> None:
        """Set several keys at once, which may be right only together."""
        given = self._changes | dict(changes or {}) | dotted(overrides)
        self._loaded = self._load(given)
        self._changes = given

    def changed(self, changes: Mapping | None = None, /, **overrides: object) -> "Preset":
        """Another preset with these keys set."""
        return Preset(self, **{**(changes or {}), **overrides})

    def schema(self, key: str = "") -> dict[str, object]:
        """What a key takes: kind, unit, range, words, default and sentence. Without a key, the JSON Schema of all."""
        if key:
            from lab.preset.python.keys import about

            return about(key)
        from lab.preset.editor import json_schema

        return json_schema()

    def keys(self) -> Iterator[str]:
        """The dotted keys that the preset sets."""
        from lab.preset.python.keys import given_keys

        return given_keys(self._loaded.given_text)

    def cost(self) -> "Cost":
        """What a run will cost: particles, steps, memory, seconds. It builds the scene, and runs nothing."""
        from lab.report.cost import cost

        return cost(self._loaded)

    def explain(self) -> str:
        """What is simulated, by which models, and what it will cost."""
        from lab.report.explain import explain

        return explain(self._loaded)

    def run(self, out: Path | str | None = None, **options: object) -> "Result":
        """Run it; `options` as of `cargolab.run`."""
        from lab import run

        return run(self._base, out, **_with(self._changes, options))

    def sweep(self, axes: Mapping, out: Path | str | None = None, **options: object) -> "SweepResult":
        """Run it over a grid; `axes` and `options` as of `cargolab.sweep`."""
        from lab import sweep

        return sweep(self._base, axes, out, **_with(self._changes, options))

    def save(self, path: Path | str) -> Path:
        """Write it as a TOML file, which `cargolab run` takes."""
        from lab.base.files import named, write_text

        path = named(path)
        write_text(path, self.text)
        return path

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Preset) and self.values == other.values

    __hash__ = None

    def __repr__(self) -> str:
        return f"<Preset {self.name}: {self.title}>"

    def _repr_html_(self) -> str:
        from lab.report.notebook import of_preset

        return of_preset(self._loaded)


def _with(changes: Mapping, options: Mapping) -> dict[str, object]:
    return {**changes, **options}
