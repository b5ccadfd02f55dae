"""Cargo Shift Lab in Python: `cargolab.run("tilting/quick")` runs an experiment and returns numbers with their errors.

Importing loads nothing; what a call needs is loaded by the call. `lab` and `solvers`, the packages behind these names,
may change between versions; these names stay.
"""

from typing import TYPE_CHECKING

from cargolab import _hidden

if TYPE_CHECKING:
    from cargolab._calls import (
        Error,
        Preset,
        Simulation,
        __version__,
        calibrate,
        cargoes,
        colour,
        explain,
        export,
        fields,
        flood,
        hull,
        law,
        measure,
        motion,
        open,
        plugin,
        presets,
        quantity,
        render,
        resume,
        run,
        sweep,
        view,
        water_at,
    )

__all__ = [
    "Error",
    "Preset",
    "Simulation",
    "__version__",
    "calibrate",
    "cargoes",
    "colour",
    "explain",
    "export",
    "fields",
    "flood",
    "hull",
    "law",
    "measure",
    "motion",
    "open",
    "plugin",
    "presets",
    "quantity",
    "render",
    "resume",
    "run",
    "sweep",
    "view",
    "water_at",
]


def __getattr__(name: str) -> object:
    """One of the names above. Raises ImportError where a user's own file hides the lab."""
    if name not in __all__:
        raise AttributeError(f"cargolab has no {name}; it has {', '.join(__all__)}")
    _hidden.check()
    from cargolab import _calls

    found = globals()[name] = getattr(_calls, name)
    return found


def __dir__() -> list[str]:
    return __all__
