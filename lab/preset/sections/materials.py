"""The materials of a preset: those of grains, walls and kinds of grains, and what each inherits."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, make_dataclass, replace
from typing import Annotated, get_type_hints

from lab.base.errors import LabError
from lab.preset.units import show
from solvers.grains.laws import COHESION
from solvers.grains.materials import Material
from solvers.machine.marks import Interval

LEAST_RESTITUTION, LONGEST_DISSIPATION = 1e-6, 0.1  # 1 and s: beyond these no rebound is visible

WallGiven = make_dataclass(
    "WallGiven",
    [
        (name, hint | None, None)
        for name, hint in get_type_hints(Material, include_extras=True).items()
        if name != "density"
    ],
    frozen=True,
)


KindGiven = make_dataclass(
    "KindGiven",
    [
        ("share", Annotated[float, Interval(gt=0, lt=1)]),
        *((name, hint | None, None) for name, hint in get_type_hints(Material, include_extras=True).items()),
        ("against", WallGiven | None, None),
    ],
    frozen=True,
)


@dataclass(frozen=True)
class Kind:
    """A fraction of the grains, by number, of another material than the rest.

    `against`: the material for contacts of this kind with the rest; None: the mean of the two materials.
    """

    share: float
    material: Material
    against: Material | None = None


def check_dissipation(material: Material | WallGiven, section: str, needed: bool) -> None:
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


def full_kinds(given: Mapping[str, KindGiven], material: Material) -> dict[str, Kind]:
    """The resolved kinds of grains, other than those of `material`."""
    kinds = {}
    for name, kind in given.items():
        check_dissipation(kind, f"kinds.{name}", needed=False)
        own, against = over(material, kind), None
        if kind.against is not None:
            check_dissipation(kind.against, f"kinds.{name}.against", needed=False)
            against = over(own, kind.against)
        elif (own.restitution is None) != (material.restitution is None):
            raise LabError(
                f"kinds.{name}.against: missing; a restitution and a dissipative time have no mean, so say how this "
                "kind touches the rest."
            )
        kinds[name] = Kind(kind.share, own, against)
    total = sum(kind.share for kind in kinds.values())
    if total >= 1.0:
        raise LabError(
            f"kinds.{next(iter(kinds))}.share: the shares add up to {total:.3g}; keep them below 1 together."
        )
    if len({own.material.restitution is None for own in kinds.values()}) > 1:
        raise LabError("kinds: give all of them a restitution, or all a dissipative time.")
    return kinds


def over(material: Material, given: object) -> Material:
    """The material with the given values in place of its own."""
    names = {name for name in asdict(material)}
    own = {name: value for name, value in asdict(given).items() if name in names and value is not None}
    if "restitution" in own:
        own["dissipative_time"] = None
    elif "dissipative_time" in own:
        own["restitution"] = None
    return replace(material, **own)
