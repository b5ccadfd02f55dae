"""A ship by her file: hull, tanks, holds, and each loading condition as a ship that can be judged."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from lab.naval.hull import Hull, read_hull
from lab.naval.loaded import HEELS, Loaded, Wind
from lab.naval.ship_file import items
from lab.naval.ship_file.items import Cargo, Item, Liquid
from lab.naval.ship_file.keys import ConditionKeys, ShipKeys, WindKeys
from lab.naval.ship_file.reading import Source, load_keys
from lab.naval.ship_file.spaces import check_apart, members, spaces, unknown
from lab.naval.surfaces.axes import Axes
from lab.naval.weights import Weights
from solvers.ship.naval.compartments.compartment import Compartment
from solvers.ship.naval.curve import Levers
from solvers.ship.naval.form import Form
from solvers.ship.water import Water


@dataclass(frozen=True, eq=False)
class Condition(Loaded):
    """A loading condition: what `Loaded` is, and what she carries: fixed weights, liquids, cargo.

    With `by_transfer` her levers lose the actual transfer of the liquids at each heel; without it KG is raised by the
    second moments of their free surfaces, as in GM fluid (2008 IS Code, part B 3.1, for the effect).
    """

    name: str = ""
    title: str = ""
    fixed: tuple[Item, ...] = ()
    liquids: tuple[Liquid, ...] = ()
    cargo: tuple[Cargo, ...] = ()
    by_transfer: bool = False

    @property
    def items(self) -> list[Item]:
        """All that she weighs, a row each."""
        return [*self.fixed, *(one.item for one in self.liquids), *(one.item for one in self.cargo)]

    def transfer(self, heel: np.ndarray) -> np.ndarray:
        """Moment (t m) of the liquids' transfer at heels (rad), positive starboard down."""
        return sum((one.transfer(heel) for one in self.liquids), np.zeros(np.shape(heel)))

    @cached_property
    def starboard(self) -> Levers:
        """Righting levers (m) over `HEELS`, positive starboard down, corrected for free surfaces."""
        if not self.by_transfer:
            return self._raised(self.weights)
        still = sum(one.fsm for one in self.fixed)  # given as a moment: they can only raise KG
        solid = self._raised(replace(self.weights, free_surface=still))
        return Levers(HEELS, solid.lever - self.transfer(HEELS) / self.weights.mass)

    def _raised(self, weights: Weights) -> Levers:
        """Levers (m) with KG raised by the free surfaces of these weights."""
        gravity = weights.tcg, weights.fluid_vcg
        port = self.form.righting_levers(weights.mass, self.water, HEELS, gravity, weights.lcg)
        return Levers(HEELS, -port[::-1])


@dataclass(frozen=True, eq=False)
class Ship(Hull):
    """A hull with tanks and holds by name, and loading conditions by name."""

    title: str = ""
    tanks: Mapping[str, Compartment] = field(default_factory=dict)
    holds: Mapping[str, Compartment] = field(default_factory=dict)
    conditions: Mapping[str, Condition] = field(default_factory=dict)
    densities: Mapping[str, float] = field(default_factory=dict)
    keys: ShipKeys | None = None
    source: Source | None = None


def read_ship(path: Path | str) -> Ship:
    """The ship of a ship file, or of the folder with a ship.toml. Raises LabError, with line and key."""
    keys, source = load_keys(Path(path))
    hull = _hull(keys, source)
    tanks = spaces("tanks", keys.tanks, hull.form, source)
    holds = spaces("holds", keys.holds, hull.form, source)
    check_apart(
        {f"tanks.{name}": one for name, one in tanks.items()} | {f"holds.{name}": one for name, one in holds.items()},
        source,
    )
    fixed = [items.weight(name, one, f"weights.{name}", source) for name, one in keys.weights.items()]
    densities = {
        name: items.density_of(one.density) for given, one in keys.tanks.items() for name in members(given, tanks)
    }
    maker = _Maker(keys, source, hull.form, tanks, holds, fixed)
    conditions = {name: maker.condition(name, one) for name, one in keys.conditions.items()}
    return Ship(
        hull.name, hull.form, hull.water, hull.mesh, keys.name, tanks, holds, conditions, densities, keys, source
    )


