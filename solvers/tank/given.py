"""What a scene says of a matter: the interface of all that a tank may hold, before there is a simulation of it."""

from typing import ClassVar, Self

from solvers.machine import wide


class Given:
    """What a scene says of one matter, with the answers of one that is simple and moves no particles.

    `worlds`: how many worlds it is given for. `substeps` and `soft_multiple`: how many steps of the scene one of its
    own is, always and while it is soft. `pieces`: how many things of its own bear loads beside the tank's. `thickness`
    (m) of the tank that suits it, None: any. `start_speed` (m/s): highest closing speed at its start. `simple`: whether
    its kernels are short.
    """

    substeps: int = 1
    soft_multiple: int = 1
    start_speed: float = 0.0
    simple: ClassVar[bool] = True
    worlds: int
    pieces = 0
    thickness: float | None = None
    count = 0  # particles in a world
    moved = 0  # of these, those that are moved one by one
    in_bands = 0  # those that the bands of a world are cut by
    start: tuple = ()  # velocities and spins, as `Simulation.launch` takes them, of what starts with some

    @property
    def softened(self) -> Self:
        """As it is at the start, while it is soft."""
        return self

    def lanes(self, precision: str) -> int:
        """Lanes of a block of pairs of grains on real vectors, in it or beside it; 0 for none."""
        return wide.lanes()

    def fills(self, tanks: int) -> tuple[int, ...]:
        """How many particles that never leave their tank are in each of so many tanks."""
        return (0,) * tanks
