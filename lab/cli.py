"""The command `cargolab`: every fault of a person's making ends in one sentence and an exit code.

Exit codes: 0 done; 1 the simulation could not go on; 2 what was asked for cannot be done; 130 interrupted by Ctrl-C,
143 by SIGTERM, 129 by SIGHUP.
"""

import errno
import os
import sys
from pathlib import Path

import click

from lab import __version__
from lab.base.errors import LabError
from lab.base.interrupt import exit_code, heeding
from lab.base.text import one_line
from lab.preset.units import quoted
from solvers.machine.errors import BadState, Unavailable

REMEDIES = {
    errno.ENOSPC: "free some space or choose another folder with --out",
    errno.EDQUOT: "free some space or choose another folder with --out",
    errno.EACCES: "choose another folder with --out",
    errno.EPERM: "choose another folder with --out",
    errno.EROFS: "choose another folder with --out",
}


class Commands(click.Group):
    """A group whose errors are one sentence on stderr."""

    def main(self, *args, **kwargs):
        """Run a command line and exit."""
        # Matrices are small here, and threads of numpy's that wait by spinning would take the cores from the grains.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        try:
            with heeding():
                code = super().main(*args, **{**kwargs, "standalone_mode": False})
        except click.exceptions.NoArgsIsHelpError as error:
            error.show()
            code = 2
        except click.Abort as error:  # Ctrl-C and its like
            said = str(error.__cause__ or "") or "interrupted; what was written until then is kept."
            code = _say(said, exit_code())
        except click.ClickException as error:
            code = _say(error.format_message(), 2)
        except (LabError, Unavailable) as error:
            code = _say(str(error), 2)
        except BadState as error:
            code = _say(str(error), 1)
        except OSError as error:
            code = _say(_os_sentence(error), 2)
        except MemoryError:
            code = _say("there is not enough memory for this: ask for fewer grains or repeats, or free some.", 2)
        sys.exit(code if isinstance(code, int) else 0)


def _say(sentence: str, code: int) -> int:
    click.echo(f"cargolab: {one_line(sentence)}", err=True)
    return code


def _os_sentence(error: OSError) -> str:
    where = f"{error.filename}: " if error.filename else ""
    what = error.strerror or str(error) or type(error).__name__
    remedy = REMEDIES.get(error.errno)
    return f"{where}{what[0].lower()}{what[1:]}{f'; {remedy}' if remedy else ''}."


def _settings(texts: tuple[str, ...]) -> dict[str, str]:
    """The texts of values by key, from KEY=VALUE texts."""
    settings = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            raise LabError(f"--set {quoted(text)[1:-1]}: write it like --set grains.diameter='4 mm'.")
        settings[key.strip()] = value.strip()
    return settings


def _overrides(_context, _option, texts: tuple[str, ...]) -> dict[str, object]:
    """Overrides from KEY=VALUE texts; a value that is not TOML, such as 4 mm, is taken as text."""
    if not texts:
        return {}
    from lab.sweeps.axes import plain

    return {key: plain(text) for key, text in _settings(texts).items()}


def _shortcuts(repeats: int | None, arch: str | None) -> dict[str, object]:
    """The overrides that have options of their own."""
    wanted = {"run.repeats": repeats, "run.arch": arch}
    return {key: value for key, value in wanted.items() if value is not None}


set_option = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="KEY=VALUE",
    callback=_overrides,
    help="Change a key of the preset; repeat for more.",
)
repeats_option = click.option("--repeats", type=int, metavar="N", help="Beds, each with its own seed.")
arch_option = click.option(
    "--arch", type=click.Choice(["auto", "cpu", "cuda", "vulkan"]), help="What computes.  [default: as the preset says]"
)
quiet_option = click.option("--quiet", is_flag=True, help="Say only where the results are.")
cluster_option = click.option(
    "--cluster", metavar="ADDRESS", help="Run on the workers of this Dask scheduler, e.g. tcp://node1:8786."
)
video_option = click.option("--no-video", is_flag=True, help="Do not paint a video.")


class ColourOption(click.Option):
    """An option whose help names the colourings; they are slow to import, and only help needs them."""

    def get_help_record(self, context: click.Context) -> tuple[str, str] | None:
        """Flags and help."""
        from lab.paint.colours import MODES

        self.help = f"What the colour says: {', '.join(MODES)}."
        return super().get_help_record(context)


def _show(result, quiet: bool) -> None:
    if not quiet:
        click.echo(result.summary_text)
    click.echo(result.folder)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="cargolab", message="%(prog)s %(version)s", help="Show the version.")
def main() -> None:
    """Experiments on loose cargo: run one, watch it, get a number with its error.

    \b
    cargolab list                    what there is
    cargolab run tilting/quick       run one, with video, plot and summary
    cargolab view tilting/quick      run one live in a window, under your hand
    cargolab explain tilting/quick   what it is and what it will cost
    cargolab sweep shaking/sway ...  run one for many values of its keys
    cargolab resume DIR              go on with a run or sweep that was cut short
    """


