"""Motions of the tank of a user's own, from plug-ins and notebooks: functions of time, or classes like the lab's."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, is_dataclass, make_dataclass
from functools import cache, cached_property
from inspect import Parameter, signature
from math import isfinite
from typing import Annotated, ClassVar

from lab.base.errors import LabError
from lab.plugins.guard import told, within
from lab.plugins.loading import owner
from lab.preset.python.words import add_key
from lab.preset.sections.history import FASTEST, HARDEST
from lab.preset.sections.motion import OF_LAB, Motion
from lab.preset.units import KINDS, known_unit, parse, show
from solvers.machine.marks import Doc, Interval, Unit
from solvers.motion.frame import AXIS, TURNING, is_turn
from solvers.motion.history import COORDINATES
from solvers.motion.sampled import Jump, Sampled, sampled

LONGEST_NAME = 40  # characters
ASKED_TWICE = 7  # times at which a function must say the same again, since a run that goes on asks again
NEEDED = "coordinate", "state", "parameters", "duration", "fastest"  # of a class, as the manual's recipe has them
OF_ALL = "end", "centre"  # keys that a function's motion has without naming them

End = Annotated[float | None, Unit("s"), Interval(gt=0), Doc("When it ends, at rest; with the run without it.")]
Centre = Annotated[tuple[float, float], Unit("m"), Doc("The fixed point, y and z, about which the tank turns.")]


@dataclass(frozen=True)
class Own:
    """A motion by a function of time: sampled, and joined by splines (`solvers.motion.sampled`).

    The function is asked for a time (s) and the parameters in the units they are declared in, and returns each of the
    coordinates `moves` in its unit. A subclass has the parameters as fields, in SI.
    """

    name: ClassVar[str]
    owner: ClassVar[str]
    function: ClassVar[Callable]
    factors: ClassVar[Mapping[str, float]]  # from the declared unit of each parameter to that of its field
    moves: ClassVar[Mapping[str, float]]  # from the unit returned of each motion, sway, roll …, to SI

    def __call__(self, time: float) -> tuple[float, ...]:
        """The coordinates (m or rad) at a time (s). Raises TypeError or ValueError for no finite numbers."""
        given = {name: getattr(self, name) / factor for name, factor in self.factors.items()}
        found = type(self).function(time, **given)
        several = found if isinstance(found, tuple | list) else (found,)
        if len(several) != len(self.moves):
            raise ValueError(f"it returned {len(several)} numbers, not one for each of {', '.join(self.moves)}")
        values = tuple(float(one) * factor for one, factor in zip(several, self.moves.values(), strict=True))
        if not all(map(isfinite, values)):
            raise ValueError(f"it returned {found} at {time:.4g} s, which is no finite number")
        return values

    @cached_property
    def motions(self) -> dict[str, Sampled]:
        """The motions of its coordinates by name, innermost first. Raises LabError, one sentence."""
        return dict(zip(self._innermost_first, _motions_of(self), strict=True))

    @property
    def _innermost_first(self) -> list[str]:
        return [name for name in COORDINATES if name in self.moves]

    def check(self) -> None:
        """Raise LabError for what no tank follows."""
        for name, motion in self.motions.items():
            rate = "rad/s" if is_turn(motion.coordinate) else "m/s"
            hardest, fastest = motion.hardest(), motion.fastest(0.0)
            if hardest > HARDEST or fastest > FASTEST:
                raise LabError(
                    f"motion.{self.name}: its {name} has speeds up to {show(fastest, rate)} and accelerations up to "
                    f"{hardest:.3g} {rate}²: no tank is shaken so; look at its numbers and units."
                )


@cache
def _motions_of(own: Own) -> tuple[Sampled, ...]:
    """The sampled motions, innermost first: kept, since a function may take a while."""
    names = list(own.moves)
    order = [names.index(name) for name in own._innermost_first]
    y, z = getattr(own, "centre", (0.0, 0.0))
    centres = {"pitch": (z, 0.0), "yaw": (y, 0.0)}  # as those of a record
    coordinates = {COORDINATES[name]: centres.get(name, (y, z)) for name in own._innermost_first}
    try:
        with within():
            for k in range(ASKED_TWICE):
                time = own.end * k / ASKED_TWICE
                if own(time) != own(time):
                    raise ValueError(f"it returned two places at {time:.4g} s, and a motion has one at each time")
            return tuple(sampled(lambda time: [own(time)[k] for k in order], own.end, coordinates))
    except Jump as error:
        remedy = "no tank is moved so; let it change over a while"
        raise LabError(f"motion.{own.name}: {own.owner}: {error}, and {remedy}.") from None
    except Exception as error:
        raise LabError(f"motion.{own.name}: {own.owner}: {told(error)}.") from error


def register(
    name: str, function: Callable, moves: str | Mapping[str, str], unit: str, parameters: Mapping[str, str]
) -> None:
    """Add a motion to the keys of [motion], or replace one of the same name. Raises LabError."""
    if not name.isidentifier() or len(name) > LONGEST_NAME or name in OF_LAB:
        raise LabError(f"motion: {name!r} is no name, or one of the lab's; choose another.")
    if isinstance(function, type):
        kind = _checked(name, function)
        owner(function)
    else:
        kind = _kind_of(name, function, moves, unit, parameters)
    says = (kind.__doc__ or "").strip().partition("\n")[0] or f"The tank's {name}."
    add_key(Motion, name, Annotated[kind | None, Doc(says)])


def _checked(name: str, kind: type) -> type:
    """A class that is a motion as the manual's recipe has it."""
    missing = [part for part in NEEDED if not hasattr(kind, part)]
    if not is_dataclass(kind) or missing:
        what = f"has no {missing[0]}" if missing else "is no dataclass"
        raise LabError(f"motion {name}: its class {what}; the page on extending has a whole one.")
    if kind.coordinate not in (*AXIS, *TURNING):
        raise LabError(f"motion {name}: coordinate: is {kind.coordinate!r}; choose one of {', '.join(AXIS | TURNING)}.")
    if is_turn(kind.coordinate) and not hasattr(kind, "centre"):
        raise LabError(f"motion {name}: a motion that turns needs a field centre with a default, two lengths.")
    return kind


