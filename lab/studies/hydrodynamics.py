"""`cargolab hydrodynamics`: a ship's coefficients by her section, by strips and in space, side by side."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from lab.assembly.ship import MEMORY_ORDER
from lab.base.errors import LabError
from lab.base.files import write_text
from lab.naval.linear_water import by, linear_motion, peaks, table_in_calm
from lab.naval.rolling.preset_sea import has_spectrum, in_her_sea, told
from lab.naval.tables import write
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from solvers.ship.potential.memory import fit_memory, retardation
from solvers.ship.potential.radiation import Hydrodynamics

KINDS = {"section": "section, in the plane", "strips": "strips of the hull", "hull": "hull in space"}
MODES = "sway", "heave", "roll"
UNITS = (("kg/m", "kg/m", "kg m"), ("kg/(m s)", "kg/(m s)", "kg m/s"), ("kPa", "kPa", "kN"))
QUANTITIES = "added mass", "damping", "excitation"
SHOWN = 2.0  # √(g/draught): up to there coefficients are drawn
STEP = 0.002  # √(g/draught), of the response
STRONG = 0.1  # of the largest excitation of a mode: where Haskind's relation is judged
PAGE = """# Coefficients of {name}: section, strips, hull in space

Written by `cargolab hydrodynamics {name}`. All are for each metre of her length, in waves from abeam. Haskind's \
relation gives the excitation from the waves that she makes: the largest difference, of the excitation, where \
this is more than a tenth of its largest. The memory's error is that of the linear system that the time loop \
steps.

| coefficients of | roll peaks by linear theory | Haskind's relation | error of the memory |
| --- | --- | --- | --- |
{rows}

![Added mass, damping and excitation](coefficients.png)

![Roll for each metre of wave, and the retardation function](response.png)
"""
SIZE, LOW = (8.4, 7.6), (7.4, 4.0)


def compare(loaded: LoadedPreset, out: Path | None) -> tuple[str, Path]:
    """Write tables and figures of a preset's ship; returns the text to show and the folder.

    Raises LabError without a ship or her length.
    """
    preset = loaded.resolved
    if preset.ship is None:
        raise LabError(f"{loaded.name}: has no ship; take one of ship/…")
    if preset.ship.length is None:
        raise LabError("ship.length: missing; strips and a hull need it.")
    folder = out or Path("renders/hydrodynamics") / loaded.name
    tables, lines, rows = {}, [], []
    for kind in KINDS:
        try:
            tables[kind] = table_in_calm(by(preset, kind))
        except LabError as error:
            lines.append(f"{KINDS[kind]}: left out. {error}")
    omega = _frequencies(preset, tables["section"])
    moves = {kind: linear_motion(by(preset, kind), omega) for kind in tables}
    for kind, table in tables.items():
        found = [f"{at:.3f} rad/s ({high:.3g} rad/m)" for at, high in peaks(omega, np.abs(moves[kind][:, 2]))]
        haskind = ", ".join(f"{mode} {100.0 * miss:.2g} %" for mode, miss in _haskind(table, omega[-1]).items())
        fitted = ", ".join(f"{mode} {100.0 * miss:.2g} %" for mode, miss in _fit(preset, table).items())
        lines += [f"{KINDS[kind]}: roll peaks at {', '.join(found) or 'none'}"]
        lines += [f"  Haskind's relation within {haskind}", f"  memory's rms error {fitted}"]
        lines += [f"  {told(in_her_sea(preset, kind))}"] if has_spectrum(preset) else []
        rows.append(f"| {KINDS[kind]} | {'; '.join(found)} | {haskind} | {fitted} |")
    write({f"hydrodynamics-{kind}": _columns(table) for kind, table in tables.items()}, folder)
    write({"responses": _responses(omega, moves)}, folder)
    _draw(folder, loaded.name, preset, tables, (omega, moves))
    write_text(folder / "hydrodynamics.md", PAGE.format(name=loaded.name, rows="\n".join(rows)))
    return "\n".join(lines), folder


def _fit(preset: Preset, table: Hydrodynamics) -> dict[str, float]:
    """The rms error of the fitted memory of each mode, of its rms."""
    memory = fit_memory(table, MEMORY_ORDER, preset.sea.depth is None)
    return dict(zip(MODES, memory.error.diagonal(), strict=True))


def _frequencies(preset: Preset, table: Hydrodynamics) -> np.ndarray:
    """Frequencies (rad/s) of the response."""
    unit = np.sqrt(preset.run.gravity / preset.ship.draught)
    return np.arange(table.frequency[0], min(SHOWN * unit, table.frequency[-1]), STEP * unit)


def _haskind(table: Hydrodynamics, highest: float) -> dict[str, float]:
    """The largest difference of both excitations, of their size, where it is strong, up to `highest` rad/s."""
    table = table.at(table.frequency[table.frequency <= highest])
    size = np.abs(table.excitation)
    strong = size > STRONG * size.max(axis=0)
    miss = np.abs(table.haskind - table.excitation) / np.where(strong, size, np.inf)
    return dict(zip(MODES, miss.max(axis=0), strict=True))


def _columns(table: Hydrodynamics):
    """A table's numbers for a CSV file."""
    header, columns = ["frequency rad/s"], [table.frequency]
    for i, one in enumerate(MODES):
        for j, other in enumerate(MODES):
            if j < i:
                continue
            header += [f"added mass {one} {other}", f"damping {one} {other}"]
            columns += [table.added_mass[:, i, j], table.damping[:, i, j]]
    for i, one in enumerate(MODES):
        header += [f"excitation {one} real", f"excitation {one} imaginary"]
        columns += [table.excitation[:, i].real, table.excitation[:, i].imag]
    return header, [[f"{value:.6g}" for value in row] for row in np.array(columns).T]