@main.command("list")
def list_presets() -> None:
    """List the presets."""
    from lab.preset.find import QUICK, names

    titles = names()
    shown = {
        name + f"[{QUICK}]" * (name + QUICK in titles): title
        for name, title in titles.items()
        if not name.endswith(QUICK)
    }
    width = max(map(len, shown), default=0)
    for name, title in shown.items():
        click.echo(f"{name:<{width}}  {title}")
    click.echo(f"\n[{QUICK}]: also by that longer name, cheaper and less exact", err=True)


@main.command()
@click.argument("preset", required=False)
@set_option
@click.option(
    "--replay",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Instead of a preset: a recording of `cargolab view`, steered again as it was, bit for bit.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    help="Folder for the results.  [default: renders/PRESET]",
)
@repeats_option
@arch_option
@video_option
@quiet_option
def run(
    preset: str | None,
    overrides: dict,
    replay: Path | None,
    out: Path | None,
    repeats: int | None,
    arch: str | None,
    no_video: bool,
    quiet: bool,
) -> None:
    """Run PRESET: a name from `cargolab list`, or your own .toml file.

    \b
    cargolab run tilting/quick
    cargolab run tilting/quick --set grains.diameter="4 mm" --repeats 12
    cargolab run shaking/roll --set motion.roll.centre='["0 mm", "0 mm"]' --out centre0
    cargolab run my.toml --no-video
    cargolab run --replay renders/view/tilting/quick
    """
    overrides |= _shortcuts(repeats, arch)
    if replay is not None:
        if preset is not None or overrides:
            raise LabError("--replay: repeats a recording as it was; leave out the preset and all changes.")
        from lab.view.replay import replay as replayed

        _show(replayed(replay, out, video=not no_video, quiet=quiet), quiet)
        return
    if preset is None:
        raise LabError("run: which preset? `cargolab list` shows all.")
    from lab.preset.find import load

    load(preset, overrides)  # before the slow imports, so that a slip is answered at once
    from lab.runs.runner import run_preset

    _show(run_preset(preset, overrides, out, video=not no_video, quiet=quiet), quiet)


@main.command()
@click.argument("preset", required=False)
@set_option
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    help="Folder for what is recorded.  [default: renders/view/PRESET]",
)
@click.option("--size", default="1280x720", show_default=True, metavar="WIDTHxHEIGHT", help="Of the window, in pixels.")
@click.option(
    "--window",
    type=click.Choice(["auto", "ggui", "gui"]),
    default="auto",
    help="GGUI needs Vulkan; gui is drawn by the processor.  [default: the first that opens]",
)
def view(preset: str | None, overrides: dict, out: Path | None, size: str, window: str) -> None:
    """Run PRESET live in a window: tilt and shake the tank, change friction, look back, keep what you saw.

    \b
    cargolab view                                         choose one there
    cargolab view tilting/quick
    cargolab view shaking/sway-quick --set grains.diameter="4 mm" --size 1920x1080
    cargolab run --replay renders/view/tilting/quick      the same again, without a window
    """
    from lab.preset.find import load

    pixels = _pixels(size)
    if preset:
        load(preset, overrides)
    from lab.view.windows import open_window

    if folder := open_window(preset, overrides, pixels, out, window):
        click.echo(folder)


def _pixels(text: str) -> tuple[int, int]:
    """Width and height from 1280x720."""
    width, _, height = text.lower().partition("x")
    if not (width.isdigit() and height.isdigit() and 640 <= int(width) <= 7680 and 360 <= int(height) <= 4320):
        raise LabError(f"--size {quoted(text)[1:-1]}: write it like --size 1280x720; at least 640x360.")
    return int(width), int(height)


@main.command()
@click.argument("preset")
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUES",
    help="Values of a key: a range FROM:TO:NUMBER, with :log for a logarithmic one, or a list; one value just sets it.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    help="Folder for the results.  [default: renders/PRESET-sweep]",
)
@repeats_option
@arch_option
@video_option
@cluster_option
@quiet_option
def sweep(
    preset: str,
    settings: tuple[str, ...],
    out: Path | None,
    repeats: int | None,
    arch: str | None,
    no_video: bool,
    cluster: str | None,
    quiet: bool,
) -> None:
    """Run PRESET for every combination of the values of its keys.

    \b
    cargolab sweep shaking/sway --set motion.sway.frequency="0.2:1.5:14 Hz" --repeats 12
    cargolab sweep tilting/quick --set grains.diameter="2, 3, 4 mm" --set material.friction=0.1:0.5:5
    cargolab sweep shaking/sway --set run.seed=1:200:200 --cluster tcp://node1:8786
    Asked again, it goes on where it was cut short.
    """
    from lab.sweeps.sweep import run_sweep

    axes = _settings(settings)
    shortcuts = _shortcuts(repeats, arch)
    _show(run_sweep(preset, axes, shortcuts, out, video=not no_video, quiet=quiet, cluster=cluster), quiet)


