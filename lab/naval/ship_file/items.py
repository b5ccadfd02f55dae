"""What a ship carries in a loading condition, a row each: fixed weights, liquids in tanks, cargo in holds."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from lab.naval.ship_file.keys import CargoKeys, FillKeys, TankKeys, WeightKeys
from lab.naval.ship_file.reading import Source
from lab.naval.stowed import Stowed
from lab.naval.weights import Weights
from solvers.machine.errors import Unavailable
from solvers.ship.naval.compartments.compartment import FULL, NOMINALLY_FULL, Compartment
from solvers.ship.naval.form import TONNE
from solvers.ship.naval.grain_code import ASSUMED

WATERS = {"salt": 1025.0, "fresh": 1000.0}  # kg/m³
AMOUNTS = "full", "mass", "level"
STRIPS = 40  # blocks that stand for a weight whose density rises or falls along her
AGREE = 1e-3  # by so much two statements of one mass (share) or place (m) may differ

Block = tuple[float, float, float]


@dataclass(frozen=True)
class Item:
    """A weight: mass (t), centre (m), moment of its free surface (t m).

    `spread`: its blocks along her, each from x to x (m) with a mass (t) laid evenly; none of a weight at a point.
    """

    name: str
    mass: float
    lcg: float
    tcg: float
    vcg: float
    fsm: float = 0.0
    spread: Sequence[Block] = ()


@dataclass(frozen=True, eq=False)
class Liquid:
    """The liquid in a tank: volume (m³), density (kg/m³).

    `surface` is the volume (m³) whose free surface counts: its own, or in a tank that is emptied on the way that with
    the largest one (2008 IS Code, part B 3.1.3).
    """

    tank: str
    space: Compartment
    volume: float
    density: float
    surface: float

    @property
    def level(self) -> float:
        """Height z (m) of its surface upright."""
        return float(self.space.level_of(self.volume))

    @property
    def share(self) -> float:
        """Share of the tank that is filled."""
        return self.volume / self.space.volume

    @property
    def moves(self) -> bool:
        """Whether it has a free surface that counts."""
        return self.volume > 0.0 and 0.0 < self.surface < NOMINALLY_FULL * self.space.volume

    @property
    def fsm(self) -> float:
        """Upright moment ρ i (t m) of its free surface."""
        return self.density / TONNE * self.space.second_moment(self.surface) if self.moves else 0.0

    def transfer(self, heel: np.ndarray) -> np.ndarray:
        """Moment (t m) of the actual transfer of the liquid at heels (rad), positive starboard down."""
        heel = np.asarray(heel, dtype=float)
        return self.density / TONNE * self.space.transfer(self.surface, heel) if self.moves else np.zeros(heel.shape)

    @property
    def item(self) -> Item:
        """Its weight."""
        mass, centre = self.volume * self.density / TONNE, self.space.centre(self.volume)
        spread = [(aft, forward, share * mass) for aft, forward, share in self.space.parts(self.volume)]
        return Item(self.tank, mass, *(float(one) for one in centre), self.fsm, spread)


@dataclass(frozen=True, eq=False)
class Cargo:
    """The cargo in a hold: volume (m³), stowage factor (m³/t), its weight, and its grain if it is that."""

    hold: str
    space: Compartment
    volume: float
    level: float
    item: Item = field(repr=False)
    grain: Stowed | None = None


def weight(name: str, keys: WeightKeys, key: str, source: Source) -> Item:
    """A fixed weight. Raises LabError where mass, place and distribution do not agree."""
    if keys.distribution:
        return _distributed(name, keys, key, source)
    if keys.mass is None:
        raise source.error(key, "has no mass; give mass (t), or distribution.")
    if (keys.aft is None) != (keys.forward is None):
        raise source.error(key, "is spread from aft to forward; give both, or none of them.")
    if keys.aft is None:
        if keys.lcg is None:
            raise source.error(key, "has no place along her; give lcg, or aft and forward.")
        return Item(name, keys.mass, keys.lcg, keys.tcg, keys.vcg, keys.fsm)
    if not keys.aft < keys.forward:
        raise source.error(f"{key}.forward", f"{keys.forward:g} m must be forward of aft, {keys.aft:g} m.")
    middle = 0.5 * (keys.aft + keys.forward)
    lcg = middle if keys.lcg is None else keys.lcg
    return Item(name, keys.mass, lcg, keys.tcg, keys.vcg, keys.fsm, _trapezoid(keys, lcg - middle, key, source))


def _trapezoid(keys: WeightKeys, off: float, key: str, source: Source) -> list[Block]:
    """Blocks of a weight whose density is linear from aft to forward, with its centre `off` (m) the middle.

    w(s) = m/l (1 + 12 off s/l²), s from the middle: never negative while |off| ≤ l/6.
    """
    aft, forward, mass = keys.aft, keys.forward, keys.mass
    long = forward - aft
    if abs(off) <= AGREE:
        return [(aft, forward, mass)]
    if abs(off) > long / 6.0:
        raise source.error(
            f"{key}.lcg",
            f"lies {abs(off):.4g} m from the middle of aft and forward, and no weight spread between them has it more "
            f"than a sixth of their distance away, {long / 6.0:.4g} m; give distribution.",
        )
    ends = np.linspace(aft, forward, STRIPS + 1)
    places = 0.5 * (ends[1:] + ends[:-1]) - 0.5 * (aft + forward)
    masses = mass / STRIPS * (1.0 + 12.0 * off * places / long**2)
    masses *= mass / masses.sum()
    return list(zip(ends[:-1].tolist(), ends[1:].tolist(), masses.tolist(), strict=True))


def _distributed(name: str, keys: WeightKeys, key: str, source: Source) -> Item:
    """A weight of blocks along her."""
    for k, (aft, forward, _) in enumerate(keys.distribution):
        if not aft < forward:
            raise source.error(f"{key}.distribution[{k}]", f"{forward:g} m must be forward of {aft:g} m.")
    mass = sum(block[2] for block in keys.distribution)
    if not mass > 0.0:
        raise source.error(f"{key}.distribution", "adds up to nothing; give blocks of aft, forward and mass.")
    lcg = sum(0.5 * (aft + forward) * one for aft, forward, one in keys.distribution) / mass
    for told, found, what in ((keys.mass, mass, "t"), (keys.lcg, lcg, "m")):
        slack = AGREE * (mass if what == "t" else 1.0)
        if told is not None and abs(told - found) > slack:
            word = "mass" if what == "t" else "lcg"
            raise source.error(
                f"{key}.{word}",
                f"is {told:g} {what}, and its distribution has {found:.6g} {what}; leave one of them out.",
            )
    return Item(name, mass, lcg, keys.tcg, keys.vcg, keys.fsm, keys.distribution)


def liquid(tank: str, space: Compartment, keys: TankKeys, fill: FillKeys, key: str, source: Source) -> Liquid:
    """What is in a tank. Raises LabError for an amount that it does not hold."""
    density = density_of(keys.density if fill.density is None else fill.density)
    volume = _volume(space, fill, TONNE / density, key, source)
    return Liquid(tank, space, volume, density, space.freest_volume if keys.consumable else volume)


def cargo(hold: str, space: Compartment, keys: CargoKeys, key: str, source: Source) -> Cargo:
    """What is in a hold. Raises LabError for an amount that it does not hold.

    The centre of a `filled` hold is that of the hold's whole volume, with which the Grain Code's factor of 1.00 goes.
    """
    volume = _volume(space, keys, keys.stowage, key, source)
    if keys.moment is not None and keys.filling == "no-grain":
        raise source.error(f"{key}.moment", "is of grain; give another filling, or leave it out.")
    mass = volume / keys.stowage
    centre = space.centre(space.volume if keys.filling == "filled" and volume > 0.0 else volume)
    spread = [(aft, forward, share * mass) for aft, forward, share in space.parts(volume)]
    item = Item(hold, mass, *(float(one) for one in centre), 0.0, spread)
    grain = None
    if keys.filling in ASSUMED and volume > 0.0:
        within = min(volume, space.volume * (1.0 - FULL))
        moment = space.volumetric_moment(within, ASSUMED[keys.filling].surface)
        grain = Stowed(hold, keys.filling, keys.stowage, moment if keys.moment is None else keys.moment)
    return Cargo(hold, space, volume, float(space.level_of(volume)), item, grain)


def total(items: Sequence[Item]) -> Weights:
    """The sum of weights."""
    mass = sum(one.mass for one in items)
    centre = (sum(one.mass * getattr(one, name) for one in items) / mass for name in ("lcg", "tcg", "vcg"))
    return Weights(mass, *centre, sum(one.fsm for one in items))


def density_of(given: float | str) -> float:
    """A density (kg/m³), or that of a water by name."""
    return WATERS[given] if isinstance(given, str) else given


def _volume(space: Compartment, amount: FillKeys | CargoKeys, stowage: float, key: str, source: Source) -> float:
    """The volume (m³) of an amount given as one of full, mass (t) or level (m); `stowage` is m³/t."""
    given = [name for name in AMOUNTS if getattr(amount, name) is not None]
    if len(given) != 1:
        raise source.error(key, f"has {' and '.join(given) or 'no amount'}; give one of {', '.join(AMOUNTS)}.")
    try:
        if amount.level is not None:
            return space.volume_to(amount.level)
        volume = amount.full * space.volume if amount.mass is None else amount.mass * stowage
        space.level_of(volume)
    except Unavailable as error:
        raise source.error(f"{key}.{given[0]}", str(error)) from None
    return volume
