"""Irregular grains of a preset: classes of outlines, and the outlines of each class."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Annotated, Literal

import numpy as np

from lab.base.errors import LabError
from lab.preset.fields import Columns, Table, defaults_of, join
from lab.preset.units import needed
from solvers.grains.shapes.cargo import cargo, cargoes
from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.fitting import fit
from solvers.grains.shapes.spectrum import draw, spectrum
from solvers.machine.errors import BadOutline
from solvers.machine.marks import Doc, Interval, Unit

MOST_DESCRIPTORS, MOST_DRAWS = 100, 1000
TRIED, BELOW = 6, 0.75  # outlines drawn to estimate `least_mass`; factor on their least, as a safe lower value
SHARP = 0.05  # of R0: in dents of smaller radius `continuous` may lose contacts; with 0.076 it does not
MOST_POINTS = 1000  # of an outline in a file
DESCRIBED = ("cargo", "descriptors", "contour", "spectrum", "disc")  # a class has exactly one of these keys

# No outline has a descriptor of twice R0: the mean of R (1 − cos(nθ + δ_n)), which is positive, is R0 − D_n/2.
Descriptor = Annotated[float, Interval(gt=-2, lt=2)]
Slope = Annotated[float, Interval(ge=-10, le=10)]


@dataclass(frozen=True)
class Spectrum:
    """Descriptors D_1 … D_count relative to R0, by the law of `solvers.grains.shapes.spectrum`."""

    count: Annotated[int, Interval(ge=2, le=MOST_DESCRIPTORS), Doc("Number of descriptors.")]
    D2: Annotated[Descriptor, Doc("Second descriptor, the elongation.")] = 0.0
    D3: Annotated[Descriptor, Doc("Third descriptor, from which those up to D7 follow.")] = 0.0
    D8: Annotated[Descriptor, Doc("Eighth descriptor, from which those beyond follow.")] = 0.0
    alpha: Annotated[Slope, Doc("Exponent of the descriptors between D3 and D8.")] = -2.0
    beta: Annotated[Slope, Doc("Exponent of the descriptors beyond D8.")] = -2.0


@dataclass(frozen=True)
class Shape:
    """A class of outlines: exactly one of DESCRIBED, its share, its size."""

    cargo: Annotated[Literal[*cargoes()] | None, Doc("Grains of a cargo, with its outline and size.")] = None
    descriptors: Annotated[
        tuple[Descriptor, ...] | None, Doc("Fourier descriptors D_1, D_2 … of the outline, relative to R0.")
    ] = None
    phases: Annotated[
        tuple[float, ...] | None, Unit("rad"), Doc("Phases of the descriptors; drawn at random without them.")
    ] = None
    contour: Annotated[
        Table | None,
        Columns(("y", "z"), most=MOST_POINTS),
        Doc("CSV file with the outline's points y and z, in any unit."),
    ] = None
    spectrum: Annotated[Spectrum | None, Doc("Descriptors by a law, with phases at random.")] = None
    disc: Annotated[bool, Doc("Whether the outline is a circle.")] = False
    share: Annotated[
        Annotated[float, Interval(gt=0)] | None, Doc("Share of the grains, by number or as grains.shares says.")
    ] = None
    diameter: Annotated[
        Annotated[float, Unit("m"), Interval(gt=0)] | None,
        Doc("Diameter of the disc of equal area; grains.diameter without it, or the cargo's own."),
    ] = None
    draws: Annotated[
        int, Interval(ge=1, le=MOST_DRAWS), Doc("Outlines drawn for each repeat where phases are random.")
    ] = 25

    @property
    def round(self) -> bool:
        """Whether its outline is a circle."""
        return self.disc or (self.descriptors is not None and not any(self.descriptors))

    @cached_property
    def described(self) -> tuple[tuple[float, ...], tuple[float, ...] | None]:
        """Descriptors relative to R0 and phases (rad), None if they are random. Raises BadOutline."""
        if self.cargo is not None:
            return cargo(self.cargo).descriptors, cargo(self.cargo).phases
        if self.contour is not None:
            return _fitted(self.contour)
        if self.spectrum is not None:
            law = {field.name.lower(): getattr(self.spectrum, field.name) for field in fields(self.spectrum)}
            return tuple(spectrum(**law).tolist()), None
        return self.descriptors or (), () if self.disc else self.phases


@dataclass(frozen=True)
class ShapeClass:
    """The grains of one shape: their share by number, the diameter (m) of the disc of equal area.

    `descriptors` D_1, D_2, … are relative to R0; `phases` in rad, None: drawn at random, `draws` times per repeat.
    """

    share: float
    diameter: float
    descriptors: tuple[float, ...] = ()
    phases: tuple[float, ...] | None = ()
    draws: int = 1

    @property
    def random(self) -> bool:
        """Whether the phases are drawn at random."""
        return self.phases is None

    @property
    def reach(self) -> float:
        """Upper bound on the outlines' distance from their centroid, in radii of the disc of equal area.

        Exact for given phases. For random ones a bound: R is at most (1 + S) R0 with S = Σ|D_n|/R0, and the centroid,
        ∫ R³ (cos θ, sin θ) dθ/(3 A) with A ≥ π R0², at most |D_1| + (1 + S/3) Σ D_n²/R0 off the origin.
        """
        if not self.random:
            return self.outlines()[0].bounding_radius
        sizes = np.abs(self.descriptors)
        total, squares = float(sizes.sum()), float(sizes @ sizes)
        return 1.0 + total + float(sizes[:1].sum()) + (1.0 + total / 3.0) * squares

    @property
    def least_mass(self) -> float:
        """Least effective mass of a grain against a push on its outline, over its mass; see `Contour.least_mass`.

        Exact for given phases. For random ones, BELOW times the least of TRIED outlines, drawn with a fixed seed so
        that it does not depend on the repeats.
        """
        if not self.random:
            return self.outlines()[0].least_mass
        tried = replace(self, draws=TRIED).outlines(np.random.default_rng(0))
        return BELOW * min(outline.least_mass for outline in tried)

    def outlines(self, random: np.random.Generator | None = None) -> list[Contour]:
        """The outlines of one repeat, centred, with the area of a disc of radius 1. Raises BadOutline."""
        radius = 0.5 * self.diameter  # so that messages about an outline have its real size
        sizes = radius * np.array(self.descriptors)
        if self.random:
            drawn = [draw(radius, sizes, random) for _ in range(self.draws)]
        else:
            drawn = [Contour(radius, sizes, self.phases)]
        return [contour.centred().with_diameter(2.0) for contour in drawn]


def shape_classes(shapes: Mapping[str, Shape], diameter: float | None, shares: str) -> dict[str, ShapeClass]:
    """The grains of each shape; `diameter` (m) is for those without their own; `shares`: by number or by mass.

    Raises LabError, one sentence with the key.
    """
    found = {name: _shape_class(f"shapes.{name}", shape, diameter) for name, shape in shapes.items()}
    lacking = [name for name, shape in shapes.items() if shape.share is None]
    if lacking and len(lacking) < len(shapes):
        raise LabError(f"shapes.{lacking[0]}.share: missing; give all shapes a share, or none and they are equal.")
    classes = by_number([(shape.diameter, shape.share) for shape in found.values()], shares)
    return {name: replace(shape, share=share) for (name, shape), (_, share) in zip(found.items(), classes, strict=True)}


def by_number(classes, shares: str) -> tuple[tuple[float, float], ...]:
    """Convert shares of classes (diameter m, share) to shares by number, with sum 1; `shares`: number or sphere mass.

    A relative spread of the diameters within the classes changes all mean masses by the same factor.
    """
    power = 3 if shares == "mass" else 0
    numbers = [share / diameter**power for diameter, share in classes]
    total = sum(numbers)
    return tuple((diameter, number / total) for (diameter, _), number in zip(classes, numbers, strict=True))


def _shape_class(key: str, shape: Shape, diameter: float | None) -> ShapeClass:
    used = [name for name in DESCRIBED if getattr(shape, name) not in (None, False)]
    if len(used) != 1:
        got = f"got {' and '.join(used)}" if used else "got none"
        raise LabError(f"{key}: give exactly one of {', '.join(DESCRIBED)} ({got}).")
    if shape.phases is not None and used != ["descriptors"]:
        raise LabError(f"{key}.phases: go with descriptors.")
    if len(shape.descriptors or ()) > MOST_DESCRIPTORS:
        most = f"at most {MOST_DESCRIPTORS} are possible"
        raise LabError(f"{key}.descriptors: {most} (got {len(shape.descriptors)}).")
    own = cargo(shape.cargo).diameter if shape.cargo else None
    size = shape.diameter or diameter or own
    if size is None:
        raise LabError(f"{key}.diameter: missing; {needed('m')}, here or as grains.diameter.")
    try:
        descriptors, phases = shape.described
        made = ShapeClass(shape.share or 1.0, size, descriptors, phases, shape.draws if phases is None else 1)
        if not made.random:
            made.outlines()
    except BadOutline as error:
        raise LabError(f"{key}.{used[0]}: {error}") from None
    return made


def _fitted(contour: Table) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Descriptors and phases of an outline with the columns y and z, in any unit of length. Raises BadOutline."""
    points = np.column_stack([contour.columns["y"], contour.columns["z"]])
    points = points / (np.abs(points).max() or 1.0)
    found = fit(points).contour
    if len(found.descriptors) > MOST_DESCRIPTORS:
        found = fit(points, MOST_DESCRIPTORS).contour
    return tuple((np.array(found.descriptors) / found.radius).tolist()), found.phases


