"""What `cargolab` offers: each call hands on to the room of `lab` that does it, which it loads only then."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cargolab._plugins import colour, law, measure, motion, plugin, quantity
from cargolab._preset import Preset
from cargolab._simulation import Simulation
from lab import __version__, dotted, resume, run, sweep
from lab.base.errors import Told as Error
from lab.preset.python.written import asked

if TYPE_CHECKING:
    import xarray

    from lab.naval.flooding.results import Results
    from lab.naval.hull import Hull
    from lab.preset.cargo.numbers import Cargo
    from lab.recording import Recording
    from lab.sweeps.calibration_report import Calibration
    from lab.sweeps.result import SweepResult

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


def calibrate(
    preset: "str | Path | Mapping | Preset",
    target: str,
    vary: str,
    out: Path | str | None = None,
    *,
    repeats: int | None = None,
    quiet: bool = False,
    cluster: str | None = None,
    **overrides: object,
) -> "Calibration":
    """Find the value of a key at which a measure meets its target, with its interval.

    `cargolab.calibrate("tilting/chickpeas-quick", "repose=30 deg", "friction=0.2:0.7")`; the target may have a standard
    error, "repose=30 ± 0.8 deg". At least eight beds are run. cluster: the address of a Dask scheduler; `overrides` as
    in `run`.
    """
    from lab.preset.find import screen

    name, changes = asked(preset)
    given = changes | dotted(overrides, repeats)
    screen(name, given)  # before the slow imports
    from lab.sweeps.calibrate import calibrate as calibrated

    return calibrated(name, target, vary, given, out, quiet=quiet, cluster=cluster)


def open(path: Path | str, *, sound: bool = False) -> "Recording | SweepResult":
    """Open the recording in a run's folder, or its file, for reading: `series`, `frames`, `tree()`.

    sound: leave out the rows from the first damaged one on. Of a sweep's folder it is the sweep's result: `dataset()`.
    """
    from lab.sweeps.request import SWEEP

    if (Path(path) / SWEEP).is_file():
        from lab.sweeps.sweep import open_sweep

        return open_sweep(path)
    from lab.recording import open_recording

    return open_recording(path, sound=sound)


def fields(
    of: "Recording | Simulation | Path | str",
    frame: int = -1,
    world: int = 0,
    *,
    spacing: float | None = None,
    width: float | None = None,
) -> "xarray.Dataset":
    """Porosity, density, velocity, stress and pressure of a bed on a grid: `cargolab.fields("renders/tilting/quick")`.

    By coarse graining over Lucy's function of the half width `width` (m; 1.5 mean diameters without it), at nodes
    `spacing` apart. frame: of a recording, the last one without it; of a simulation it is the present state.
    """
    from lab.recording.fields.reading import fields_of, recorded_bed

    if isinstance(of, Simulation):
        return fields_of(of.bed(world), spacing, width)
    return fields_of(recorded_bed(open(of) if isinstance(of, str | Path) else of, frame, world), spacing, width)


def water_at(
    of: "Recording | Path | str", points: "Sequence[Sequence[float]]", frame: int = -1, world: int = 0
) -> "xarray.Dataset":
    """Pressure and velocity of the water at points (k, axes), m in the tank's frame; NaN where there is no water."""
    from lab.recording.fields.reading import water_at as found

    return found(open(of) if isinstance(of, str | Path) else of, points, frame, world)


def hull(
    file: Path | str,
    *,
    density: float = 1025.0,
    fair: bool = False,
    lbp: float | None = None,
    ap: float = 0.0,
    stations: int = 41,
    scale: float = 1.0,
    up: str = "z",
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
    mirror: bool = False,
    close: bool = False,
) -> "Hull":
    """The hull of a table of offsets (CSV) or a surface (STL): `hull.at(8.5)`, `hull.at(displacement=32000, trim=0.6)`.

    `hull.table()` has hydrostatics at round draughts, `hull.form` righting levers. density: of the water, kg/m³. The
    others are the options of `cargolab hull`: lengths in m. Of a ship file, which says these itself, it has
    `conditions`, `tanks` and `holds` by name, too: `hull("ship.toml").conditions["departure"].metacentric_height`.
    """
    from lab.naval.ship_file.reading import is_ship_file

    if is_ship_file(Path(file)):
        from lab.base.errors import LabError
        from lab.naval.ship_file.ship import read_ship

        given = (density, fair, lbp, ap, stations, scale, up, tuple(origin), mirror, close)
        if given != (1025.0, False, None, 0.0, 41, 1.0, "z", (0.0, 0.0, 0.0), False, False):
            raise LabError(f"{Path(file).name}: a ship file says the options of the hull itself; leave them out.")
        return read_ship(file)
    from lab.naval.hull import read_hull
    from lab.naval.surfaces.axes import Axes

    axes = Axes(scale, up, origin, mirror, close)
    return read_hull(file, density=density, fair=fair, stations=stations, axes=axes, lbp=lbp, ap=ap)


