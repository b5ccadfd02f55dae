"""A hull from a GHS geometry file (GF): sections of one shape, as the format's public description has them.

Source: "General HydroStatics System, Geometry File Format" (Creative Systems 1999). The file is text: after a title
come shapes (`*`: a name, sections with their longitudinal place and points y, z), components (`**`: a shape with side,
effectiveness and shift) and parts (`***`: components with a type; 1 displaces), up to `****`. Distances are in feet,
longitudinal places grow towards the stern: x here is minus the file's, in m, so that it grows forward.

Limits: what is read is one displacing part of one component that is wholly effective; tanks, sails and critical points
are left out. Points of an arc are joined by straight lines, which the format allows.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.files import read_bytes
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.section import ROUNDING, Section

FOOT = 0.3048  # m
LARGEST = 50_000_000  # bytes
DISPLACES = 1  # type of a part
KEEL = 1e-4  # of the depth: a keel amidships this close to z = 0 is there
AGREE = 0.01  # by so much Simpson's rule and the format's own straight lines may differ in volume

Cut = tuple[float, np.ndarray]  # place (ft) and points (n, 2) ft


@dataclass(frozen=True)
class _Component:
    """A shape by name on a side (0: half of it is given), its effectiveness and its shift (ft)."""

    shape: str
    side: int
    effective: float
    shift: tuple[float, float, float]


class _Lines:
    """The lines of a file, read one after the other. Raises LabError where one is not what the format asks for."""

    def __init__(self, path: Path, text: str):
        self.name = path.name
        self._lines = [line.strip() for line in text.splitlines()]
        self._at = 0

    def next(self) -> str | None:
        """The next line that is no comment; None at the end."""
        while self._at < len(self._lines):
            self._at += 1
            if not self._lines[self._at - 1].startswith("\\"):
                return self._lines[self._at - 1]
        return None

    def text(self, what: str) -> str:
        """The next line, which must be there."""
        line = self.next()
        if line is None:
            raise self.wrong(what)
        return line

    def numbers(self, what: str, least: int) -> list[float]:
        """The first numbers of the next line, at least so many."""
        try:
            found = [float(word) for word in self.text(what).split(",")[:least]]
        except ValueError:
            found = []
        if len(found) < least or not np.isfinite(found).all():
            raise self.wrong(what)
        return found

    def wrong(self, what: str) -> LabError:
        """An error at the present line."""
        return LabError(f"{self.name}: line {self._at}: {what} is needed there; write the geometry file anew.")


def read_gf(path: Path) -> Form:
    """The hull of a geometry file. Raises LabError for a file that is none, or has not one plain displacing hull."""
    try:
        content = read_bytes(path, LARGEST + 1)
    except (OSError, ValueError) as error:
        raise LabError(f"{path} cannot be read ({getattr(error, 'strerror', '')}); look at its name.") from None
    if content is None or len(content) > LARGEST:
        raise LabError(f"{path.name}: is no geometry file; look at its name.")
    shapes, components, parts = _records(_Lines(path, content.decode("latin-1")))
    hulls = [(name, members) for name, kind, members in parts if kind == DISPLACES]
    if len(hulls) != 1 or len(hulls[0][1]) != 1:
        found = ", ".join(f"{name} of {len(members)}" for name, members in hulls) or "none"
        raise LabError(
            f"{path.name}: displacing parts and their components are {found}; give a file with one part of one "
            "component."
        )
    one = components.get(hulls[0][1][0])
    if one is None or one.shape not in shapes:
        raise LabError(f"{path.name}: the hull's component or shape is not in the file; write the geometry file anew.")
    if one.effective != 1.0:
        raise LabError(
            f"{path.name}: the hull's effectiveness is {one.effective:g}; give one that is wholly effective."
        )
    return _form(shapes[one.shape], one, path.name)


def _records(lines: _Lines) -> tuple[dict[str, list[Cut]], dict[str, _Component], list[tuple[str, int, list[str]]]]:
    """Shapes and components by name, and parts with type and components."""
    shapes, components, parts = {}, {}, []
    while (line := lines.next()) is not None and line != "****":
        if line == "*":
            name = lines.text("the name of a shape")
            count = int(lines.numbers("the number of sections", 1)[0])
            shapes[name] = [_cut(lines) for _ in range(count)]
        elif line == "**":
            name = lines.text("the name of a component")
            side = int(lines.numbers("the side, −1, 0 or 1,", 1)[0])
            effective = lines.numbers("the effectiveness", 1)[0]
            shift = tuple(lines.numbers("the shift of the origin", 3))
            components[name] = _Component(lines.text("the name of a shape"), side, effective, shift)
        elif line == "***":
            name = lines.text("the name of a part").partition("\\")[0]
            lines.text("the fluid")
            kind = int(lines.numbers("the type of a part", 1)[0])
            lines.text("the specific gravity")
            lines.text("the reference point")
            count = int(lines.numbers("the number of components", 1)[0])
            parts.append((name, kind, [lines.text("the name of a component") for _ in range(count)]))
    return shapes, components, parts


def _cut(lines: _Lines) -> Cut:
    """A section."""
    place, count = lines.numbers("a section's place and number of points", 2)
    return place, np.array([lines.numbers("a point y, z", 2) for _ in range(int(count))]).reshape(-1, 2)


def _form(cuts: list[Cut], one: _Component, name: str) -> Form:
    """The hull in m, x forward."""
    x = -FOOT * (np.array([place for place, _ in cuts]) + one.shift[0])
    try:
        sections = [_section(points, one) for _, points in cuts]
        order = np.argsort(x)
        amidships = sections[order[len(order) // 2]]
        form = Form(x[order], tuple(sections[k] for k in order))
    except Unavailable as error:
        raise LabError(f"{name}: {error}") from None
    areas = np.array([0.0 if section is None else section.area for section in form.sections])
    straight = float((0.5 * (areas[1:] + areas[:-1]) * np.diff(form.x)).sum())
    if abs(form.volume / straight - 1.0) > AGREE:
        off = 100.0 * (form.volume / straight - 1.0)
        raise LabError(
            f"{name}: Simpson's rule over its sections has {off:+.1f} % of volume beside straight lines between them, "
            "as they are spaced too unevenly; give evenly spaced ones."
        )
    keel = float((amidships or next(filter(None, sections))).outline[:, 1].min())
    return Form(form.x, form.sections, base=keel if abs(keel) > KEEL * form.depth else 0.0)


def _section(points: np.ndarray, one: _Component) -> Section | None:
    """A section in m; None for one that has shrunk to a point or a line."""
    if one.side == 0:
        points = np.concatenate([points, points[::-1] * [-1.0, 1.0]])
    elif one.side < 0:
        points = points[::-1] * [-1.0, 1.0]
    outline = FOOT * (points + np.array(one.shift[1:]))
    size = float(np.ptp(outline, axis=0).max())
    outline = outline[np.hypot(*(outline - np.roll(outline, 1, axis=0)).T) > ROUNDING * max(size, FOOT)]
    if len(outline) < 3 or np.ptp(outline[:, 0]) <= ROUNDING * size:
        return None
    return Section(outline)
