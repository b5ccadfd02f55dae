"""Presets and recordings of earlier formats, in the keys of the present one. Nothing else knows of them.

In format 2, which had no key `format`, the table [water] was the sea; in format 3 that is [sea], and [water] is water
in a tank. A preset that says no format and has no [water] reads the same in both. Values that have another word now are
read under the old one, too. Recordings of earlier versions hold their presets as resolved then: with derived values in
place of the keys that they follow from.
"""

import warnings
from collections.abc import Mapping, Sequence

from lab.base.errors import LabError
from lab.preset.units import quoted

FORMAT = 3
SEA = "density", "depth"  # keys of the sea in format 2
REWORDED = {"ship": {"coupling": {"as_K": "staggered"}}}  # values by section and key, and their present words
# Keys by section that were taken out; recordings may still hold them
GONE = {"air": ("vent_area",), "record": ("xdmf",)}
# Those that a preset may still say, and what to do now
LEFT = {"record": {"xdmf": "ParaView opens what `cargolab export --to vtkhdf` writes after the run"}}


class OldFormat(UserWarning):
    """A preset of an earlier format was read as what it meant then."""


def upgrade(tables: Sequence[dict], shown: str, changes: dict) -> None:
    """Put the tables of a preset and its bases, the lowest first, into the keys of the present format, in place.

    Their words and those of the `changes` over them are put into present ones, and keys that are gone are left out.
    Warns of a table that has another name now. Raises LabError, one sentence with the name `shown` of the preset, for
    a format that this version does not know, and for presets of different formats based on each other.
    """
    formats = {_format(table, shown) for table in tables} - {None}
    if len(formats) > 1:
        raise LabError(
            f"{shown}: based_on: one of these presets has [water] and no format, the other is of format {FORMAT}; "
            f"say format = {FORMAT} in both, and name the sea [sea]."
        )
    _upgrade_words([*tables, changes], shown)
    if formats != {2}:
        return
    for table in tables:
        if "water" in table:
            _check_sea(table["water"], shown)
            if "sea" in table:
                raise LabError(f"{shown}: water: without format = {FORMAT} this is the sea, which [sea] is, too.")
            table["sea"] = table.pop("water")
    warnings.warn(
        f"{shown}: [water] is read as the sea here, since it does not say format = {FORMAT}; name it [sea] and say so.",
        OldFormat,
        stacklevel=2,
    )


def _upgrade_words(tables: Sequence[dict], shown: str) -> None:
    """Put values that have another word now into that, in place, and warn of each."""
    for key, now in (one for table in tables for one in _leave(table)):
        warnings.warn(f"{shown}: {key}: is not read any more: {now}; leave it out.", OldFormat, stacklevel=2)
    for key, old, new in (one for table in tables for one in _reword(table)):
        warnings.warn(f'{shown}: {key}: "{old}" is called "{new}" now; write that.', OldFormat, stacklevel=2)


def _reword(table: dict) -> list[tuple[str, str, str]]:
    """Put values of earlier versions into present words, in place; returns each key, old and new word."""
    found = []
    for section, keys in REWORDED.items():
        for key, new in keys.items():
            old = table[section].get(key) if isinstance(table.get(section), Mapping) else None
            if isinstance(old, str) and old in new:
                table[section] = {**table[section], key: new[old]}
                found.append((f"{section}.{key}", old, new[old]))
    return found


def _leave(table: dict) -> list[tuple[str, str]]:
    """Take keys of earlier versions out, in place; returns each with what to do now."""
    found = []
    for section, keys in LEFT.items():
        given = table.get(section)
        gone = [key for key in keys if isinstance(given, Mapping) and key in given]
        if gone:
            table[section] = {key: value for key, value in given.items() if key not in gone}
            found += [(f"{section}.{key}", keys[key]) for key in gone]
    return found


def _check_sea(table: object, shown: str) -> None:
    """Raise LabError for a table that no sea is but water in a tank, whose preset says no format."""
    strange = [key for key in table if key not in SEA] if isinstance(table, Mapping) else []
    if strange:
        raise LabError(
            f"{shown}: water.{quoted(str(strange[0]))[1:-1]}: write format = {FORMAT} at the top of the file; without "
            "it [water] is the sea outside, which has a density and a depth alone."
        )


