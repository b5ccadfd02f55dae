"""One thread of a process at a time: Taichi, which computes and paints, has one program in a process.

A second thread would start it anew under the first one's hands, or compile kernels in it, which Taichi answers with a
failed assertion. Threads one after another are fine.
"""

from collections.abc import Callable
from functools import wraps
from threading import RLock
from typing import ParamSpec, TypeVar

from lab.base.errors import LabError

Given, Found = ParamSpec("Given"), TypeVar("Found")
_turn = RLock()


def in_turn(act: Callable[Given, Found]) -> Callable[Given, Found]:
    """A function that uses Taichi; it raises LabError while another thread is in one such."""

    @wraps(act)
    def alone(*given: Given.args, **options: Given.kwargs) -> Found:
        if not _turn.acquire(blocking=False):
            raise LabError(
                "the lab is at work in another thread of this process, which can do one thing at a time: wait until it "
                "ends, use a process for each, or run several beds at once (run.repeats, or a sweep)."
            )
        try:
            return act(*given, **options)
        finally:
            _turn.release()

    return alone
