"""Objects in processes of their own: Taichi has one number of threads and one precision a process."""

from collections.abc import Callable
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection

from lab.base.errors import LabError
from solvers.machine.errors import BadState, Unavailable


class Aside:
    """What `make(*given)` gives, in a process of its own; it rests unless a method of it is asked for.

    Raises LabError if it cannot be made or breaks off.
    """

    def __init__(self, make: Callable, *given: object):
        context = get_context("spawn")  # Taichi hangs in a fork
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_serve, args=(theirs, make, given), daemon=True)
        self._process.start()
        theirs.close()
        self._answer()

    def ask(self, method: str, *given: object) -> object:
        """What a method of it returns, which is no text."""
        with suppress(BrokenPipeError):  # what it said last is still to be read
            self._pipe.send((method, given))
        return self._answer()

    def close(self) -> None:
        """End the process."""
        self._pipe.close()
        self._process.join()

    def _answer(self) -> object:
        try:
            answer = self._pipe.recv()
        except EOFError:
            raise LabError("a process that times a simulation broke off.") from None
        if isinstance(answer, str):
            raise LabError(answer)
        return answer


def _serve(pipe: Connection, make: Callable, given: tuple) -> None:
    """Make it and say so, then answer each question; an error is a text."""
    try:
        held = make(*given)
        pipe.send(None)
        while True:
            method, asked = pipe.recv()
            pipe.send(getattr(held, method)(*asked))
    except EOFError:  # nobody asks any more
        pass
    except (BadState, Unavailable) as error:
        pipe.send(str(error))
