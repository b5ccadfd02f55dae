"""What is asked of a voyage: a preset's ship and cargo, a sea, how long, and how many seeds of it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi

from lab.base.errors import LabError
from lab.preset.find import LoadedPreset, load
from lab.preset.units import show
from lab.sweeps.grid import Sweep
from lab.voyage.groups import worst_group

HOUR = 3600.0
AXIS = "waves.seed"
MOST_SEEDS = 1000


@dataclass(frozen=True)
class Voyage:
    """A ship with her cargo in `hours` of a random sea of significant `height` (m) and peak `period` (s).

    Each of the `seeds` is a sea of its own, of which the `span` (s) round its worst group is run (`groups`). A list is
    counted from `limit` (deg) on.
    """

    preset: str
    height: float
    period: float
    hours: float = 3.0
    span: float = 600.0
    seeds: int = 20
    limit: float = 5.0
    overrides: Mapping[str, object] = field(default_factory=dict)

    def __post_init__(self):
        if self.seeds < 2 or self.seeds > MOST_SEEDS:
            raise LabError(f"--seeds: {self.seeds} is not from 2 to {MOST_SEEDS}.")
        if self.span > self.hours * HOUR:
            raise LabError(
                f"--span: {show(self.span, 's')} is longer than the sea, {self.hours:g} h; take a longer sea."
            )

    @property
    def sea(self) -> dict[str, object]:
        """The keys of a preset that give it this sea, for one run of the span."""
        waves = {"kind": "jonswap", "height": f"{self.height!r} m", "frequency": f"{2.0 * pi / self.period!r} rad/s"}
        others = {"amplitude": False, "spread": False, "time": False}  # of other kinds of waves
        keys = {f"waves.{key}": value for key, value in (waves | others).items()}
        return keys | {"run.duration": f"{self.span!r} s", "run.repeats": 1}

    def point(self, seed: int) -> LoadedPreset:
        """The run of a seed. Raises LabError."""
        keys = {**self.overrides, **self.sea, AXIS: seed}
        _check(load(self.preset, self.overrides))
        whole = load(self.preset, keys)
        begin = worst_group(whole.resolved, self.hours * HOUR, self.span)
        return load(self.preset, keys | {"waves.begin": f"{begin!r} s"})

    def sweep(self) -> Sweep:
        """The runs of all seeds. Raises LabError."""
        seeds = list(range(1, self.seeds + 1))
        points = [self.point(seed) for seed in seeds]
        return Sweep(points[0].name, {AXIS: seeds}, points)


def _check(loaded: LoadedPreset) -> None:
    """Raise LabError unless a preset is a ship's with loose cargo."""
    preset = loaded.resolved
    if preset.ship is None or preset.sea is None:
        raise LabError(f"{loaded.name}: has no ship in a sea; `cargolab list ship` names those that have.")
    if preset.bulk is None and preset.grains is None:
        raise LabError(f"{loaded.name}: its ship carries no loose cargo; give it [bulk] or [grains].")
