"""Quantities: what is worth knowing of a scene, each declared once in the room that fills it.

Whoever stores, draws or explains numbers reads these declarations and keeps no list of names, units or labels.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

PLANE, SPACE = 2, 3  # numbers of axes
DIRECTIONS = ("y", "z", "x")  # of the axes, in the order of all arrays
ROTATIONS = ("pitch", "yaw", "roll")  # about these
ROLL = -1  # of the freedoms of a body the last, in the plane and in space
OWNERS = {
    "run": (),
    "world": ("world",),
    "grain": ("world", "grain"),
    "part": ("world", "part"),
    "face": ("world", "face"),
    "body": ("world", "body"),
    "room": ("world", "room"),
    "opening": ("world", "opening"),
    "inlet": ("world", "inlet"),
    "water_particle": ("world", "water_particle"),
    "air_particle": ("world", "air_particle"),
    "point": ("world", "point"),
    "gauge": ("world", "gauge"),
    "level": ("world", "level"),
    "edge": ("world", "edge"),
}


def directions(axes: int) -> tuple[str, ...]:
    """Names of the components of a vector in a scene of so many axes."""
    return DIRECTIONS[:axes]


def rotations(axes: int) -> tuple[str, ...]:
    """Names of the components of a rotation, none in the plane: there it is a single number, about x."""
    return ROTATIONS if axes > PLANE else ()


def freedoms(axes: int) -> tuple[str, ...]:
    """Names of the freedoms of a body: along the axes, then about them."""
    return (*directions(axes), *(rotations(axes) or ROTATIONS[-1:]))


def in_plane(axes: int) -> tuple[int, ...]:
    """Which of the freedoms of a body are those of the plane, by their numbers."""
    return tuple(freedoms(axes).index(name) for name in freedoms(PLANE))


def flat(values: np.ndarray) -> np.ndarray:
    """The freedoms of the plane (..., 3) of poses, rates or loads in the plane (..., 3) or in space (..., 6)."""
    return values if values.shape[-1] == len(freedoms(PLANE)) else values[..., in_plane(SPACE)]


# What runs over components that many quantities have
DIMENSIONS = {
    named(axes): what for axes in (PLANE, SPACE) for named, what in ((directions, "axis"), (freedoms, "freedom"))
}
DIMENSIONS[ROTATIONS] = "rotation"


@dataclass(frozen=True)
class Quantity:
    """What an array of numbers means.

    name: of the array; unit: SI, "1" of a pure number, "N, N, N m" where the components have different ones; over:
    their names, none of a single number, or `directions`, `rotations` or `freedoms`, which tell them from the number
    of the scene's axes, `space`; label: what it is, for people, a noun without an article; mean: whether it is averaged
    over the time since the last sample, else it is that of the instant; per: what has one each, a key of OWNERS; never:
    the value that stands for "has not happened"; plot: whether a run's report draws it against time in a figure of its
    own.
    """

    name: str
    unit: str
    over: tuple[str, ...] | Callable[[int], tuple[str, ...]] = ()
    label: str = ""
    mean: bool = False
    per: str = "world"
    never: float | None = None
    plot: bool = False
    space: int = PLANE

    def within(self, axes: int) -> "Quantity":
        """The quantity in a scene of so many axes."""
        unit, (along, about) = self.unit, (self.units[0], self.units[-1])
        if self.over is freedoms and along != about:
            unit = ", ".join(along if name in DIRECTIONS else about for name in freedoms(axes))
        return replace(self, space=axes, unit=unit)

    @property
    def components(self) -> tuple[str, ...]:
        """Names of its components, none of a single number."""
        return self.over(self.space) if callable(self.over) else self.over

    @property
    def shape(self) -> tuple[int, ...]:
        """Of one value: (components,), or () of a single number."""
        return (len(self.components),) if self.components else ()

    @property
    def width(self) -> int:
        """How many numbers one value has."""
        return len(self.components) or 1

    @property
    def units(self) -> tuple[str, ...]:
        """The unit of each component, or the one of a single number."""
        said = tuple(self.unit.split(", "))
        return said * self.width if len(said) == 1 else said

    @property
    def dimension(self) -> str:
        """The name of the axis along the components: the same of quantities that have the same ones."""
        return DIMENSIONS.get(self.components, f"{self.name}_component")

    @property
    def axes(self) -> tuple[str, ...]:
        """Names of the axes of what is recorded of it, time first."""
        return ("time", *OWNERS[self.per], *((self.dimension,) if self.components else ()))


def places(quantities: Sequence[Quantity]) -> dict[str, int]:
    """The first column of each quantity by name, where all their numbers stand side by side in a row."""
    ends = np.cumsum([0, *(quantity.width for quantity in quantities)])
    return {quantity.name: int(begin) for quantity, begin in zip(quantities, ends, strict=False)}


def parted(rows: np.ndarray, quantities: Sequence[Quantity]) -> dict[str, np.ndarray]:
    """Rows (W, columns) as `places` orders them, as one array (W, *shape) a quantity, by name."""
    begin, found = places(quantities), {}
    for quantity in quantities:
        block = rows[:, begin[quantity.name] : begin[quantity.name] + quantity.width]
        found[quantity.name] = block if quantity.components else block[:, 0]
    return found
