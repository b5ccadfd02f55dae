"""How Taichi finds its way in the source of the functions that it traces.

Taichi 1.7.4 looks up and splits the source of a function anew for every place that calls it, wraps its lines, and
draws, for every expression, the source lines with a mark under them, in case that one is wrong: the latter half of the
time that a simulation took to set up. For every field it formats the whole stack of calls that declared it. For every
function it goes through all modules to see whether it stands in a class: a quarter of the time that the lab took to
start.
"""

import inspect
import linecache
import sys
import textwrap
from functools import cache
from types import FrameType, SimpleNamespace

from solvers.machine.errors import NotLoaded


def _not_loaded(error: ImportError) -> NotLoaded:
    """Taichi is not there, or a library of the system that it is linked to is not: mostly X11's, without a desktop."""
    remedy = "libx11-6" if "libX11" in str(error) else "the package that holds it"
    system = f"it is linked to a library that this machine lacks; on Debian and Ubuntu: sudo apt install {remedy}"
    missing = "cannot open shared object file" in str(error)
    return NotLoaded(f"Taichi cannot be loaded ({error}): {system if missing else 'install cargo-shift-lab anew'}.")


def _line_alone(frame: FrameType, context: int = 1) -> inspect.Traceback:
    """`inspect.getframeinfo`, with the one line that runs, and without a search through all modules for its file."""
    code = frame.f_code
    line = linecache.getline(code.co_filename, frame.f_lineno)
    return inspect.Traceback(code.co_filename, frame.f_lineno, code.co_name, [line] if line else None, 0)


_usual = inspect.getframeinfo
inspect.getframeinfo = _line_alone  # while Taichi is loaded, whose own functions are a hundred
try:
    from taichi.lang import impl, kernel_impl, snode
    from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext
except ImportError as error:
    raise _not_loaded(error) from error
finally:
    inspect.getframeinfo = _usual


def remember() -> None:
    """Have Taichi look up each source once, and tell of an expression its file and line alone, of a field nothing."""
    ASTTransformerContext.get_pos_info = _place
    impl.get_traceback = snode.get_traceback = _nowhere
    kernel_impl._inside_class = _inside_class
    kernel_impl.textwrap = SimpleNamespace(fill=cache(textwrap.fill), dedent=cache(textwrap.dedent))
    for name in ("getsourcefile", "getsourcelines"):
        find = getattr(kernel_impl, name)
        if not hasattr(find, "cache_info"):
            setattr(kernel_impl, name, cache(find))


def _place(context: ASTTransformerContext, node) -> str:
    """Where an expression stands, in words."""
    return f'File "{context.file}", line {node.lineno + context.lineno_offset}, in {context.func.func.__name__}:\n'


def _inside_class(level_of_class_stackframe: int) -> bool:
    """Whether the line that runs so many calls up from here begins a class."""
    try:
        frame = sys._getframe(level_of_class_stackframe)
    except ValueError:  # there are fewer
        return False
    line = linecache.getline(frame.f_code.co_filename, frame.f_lineno).strip()
    return any(pattern.match(line) for pattern in kernel_impl._KERNEL_CLASS_STACKFRAME_STMT_RES)


def _nowhere(stacklevel: int = 1) -> str:
    """Where a field was declared: not said."""
    return ""
