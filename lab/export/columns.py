"""Tables: particles of all sorts in one, for formats that have one list of them, and the columns of the series."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from solvers.machine.quantity import OWNERS, Quantity

if TYPE_CHECKING:
    from lab.export.stage import Stage

NEITHER = {"i": -1, "u": -1, "f": np.nan}  # the value of what a sort of particles does not have, by kind of number


def table(stage: Stage, row: int) -> tuple[list[str], dict[str, np.ndarray]]:
    """The sort of each particle at a picture, and the values of all by name, "position" first.

    What a sort does not have is NaN, or −1 of whole numbers. Particles of a sort keep their order and `id`.
    """
    clouds = {name: stage.cloud(name, row) for name in stage.clouds}
    sizes = {name: len(cloud.place) for name, cloud in clouds.items()}
    values = {"position": np.concatenate([np.zeros((0, 3)), *(cloud.place for cloud in clouds.values())])}
    known = {name: one for cloud in clouds.values() for name, one in cloud.values.items()}
    for name, one in known.items():
        kind = "i" if one.dtype.kind in "iu" else "f"
        blank = {sort: np.full((size, *one.shape[1:]), NEITHER[kind]) for sort, size in sizes.items()}
        parts = [np.asarray(clouds[sort].values.get(name, blank[sort])) for sort in clouds]
        values[name] = np.concatenate([part.astype("<i4" if kind == "i" else float) for part in parts])
    return [sort for sort, size in sizes.items() for _ in range(size)], values


def types_of(stage: Stage) -> list[str]:
    """The names of all sorts of particles; grains of several kinds are of as many sorts."""
    found = []
    for cloud in stage.clouds:
        found += [_word(f"grains-{kind}") for kind in stage.kinds] if _kinds_apart(stage, cloud) else [cloud]
    return found


def species(stage: Stage, sorts: list[str], values: dict[str, np.ndarray]) -> list[str]:
    """The name of the sort of each particle, as `types_of` has them."""
    if not any(_kinds_apart(stage, cloud) for cloud in stage.clouds):
        return sorts
    words = [_word(f"grains-{kind}") for kind in stage.kinds]
    kinds = values["kind"].tolist()
    return [words[kind] if sort == "grains" else sort for sort, kind in zip(sorts, kinds, strict=True)]


def _kinds_apart(stage: Stage, cloud: str) -> bool:
    return cloud == "grains" and len(stage.kinds) > 1


def _word(name: str) -> str:
    """A name without blanks and signs."""
    return re.sub(r"[^\w-]+", "-", name)


def columns_of(stage: Stage, name: str, quantity: Quantity) -> Iterator[tuple[str, np.ndarray]]:
    """The columns (T,) of a quantity of the series with their labels: "gauge_pressure left (Pa)", "pose_roll (rad)"."""
    values = stage.recording.series[name]
    if quantity.per == "run":
        yield _label(name, "", "", quantity.unit), values
        return
    values = values[:, stage.world]
    owner = OWNERS[quantity.per][-1]
    owners = stage.recording.names.get(owner, []) if quantity.per != "world" else [""]
    for k, own in enumerate(owners):
        one = values[:, k] if quantity.per != "world" else values
        for c, unit in enumerate(quantity.units):
            component = quantity.components[c] if quantity.components else ""
            yield _label(name, component, own, unit), one[:, c] if quantity.components else one


def _label(name: str, component: str, owner: str, unit: str) -> str:
    full = f"{name}_{component}" if component else name
    full = f"{full} {owner}" if owner else full
    return full if unit == "1" else f"{full} ({unit})"