@main.command()
@click.argument("preset")
@click.option("--target", required=True, metavar="MEASURE=VALUE", help="What a measure is to be.")
@click.option("--vary", required=True, metavar="KEY=FROM:TO", help="The key to find the value of, and its range.")
@set_option
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    help="Folder for the results.  [default: renders/PRESET-calibration]",
)
@repeats_option
@arch_option
@cluster_option
@quiet_option
def calibrate(
    preset: str,
    target: str,
    vary: str,
    overrides: dict,
    out: Path | None,
    repeats: int | None,
    arch: str | None,
    cluster: str | None,
    quiet: bool,
) -> None:
    """Find the value of a key of PRESET at which a measure meets its target, with its interval.

    Runs eight beds at the least unless --repeats says otherwise. A target may have a standard error.

    \b
    cargolab calibrate tilting/chickpeas-quick --target "repose=30 deg" --vary friction=0.2:0.7
    cargolab calibrate tilting/chickpeas-quick --target "repose=30 ± 0.8 deg" --vary friction=0.2:0.7 --repeats 24
    cargolab calibrate shaking/sway --target "response_amplitude=2 mm" --vary "motion.sway.frequency=0.8 Hz:2 Hz"
    cargolab calibrate tilting/acetate --target "repose=25 deg" --vary friction=0.2:0.7 --cluster tcp://node1:8786
    """
    from lab.sweeps.calibrate import calibrate as calibrated

    overrides |= _shortcuts(repeats, arch)
    click.echo(calibrated(preset, target, vary, overrides, out, quiet=quiet, cluster=cluster).text())


@main.command()
@click.argument("folder", type=click.Path(path_type=Path))
@video_option
@quiet_option
def resume(folder: Path, no_video: bool, quiet: bool) -> None:
    """Go on with the run, sweep or calibration in FOLDER that was killed, interrupted or stopped.

    \b
    cargolab resume renders/tilting/quick
    """
    from lab.sweeps.sweep import resume_any

    _show(resume_any(folder, video=not no_video, quiet=quiet), quiet)


@main.command()
@click.argument("recording", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="An .mp4 file, or with --png a folder.  [default: beside the recording]",
)
@click.option("--colour", cls=ColourOption)
@click.option("--frame", help="Whose frame to draw in: tank or earth.")
@click.option("--width", type=int, help="Pixels.")
@click.option("--height", type=int, help="Pixels.")
@click.option("--world", type=int, help="One of the repeats, from 0.  [default: side by side]")
@click.option("--png/--mp4", default=False, help="Single pictures, or a video (the default).")
@click.option("--sound", is_flag=True, help="Of a damaged recording: only what lies before the damage.")
def render(recording: Path, out: Path | None, png: bool, **look: object) -> None:
    """Paint the video of RECORDING (a recording.h5 or the folder of a run) anew.

    \b
    cargolab render renders/tilting/quick --colour displacement --out shift.mp4
    cargolab render renders/tilting/quick --frame earth --world 2
    cargolab render renders/tilting/quick --png --out pictures
    """
    from lab.base.progress import Progress
    from lab.paint.video import render_recording

    with Progress(quiet=False) as progress:

        def count(done: int, total: int) -> None:
            if done == 1:  # not before: what cannot be painted is said in one line
                progress.start("painting", total)
            progress.reach(done)

        path = render_recording(recording, out, png=png, progress=count, **look)
    click.echo(path)


@main.command()
@click.argument("preset")
@set_option
def explain(preset: str, overrides: dict) -> None:
    """Say what PRESET is, what it switches on and what it will cost.

    \b
    cargolab explain shaking/sway
    cargolab explain shaking/sway --set motion.sway.frequency="0.8 Hz"
    """
    from lab.preset.find import load
    from lab.report.explain import explain as explained

    click.echo(explained(load(preset, overrides)))


page_option = click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    default=Path("renders/bench"),
    show_default=True,
    help="Folder of the page and its figures.",
)
fast_option = click.option("--fast", is_flag=True, help="Only what takes seconds.")


@main.command()
@click.argument("cases", nargs=-1)
@page_option
@fast_option
def verify(cases: tuple[str, ...], out: Path, fast: bool) -> None:
    """Compare small scenes with closed forms, independent integrations and published numbers.

    \b
    cargolab verify                     all CASES, and a page with a table and figures
    cargolab verify --fast
    cargolab verify oblique incline     those whose names begin like this
    """
    from lab.studies.verify import run_cases

    if not run_cases(cases, out, fast):
        sys.exit(1)