def caution(contours: Sequence[Contour], rule: str) -> str | None:
    """A warning about these outlines under a contact rule, in one sentence; None if there is nothing to warn of.

    Of 24 pairs of discs with 50 lobes, dents of 0.03 R0, three gain energy by `continuous`; those of 0.076 R0 do not.
    """
    sharpest = min(contour.sharpest_dent / contour.radius for contour in contours)
    if rule != "continuous" or sharpest >= SHARP:
        return None
    return (
        f"Outlines have dents with a radius of curvature of {100 * sharpest:.1f} % of R0: "
        'grains that mesh may gain energy; contact.outlines = "area" keeps it.'
    )


def check_shapes(preset) -> None:
    """Raise LabError for settings of a preset that need irregular grains, or discs, where it has the others."""
    (_check_shapely if preset.shapes else _check_shapeless)(preset)


def _check_shapeless(preset) -> None:
    """Raise LabError for settings that need irregular grains if there are none."""
    for section, keys in (("grains", ("orientation", "settled_as")), ("contact", ("outlines", "nodes"))):
        given = getattr(preset, section)
        for name in keys:
            if getattr(given, name) != defaults_of(type(given))[name]:
                key = join(section, name)
                raise LabError(f"{key}: goes with irregular grains; add a table [shapes.NAME], or leave this out.")