def flood(case: Path | str, out: Path | str | None = None, *, video: bool = True, **overrides: object) -> "Results":
    """Flood the ship of a case, a TOML file or one of the lab's own: `cargolab.flood("wing-tank").largest`.

    `cargolab.flood("cabin-side", ship__vcg="57 mm")`; `time`, `heel`, `volume`, `deck_time`, `stages` and others are
    fields of what it returns. With `out`, page and tables are written into that folder, with `video` the film, too.
    """
    from lab.naval.flooding.case import load_case
    from lab.naval.flooding.results import compute

    loaded = load_case(case, dotted(overrides))
    results = compute(loaded)
    if out is not None:
        from lab.report.flooding.page import write

        write(loaded, results, Path(out), video)
    return results


def presets(word: str = "") -> dict[str, str]:
    """The titles of the shipped presets by name; of those alone whose name begins with `word`, if it is given."""
    from lab.preset.find import names

    return {name: title for name, title in names().items() if name.startswith(word)}


def cargoes(name: str | Path = "") -> "dict[str, Cargo]":
    """The cargoes of the library by name, with their numbers (SI) and sources; of a name or a cargo file, that alone.

    `cargolab.cargoes("soybeans")["soybeans"].number("density").value` is in kg/m³. Raises cargolab.Error.
    """
    from lab.preset.cargo.cargoes import asked as found

    return found(name)


def explain(preset: "str | Path | Mapping | Preset", **overrides: object) -> str:
    """What a preset simulates, by which models, and what it will cost; `overrides` as in `run`."""
    from lab.preset.find import load

    name, changes = asked(preset)
    loaded = load(name, changes | dotted(overrides))
    from lab.report.explain import explain as explained

    return explained(loaded)


def export(
    path: Path | str,
    to: str,
    out: Path | str | None = None,
    *,
    every: int = 1,
    world: int | None = None,
    frame: str | None = None,
    sound: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write a recording for other programs and return the path: `cargolab.export("renders/tilting/quick", "gsd")`.

    to: vtkhdf (ParaView), gsd (OVITO), xyz, csv, netcdf (xarray) or html, a player for any browser. out: a new file, or
    a new folder for vtkhdf and csv. every: one of so many frames. world: one of the repeats, from 0; by default the
    first, and all of them in netcdf. frame: earth or tank. sound: only the rows before the first damaged one.
    """
    from lab.export.exporting import export_recording

    return export_recording(path, to, out, every=every, world=world, frame=frame, sound=sound, progress=progress)


def render(
    path: Path | str,
    out: Path | str | None = None,
    *,
    png: bool = False,
    world: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    **look: object,
) -> Path:
    """Paint the video of a recording again and return its path; `look` are keys of [video], such as colour="layer".

    out: an .mp4, .gif or .webp file; with `png` a folder of single pictures. world: one of the repeats, from 0.
    """
    from lab.paint.video import render_recording

    return render_recording(path, out, png=png, world=world, progress=progress, **look)


def view(
    preset: "str | Path | Mapping | Preset | None" = None,
    out: Path | str | None = None,
    *,
    size: tuple[int, int] = (1280, 720),
    **overrides: object,
) -> Path | None:
    """Run a preset live in a window and steer it; returns the folder of what was kept. Without one, choose there."""
    from lab.view.windows import open_window

    name, changes = (None, {}) if preset is None else asked(preset)
    return open_window(name, changes | dotted(overrides), size, None if out is None else Path(out), "auto")
