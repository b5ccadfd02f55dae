"""Workers on a device and on the processor beside it, timed in turn."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from benchmarks.aside import Aside
from lab.base.errors import LabError
from lab.studies.engine import Kept
from solvers.machine.runtime import available_cores

BESIDE = "processor"  # the name of the worker on all its cores, in mixed precision

Makers = Mapping[str, Callable[[], Aside]]
Timings = dict[str, list]  # by the worker's name, one a turn
Faults = dict[str, str]  # why workers broke off, by name


class Sizes:
    """Timings by size, each kept in the folder `work` once it is done: a bench that breaks off goes on from there."""

    def __init__(self, work: Path, name: str, fast: bool) -> None:
        self.kept = Kept(work / f"{name}.json", "bench gpu", {"fast": fast})

    def timed(self, size: str, makers: Makers, timing: Callable[[Aside], object], turns: int) -> tuple[Timings, Faults]:
        """What `in_turns` returns; `timing` gives numbers."""
        if size not in self.kept:
            print(f"gpu: {size}", flush=True)
            timings, faults = in_turns(makers, timing, turns)
            self.kept.keep(size, {"timings": timings, "faults": faults, "fault": " ".join(faults.values())})
        return self.kept[size]["timings"], self.kept[size]["faults"]


def at_once(work: Callable, asked: Sequence[tuple]) -> list:
    """What `work` gives for each tuple of arguments, on as many threads as there are cores. Raises its first error."""
    with ThreadPoolExecutor(available_cores()) as pool:
        return list(pool.map(lambda given: work(*given), asked))


def in_turns(makers: Makers, timing: Callable[[Aside], object], turns: int) -> tuple[Timings, Faults]:
    """What `timing` gives of each worker in so many turns after one to warm up, and why others broke off, by name.

    Workers are made at the same time, since most of the wait is compiling. Those that break off, as where a device
    lacks room for all, are made again alone.
    """
    found, faults = _together(makers, timing, turns)
    again = list(faults) if len(makers) > 1 else []
    for name in again:
        alone, fault = _together({name: makers[name]}, timing, turns)
        found |= alone
        faults = {other: why for other, why in faults.items() if other != name} | fault
    return found, faults


def _together(makers: Makers, timing: Callable[[Aside], object], turns: int) -> tuple[Timings, Faults]:
    faults: Faults = {}

    def attempt(name: str, what: Callable, *given: object) -> object:
        try:
            return what(*given)
        except LabError as error:
            faults[name] = str(error)
            return None

    with ThreadPoolExecutor(len(makers)) as pool:
        made = dict(zip(makers, pool.map(attempt, makers, makers.values()), strict=True))
    found: Timings = {name: [] for name in makers}
    try:
        for _ in range(1 + turns):
            for name in [name for name in makers if name not in faults]:
                found[name].append(attempt(name, timing, made[name]))
    finally:
        for worker in filter(None, made.values()):
            worker.close()
    return {name: timings[1:] for name, timings in found.items() if name not in faults}, faults


def heading(name: str) -> str:
    """What a column of a worker is called."""
    return f"{name}, {available_cores()} cores, mixed" if name == BESIDE else name
