"""What a run costs: wall-clock time by what it went into, each second counted once."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from solvers.machine import compiling

PARTS = ("import", "compile", "settle", "run", "measures", "plots", "video")

_importing = 0.0  # s spent on imports that no run has counted yet


@contextmanager
def importing() -> Iterator[None]:
    """Count what is done inside as imports of the next run."""
    global _importing
    begun = time.perf_counter()
    try:
        yield
    finally:
        _importing += time.perf_counter() - begun


class Costs:
    """Seconds of a run by PARTS, from now on; imports come from before.

    `settle` is the scene and its bed. A video, painted beside measures and plots, counts as far as it takes longer.
    Kernels are compiled when they are first needed, within other parts: that time is `compile` and not theirs.
    """

    def __init__(self) -> None:
        global _importing
        self.seconds = dict.fromkeys(PARTS, 0.0) | {"import": _importing}
        self._begun, _importing = time.perf_counter() - _importing, 0.0

    @contextmanager
    def of(self, part: str) -> Iterator[None]:
        """Count what is done inside as this part; parts do not hold each other."""
        begun, compiled = time.perf_counter(), compiling.seconds()
        try:
            yield
        finally:
            new = compiling.seconds() - compiled
            self.seconds["compile"] += new
            self.seconds[part] += time.perf_counter() - begun - new

    def told(self) -> Mapping[str, float]:
        """Seconds by part, with what has no name as `rest` and the `whole` until now."""
        whole = time.perf_counter() - self._begun
        found = self.seconds | {"rest": whole - sum(self.seconds.values()), "whole": whole}
        return {part: round(spent, 3) for part, spent in found.items()}


def in_words(seconds: Mapping[str, float]) -> str:
    """Where the time went, as `Costs.told` has it."""
    return f"{seconds['whole']:.1f} s in all: {', '.join(f'{part} {seconds[part]:.1f} s' for part in PARTS)}"
