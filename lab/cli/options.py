"""Options that several commands share, and their parsing."""

from pathlib import Path

import click

from lab.base.errors import LabError
from lab.base.text import printable
from lab.cli.completion import Setting
from lab.preset.units import quoted


class FilePath(click.Path):
    """A path on a command line, as `click.Path`; an empty one, which would be the current folder, is refused."""

    def convert(self, value: object, param: click.Parameter | None, context: click.Context | None) -> object:
        """The path. Fails for an empty one, as of a variable of the shell that is not set."""
        if value == "":
            self.fail("the name is empty; write . for the current folder.", param, context)
        return super().convert(value, param, context)


def check_recording(path: Path) -> None:
    """Raise LabError for a place without a recording, before what works on it is loaded, which takes seconds."""
    from lab.recording import open_recording

    open_recording(path).close()


def check_files(*paths: Path | None) -> None:
    """Raise LabError for files that cannot be read; None stands for one that is not given."""
    for path in filter(None, paths):
        try:
            path.open("rb").close()
        except OSError as error:
            raise LabError(f"{path} cannot be read ({error.strerror}); look at its name.") from None


def tell(text: str, err: bool = False) -> None:
    """Print a text, which may hold words of users and files: control codes, which a terminal would obey, become ?."""
    click.echo(printable(text), err=err)


def texts_by_key(texts: tuple[str, ...]) -> dict[str, str]:
    """Split KEY=VALUE texts into texts of values by key."""
    settings = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            raise LabError(f"--set {quoted(text)[1:-1]}: write it like --set grains.diameter='4 mm'.")
        settings[key.strip()] = value.strip()
    return settings


def read_overrides(_context, _option, texts: tuple[str, ...]) -> dict[str, object]:
    """Overrides from KEY=VALUE texts; a value that is not TOML, such as 4 mm, is taken as text."""
    if not texts:
        return {}
    from lab.sweeps.axes import plain

    return {key: plain(text) for key, text in texts_by_key(texts).items()}


def short_overrides(repeats: int | None, arch: str | None) -> dict[str, object]:
    """The overrides from --repeats and --arch."""
    wanted = {"run.repeats": repeats, "run.arch": arch}
    return {key: value for key, value in wanted.items() if value is not None}


def out_option(about: str, shown: str = "", default: Path | None = None):
    """The option --out for a folder; `about`: its content; `shown`: a default that depends on the preset, as a text."""
    return click.option(
        "--out",
        type=FilePath(path_type=Path, file_okay=False),
        metavar="DIR",
        default=default,
        show_default=default is not None,
        help=f"Folder {about}.{f'  [default: {shown}]' if shown else ''}",
    )


set_option = click.option(
    "--set",
    "overrides",
    type=Setting(),
    multiple=True,
    metavar="KEY=VALUE",
    callback=read_overrides,
    help="Change a key of the preset; repeat for more.",
)
repeats_option = click.option("--repeats", type=int, metavar="N", help="Number of beds, each with its own seed.")
arch_option = click.option(
    "--arch", type=click.Choice(["auto", "cpu", "cuda", "vulkan"]), help="Device to run on.  [default: from the preset]"
)
quiet_option = click.option("--quiet", is_flag=True, help="Print only the folder of the results.")
cluster_option = click.option(
    "--cluster", metavar="ADDRESS", help="Run on the workers of this Dask scheduler, e.g. tcp://node1:8786."
)
video_option = click.option("--no-video", is_flag=True, help="Do not paint a video.")
json_option = click.option("--json", "as_json", is_flag=True, help="Print it as JSON, for other programs.")
plots_option = click.option("--no-plots", is_flag=True, help="Do not draw figures.")


class ColourOption(click.Option):
    """An option whose help lists the colourings, which are imported only for the help."""

    def get_help_record(self, context: click.Context) -> tuple[str, str] | None:
        """Flags and help."""
        from lab.preset.sections.video import COLOURS

        self.help = f"Quantity shown by the colour: {', '.join(COLOURS)}."
        return super().get_help_record(context)


def _allow(_context, _option, given: bool) -> None:
    if given:
        from lab.plugins.loading import allow

        allow()


plugins_option = click.option(
    "--plugins",
    is_flag=True,
    expose_value=False,
    is_eager=True,
    callback=_allow,
    help="Run the code of the plug-ins that the preset names.",
)

page_option = out_option("of the page and its figures", default=Path("renders/bench"))
page_only_option = click.option(
    "--page", "page_only", is_flag=True, help="Run nothing: write the page from what is kept."
)
fast_option = click.option("--fast", is_flag=True, help="Only the parts that take seconds.")


def tell_json(found: object) -> None:
    """Print something as JSON, which escapes control codes."""
    import json

    click.echo(json.dumps(found, indent=1, ensure_ascii=True))


def show(result, quiet: bool) -> None:
    """Print the summary, unless `quiet`, and where the results are."""
    if not quiet:
        tell(result.summary_text)
    click.echo(result.folder)