def _check_shapely(preset) -> None:
    """Raise LabError for settings that need discs if the grains are irregular."""
    grains = preset.grains
    if preset.kinds:
        raise LabError("kinds: irregular grains are of one material; leave out the kinds, or the shapes.")
    if preset.contact.cohesion != "none":
        raise LabError("contact.cohesion: no liquid between irregular grains yet; leave it out, or the shapes.")
    if grains.bed is not None:
        raise LabError("grains.bed: lists round grains; leave out the file, or the shapes.")
    if grains.table is not None:
        raise LabError("grains.table: shapes have diameters of their own; give these as shapes.NAME.diameter.")
    if grains.settled_as == "discs" and not all(shape.round for shape in preset.shapes.values()):
        raise LabError("grains.settled_as: discs stand for round outlines only; leave it out, or the descriptors.")
    if grains.settled_as == "discs" and not preset.run.settles:
        raise LabError("grains.settled_as: without run.settle, or without gravity, no bed is settled; leave it out.")
    if grains.surface == "undisturbed":
        raise LabError(
            "grains.surface: an undisturbed surface is levelled with round grains; take slightly-disturbed or "
            "disturbed, or leave out the shapes."
        )


def size_key(preset) -> str:
    """The key of a preset (`lab.preset.schema.Preset`) that sets the size of the largest grains."""
    if preset.shapes:
        sizes = preset.shape_classes
        return f"shapes.{max(sizes, key=lambda name: sizes[name].diameter)}.diameter"
    if preset.grains.table is not None:
        return "grains.table"
    largest = max(preset.kinds.items(), key=lambda item: item[1].diameter or 0.0, default=("", None))
    own = largest[1] is not None and (largest[1].diameter or 0.0) > (preset.grains.diameter or 0.0)
    return f"kinds.{largest[0]}.diameter" if own else "grains.diameter"