@main.command()
@click.argument("what", metavar="REPORT", type=click.Choice(["granular", "shapes", "ship"]))
@click.argument("experiments", nargs=-1)
@click.option("--quick", is_flag=True, help="Fewer beds, faster tilts, draft accuracy: under 20 minutes on two cores.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    default=Path("renders/reproduce"),
    show_default=True,
    help="Folder of the report and of its runs.",
)
@cluster_option
@quiet_option
def reproduce(
    what: str, experiments: tuple[str, ...], quick: bool, out: Path, cluster: str | None, quiet: bool
) -> None:
    """Run the experiments of the source and write one report: what it states, what we get, the difference, the cost.

    \b
    cargolab reproduce granular --quick
    cargolab reproduce granular                 hours on two cores; asked again, it goes on
    cargolab reproduce granular tilt-fill stack EXPERIMENTS whose names begin like this
    cargolab reproduce shapes --quick           those with irregular grains
    cargolab reproduce ship --quick             those with ships in waves
    cargolab reproduce granular --cluster tcp://node1:8786
    """
    from lab.studies.reproduce import reproduce as reproduced

    click.echo(reproduced(what, experiments, out, quick, quiet, cluster))


@main.command()
@click.argument("presets", nargs=-1)
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    default=Path("renders/gallery/presets"),
    show_default=True,
    help="Folder of the page.",
)
@click.option("--repeats", "beds", type=click.IntRange(1), default=1, show_default=True, help="Beds of each preset.")
@quiet_option
def gallery(presets: tuple[str, ...], out: Path, beds: int, quiet: bool) -> None:
    """Run every preset, or those whose names begin like PRESETS, and show them on one page: clips and numbers.

    \b
    cargolab gallery                  some hours on two cores; asked again, it goes on
    cargolab gallery tilting funnel
    """
    from lab.studies.gallery import make_gallery

    click.echo(make_gallery(presets, out, quiet, beds))


@main.group()
def bench() -> None:
    """Measure what the lab's numbers cost and how far to trust them; each writes a page with tables and figures."""


@bench.command()
@click.argument("studies", nargs=-1)
@page_option
@fast_option
def accuracy(studies: tuple[str, ...], out: Path, fast: bool) -> None:
    """Error against cost: integrator, step, stiffness, precision, tilt rate, laws, repeats; why the defaults are so.

    \b
    cargolab bench accuracy                an hour or two on two cores; asked again, it goes on
    cargolab bench accuracy stiffness rate
    """
    from lab.studies.bench.accuracy import run_page

    click.echo(run_page(studies, out, fast))


@bench.command()
@click.argument("cases", nargs=-1)
@page_option
@fast_option
def stability(cases: tuple[str, ...], out: Path, fast: bool) -> None:
    """Hard cases at the automatic step and far beyond it: still right, or stopped with a sentence.

    \b
    cargolab bench stability
    cargolab bench stability impact column
    """
    from lab.studies.bench.stability import run_cases

    if not run_cases(cases, out, fast):
        sys.exit(1)


@bench.command()
@click.argument("studies", nargs=-1)
@page_option
@fast_option
def speed(studies: tuple[str, ...], out: Path, fast: bool) -> None:
    """Grain-steps a second by grains, worlds, precision, schedule and threads; where a step's time goes; other codes.

    \b
    cargolab bench speed
    cargolab bench speed peers          beside LIGGGHTS and LAMMPS, where they are installed
    """
    from lab.studies.bench.speed import run_page

    click.echo(run_page(studies, out, fast))


@bench.command()
@click.argument("cases", nargs=-1)
@click.option("--kills", type=click.IntRange(min=1), metavar="N", help="Of each kind of command.  [default: 50]")
@page_option
@fast_option
def survival(cases: tuple[str, ...], kills: int | None, out: Path, fast: bool) -> None:
    """Kill the lab at random times, starve and mislead it; count how it ends.

    \b
    cargolab bench survival                   all of it; --fast: a few kills, odd folders, things that lack
    cargolab bench survival kill --kills 200
    """
    from lab.studies.bench.survival import run_cases

    if not run_cases(cases, out, fast, kills):
        sys.exit(1)


@bench.command()
@page_option
@fast_option
def outlines(out: Path, fast: bool) -> None:
    """How irregular grains touch: what energy each rule loses, by nodes, and what a step costs."""
    from lab.studies.bench.outlines import run_page

    click.echo(run_page(out, fast))


@bench.command()
@page_option
@fast_option
def gpu(out: Path, fast: bool) -> None:
    """Correctness against the CPU and speed on CUDA and Vulkan, where there is such a device."""
    from lab.studies.bench.gpu import run_page

    click.echo(run_page(out, fast))
