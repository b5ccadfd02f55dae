"""Measures, quantities, colours, laws and motions of one's own, from a file that a preset names or from a notebook."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeVar

from lab.base.errors import LabError

Function = TypeVar("Function", bound=Callable)
Kind = TypeVar("Kind", bound=type)

LAWS = "normal", "tangential", "rolling", "twisting", "cohesion"  # kinds of contact laws, as in [contact]


def plugin(path: Path | str) -> None:
    """Load a plug-in from a file of Python; presets that name it in `plugins` may use it from then on."""
    from lab.plugins.loading import load_file

    load_file(path)


def measure(
    function: Function | None = None, *, unit: str = "1", of: str = "", when: Callable | None = None, name: str = ""
) -> Function:
    """A measure: a function of a recording that returns a number for each bed, in `unit`.

    `@cargolab.measure(unit="mm")`; it is named as the function is, and made of every run that it suits: of those with
    the matter `of` ("grains", "water" …) for which `when(recording)` is true. It may also return Values by name. What
    it raises is the note of a number that was not found.
    """

    def register(function: Function) -> Function:
        from lab.measures.own import register

        register(name or function.__name__, function, unit, of, when)
        return function

    return register if function is None else register(function)


def quantity(function: Function | None = None, *, unit: str = "1", label: str = "", name: str = "") -> Function:
    """A quantity that runs record from now on: a function of the solver's simulation and of what it observes by name.

    It returns a number for each bed: `@cargolab.quantity(unit="m") def depth(simulation, now): return
    now["centre_of_mass"][:, 1]`.
    """

    def register(function: Function) -> Function:
        from lab.recording.own import register

        called = name or function.__name__
        register(called, function, unit, label or called.replace("_", " "))
        return function

    return register if function is None else register(function)


def colour(function: Function | None = None, *, label: str = "", name: str = "") -> Function:
    """A colour of grains in films, `video.colour = NAME`: a function of a bed and a frame, a number for each grain.

    A bed has `position(frame)`, `speed(frame)`, `radius` and others; `label` is beside the scale, with the unit.
    """

    def register(function: Function) -> Function:
        from lab.paint.cargo.own import register

        register(name or function.__name__, function, label)
        return function

    return register if function is None else register(function)


def law(kind: str, name: str) -> Callable[[Kind], Kind]:
    """A contact law: a class as the manual's recipe has it, which presets then name in [contact].

    `@cargolab.law("normal", "mine")`; kind: normal, tangential, rolling, twisting or cohesion.
    """
    if kind not in LAWS:
        raise LabError(f"law: {kind!r} is no kind of contact law; choose one of {', '.join(LAWS)}.")

    def register(law: Kind) -> Kind:
        from lab.plugins.loading import owner
        from lab.preset.python.words import add_word
        from lab.preset.sections.contact import Contact
        from solvers.grains import laws

        owner(law)
        getattr(laws, kind.upper())[name] = law
        add_word(Contact, kind, name)
        return law

    return register


def motion(
    function: Function | None = None,
    *,
    moves: str | Mapping[str, str] = "roll",
    unit: str = "",
    parameters: Mapping[str, str] | None = None,
    name: str = "",
) -> Function:
    """A prescribed motion of the tank, a table of [motion] by its name: a function of the time (s).

    `@cargolab.motion(moves="roll", unit="deg", parameters={"amplitude": "deg", "period": "s"})` over `def jerk(time,
    amplitude, period): …`; parameters come and places go in the units said, m or rad without one. moves: sway, heave,
    surge, roll, pitch or yaw, or several with their units, then it returns a tuple. A class is one of the manual's
    recipe.
    """

    def register(function: Function) -> Function:
        from lab.preset.python.motions import register

        register(name or function.__name__, function, moves, unit, parameters or {})
        return function

    return register if function is None else register(function)