def _responses(omega: np.ndarray, moves: Mapping[str, np.ndarray]):
    header = ["frequency rad/s", *(f"{mode} {kind}" for kind in moves for mode in MODES)]
    values = np.column_stack([omega, *(np.abs(one) for one in moves.values())])
    return header, [[f"{value:.6g}" for value in row] for row in values]


def _draw(folder: Path, name: str, preset: Preset, tables: Mapping[str, Hydrodynamics], response) -> None:
    """coefficients.png and response.png."""
    from lab.report.page import save_figure
    from lab.report.plots import BELOW, BLUE, GREY, STYLE, VERMILION, canvas, matplotlib

    look = {"section": (BLUE, "-"), "strips": (GREY, ":"), "hull": (VERMILION, "-")}
    with matplotlib.rc_context(STYLE):
        figure, panels = canvas(SIZE, 3, 3, sharex=True)
        highest = SHOWN * np.sqrt(preset.run.gravity / preset.ship.draught)
        for kind, table in tables.items():
            colour, line = look[kind]
            shown = table.frequency <= highest
            rows = table.added_mass, table.damping, 1e-3 * np.abs(table.excitation)
            for k, values in enumerate(rows):
                for j, mode in enumerate(MODES):
                    curve = values[shown, j] if k == 2 else values[shown, j, j]
                    axes = panels[k, j]
                    axes.plot(
                        table.frequency[shown], curve, line, color=colour, label=KINDS[kind] if k == j == 0 else None
                    )
                    axes.set_ylabel(f"{QUANTITIES[k]} of {mode}\n({UNITS[k][j]})")
        for axes in panels[2]:
            axes.set_xlabel("frequency (rad/s)")
        figure.suptitle(f"{name}: for each metre of her length, beam waves", x=0.01, ha="left")
        figure.legend(loc=BELOW, ncols=3)
        save_figure(folder / "coefficients.png", figure)
        figure, (left, right) = canvas(LOW, 1, 2)
        omega, moves = response
        for kind, one in moves.items():
            colour, line = look[kind]
            left.plot(omega, np.abs(one[:, 2]), line, color=colour, label=KINDS[kind])
            time = np.linspace(0.0, 30.0 / np.sqrt(preset.run.gravity / preset.ship.draught), 400)
            memory = retardation(tables[kind].frequency, tables[kind].damping, time)[:, 2, 2]
            right.plot(time, memory, line, color=colour)
        left.set_xlabel("wave frequency (rad/s)")
        left.set_ylabel("roll per metre of wave (rad/m)")
        right.set_xlabel("time (s)")
        right.set_ylabel("retardation function of roll (N)")
        figure.suptitle(f"{name}: by linear theory", x=0.01, ha="left")
        figure.legend(loc=BELOW, ncols=3)
        save_figure(folder / "response.png", figure)
