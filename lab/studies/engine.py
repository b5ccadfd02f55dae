"""What reproduce, verify and bench share: names that are beginnings, results that are kept, pages made from them."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import asdict
from functools import cache
from hashlib import blake2b
from importlib.resources import files
from pathlib import Path

from lab.base.data import BENCHMARKS, PRESETS
from lab.base.errors import LabError
from lab.report.kept import Made, plain, read, write
from lab.report.page import on_page, render
from lab.sweeps.cluster import sources


def choose(names: Collection[str], known: Iterable[str], what: str, usual: Collection[str] | None = None) -> list[str]:
    """The known names that begin like one of `names`, in their order; without names the `usual` ones, or all.

    A name that is known means itself alone, whatever else begins like it. Raises LabError, which lists all, for a name
    that begins none; `what` they are is part of its sentence.
    """
    known = list(known)
    for name in names:
        if not any(one.startswith(name) for one in known):
            raise LabError(f"there is no {what} {name}; there are {', '.join(known)}.")
    if names:
        begins = tuple(name for name in names if name not in known)
        return [one for one in known if one in names or one.startswith(begins)]
    return [one for one in known if usual is None or one in usual]


@cache
def code() -> str:
    """A hash of what makes results: the source of lab, solvers and benchmarks, their data, and the presets."""
    digest = blake2b(sources().encode(), digest_size=16)
    for path in sorted(BENCHMARKS.rglob("*.py")):
        digest.update(path.relative_to(BENCHMARKS).as_posix().encode() + b"\0" + path.read_bytes())
    for home in (Path(str(files("lab"))), Path(str(files("solvers"))), PRESETS):
        for path in sorted(home.rglob("*.toml")):
            digest.update(path.read_bytes())
    return digest.hexdigest()


def word(passed: bool) -> str:
    """The word for a verdict."""
    return "pass" if passed else "FAIL"


class Kept:
    """Results by name in a JSON file, each with what made it.

    A result is `in` it if it was made by the same code and packages, on the same processor and with the same choices
    (`asked`), and has no `fault`: then it need not be made again. Raises LabError if the file is none of these.
    """

    def __init__(self, path: Path, command: str, asked: object) -> None:
        self.path, self.asked, self.made = path, asked, Made.now(command)
        self.results: dict[str, dict] = read(path)

    def __getitem__(self, name: str) -> dict:
        return self.results[name]

    def __contains__(self, name: str) -> bool:
        found = self.results.get(name, {})
        made, here = found.get("made", {}), (self.asked, code(), self.made.packages, self.made.processor)
        same = here == (found.get("asked"), found.get("code"), made.get("packages"), made.get("processor"))
        return same and not found.get("fault")

    def missing(self, chosen: Iterable[str], anew: bool) -> Iterator[str]:
        """The chosen ones that are not in it, or `anew` all of them; of each of the others a line is printed."""
        for name in chosen:
            if name in self and not anew:
                verdict = f"{word(self[name]['passed'])}, " if "passed" in self[name] else ""
                print(f"{name}: {verdict}kept from an earlier run", flush=True)
            else:
                yield name

    def keep(self, name: str, result: Mapping[str, object]) -> None:
        """Put a result on the disk, in place of an older one; a number that JSON lacks becomes None."""
        made = {"asked": self.asked, "code": code(), "made": asdict(self.made)}
        self.results[name] = plain({**made, **result})
        write(self.path, self.results)

    def shown(self, names: Iterable[str]) -> dict[str, dict]:
        """What a page tells: the results of these names with the same choices, whatever code has made them.

        `said` tells what did.
        """
        found = {name: self[name] for name in names if self.results.get(name, {}).get("asked") == self.asked}
        return {name: one | {"said": _said(Made(**one["made"]))} for name, one in found.items()}


def _said(made: Made) -> str:
    return f"Made by `{made.command}`: {made.words}."


def write_sections(path: Path, title: str, results: Mapping[str, Mapping], about: str = "", shown: str = "") -> Path:
    """Write a page from the `blocks` of results; `shown` is the file of the figure on it. Returns the page."""
    files = [block["file"] for one in results.values() for block in one["blocks"] if "file" in block]
    told = {"title": title, "about": about, "name": path.stem, **on_page(files, shown)}
    return render(path, "page.md.j2", **told, results=list(results.values()))