def _kind_of(
    name: str, function: Callable, moves: str | Mapping[str, str], unit: str, parameters: Mapping[str, str]
) -> type[Own]:
    """The dataclass of a function's motion, with its parameters as fields."""
    units = dict(moves) if isinstance(moves, Mapping) else {moves: unit}
    if isinstance(moves, Mapping) and unit:
        raise LabError(f"motion {name}: unit: say the units in moves, or name one motion there.")
    factors, fields = {}, []
    taken = _arguments(name, function, parameters)
    for parameter, given in parameters.items():
        symbol, factors[parameter] = _si(name, parameter, given)
        hint = Annotated[float, Unit(symbol), Doc(f"The {parameter.replace('_', ' ')} of {name}.")]
        default = taken[parameter].default
        given = () if default is Parameter.empty else (_number(name, parameter, default) * factors[parameter],)
        fields.append((parameter, hint, *given))
    fields = sorted(fields, key=len)  # those without a default first
    if any(motion in COORDINATES and is_turn(COORDINATES[motion]) for motion in units):
        fields.append(("centre", Centre, (0.0, 0.0)))
    fields.append(("end", End, None))
    of_class = {
        "name": name,
        "owner": owner(function),
        "function": staticmethod(function),
        "factors": factors,
        "moves": {motion: _returned(name, motion, given) for motion, given in units.items()},
        "__doc__": function.__doc__,
    }
    return make_dataclass(name, fields, bases=(Own,), frozen=True, namespace=of_class)


def _arguments(name: str, function: Callable, parameters: Mapping[str, str]) -> Mapping[str, Parameter]:
    """What a function takes beside the time. Raises LabError where that is not the parameters."""
    for parameter in parameters:
        if not str(parameter).isidentifier() or parameter in (*OF_ALL, *dir(Own), *Own.__annotations__):
            raise LabError(f"motion {name}: {parameter!r} is no name for a parameter, or one that it has anyhow.")
    try:
        taken = signature(function)
        taken.bind(0.0, **dict.fromkeys(parameters))
    except (TypeError, ValueError):
        named = ", ".join(["time", *parameters])
        raise LabError(
            f"motion {name}: its function must take {named}; name in parameters what it takes, each with its unit."
        ) from None
    return taken.parameters


def _number(name: str, parameter: str, default: object) -> float:
    if isinstance(default, bool) or not isinstance(default, int | float) or not isfinite(default):
        raise LabError(f"motion {name}: {parameter}: its default must be a number (got {default!r}).")
    return float(default)


def _si(name: str, parameter: str, unit: str) -> tuple[str, float]:
    """The unit that a parameter is kept in, SI where the lab has a word for it, and the factor to it."""
    if not isinstance(unit, str) or not known_unit("" if unit == "1" else unit):
        raise LabError(f'motion {name}: {parameter}: the unit {unit!r} is unknown; "1" is that of a pure number.')
    for symbol in KINDS:
        try:
            return symbol, parse(f"1 {unit}" if unit != "1" else "1", symbol)
        except LabError:
            continue
    return unit, 1.0


def _returned(name: str, motion: str, unit: str) -> float:
    """The factor to SI from the unit in which a function returns a motion."""
    if motion not in COORDINATES:
        raise LabError(f"motion {name}: moves: {motion!r} is unknown; choose from {', '.join(COORDINATES)}.")
    symbol = "rad" if is_turn(COORDINATES[motion]) else "m"
    try:
        return parse(f"1 {unit or symbol}", symbol)
    except LabError as error:
        raise LabError(f"motion {name}: unit: {error}") from None
