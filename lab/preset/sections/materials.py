"""The materials of a preset: those of grains, walls and kinds of grains, and what each inherits."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, make_dataclass, replace
from typing import Annotated, get_type_hints

from lab.base.errors import LabError
from lab.preset.units import show
from solvers.grains.laws import COHESION
from solvers.grains.materials import Material
from solvers.machine.marks import Cheap, Doc, Interval, Unit, Usual

LEAST_RESTITUTION, LONGEST_DISSIPATION = 1e-6, 0.1  # 1 and s: beyond these no rebound is visible


class Over:
    """Properties of a material, any of which may be left out."""

    def over(self, material: Material) -> Material:
        """The material with the properties given here in place of its own."""
        names = {field.name for field in fields(material)}
        own = {name: value for name, value in vars(self).items() if name in names and value is not None}
        if "restitution" in own:
            own["dissipative_time"] = None
        elif "dissipative_time" in own:
            own["restitution"] = None
        return replace(material, **own)


def _properties(*left_out: str) -> list[tuple]:
    """The fields of a material, each of which may be left out."""
    hints = get_type_hints(Material, include_extras=True)
    return [(name, _optional(hint), None) for name, hint in hints.items() if name not in left_out]


def _optional(hint: object) -> object:
    """The annotation with None allowed, and its marks around it."""
    return Annotated[hint.__origin__ | None, *hint.__metadata__]


Wall = make_dataclass("Wall", _properties("density"), bases=(Over,), frozen=True)
"""What of a wall's material is not as that of the grains."""

Share = Annotated[
    float, Interval(gt=0, lt=1), Doc("Share of these grains by number; a column `kind` of grains.bed replaces it.")
]
Against = Annotated[Wall | None, Doc("How these grains touch the rest; by the mean of the two materials without it.")]
Diameter = Annotated[
    float | None,
    Cheap(),
    Unit("m"),
    Interval(gt=0),
    Usual(1e-3, 1e-2, "mm"),
    Doc("Mean diameter of these grains; that of the rest without it."),
]
KEYS = [("share", Share), *_properties(), ("against", Against, None), ("diameter", Diameter, None)]
Kind = make_dataclass("Kind", KEYS, bases=(Over,), frozen=True)
"""A share of the grains, of another material than the rest, and maybe of another size."""
Wall.__module__ = Kind.__module__ = __name__  # so that they can be sent to another process


@dataclass(frozen=True)
class Other:
    """The materials of a kind of grains: its own, and that of its contacts with the rest, None for the mean of both."""

    material: Material
    against: Material | None


def others(kinds: Mapping[str, Kind], material: Material) -> dict[str, Other]:
    """The materials of the kinds of grains other than those of `material`."""
    found = {}
    for name, kind in kinds.items():
        own = kind.over(material)
        found[name] = Other(own, kind.against.over(own) if kind.against is not None else None)
    return found


def check_dissipation(material: Material | Wall | Kind, section: str, needed: bool) -> None:
    """Raise LabError if the rebound is given twice, is out of range or, if `needed`, is missing."""
    given = [material.restitution, material.dissipative_time]
    if None not in given:
        raise LabError(f"{section}.restitution: give restitution or dissipative_time, not both.")
    if needed and given == [None, None]:
        raise LabError(f"{section}.restitution: missing; give restitution or dissipative_time.")
    if (material.restitution or 1.0) < LEAST_RESTITUTION:
        raise LabError(f"{section}.restitution: must be at least {LEAST_RESTITUTION:g} (got {material.restitution:g}).")
    if (material.dissipative_time or 0.0) > LONGEST_DISSIPATION:
        longest = show(LONGEST_DISSIPATION, "s")
        raise LabError(f"{section}.dissipative_time: must be at most {longest}, far past where no grain rebounds.")


def check_cohesion(law: str, material: Material) -> None:
    """Raise LabError if a value that the cohesion law needs is missing; walls and kinds of grains inherit these."""
    for name in COHESION[law].needs:
        if getattr(material, name) is None:
            example = {"humidity": "70 %", "bridge_volume": "0.002 mm^3"}[name]
            raise LabError(f'material.{name}: missing; contact.cohesion = "{law}" needs it, e.g. "{example}".')


def classes_of(kinds: Mapping[str, Kind], diameter: float) -> tuple[tuple[float, float], ...]:
    """Diameter (m) and share by number of the rest, of that diameter, and of each kind; empty if none has its own."""
    if not any(kind.diameter for kind in kinds.values()):
        return ()
    found = tuple((kind.diameter or diameter, kind.share) for kind in kinds.values())
    return ((diameter, 1.0 - sum(share for _, share in found)), *found)


def check_kinds(kinds: Mapping[str, Kind], material: Material) -> None:
    """Raise LabError for kinds of grains whose rebounds have no mean, or whose shares are too large."""
    made = others(kinds, material)
    for name, kind in kinds.items():
        check_dissipation(kind, f"kinds.{name}", needed=False)
        if kind.against is not None:
            check_dissipation(kind.against, f"kinds.{name}.against", needed=False)
        elif (made[name].material.restitution is None) != (material.restitution is None):
            raise LabError(
                f"kinds.{name}.against: missing; a restitution and a dissipative time have no mean, so say how this "
                "kind touches the rest."
            )
    total = sum(kind.share for kind in kinds.values())
    if total >= 1.0:
        raise LabError(
            f"kinds.{next(iter(kinds))}.share: the shares add up to {total:.3g}; keep them below 1 together."
        )
    if len({other.material.restitution is None for other in made.values()}) > 1:
        raise LabError("kinds: give all of them a restitution, or all a dissipative time.")