def _hull(keys: ShipKeys, source: Source) -> Hull:
    """Her hull; a path in the file is relative to the file's folder."""
    given = keys.hull
    axes = Axes(given.scale, given.up, given.origin, given.mirror, given.close)
    lines = source.path.parent / given.lines
    how = {"fair": given.fair, "stations": given.stations, "lbp": given.lbp, "lwl": given.lwl, "ap": given.ap}
    if not lines.is_file():
        raise source.error("hull.lines", f"there is no file {given.lines} beside the ship file; look at its name.")
    with source.told("hull.lines"):
        return read_hull(lines, density=items.density_of(keys.water.density), axes=axes, **how)


@dataclass(frozen=True, eq=False)
class _Maker:
    """What conditions are made from."""

    keys: ShipKeys
    source: Source
    form: Form
    tanks: Mapping[str, Compartment]
    holds: Mapping[str, Compartment]
    fixed: list[Item]

    def condition(self, name: str, given: ConditionKeys) -> Condition:
        """A condition, which must float."""
        key = f"conditions.{name}"
        further = [
            items.weight(one, weight, f"{key}.weights.{one}", self.source) for one, weight in given.weights.items()
        ]
        fixed = (*self.fixed, *further)
        liquids, cargo = tuple(self._liquids(given, key)), tuple(self._cargo(given, key))
        carried = [*fixed, *(one.item for one in liquids), *(one.item for one in cargo)]
        if not sum(one.mass for one in carried) > 0.0:
            raise self.source.error(key, "she weighs nothing; give her weights.")
        water = Water(items.density_of(self.keys.water.density if given.density is None else given.density))
        found = Condition(
            self.form,
            water,
            items.total(carried),
            self._points(),
            tuple(one.grain for one in cargo if one.grain is not None),
            self._wind(given.wind or self.keys.wind),
            self.keys.hull.lwl,
            self._openings(),
            name,
            given.title,
            fixed,
            liquids,
            cargo,
            self.keys.free_surfaces == "transfer",
        )
        with self.source.told(key):
            _ = found.level  # she floats
        return found

    def _liquids(self, given: ConditionKeys, key: str) -> list[Liquid]:
        found: dict[str, Liquid] = {}
        for name, fill in given.fills.items():
            where = f"{key}.fills.{name}"
            for tank in self._known(name, self.tanks, "tank", where, found):
                keys = self.keys.tanks[tank if tank in self.keys.tanks else tank[:-2]]
                found[tank] = items.liquid(tank, self.tanks[tank], keys, fill, where, self.source)
        return list(found.values())

    def _cargo(self, given: ConditionKeys, key: str) -> list[Cargo]:
        found: dict[str, Cargo] = {}
        for name, one in given.cargo.items():
            where = f"{key}.cargo.{name}"
            for hold in self._known(name, self.holds, "hold", where, found):
                found[hold] = items.cargo(hold, self.holds[hold], one, where, self.source)
        return list(found.values())

    def _known(self, name: str, known: Mapping, what: str, where: str, taken: Mapping) -> list[str]:
        """The spaces that a name means. Raises LabError for none, or one that has been filled."""
        found = members(name, known)
        if not found:
            raise self.source.error(where, unknown(known, what))
        if twice := next((one for one in found if one in taken), None):
            raise self.source.error(where, f"{twice} is filled already by its pair's name; leave one of them out.")
        return found

    def _points(self) -> dict[str, np.ndarray]:
        """Points (n, 3) m by kind."""
        found: dict[str, list] = {}
        for one in self.keys.openings.values():
            found.setdefault(one.kind, []).append(one.place)
        return {kind: np.array(places) for kind, places in found.items()}

    def _openings(self) -> tuple[str, ...]:
        """The names of the points that are openings, in their order."""
        return tuple(name for name, one in self.keys.openings.items() if one.kind == "opening")

    def _wind(self, given: WindKeys | None) -> Wind | None:
        hull = self.keys.hull
        return None if given is None else Wind(given.area, given.lever, hull.keels, hull.sharp)
