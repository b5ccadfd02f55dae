"""Turn errors of the commands into one sentence on stderr and an exit code.

Exit codes: 0 done; 1 the simulation could not continue; 2 the request cannot be carried out; 130 interrupted by Ctrl-C,
143 by SIGTERM, 129 by SIGHUP.
"""

import os
import sys
import warnings

import click

from lab.base.errors import LabError, os_sentence
from lab.base.interrupt import exit_code, handling_signals
from lab.base.text import one_line
from lab.plugins.loading import asking
from lab.preset.formats import OldFormat
from solvers.machine.errors import BadState, NotLoaded, Unavailable


class Commands(click.Group):
    """A group of commands whose errors are one sentence on stderr."""

    def main(self, *args, **kwargs):
        """Run a command line and exit."""
        # Matrices are small here, and numpy's threads, which spin while they wait, would take cores from the solver.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        if sys.stdin is not None and sys.stdin.isatty() and sys.stderr.isatty():
            asking[:] = [_ask]
        try:
            with handling_signals(), warnings.catch_warnings():
                warnings.showwarning = _warn
                code = super().main(*args, **{**kwargs, "standalone_mode": False})
        except click.exceptions.NoArgsIsHelpError as error:
            error.show()
            code = 2
        except click.Abort as error:  # Ctrl-C and other signals
            sentence = str(error.__cause__ or "") or "interrupted; everything written so far is kept."
            code = _say(sentence, exit_code())
        except click.ClickException as error:
            code = _say(error.format_message(), 2)
        except (LabError, Unavailable, NotLoaded) as error:
            code = _say(str(error), 2)
        except BadState as error:
            code = _say(str(error), 1)
        except OSError as error:
            code = _say(os_sentence(error), 2)
        except MemoryError:
            code = _say("there is not enough memory for this: ask for fewer grains or repeats, or free some.", 2)
        sys.exit(code if isinstance(code, int) else 0)


def _ask(where: str) -> bool:
    """Whether the user allows a plug-in to run."""
    return click.confirm(f"The preset names {where}, code that would run with your rights. Run it?", err=True)


def _warn(message: Warning, category: type[Warning], *where: object) -> None:
    """Say in a sentence what a preset of an earlier format means; any other warning as Python does."""
    if issubclass(category, OldFormat):
        click.echo(f"cargolab: {one_line(str(message))}", err=True)
    else:
        sys.stderr.write(warnings.formatwarning(message, category, *where[:2]))


def _say(sentence: str, code: int) -> int:
    click.echo(f"cargolab: {one_line(sentence)}", err=True)
    return code
