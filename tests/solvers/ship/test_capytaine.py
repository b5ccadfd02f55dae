"""Our section against Capytaine's barge in three dimensions: another code, other panels, another Green's function."""

from math import pi

import numpy as np
import pytest

from solvers.ship.potential.radiation import hydrodynamics
from solvers.ship.section import box
from solvers.ship.water import Water

pytestmark = pytest.mark.slow

BREADTH, DRAUGHT = 0.34, 0.11
SHORT, LONG = 4.0, 6.0  # m: what the second has more than the first has no ends
MODES = ("Sway", "Heave", "Roll")
FREQUENCY = 8.0  # rad/s: waves of 1 m, shorter than either barge
WATER = Water()


def of_barge(capytaine, length: float, across: int) -> tuple[np.ndarray, ...]:
    """Added mass, damping (3, 3) and the force in beam waves (3,) of a barge with so many panels across its bottom."""
    resolution = (round(7.0 * length * across / 4.0), across, across)
    box_of = capytaine.mesh_parallelepiped(size=(length, BREADTH, 2.0 * DRAUGHT), resolution=resolution)
    dofs = capytaine.rigid_body_dofs(rotation_center=(0.0, 0.0, 0.0))
    body, solver = capytaine.FloatingBody(mesh=box_of.immersed_part(), dofs=dofs), capytaine.BEMSolver()
    how = {"body": body, "omega": FREQUENCY, "rho": WATER.density, "g": WATER.gravity}
    moved = [solver.solve(capytaine.RadiationProblem(radiating_dof=mode, **how)) for mode in MODES]
    met = capytaine.DiffractionProblem(wave_direction=0.5 * pi, **how)
    passing, scattered = capytaine.bem.airy_waves.froude_krylov_force(met), solver.solve(met).forces
    added = np.array([[one.added_masses[mode] for one in moved] for mode in MODES])
    damping = np.array([[one.radiation_dampings[mode] for one in moved] for mode in MODES])
    return added, damping, np.array([passing[mode] + scattered[mode] for mode in MODES])


@pytest.fixture(scope="module")
def quotients():
    """Ratios of the barge's values per metre to our section's: added mass, damping, force, by panels across."""
    capytaine = pytest.importorskip("capytaine", reason="needs Capytaine: pip install -e '.[ship3d]'")
    section = hydrodynamics(box(BREADTH, 0.3), WATER, -DRAUGHT, [FREQUENCY], about=(0.0, DRAUGHT), count=120)
    ours = section.added_mass[0], section.damping[0], np.abs(section.excitation[0])
    found = {}
    for across in (6, 12):
        ends = [of_barge(capytaine, length, across) for length in (SHORT, LONG)]
        metre = [(long - short) / (LONG - SHORT) for short, long in zip(*ends, strict=True)]
        found[across] = [np.abs(theirs) / np.abs(mine) for theirs, mine in zip(metre, ours, strict=True)]
    return found


def test_sway_and_heave_are_those_of_a_long_barge(quotients):
    added, damping, force = quotients[12]
    assert np.diag(added) == pytest.approx([1.0, 1.0, 1.0], abs=0.015)
    assert np.diag(damping)[:2] == pytest.approx([1.0, 1.0], abs=0.025)
    assert force[:2] == pytest.approx([1.0, 1.0], abs=0.01)


def test_roll_converges_with_smaller_panels(quotients):
    """A box rolling about its waterline makes hardly any waves: the result is a small difference of large numbers."""
    for of_roll in (lambda q: q[1][2, 2], lambda q: q[2][2], lambda q: q[0][0, 2]):
        coarse, fine = (abs(of_roll(quotients[across]) - 1.0) for across in (6, 12))
        assert fine < 0.5 * coarse
        assert fine < 0.25
