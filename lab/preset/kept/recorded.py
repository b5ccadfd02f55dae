"""What a recorded preset holds, and whether it can be one; the preset itself is made by `lab.preset.recorded`."""

from collections.abc import Mapping

from lab.preset import formats
from lab.preset.fields import Table, Taken, defaults_of, join, taken_of
from lab.preset.kept.content import FIRST, INSIDE, KINDS_OF_GAUGES, MATTERS, Content, Gauge
from lab.preset.kept.openings import leads_into
from lab.preset.kept.read import keys
from solvers.machine.quantity import PLANE, SPACE
from solvers.tank.solids.solid import ENDS, MESH, edges_named


def content(table: object) -> Content:
    """The content of a recorded preset. Raises ValueError where it is none, as far as types and words tell."""
    try:
        kept = formats.recorded(table) if isinstance(table, Mapping) else table
        _check(Taken(keys()), _without_own_words(kept), "")
    except (RecursionError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(str(error)) from error
    gauges = {name: Gauge(gauge.get("kind", KINDS_OF_GAUGES[0])) for name, gauge in kept.get("gauges", {}).items()}
    has = {name: kept.get(name) is not None for name in (*MATTERS, "material", "ship", "axle")}
    repeats = kept.get("run", {}).get("repeats", 1)
    matters = tuple(name for name in MATTERS if has[name])
    tank = kept.get("tank", {})
    axes = SPACE if any(tank.get(key) for key in ("along", "turned", "mesh")) else PLANE
    faces = edges_named(0 if axes == PLANE or tank.get("mesh") else len(tank.get("outline") or range(4)))
    faces += ENDS if tank.get("along") and not (tank.get("turned") or tank.get("periodic")) else ()
    faces += MESH if tank.get("mesh") else ()
    faces = faces if matters else ()
    parts = kept.get("parts", {}).items()
    bodies = tuple(name for name, part in parts if part.get("density") or part.get("mass"))
    rooms = (f"{name}.{room}" for name, part in parts if part.get("wall") for room in part.get("rooms") or (INSIDE,))
    openings = (f"{name}.{opening}" for name, part in parts for opening in part.get("openings") or ())
    water, grains = kept.get("water") or {}, kept.get("grains") or {}
    poured = any(water.get(name) is not None for name in ("depth", "region", "radius", "moisture", "saturation"))
    poured = poured or any(inlet.get("room", FIRST) == FIRST for inlet in kept.get("inflow", {}).values())
    wet = has["water"] and has["grains"] and poured and grains.get("room") is None
    own = has["material"], has["ship"], has["axle"], gauges
    room = bodies, tuple(rooms), tuple(openings), tuple(kept.get("inflow", ()))
    soaks = has["water"] and has["grains"] and _soaks(kept.get("parts", {}), grains.get("room"))
    return Content(matters, *own, *room, repeats, tuple(kept.get("parts", {})), axes, faces, wet, soaks)


def _without_own_words(kept: Mapping) -> Mapping:
    """The table; of one with plug-ins, whose laws and colours only they know, without these."""
    if not isinstance(kept, Mapping) or not kept.get("plugins"):
        return kept
    return {**kept, "contact": {}, "video": {**kept.get("video", {}), "colour": None}}


def _soaks(parts: Mapping, name: str | None) -> bool:
    """Whether an opening leads into the room of a hull that the grains are in, if they are in one."""
    hull, _, room = (name or "").rpartition(".")
    part = parts.get(hull) or {}
    openings = [one["points"] for one in (part.get("openings") or {}).values()]
    if not part.get("rooms"):
        return bool(openings)
    return any(leads_into(points, part["wall"], part["rooms"][room]["points"]) for points in openings)


def _check(taken: Taken, value: object, key: str) -> None:
    """Raise ValueError where a value in SI is of another type than its key takes."""
    if (value is None and taken.optional) or (isinstance(value, str) and value in taken.words):
        return
    if taken.below or taken.kind is Table:
        _check_table(taken, value, key)
    elif taken.items:
        _check_list(taken, value, key)
    elif not _is(taken.kind, value):
        raise ValueError(f"{key}: another kind of value is needed")


def _check_table(taken: Taken, value: object, key: str) -> None:
    if not isinstance(value, Mapping):
        raise ValueError(f"{key or 'the preset'}: a table is needed")
    if taken.kind is Table:
        _check(Taken(str), value.get("name"), join(key, "name"))
        for name, column in _mapping(value.get("columns"), key).items():
            _check(Taken(tuple[float, ...]), column, join(key, name))
    elif taken.named:
        one = Taken(taken.named)
        for name, inner in value.items():
            _check(one, inner, join(key, name))
    else:
        defaults = defaults_of(taken.table)
        for name, inner in taken_of(taken.table).items():
            if name in value:
                _check(inner, value[name], join(key, name))
            elif name not in defaults:
                raise ValueError(f"{join(key, name)}: is missing")


def _mapping(value: object, key: str) -> Mapping:
    if not isinstance(value, Mapping):
        raise ValueError(f"{key}: columns are needed")
    return value


def _check_list(taken: Taken, value: object, key: str) -> None:
    items, many = taken.items, taken.many
    if not isinstance(value, list | tuple) or (not many and len(value) != len(items)):
        raise ValueError(f"{key}: another kind of list is needed")
    if many and items[0].kind is float and set(map(type, value)) <= {int, float}:  # maybe a million
        return
    for place, inner in enumerate(value):
        _check(items[0 if many else place], inner, f"{key}[{place}]")


def _is(kind: type | None, value: object) -> bool:
    """Whether a value is of a plain type; whole numbers are numbers, true and false are none."""
    if isinstance(value, bool) or kind is bool:
        return kind is bool and isinstance(value, bool)
    return kind is not None and isinstance(value, int | float if kind is float else kind)
