"""What a notebook shows of a preset and of a run: tables, figures, and the film that plays in it.

Every text is escaped, since presets and recordings may come from anybody.
"""

import tomllib
from base64 import b64encode
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from lab.base.errors import LabError, NotRecorded
from lab.base.files import read_bytes
from lab.base.notebook.html import details, paragraph, preformatted, table, text, titled
from lab.base.text import one_line
from lab.preset.python.keys import about, given_keys

if TYPE_CHECKING:
    from lab.preset.find import LoadedPreset

HEADS = "key", "value", "unit in SI", "what it is"
OWN = "title", "source", "reports", "quick"  # keys of a preset that stand above its tables
MOST_INLINE = 50_000_000  # bytes of a film that a page holds itself; a longer one is played from its file
LONGEST = 80  # letters of a value in a table


def of_preset(loaded: "LoadedPreset") -> str:
    """A preset: title, source, what the source reports, and the keys that it sets, a table a section."""
    preset = loaded.resolved
    pieces = [paragraph(loaded.name)]
    for said, value in (("Source", preset.source), ("Reports", preset.reports), ("Quick variant", preset.quick)):
        pieces += [paragraph(f"{said}: {value}")] if value else []
    for section, rows in _sections(loaded.given_text).items():
        pieces.append(details(f"[{section}]" if section else "at the top", table(HEADS, rows)))
    pieces.append(details("as TOML", preformatted(loaded.given_text)))
    return titled(preset.title, *pieces)


def _sections(given: str) -> dict[str, list[tuple[str, ...]]]:
    """The rows of the keys that a text sets, by the first part of their names."""
    values = tomllib.loads(given)
    sections: dict[str, list[tuple[str, ...]]] = {}
    for key in given_keys(given):
        section, _, rest = key.partition(".")
        if key in OWN:
            continue
        told = _about(key)
        row = rest or key, _shown(_value(values, key)), told.get("unit", ""), told.get("sentence", "")
        sections.setdefault(section if rest else "", []).append(tuple(map(str, row)))
    return sections


def _about(key: str) -> Mapping[str, object]:
    try:
        return about(key)
    except LabError:
        return {}


def _value(table: Mapping, key: str) -> object:
    found: object = table
    for part in key.split("."):
        found = found[part] if isinstance(found, Mapping) else None
    return found


def _shown(value: object) -> str:
    said = str(value).lower() if isinstance(value, bool) else one_line(value)
    return said if len(said) <= LONGEST else f"{said[:LONGEST]}…"


@dataclass(frozen=True)
class Film:
    """The video of a run, which a notebook plays."""

    path: Path

    def __fspath__(self) -> str:
        return str(self.path)

    def _repr_html_(self) -> str:
        """A player; a film that is small enough is within the page, a longer one is played from its file."""
        content = read_bytes(self.path, MOST_INLINE + 1)
        if content is None or len(content) > MOST_INLINE:
            source = self.path.as_posix()
        else:
            source = f"data:video/mp4;base64,{b64encode(content).decode('ascii')}"
        return f'<video controls loop muted style="max-width: 100%" src="{text(source)}"></video>'


@dataclass(frozen=True)
class Picture:
    """A figure of a run, which a notebook shows."""

    path: Path

    def __fspath__(self) -> str:
        return str(self.path)

    def _repr_png_(self) -> bytes:
        return self.path.read_bytes()


def film(folder: Path) -> Film:
    """The video in the folder of a run or a sweep. Raises NotRecorded if there is none."""
    for name in ("video.mp4", "sweep.mp4"):
        if (folder / name).is_file():
            return Film(folder / name)
    raise NotRecorded(f"{folder} has no video: `cargolab render {folder}` paints it.")


def plot(folder: Path, name: str) -> Picture:
    """The figure of that name in a folder. Raises NotRecorded, with the names that there are."""
    found = {path.stem: path for path in sorted(folder.glob("*.png"))}
    plain = name.strip().replace(" ", "_")
    if plain in found:
        return Picture(found[plain])
    near = get_close_matches(plain[:100], found, n=1)
    has = f"did you mean {near[0]}?" if near else f"it has {', '.join(found) or 'none'}."
    raise NotRecorded(f"{folder} has no figure {one_line(name)[:100]!r}; {has}")


class WithPictures:
    """What the results of a run and of a sweep share: a `folder` with pictures, and a summary."""

    folder: Path
    summary_text: str

    @property
    def video(self) -> Film:
        """The film, which a notebook plays; its `path` is the file. Raises LabError if none was painted."""
        return film(self.folder)

    def plot(self, name: str) -> Picture:
        """A figure by its name, `result.plot("shift")`, which a notebook shows. Raises LabError with the names."""
        return plot(self.folder, name)

    def __str__(self) -> str:
        return self.summary_text


def of_run(title: str, facts: str, measures: str, folder: Path) -> str:
    """A run: its title, facts, table of measures (HTML), and its film if there is one."""
    return titled(title, paragraph(facts), measures, *_films(folder))


def _films(folder: Path) -> Iterator[str]:
    try:
        yield film(folder)._repr_html_()
    except (LabError, OSError):
        return