def _format(table: Mapping, shown: str) -> int | None:
    """The format of a table; None where it reads the same in all."""
    said = table.get("format")
    if said is None:
        return 2 if "water" in table else None
    if said != FORMAT or isinstance(said, bool | float):
        raise LabError(f"{shown}: format: this version reads presets of format {FORMAT} (got {quoted(said)}).")
    return FORMAT


def recorded(table: Mapping) -> Mapping:
    """The table of a recorded preset in the keys and words of the present format."""
    kept = dict(table)
    _reword(kept)
    for section, keys in GONE.items():
        if isinstance(kept.get(section), Mapping):
            kept[section] = {key: value for key, value in kept[section].items() if key not in keys}
    if "format" in table or not isinstance(table.get("tank"), Mapping):
        return _timed(kept)
    if "water" in kept:
        kept["sea"] = kept.pop("water")
    if isinstance(kept.get("ship"), Mapping) and "sheet" in kept["ship"]:
        kept["ship"] = dict(kept["ship"])
        kept["tank"] = {**kept["tank"], "thickness": kept["ship"].pop("sheet")}
    kept["tank"] = _tank(kept["tank"])
    kept["grains"] = _grains(kept.get("grains") or {}, bool(kept.get("shapes")))
    kept["shapes"] = {name: _shape(shape) for name, shape in (kept.get("shapes") or {}).items()}
    kept["kinds"] = {name: _kind(kind) for name, kind in (kept.get("kinds") or {}).items()}
    kept["motion"] = _motion(kept.get("motion") or {})
    return kept


def _timed(table: Mapping) -> dict:
    """Motions from files had times in seconds, and no key that says so."""
    kept = dict(table)
    for name, key in {"motion": "history", "axle": "slide"}.items():
        if name in kept:
            kept[name] = _in_seconds(kept[name], key)
    if isinstance(kept.get("parts"), Mapping):
        kept["parts"] = {name: _in_seconds(part, "history") for name, part in kept["parts"].items()}
    return kept


def _in_seconds(table: object, key: str) -> object:
    record = table.get(key) if isinstance(table, Mapping) else None
    return {**table, key: {"time_unit": "s", **record}} if isinstance(record, Mapping) else table


def _tank(tank: Mapping) -> dict:
    """Its edges that are open were recorded, of which the lid is the cause."""
    return {"lid": not tank.get("open_edges"), **{key: value for key, value in tank.items() if key != "open_edges"}}


def _grains(grains: Mapping, shaped: bool) -> dict:
    """Shares were by number, sizes of shapes were in the table, and grains of a file were listed."""
    kept = {**grains, "shares": "number"}
    rows = kept.pop("listed", None)
    if shaped:
        kept["table"] = None
    if rows:
        names = ("y", "z", "radius", "vy", "vz", "omega")
        columns = dict(zip(names, map(list, zip(*rows, strict=True)), strict=True))
        kept |= {"bed": {"name": str(kept.get("bed")), "columns": columns}, "diameter": None, "count": None}
    return kept


def _shape(shape: Mapping) -> dict:
    """Its outline was recorded as descriptors and phases, none of either for a disc."""
    if not shape.get("descriptors") and shape.get("phases") is not None:
        return {"disc": True, **{key: shape[key] for key in ("share", "diameter") if key in shape}}
    return dict(shape)


def _kind(kind: Mapping) -> dict:
    """Its material was a table of its own."""
    return {"share": kind["share"], **kind["material"], "against": kind.get("against")}


def _motion(motion: Mapping) -> dict:
    """A motion from a file was recorded in SI."""
    history = motion.get("history")
    if not history:
        return dict(motion)
    columns = {name: history[name] for name in ("time", "sway", "heave", "roll") if history.get(name)}
    record = {"file": {"name": "", "columns": columns}, "centre": history.get("centre", (0.0, 0.0))}
    record |= {"length_unit": "m", "angle_unit": "rad", "time_unit": "s"}
    return {**motion, "history": record}
