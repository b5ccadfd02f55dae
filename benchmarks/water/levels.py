"""What error each level of accuracy has in gentle water, and what it costs: the convergence study behind the levels.

The runs are those of `cargolab verify`, from packed water with the defaults: free sloshing of a tank of 0.30 m with
105 mm of water, a standing wave at a Reynolds number of 500, and a box at rest.
"""

from pathlib import Path

from benchmarks.remembered import remembered
from lab.preset.accuracy import LEVELS
from lab.report.page import Page
from lab.studies.verify.water.rest import VESSELS, rested
from lab.studies.verify.water.sloshing import BOXES, FAST, slosh
from lab.studies.verify.water.waves import viscous, waved

FEW = {"draft": 10, "standard": 20}  # layers, in haste
RESTS = 10.0  # s
HEADER = (
    *("level", "layers", "cost", "frequency of sloshing, %", "frequency of the wave, %", "decay of its height, %"),
    *("pressure at rest, %", "level at rest, %"),
)


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    layers = FEW if fast else {name: level.layers for name, level in LEVELS.items()}
    page.section("Levels of accuracy")
    page.say(f"""Errors with as many layers of particles over the depth as each level has, from packed water with the
        defaults (`cargolab verify water` has the cases): frequency of free sloshing, 105 mm of water in a tank of
        0.30 m; frequency of a standing wave in a depth of half its length, and how much faster its height decays than
        by viscosity alone at a Reynolds number of 500; pressure of all particles in a box at rest (root mean square
        over ρ g H, the worst look of the later half of {RESTS:g} s) and the depth at its middle. Cost: particles times
        steps, over draft's. Breaking water has no such errors: there the scatter from run to run is larger.""")
    first = next(iter(layers.values()))
    table = []
    for name, count in layers.items():
        found = errors(count, work)
        table.append([name, str(count), f"{(count / first) ** 3:g}", *(found[of] for of in SHOWN)])
    page.table(HEADER, table)


def errors(layers: int, work: Path) -> dict[str, float]:
    """Errors (%) with so many layers of particles; those of each run are kept in a folder."""
    found: dict[str, float] = {}
    for name, run in RUNS.items():
        kept = work / f"levels-{name}-{layers}.npz"
        shares = remembered(kept, f"water: {name}, {layers} layers", lambda run=run: run(layers))
        found |= {key: 1e2 * float(share) for key, share in shares.items()}
    return found


def sloshing(layers: int) -> dict[str, float]:
    """Free sloshing of a box."""
    pool = BOXES[FAST]
    return {"sloshing": slosh(pool, layers) / pool.rate - 1.0}


def standing(layers: int) -> dict[str, float]:
    """The standing wave."""
    wave, exact = waved(layers).swing, viscous()
    return {"wave": wave.rate / exact.imag - 1.0, "decay": -wave.decay / exact.real - 1.0}


def resting(layers: int) -> dict[str, float]:
    """The box at rest."""
    rest = rested(VESSELS["box"], layers, RESTS)
    return {"pressure": rest.pressure, "level": rest.level}


RUNS = {"sloshing": sloshing, "standing": standing, "resting": resting}
SHOWN = "sloshing", "wave", "decay", "pressure", "level"
