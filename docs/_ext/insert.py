"""What a page asks to be put in when it is read: `{{ module … }}` on a line of its own becomes Markdown.

{{ module NAME }}                 what a module of the code says of itself
{{ registry MODULE TABLE }}       each class of a registry: its formula, source, limits, units
{{ things MODULE NAME NAME … }}   classes and functions, a line or more each
{{ page FILE }}                   a page that lies elsewhere, with its pictures; FILE from the repository's root
{{ ratios FOLDER }}               by processor how many times as fast as other codes the lab is, with a folder's records
{{ presets }}                     the reference of all keys of a preset
{{ cargoes }}                     the library of cargoes with its sources

A fence ```formula holds one formula in the plain text of docstrings, which is set as theirs are.
"""

import os
import re
from pathlib import Path

import docstrings
from formula import mathml
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

from benchmarks.speed.processors import overview
from lab.preset.cargo.told import markdown
from lab.preset.reference import reference

ROOT = Path(__file__).parents[2]
ASKED = re.compile(r"^\{\{ (\w+)((?: [^ }]+)*) \}\}$", re.MULTILINE)
FORMULA = re.compile(r"^```formula\n(.*?)\n```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"(\]\()([^)#\s]+)")
SHOWN = {  # pages that lie elsewhere, and the pages here that show them
    "CONTRIBUTING": "contributing",
    "CHANGELOG": "changes",
    "renders/gallery/bench/accuracy": "results/accuracy",
    "renders/gallery/bench/outlines": "results/outlines",
    "renders/gallery/bench/water": "results/water-peers",
    "renders/gallery/bench/speed": "results/speed",
    "renders/gallery/bench/speed-peers": "results/speed-peers",
    "renders/gallery/bench/stability": "results/stability",
    "renders/gallery/bench/verify": "results/verify",
    "renders/gallery/granular/granular": "results/granular",
    "renders/gallery/shapes/shapes": "results/shapes",
    "renders/gallery/ship/ship": "results/ship",
    "renders/gallery/hydrodynamics/hydrodynamics": "results/hydrodynamics",
    "renders/gallery/water/water": "results/water",
}


def filled_in(text: str, folder: Path) -> str:
    """A page's text with what it asks for; links of pages of results are made to lead on from `folder`."""
    made = {
        "module": docstrings.module,
        "registry": docstrings.registry,
        "things": docstrings.things,
        "page": lambda name: page(ROOT / name, folder),
        "ratios": lambda name: overview(ROOT / name),
        "presets": reference,
        "cargoes": markdown,
    }
    text = FORMULA.sub(lambda found: mathml(found[1]), text)
    return ASKED.sub(lambda found: made[found[1]](*found[2].split()), text)


def page(path: Path, folder: Path) -> str:
    """A page of results, its links and pictures given from `folder`."""

    def moved(found: re.Match) -> str:
        if "://" in found[2]:
            return found[0]
        target = (path.parent / found[2]).resolve()
        known = SHOWN.get(target.relative_to(ROOT).with_suffix("").as_posix())
        target = ROOT / "docs" / f"{known}.md" if known and target.suffix == ".md" else target
        return found[1] + Path(os.path.relpath(target, folder)).as_posix()

    return LINK.sub(moved, path.read_text(encoding="utf-8"))


def on_read(app: Sphinx, name: str, content: list[str]) -> None:
    """Fill in a page as Sphinx reads it."""
    source = Path(app.env.doc2path(name))
    try:
        content[0] = filled_in(content[0], source.parent)
    except (AttributeError, ImportError, KeyError, OSError, TypeError, ValueError) as error:
        raise ExtensionError(f"{source}: what it asks for cannot be put in: {error}") from error


def always(app: Sphinx, env: object, added: set, changed: set, removed: set) -> list[str]:
    """Pages with something to put in are read anew in every build: what they ask for may have changed."""
    pages = sorted(env.found_docs)
    return [name for name in pages if ASKED.search(Path(env.doc2path(name)).read_text(encoding="utf-8"))]


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx calls this."""
    app.connect("source-read", on_read)
    app.connect("env-get-outdated", always)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
