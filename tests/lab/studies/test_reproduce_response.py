"""A swayed tank against frequency: linear theory in its limits, and what is read off made runs."""

import numpy as np
import pytest

from lab.studies.reproduce import experiments
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.water import response
from solvers.ship.potential.sloshing import SloshingLiquid
from tests.lab.studies.test_reproduce_water import ran

LIQUID, PRESET = SloshingLiquid(0.4, 0.1, (0.0, 0.1)), "sloshing/sway-sweep"
FREQUENCIES = 0.45, 0.85, 0.96, 1.04, 1.1, 1.13, 1.16, 1.22, 1.36, 1.81  # Hz
OMEGA = 2.0 * np.pi * np.array(FREQUENCIES)
SIZE = 5e-4  # m


def made(stretched: float = 1.0, more: float = 0.0, spacing: str = "6.25 mm") -> list:
    """Runs that rise and load as theory has it at frequencies so much higher, with so much more damping (N s/m)."""
    theory = response.tank(ran(PRESET)).response(OMEGA / stretched)
    runs = []
    for omega, rise, load in zip(OMEGA, theory.rise, theory.load, strict=True):
        time = np.arange(0.0, 30.0, 0.01)
        turn, middle = np.exp(-1j * omega * time), np.exp(-1j * omega * (time - 0.005))  # a load is a mean
        pose, force = np.zeros((len(time), 1, 3)), np.zeros((len(time), 1, 3))
        pose[:, 0, 0], force[:, 0, 0] = SIZE * turn.real, SIZE * ((load + 1j * omega * more) * middle).real
        level = (0.1 + SIZE * (rise * turn).real)[:, None, None]
        changes = {"motion.sway.frequency": f"{omega / (2.0 * np.pi)} Hz", "water.spacing": spacing}
        runs.append(ran(PRESET, changes, time=time, pose=pose, wall_force=force, level_depth=level))
    return runs


def verdicts(runs: list) -> dict[str, Verdict]:
    """Those of the experiment on these runs, by the first words of what they are on."""
    told = experiments("water")["sway-sweep"].report({"16 layers": runs})
    assert told.figure is not None and len(told.table) == 1 + len(FREQUENCIES)
    assert len({len(row) for row in told.table}) == 1
    return {" ".join(row.quantity.split()[:2]).rstrip(","): row.verdict for row in told.rows}


def test_theory_without_viscosity_is_that_of_graham_and_rodriguez():
    away = OMEGA[np.abs(OMEGA / LIQUID.rates[0] - 1.0) > 0.01]
    found = response.Tank(LIQUID, 1e-9, -0.19).response(away)
    assert found.added_mass == pytest.approx(LIQUID.added_mass(away)[:, 0, 0], rel=1e-3)
    assert np.abs(found.damping).max() < 1e-2 * LIQUID.mass


def test_viscosity_damps_the_first_mode_as_lamb_says():
    """β → 2νk² (Lamb 1932, §348), less √(νk²/2ω) of it for the layer under the surface."""
    viscosity, wave, rate = 1e-4, np.pi / 0.4, LIQUID.rates[0]
    near = rate * np.linspace(0.99, 1.01, response.NEAREST)
    own, decay = response.first_mode(response.Tank(LIQUID, viscosity, -0.19).response(near), rate)
    thin = viscosity * wave**2 / rate
    assert decay == pytest.approx(2.0 * viscosity * wave**2 * (1.0 - np.sqrt(0.5 * thin)), rel=0.02)
    assert own == pytest.approx(rate, rel=1e-3)


def test_runs_that_do_as_theory_says_agree_with_it():
    assert {*verdicts(made()).values()} == {Verdict.AGREES}
    found = response.response(made()[::-1])  # whatever their order
    theory = response.tank(ran(PRESET)).response(OMEGA)
    np.testing.assert_allclose(found.load, theory.load, rtol=1e-3)
    np.testing.assert_allclose(found.rise, theory.rise, rtol=1e-3)


def test_a_peak_off_by_two_per_cent_and_damping_too_much_differ():
    assert verdicts(made(stretched=1.02))["first natural"] == Verdict.DIFFERS
    found = verdicts(made(more=LIQUID.mass * 0.05))
    assert (found["damping over"], found["added mass"]) == (Verdict.AGREES, Verdict.AGREES)
    assert verdicts(made(more=LIQUID.mass * 0.5))["damping over"] == Verdict.DIFFERS


def test_only_the_finest_run_is_judged():
    found = {"8 layers": made(stretched=1.02, spacing="12.5 mm"), "16 layers": made()}
    judged = [row.verdict for row in experiments("water")["sway-sweep"].report(found).rows]
    assert judged == [None] * 4 + [Verdict.AGREES] * 4
