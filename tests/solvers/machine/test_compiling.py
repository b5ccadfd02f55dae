"""Kernels that compile fast where the environment asks for it."""

import pytest

from solvers.machine import compiling, wide
from solvers.machine.errors import Unavailable


@pytest.mark.parametrize("has", [True, False])
def test_real_vectors_are_for_processors_that_have_them_and_who_has_time(has, monkeypatch):
    monkeypatch.setattr(wide, "has_wide_registers", lambda: has)
    monkeypatch.setenv("CARGOLAB_COMPILE", "quick")
    assert not wide.pays()
    monkeypatch.delenv("CARGOLAB_COMPILE")
    assert wide.pays() == has


def test_another_word_is_refused_in_a_sentence(monkeypatch):
    monkeypatch.setenv("CARGOLAB_COMPILE", "fast")
    with pytest.raises(Unavailable, match=r"CARGOLAB_COMPILE is 'fast': set it to quick, or not at all\."):
        compiling.quick()
