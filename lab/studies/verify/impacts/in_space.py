"""The oblique tests of Chung and Ooi (2011) in space: the same meetings, turned out of the plane of the axes.

By symmetry the law by itself gives the same numbers in whatever plane two bodies meet. Those with a wall are turned
about the normal of the floor, two spheres about a skew axis, so that all components of velocities, spins and tangential
springs take part.
"""

from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.impacts.chung_ooi import SECTION, allowed, largest_errors, oblique
from lab.studies.verify.impacts.head_on import DERIVED
from lab.studies.verify.impacts.meetings import Meetings
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.solids.solid import Prism

SKEW, ANGLE = np.array([1.0, 2.0, 3.0]), 1.0  # axis, in the order y, z, x, and rad
UP = np.array([0.0, 1.0, 0.0])
PLANES = 1e-9  # of the slip: how far a sphere may leave the plane of its meeting


@dataclass(frozen=True, eq=False)
class MeetingsInSpace(Meetings):
    """Meetings in a plane that is turned by ANGLE, about the vertical on a wall and about SKEW of two spheres."""

    @classmethod
    def of(cls, one: Meetings) -> "MeetingsInSpace":
        """The same meetings in space."""
        return cls(**{field.name: getattr(one, field.name) for field in fields(Meetings)})

    @cached_property
    def turn(self) -> np.ndarray:
        """The rotation (3, 3) of vectors y, z, x."""
        axis = UP if self.mate == "plane" else SKEW / np.linalg.norm(SKEW)
        crossed = np.cross(np.eye(3), axis)
        return np.eye(3) - np.sin(ANGLE) * crossed + (1.0 - np.cos(ANGLE)) * crossed @ crossed

    def scene(self, chosen: slice = slice(None), phases: int = 0) -> Scene:
        """As in the plane, in a box as long as it is wide."""
        made = super().scene(chosen, phases)
        return replace(made, solid=Prism(float(np.ptp(made.outline[:, 0]))))

    def _starts(self, scene: Scene, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        place, velocity, spin = super()._starts(scene, step)
        base = np.array([0.0, place[0, -1, 1] if self.bodies.other_radius else 0.0, 0.0])
        turned = (_in_space(place) - base) @ self.turn.T + base
        spins = np.stack([0.0 * spin, 0.0 * spin, spin], axis=-1)
        return turned, _in_space(velocity) @ self.turn.T, spins @ self.turn.T

    def _relative(self, run: Simulation) -> np.ndarray:
        """Velocities past the second body and both spins (n, phases, 4) now, turned back.

        Raises RuntimeError if a body has left the plane of its meeting.
        """
        state = run.snapshot()
        velocity, spin = state["velocity"] @ self.turn, state["spin"] @ self.turn
        size = max(np.abs(velocity).max(), self.radius * np.abs(spin).max())
        if max(np.abs(velocity[..., 2]).max(), self.radius * np.abs(spin[..., :2]).max()) > PLANES * size:
            raise RuntimeError("a body has left the plane of its meeting")
        if velocity.shape[1] == 1:
            velocity, spin = (np.concatenate([one, np.zeros_like(one)], axis=1) for one in (velocity, spin))
        columns = np.concatenate([(velocity[:, 0] - velocity[:, 1])[:, :2], spin[..., 2]], axis=1)
        return columns.reshape(len(self.all), len(self.phases), 4)


def _in_space(vectors: np.ndarray) -> np.ndarray:
    """Vectors (…, 3) of those (…, 2) in the plane x = 0."""
    return np.concatenate([vectors, np.zeros_like(vectors[..., :1])], axis=-1)


def turned(fast: bool) -> Found:
    """Tests 4 to 8 in a plane that is no plane of the axes, against the law by itself; if `fast` one of test 6."""
    curves, lines = oblique(), []
    for name in [name for name in curves if name.startswith("test 6")][:1] if fast else curves:
        found = MeetingsInSpace.of(curves[name]).run((1.0,))
        for quantity, values in largest_errors(curves[name], found).items():
            limit = allowed(name, quantity, DERIVED)
            lines.append(Line.off(f"{name}: {quantity}", "DOP853 at 1e-11 of the same law", values[DERIVED], *limit))
    return Found(lines)


CASES = (Case("chung-ooi-space", SECTION, "Tests 4 to 8 in space, in an oblique plane", turned, quick=False),)
