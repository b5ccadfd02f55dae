"""The structure of the code: packages import only those below them, without cycles, in small folders and files.

`docs/developing.md` says what each room is for. A new room gets its place in the lists here.
"""

import ast
import re
import subprocess
import tomllib
from collections.abc import Iterator
from fnmatch import fnmatch
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FLOORS = {  # from the ground up: a room imports those before it
    "solvers": (
        "machine",
        "ship",
        "space",
        "tank",
        "motion",
        "grains",
        "fluid",
        "liquid",
        "mixture",
        "bulk",
        "matters",
        "time",
        "scene",
        "simulation",
    ),
    "lab": (
        *("base", "plugins", "preset", "assembly", "naval", "recording", "measures", "paint", "report"),
        "export",
        *("runs", "sweeps", "view", "studies", "voyage", "doctor", "cli"),
    ),
    "cargolab": ("_hidden", "_xarray", "_preset", "_simulation", "_plugins", "_calls"),
    "benchmarks": (
        *("aside", "devices", "remembered", "bench", "peers", "speed", "accuracy", "stability", "water"),
        *("outlines", "gpu"),
    ),
}
FACES = (
    "solvers",
    "lab",
    "lab.__main__",
    "cargolab",
    "cargolab.__main__",
    "benchmarks",
)  # they hand on what the rooms offer
FOR_ALL = "solvers", "lab.__version__"  # what every room may ask a face for: that Taichi is set up, the version
ASKED = "lab.sweeps.cluster imports lab"  # by a function that travels to a worker, for the version of the lab there

ASKS_FOR_BENCHMARKS = "lab.cli.benches"  # by their names, when it runs: an installed lab has none

MOST_FILES = 14  # in a folder, its __init__.py aside
REGISTRIES = "lab/measures", "solvers/grains/laws", "solvers/motion"  # as many as there are measures, laws, motions

PYTHONS = "len", "enumerate", "zip", "sum", "sorted", "reversed", "round", "isinstance", "map"

MOST_BYTES = 4_000_000  # of what `renders/` keeps

MOST_LINES = 300  # of a file
LONG = {  # too long, and not to become longer
    "lab/recording/writer.py": 352,
    "lab/view/page.py": 437,
    "lab/view/session.py": 360,
    "solvers/grains/shapes/rules/continuous.py": 401,
    "solvers/simulation.py": 324,
}


