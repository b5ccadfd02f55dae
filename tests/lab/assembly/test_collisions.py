"""Solutions of collisions that are kept between processes: the same bits, and what is damaged or stale is not used."""

import json

import pytest

from lab.assembly import collisions
from lab.assembly.collisions import known_collisions
from solvers.grains import restitution
from solvers.grains.restitution import damping_for


@pytest.fixture(autouse=True)
def forgotten(tmp_path, monkeypatch):
    """Each test has a cache of its own, and a process that has solved nothing."""
    monkeypatch.setenv("CARGOLAB_CACHE", str(tmp_path))
    monkeypatch.setattr(restitution, "solved", {})


def forget(monkeypatch):
    monkeypatch.setattr(restitution, "solved", {})
    collisions._load.cache_clear()


def test_what_is_kept_has_the_same_bits_and_is_not_solved_again(monkeypatch, tmp_path):
    with known_collisions():
        before = damping_for(0.613), restitution.restitution(0.7, 0.5)
    assert len(list((tmp_path / "collisions").iterdir())) == 1
    forget(monkeypatch)
    monkeypatch.setitem(__import__("sys").modules, "scipy.optimize", None)
    with known_collisions():
        assert (damping_for(0.613), restitution.restitution(0.7, 0.5)) == before
        with pytest.raises(ImportError):
            damping_for(0.614)


@pytest.mark.parametrize("content", ["", "[[", "[1, 2]", '[["damping_for", 0.613, 0.5, "none"]]', "null"])
def test_a_damaged_file_counts_as_missing(monkeypatch, content):
    with known_collisions():
        right = damping_for(0.613)
    file = next((collisions.cache_folder() / "collisions").iterdir())
    file.write_text(content)
    forget(monkeypatch)
    with known_collisions():
        assert damping_for(0.613) == right
    assert json.loads(file.read_text()) == [["damping_for", 0.613, 0.5, right]]


def test_a_change_of_the_code_makes_what_is_kept_stale(monkeypatch, tmp_path):
    usual = collisions._key()
    other = tmp_path / "restitution.py"
    other.write_text("# other code")
    monkeypatch.setattr(restitution, "__file__", str(other))
    collisions._key.cache_clear()
    assert collisions._key() != usual
    monkeypatch.undo()
    collisions._key.cache_clear()
    assert collisions._key() == usual
