"""A material for the presets of tests, and the error message of a refused preset."""

from collections.abc import Callable

import pytest

from lab.base.errors import LabError

MATERIAL = """\
[material]
density = "1319 kg/m^3"
young = "3.2e9 Pa"
poisson = 0.28
friction = 0.25
restitution = 0.6"""


def error_of(action: Callable[..., object], *arguments: object) -> str:
    """The message of the LabError that `action` raises, which must be one short sentence."""
    with pytest.raises(LabError) as caught:
        action(*arguments)
    sentence = str(caught.value)
    assert sentence[-1] in ".?" and "\n" not in sentence and len(sentence) < 400
    return sentence