@cache
def modules() -> dict[str, Path]:
    """The files of all packages, by their dotted names."""
    files = [path for package in FLOORS for path in sorted((ROOT / package).rglob("*.py"))]
    return {".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path for path in files}


@cache
def imported(name: str) -> tuple[str, ...]:
    """What a module imports of these packages, at its head or inside a function: modules, or names of a face."""
    return tuple(_imported(name))


def _imported(name: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(modules()[name].read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, f"{name}: import by the whole name"
            full = [f"{node.module}.{alias.name}" for alias in node.names]
            found = [one if one in modules() or node.module in FLOORS else node.module for one in full]
        else:
            continue
        yield from (one for one in found if one.split(".")[0] in FLOORS)


def floor(name: str) -> int:
    """How high the room of a module is in its package."""
    package, _, rest = name.partition(".")
    room = rest.partition(".")[0]
    assert room in FLOORS[package], f"{name}: no floor for {package}/{room}; give it one in {Path(__file__).name}"
    return FLOORS[package].index(room)


def storey(package: str) -> int:
    """How high a package is above the ground."""
    return list(FLOORS).index(package)


def uphill() -> list[str]:
    """The imports that run up."""
    found = []
    for name in modules().keys() - set(FACES):
        for other in set(imported(name)) - set(FOR_ALL):
            package = name.split(".")[0]
            theirs = other.split(".")[0]
            same, higher = theirs == package, storey(theirs) > storey(package)
            up = other in FACES or floor(other) > floor(name) if same else higher
            found += [f"{name} imports {other}"] * up
    return sorted(set(found) - {ASKED})


def test_rooms_import_only_those_below_them():
    assert uphill() == []


def test_only_one_command_asks_for_the_benchmarks_and_they_ask_for_nothing_of_users():
    """No import leads to them, and they are in no wheel; what names them in a text is one file of the command."""
    others = {name: path for name, path in modules().items() if not name.startswith("benchmarks")}
    naming = [name for name, path in others.items() if "benchmarks." in "".join(texts(path))]
    assert naming == [ASKS_FOR_BENCHMARKS]
    theirs = {one for name in modules().keys() - others.keys() for one in imported(name)}
    assert {one.split(".")[0] for one in theirs} == {"benchmarks", "lab", "solvers"}
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]["packages"]
    assert not any(fnmatch("benchmarks", one) for one in wheel["find"]["include"])


def texts(path: Path) -> list[str]:
    """The texts in the code of a file that says something of benchmarks, its docstrings aside."""
    text = path.read_text(encoding="utf-8")
    nodes = list(ast.walk(ast.parse(text if "benchmarks." in text else "")))
    said = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    return [
        node.value
        for node in nodes
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in said
    ]


def test_no_files_import_each_other_in_a_circle():
    known = set(modules())
    try:
        TopologicalSorter({name: known & set(imported(name)) - set(FACES) for name in known}).prepare()
    except CycleError as error:
        pytest.fail(" → ".join(error.args[1]))


def test_no_folder_is_too_full():
    folders = {path.parent for path in modules().values()}
    count = {folder: sum(path.name != "__init__.py" for path in folder.glob("*.py")) for folder in folders}
    for folder, files in count.items():
        name = folder.relative_to(ROOT).as_posix()
        assert name in REGISTRIES or files <= MOST_FILES, f"{name}: {files} files"


def test_no_file_is_too_long():
    lines = {
        path.relative_to(ROOT).as_posix(): len(path.read_text(encoding="utf-8").splitlines())
        for path in modules().values()
    }
    assert [f"{name}: {count}" for name, count in lines.items() if count > LONG.get(name, MOST_LINES)] == []
    assert [name for name in LONG if lines.get(name, 0) <= MOST_LINES] == []  # they need no exception any more


def test_the_page_for_developers_names_every_room():
    text = (ROOT / "docs" / "developing.md").read_text(encoding="utf-8")
    tables = re.findall(r"^\| `(\w+)/` \| is \|\n(.+?)\n\n", text, re.MULTILINE | re.DOTALL)
    assert {package: tuple(re.findall(r"^\| `(\w+)` \|", rows, re.MULTILINE)) for package, rows in tables} == FLOORS


def kept_pictures() -> dict[str, int]:
    """The files of `renders/` that git keeps, with their bytes."""
    if not (ROOT / ".git").exists():
        pytest.skip("no clone: what is kept of pictures is not known")
    said = subprocess.run(["git", "ls-files", "-z", "renders"], cwd=ROOT, capture_output=True, text=True, check=True)
    files = [name for name in said.stdout.split("\0") if name and (ROOT / name).exists()]
    return {name: (ROOT / name).stat().st_size for name in files}


def test_kept_pictures_and_pages_stay_small():
    """A clone is mostly code: the gallery has heroes, a card a preset, and a figure a page of results."""
    kept = kept_pictures()
    assert kept and sum(kept.values()) <= MOST_BYTES, sorted(kept.items(), key=lambda one: -one[1])[:10]


def test_a_page_of_results_shows_what_is_kept_and_nothing_else_is():
    kept = kept_pictures()
    pages = [name for name in kept if name.endswith(".md")]
    shown = {
        (Path(name).parent / picture).as_posix()
        for name in pages
        for picture in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", (ROOT / name).read_text(encoding="utf-8"))
    }
    folders = {Path(name).parent for name in pages}
    assert pages and shown == {name for name in kept if name.endswith(".png") and Path(name).parent in folders}


def of_taichi(function: ast.FunctionDef) -> bool:
    return any("ti.func" in ast.unparse(one) or "ti.kernel" in ast.unparse(one) for one in function.decorator_list)


def is_static(called: ast.expr) -> bool:
    return isinstance(called, ast.Attribute) and called.attr == "static"


def of_python(function: ast.FunctionDef) -> Iterator[str]:
    """The calls in a function for Taichi of what only Python knows, outside of ti.static."""
    calls = [one for one in ast.walk(function) if isinstance(one, ast.Call)]
    fixed = {id(part) for call in calls if is_static(call.func) for part in ast.walk(call)}
    for call in calls:
        if isinstance(call.func, ast.Name) and call.func.id in PYTHONS and id(call) not in fixed:
            yield f"{function.name}, line {call.lineno}: {ast.unparse(call)}"


def test_kernels_call_nothing_of_pythons():
    """Taichi would warn of it on every machine that compiles them."""
    found = []
    for path in (ROOT / "solvers").rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        tree = ast.parse(text if "ti.func" in text or "ti.kernel" in text else "")
        found += [one for one in ast.walk(tree) if isinstance(one, ast.FunctionDef) and of_taichi(one)]
    assert found and [call for function in found for call in of_python(function)] == []
