"""A bench: studies that each add a section with tables and figures to one page."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib

from lab.report.page import Page
from lab.report.plots import STYLE
from lab.studies.engine import Kept, choose, write_sections

Study = Callable[[Page, Path, bool], None]  # adds a section to a page; with a folder to work in, and whether in haste


@dataclass(frozen=True)
class Bench:
    """A bench whose studies each add a section to one page; `about` stands above them.

    Its results are kept in NAME.json, by study; NAME.md is made from them, with figures NAME-FIGURE.png beside it, of
    which the page shows that named `shown`.
    """

    name: str
    title: str
    studies: Mapping[str, Study]
    about: str = ""
    shown: str = ""

    def run(self, names: Sequence[str], out: Path | str, fast: bool, page_only: bool = False) -> Path:
        """Do the studies that begin like one of `names`, or without names all that are not kept; returns the page.

        The page is written after each. What a study needs again is in the folder NAME. `page_only`: nothing is done
        but the page. Raises LabError.
        """
        out, chosen = Path(out), choose(names, self.studies, "study")
        kept = Kept(out / f"{self.name}.json", f"bench {self.name}", {"fast": fast})
        page = self._write(kept)
        with matplotlib.rc_context(STYLE):
            for name in kept.missing([] if page_only else chosen, anew=bool(names)):
                section = Page(out, self.name)
                self.studies[name](section, out / self.name, fast)
                kept.keep(name, {"blocks": section.blocks})
                page = self._write(kept)
        return page

    def _write(self, kept: Kept) -> Path:
        return write_sections(
            kept.path.with_suffix(".md"),
            self.title,
            kept.shown(self.studies),
            self.about,
            f"{self.name}-{self.shown}.png",
        )
