"""`cargolab roll-damping`: a ship's damping by components, and her roll in a sea, as text, tables and figures."""

from dataclasses import replace
from math import degrees, pi
from pathlib import Path

import matplotlib
import numpy as np

from lab.naval.rolling import sea
from lab.naval.rolling.damping import Asked, Damping, compute, prepare
from lab.naval.tables import Table, write
from lab.report.page import save_figure
from lab.report.plots import BELOW, BLUE, GREEN, GREY, STYLE, VERMILION, canvas
from lab.report.stability import columns
from solvers.ship.damping.components import NAMES
from solvers.ship.damping.random_roll import Answer

SIZE, SEA_SIZE = (8.4, 3.9), (8.4, 3.9)
COLOURS = {"friction": GREY, "eddies": GREEN, "waves": BLUE, "keel drag": "#e69f00", "keel pressure": VERMILION}
SMOOTH = 0.5  # deg, between the amplitudes of the figure


def examine(asked: Asked, folder: Path) -> tuple[str, dict[str, Table], dict[str, float]]:
    """Write tables and figures into a folder; returns the text, the tables, and the numbers of a sea if one is asked.

    Raises LabError for what cannot be told of her.
    """
    rolling = prepare(asked)
    found = compute(asked, rolling)
    tables, numbers = {"roll-damping": found.table()}, {}
    lines = [*describe(found), ""]
    lines += columns(tables["roll-damping"], tables["roll-damping"][0])
    lines += ["", *preset_keys(found)]
    answer = sea.in_sea(asked, found) if asked.sea else None
    if answer:
        numbers = sea.told(asked, found, answer)
        tables["roll-in-sea"] = sea.table(answer)
        lines += ["", *in_words(asked, numbers)]
    write(tables, folder)
    draw(folder / "roll-damping.png", asked, rolling_curve(asked, found))
    if answer:
        draw_sea(folder / "roll-in-sea.png", asked, answer, numbers)
    return "\n".join(lines), tables, numbers


def describe(found: Damping) -> list[str]:
    """Who she is and by what formulas."""
    rolling, ship = found.rolling, found.rolling.ship
    keels = f"bilge keels {ship.keels.breadth:g} m by {ship.keels.length:g} m" if ship.keels else "no bilge keels"
    by = "sections by Ikeda, waves by strips" if rolling.hull else "eddies and waves by Kawahara et al. (2009)"
    size = f"L {ship.length:.5g}, B {ship.breadth:.4g}, d {ship.draught:.4g} m"
    return [
        f"{size}; Cb {ship.block:.3f}, Cm {ship.midship:.3f}; "
        f"KG {ship.axis:.4g}, GM {rolling.gm:.3g} m; {keels}, bilge radius {ship.section.radius:.3g} m",
        f"roll period {2.0 * pi / rolling.frequency:.4g} s, without speed; {by}",
    ]


def preset_keys(found: Damping) -> list[str]:
    """Linear and quadratic damping as a preset has them."""
    rolling = found.rolling
    share, quadratic = rolling.share(found.linear), found.quadratic / rolling.inertia
    return [
        f"without waves, from 2.5 to 25 deg within {100.0 * found.off:.0f} %: B1 {1e-6 * found.linear:.4g} MN m s and "
        f"B2 {1e-6 * found.quadratic:.4g} MN m s2",
        f"in a preset: ship.damping = {share:.4f}, ship.quadratic_damping = {quadratic:.4f}",
    ]


def in_words(asked: Asked, numbers: dict[str, float]) -> list[str]:
    """Her roll in the sea."""
    height, period = asked.sea
    first = f"JONSWAP sea from abeam, Hs {height:g} m, Tp {period:g} s, {asked.hours:g} h, by linear theory:"
    return [first, *(f"  {name:<28}{value:.4g}" for name, value in numbers.items())]


def rolling_curve(asked: Asked, found: Damping) -> Damping:
    """The same at close amplitudes, for the figure."""
    highest = max(degrees(found.amplitudes.max()), 10.0)
    angles = tuple(np.arange(SMOOTH, highest + 0.5 * SMOOTH, SMOOTH).tolist())
    return compute(replace(asked, amplitudes=angles), found.rolling)


def draw(path: Path, asked: Asked, found: Damping) -> Path:
    """Components stacked over amplitude, and the share of critical damping with the line of a preset."""
    turn, rolling = np.degrees(found.amplitudes), found.rolling
    with matplotlib.rc_context(STYLE):
        figure, (left, right) = canvas(SIZE, 1, 2)
        below = np.zeros(len(turn))
        for name, values in zip(NAMES, 1e-6 * found.parts.T, strict=True):
            left.fill_between(turn, below, below + values, color=COLOURS[name], lw=0, alpha=0.85, label=name)
            below = below + values
        left.set_ylabel("equivalent linear damping B44 (MN m s)")
        right.plot(turn, rolling.share(found.total), color="k", label="all")
        waves = rolling.share(found.parts[:, NAMES.index("waves")])
        line = found.linear + 8.0 / (3.0 * pi) * rolling.frequency * found.amplitudes * found.quadratic
        right.plot(turn, rolling.share(line) + waves, ":", color=VERMILION, label="linear and quadratic, with waves")
        right.set_ylabel("share of critical damping ζ")
        for axes in (left, right):
            axes.set_xlabel("amplitude of roll (deg)")
            axes.set_xlim(0.0, turn.max())
            axes.set_ylim(0.0)
        name = asked.file.name if asked.file else f"a ship of {rolling.ship.length:g} m"
        figure.suptitle(f"Roll damping of {name}, {2.0 * pi / rolling.frequency:.3g} s, no speed", x=0.01, ha="left")
        figure.legend(loc=BELOW, ncols=4)
        return save_figure(path, figure)


def draw_sea(path: Path, asked: Asked, answer: Answer, numbers: dict[str, float]) -> Path:
    """Roll per metre of wave, and the spectra of waves and roll."""
    kept = answer.frequency <= 2.0 * max(2.0 * pi / asked.sea[1], float(answer.frequency[np.argmax(answer.ratio)]))
    omega = answer.frequency[kept]
    with matplotlib.rc_context(STYLE):
        figure, (left, right) = canvas(SEA_SIZE, 1, 2)
        left.plot(omega, np.degrees(answer.ratio[kept]), color=VERMILION)
        left.set_ylabel("roll per metre of wave (deg/m)")
        right.plot(omega, answer.waves[kept] / answer.waves.max(), color=GREY, label="waves")
        right.plot(omega, answer.roll[kept] / answer.roll.max(), color=BLUE, label="roll")
        right.set_ylabel("spectral density, of its largest")
        for axes in (left, right):
            axes.set_xlabel("wave frequency (rad/s)")
            axes.set_ylim(0.0)
        height, period = asked.sea
        words = f"Hs {height:g} m, Tp {period:g} s: significant roll {numbers['significant roll deg']:.3g} deg"
        figure.suptitle(
            f"Roll in a beam sea, {words}, mean largest in {asked.hours:g} h {numbers['mean largest deg']:.3g} deg",
            x=0.01,
            ha="left",
        )
        figure.legend(loc=BELOW, ncols=2)
        return save_figure(path, figure)
