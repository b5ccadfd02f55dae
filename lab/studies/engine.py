"""What reproduce, verify and bench share: cases and studies chosen by name, results of cases that are not run again."""

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import asdict
from pathlib import Path

import matplotlib

from lab.base.errors import LabError
from lab.report.kept import Made, plain, read, write
from lab.report.page import Page
from lab.report.plots import STYLE

Study = Callable[[Page, Path, bool], None]  # adds a section to a page; with a folder to work in, and whether in haste


def choose(names: Collection[str], known: Iterable[str], what: str, usual: Collection[str] | None = None) -> list[str]:
    """The known names that begin like one of `names`, in their order; without names the `usual` ones, or all.

    Raises LabError, which lists all, for a name that begins none; `what` they are is part of its sentence.
    """
    known = list(known)
    for name in names:
        if not any(one.startswith(name) for one in known):
            raise LabError(f"there is no {what} {name}; there are {', '.join(known)}.")
    if names:
        return [one for one in known if one.startswith(tuple(names))]
    return [one for one in known if usual is None or one in usual]


def add_studies(page: Page, studies: Mapping[str, Study], names: Collection[str], fast: bool) -> Path:
    """Let the studies that begin like one of `names`, or all, add to a page; it is written after each.

    What they keep is in a folder beside the page, by its name. Returns the page's file. Raises LabError.
    """
    with matplotlib.rc_context(STYLE):
        for name in choose(names, studies, "study"):
            studies[name](page, page.folder / page.name, fast)
            path = page.write()
    return path


class Kept:
    """Results by name in a JSON file, each with what made it.

    A result is `in` it if it was made with the same packages and the same choices (`asked`). Raises LabError if the
    file is none of these.
    """

    def __init__(self, path: Path, command: str, asked: object) -> None:
        self.path, self.asked, self.made = path, asked, Made.now(command)
        self.results: dict[str, dict] = read(path)

    def __getitem__(self, name: str) -> dict:
        return self.results[name]

    def __contains__(self, name: str) -> bool:
        found = self.results.get(name, {})
        return found.get("asked") == self.asked and found.get("made", {}).get("packages") == self.made.packages

    def keep(self, name: str, result: Mapping[str, object]) -> None:
        """Put a result on the disk, in place of an older one; a number that JSON lacks becomes None."""
        self.results[name] = plain({"asked": self.asked, "made": asdict(self.made), **result})
        write(self.path, self.results)
