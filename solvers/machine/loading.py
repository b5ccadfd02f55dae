"""Taichi, loaded without its search for where each of its own functions stands.

Taichi 1.7.4 asks of every function that it declares whether the line that runs begins a class, and for that line Python
goes through all modules there are: a third of the time that Taichi takes to load, and more the more there are.
`machine.sources` does the same for the lab's functions.
"""

import inspect
import linecache
from types import FrameType


def _line_alone(frame: FrameType, context: int = 1) -> inspect.Traceback:
    """`inspect.getframeinfo`, with the one line that runs."""
    code = frame.f_code
    line = linecache.getline(code.co_filename, frame.f_lineno)
    return inspect.Traceback(code.co_filename, frame.f_lineno, code.co_name, [line] if line else None, 0)


_usual = inspect.getframeinfo
inspect.getframeinfo = _line_alone
try:
    import taichi  # noqa: F401 (`machine.runtime` takes it from here)
finally:
    inspect.getframeinfo = _usual
