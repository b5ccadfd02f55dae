"""Colours of a user's own, from plug-ins and notebooks: a number for each grain of a bed in a frame."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lab.base.errors import LabError
from lab.plugins.guard import told, within
from lab.plugins.loading import owner

if TYPE_CHECKING:
    from lab.paint.colours import Colouring
    from lab.paint.footage import Bed


def register(name: str, function: Callable, label: str) -> None:
    """Add a colour of grains by its name, or replace one; `label`: with its unit, beside the scale of colours."""
    from lab.paint import colours
    from lab.preset.python.words import add_word
    from lab.preset.sections import video

    taken = (word for word in video.COLOURS if word not in OWN)
    if not name.replace("-", "_").isidentifier() or name in taken:
        raise LabError(f"colour: {name!r} is no name, or one of the lab's; choose another.")
    OWN[name] = owner(function)
    video.OF_MATTERS["grains"] = tuple(dict.fromkeys((*video.OF_MATTERS["grains"], name)))
    add_word(video.Video, "colour", name)
    colours.MODES[name] = lambda beds: _colouring(name, function, label or name.replace("_", " "), beds)


def _colouring(name: str, function: Callable, label: str, beds: Sequence["Bed"]) -> "Colouring":
    from lab.paint.colours import EMBERS, FEW, Colouring, ramp, spread

    def values(bed: "Bed", frame: int) -> np.ndarray:
        try:
            with within():
                found = np.asarray(function(bed, frame), dtype=float)
        except Exception as error:
            raise LabError(f"{OWN[name]}: colour {name}: {told(error)}.") from error
        if found.shape != bed.radius.shape:
            raise LabError(f"{OWN[name]}: colour {name}: numbers of shape {found.shape}, not one for each grain.")
        return found

    samples = np.concatenate([values(bed, frame) for bed, frame in spread(beds, FEW)])
    finite = samples[np.isfinite(samples)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    return Colouring(label, low, high if high > low else low + 1.0, ramp(EMBERS), values)


OWN: dict[str, str] = {}  # the plug-in of each colour
