"""Loose cargo, whatever it is made of: grains, or bulk."""

import numpy as np

from lab.measures.wall_force import grain_mass
from lab.preset.sections.bulk.beds import beds_of, over_first
from lab.recording import Recording


def is_loose(recording: Recording) -> bool:
    """Whether there is loose cargo."""
    return bool({"grains", "bulk"} & set(recording.preset.matters))


def loose_mass(recording: Recording) -> np.ndarray:
    """The mass (W,) kg of the loose cargo in the slab, of all tanks; 0 without."""
    preset = recording.preset
    if preset.bulk:
        return preset.bulk.density * preset.thickness * recording.bulk_volume.sum(axis=1)
    return grain_mass(recording).sum(axis=1) if preset.grains else np.zeros(recording.worlds)


def mass_aboard(recording: Recording) -> np.ndarray:
    """The mass (W,) kg/m of the loose cargo a metre of the ship, each tank by its length."""
    preset = recording.preset
    share = over_first(beds_of(preset)) if preset.bulk else 1.0
    return loose_mass(recording) * preset.a_metre * share
