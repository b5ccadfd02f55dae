"""The grains' numbers: their own, which users know, and the solver's, which follow their order in space."""

import numpy as np

from solvers.grains.lists.contact_list import ContactList
from solvers.grains.lists.neighbours import Neighbours
from solvers.grains.state import GrainState
from solvers.machine.state import Axes, Axis, State
from solvers.machine.units import Units
from solvers.space import order as spatial


class Numbering:
    """The grains' own numbers in solver order, `number` (W, n).

    `ordered` (W, n, axes) m are their positions when they were last numbered. Grains of `diameter` (m) that have mixed
    are renumbered if `follows`.
    """

    def __init__(self, arrays: State, grains: GrainState, lists: Neighbours, diameter: float, follows: bool):
        self.arrays, self.grains, self.lists, self.diameter = arrays, grains, lists, diameter
        self.follows = follows and grains.mobile >= spatial.FEWEST
        self.worlds = np.arange(grains.worlds)[:, None]
        self.number = np.tile(np.arange(grains.mobile), (grains.worlds, 1))
        self.ordered = np.zeros((grains.worlds, grains.mobile, grains.axes))

    def in_solver_order(self, values: np.ndarray) -> np.ndarray:
        """Reorder values (W, n, …) from the grains' own numbers to solver order."""
        return values[self.worlds, self.number]

    def in_own_order(self, values: np.ndarray) -> np.ndarray:
        """Reorder values (W, n, …) from solver order to the grains' own numbers."""
        found = np.empty_like(values)
        found[self.worlds, self.number] = values
        return found

    def follow(self) -> None:
        """Renumber the grains in worlds where they have mixed. The lists expire there."""
        position = self.grains.read()["position"]
        order = {
            w: spatial.spatial_order(places, self.diameter)
            for w, places in enumerate(position)
            if spatial.has_mixed(places, self.ordered[w], self.diameter)
        }
        for w, old in order.items():
            self.number[w], self.ordered[w] = self.number[w][old], position[w][old]
        if order:
            self.arrays.reorder("grain", order)
            lists, odd = self.lists, self.lists.laws.odd
            renumber_list(lists.pairs, lists.units, order, odd, mates=True)
            renumber_list(lists.contacts, lists.units, order, odd, mates=False)
            lists.expire(order)

    def state(self) -> dict[str, np.ndarray]:
        """What `restore` continues from."""
        return {"number": self.number, "ordered": self.ordered}

    def axes(self) -> dict[str, Axes]:
        """The axes of the arrays of `state`, by name."""
        one = Axis("world", self.grains.worlds), Axis("grain", self.grains.mobile)
        return {"number": one, "ordered": (*one, Axis("direction", self.grains.axes))}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore what `state` returned."""
        self.number, self.ordered = np.array(state["number"]), np.array(state["ordered"])


def renumber_list(
    contacts: ContactList, units: Units, order: dict[int, np.ndarray], odd: list[bool], mates: bool
) -> None:
    """Give the grains of some worlds new numbers in a contact list: `order[w]` (n,) are the old numbers in new order.

    What is remembered goes along; the lists must then be built anew before forces are. `odd` tells which memories
    change their sign when the two grains change places; `mates` whether mates are grains, too.
    """
    length, first = contacts.length.to_numpy(), contacts.first.to_numpy()
    grain, mate = contacts.grain.to_numpy(), contacts.mate.to_numpy()
    memory = [field.to_numpy() for field in contacts.memory]
    for w, old in order.items():
        mine = range(w * units.a_world, (w + 1) * units.a_world)
        before = w * contacts.stride
        rows = [_rows(u, length, grain, mate, memory) for u in mine]
        i, j, kept = (np.concatenate(columns) for columns in zip(*rows, strict=True))
        i, j = i - before, j - before
        new = np.empty(max(len(old), int(j.max(initial=0)) + 1), dtype=np.int64)
        new[:] = np.arange(len(new))  # fixed grains and wall features keep their numbers
        new[old] = np.arange(len(old))
        i, j = new[i], new[j] if mates else j
        if mates:
            i, j, kept = _both_ways(i, j, kept, np.where(odd, -1.0, 1.0), len(old))
        for u in mine:
            _fill(u, units, before, i, j, kept, mates, length, first, grain, mate, memory)
    contacts.length.from_numpy(length)
    contacts.first.from_numpy(first)
    for field, values in zip((contacts.grain, contacts.mate, *contacts.memory), (grain, mate, *memory), strict=True):
        field.from_numpy(values)


def _rows(u, length, grain, mate, memory) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """First grains, mates (k,) and memories (k, m) of the contacts of a unit that remember something."""
    count = length[u]
    kept = [values[u].reshape(-1)[:count] for values in memory]
    kept = np.stack(kept, axis=1) if kept else np.zeros((count, 0))
    busy = (kept != 0.0).any(axis=1)
    return grain[u].reshape(-1)[:count][busy], mate[u].reshape(-1)[:count][busy], kept[busy]


def _both_ways(i, j, kept, sign, mobile) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Each pair of moving grains from either side, once."""
    back = j < mobile
    i, j, kept = np.append(i, j[back]), np.append(j, i[back]), np.concatenate([kept, sign * kept[back]])
    _, once = np.unique(np.stack([i, j], axis=1), axis=0, return_index=True)
    return i[once], j[once], kept[once]


def _fill(u, units, before, i, j, kept, mates, length, first, grain, mate, memory) -> None:
    """The list of unit u: the contacts whose first grain is its own, a pair within it once; i and j in their world."""
    start = (u % units.a_world) * units.share
    end = min(units.mobile, start + units.share)
    own = (i >= start) & (i < end)
    if mates:
        own &= ~((j < i) & (j >= start))
    rows = np.flatnonzero(own)
    rows = rows[np.lexsort((j[rows], i[rows]))]
    count = len(rows)
    length[u] = count
    first[u] = np.searchsorted(i[rows] - start, np.arange(first.shape[1]))
    for target, values in ((grain, before + i), (mate, before + j), *zip(memory, kept.T, strict=True)):
        target[u].reshape(-1)[:count] = values[rows]
