"""Potential flow about a whole hull in space, by Capytaine (Ancellin & Dias 2019, J. Open Source Softw. 4, 1341).

Boundary elements of constant strength with the free surface's Green function in deep water or water of finite depth. A
lid on the waterplane inside the hull removes irregular frequencies. Capytaine comes with the extra `ship3d`.
"""

from collections.abc import Sequence
from math import pi

import numpy as np

from lab.base.errors import LabError
from solvers.ship.potential.mesh import HullMesh
from solvers.ship.potential.radiation import Hydrodynamics
from solvers.ship.potential.strips import MODES
from solvers.ship.water import Water

ABSENT = "needs Capytaine, which is not installed: pip install 'cargo-shift-lab[ship3d]'."
TO_STARBOARD = 0.5 * pi  # heading of waves that travel to starboard
STEPS_A_WAVE = 6.0  # least number of panels in the length of a wave
FREE = 0.8  # of the lowest frequency of standing waves inside the hull: below it there is no lid
QUIET = {"_check_wavelength": False, "n_threads": 1}  # the mesh is as fine as the shortest wave asks
LID = 0.4  # of the draught and of g/ω², depth of the lid


def capytaine(key: str):
    """The library. Raises LabError, one sentence that begins with the preset's key, where it is missing."""
    try:
        import capytaine as found
    except ImportError:
        raise LabError(f"{key}: {ABSENT}") from None
    found.set_logging("ERROR")
    return found


class Flow:
    """The flow about a hull's mesh that turns about a point `height` (m) above calm water."""

    def __init__(self, mesh: HullMesh, height: float, water: Water, key: str = "ship.hydrodynamics"):
        self.capytaine, self.water = capytaine(key), water
        sides = self._sides(mesh.corners, mesh.panels)
        dofs = self.capytaine.rigid_body_dofs(rotation_center=(0.0, 0.0, height))
        self.hull, self.dofs = mesh, dofs
        self.bare = self.capytaine.FloatingBody(mesh=sides, dofs=dofs)
        self.solver = self.capytaine.BEMSolver()
        self.names = [name.capitalize() for name in MODES]
        turned = np.cross(sides.faces_centers - [0.0, 0.0, height], sides.faces_normals)
        self.normals = np.vstack([sides.faces_normals.T, turned.T])  # normal velocities of unit motion in each mode

    def _sides(self, corners: np.ndarray, panels: np.ndarray):
        half = self.capytaine.Mesh(vertices=corners, faces=panels)
        return self.capytaine.ReflectionSymmetricMesh(half, plane="xOz")

    def table(self, frequency: Sequence[float]) -> Hydrodynamics:
        """Coefficients (n, 6) at frequencies (n,) rad/s in waves to starboard; kg, kg m, kg m² and so on."""
        rows = [self._at(float(omega)) for omega in frequency]
        columns = [np.array(values) for values in zip(*rows, strict=True)]
        return Hydrodynamics(np.asarray(frequency, dtype=float), *columns, self._radiated(np.inf)[0])

    def excitation(self, omega: float, heading: float = TO_STARBOARD) -> np.ndarray:
        """Force and moment (6,) per metre of amplitude in waves of a heading (rad), π/2 to starboard."""
        problem = self.capytaine.DiffractionProblem(wave_direction=heading, **self._how(omega))
        return self._named(self.solver.solve(problem, **QUIET).forces) + self._passing(problem)

    def _at(self, omega: float):
        """Added mass, damping, excitation, its Froude–Krylov part, and excitation by Haskind's relation."""
        added, damping, potential = self._radiated(omega)
        problem = self.capytaine.DiffractionProblem(wave_direction=TO_STARBOARD, **self._how(omega))
        passing = self._passing(problem)
        scattered = self._named(self.solver.solve(problem, **QUIET).forces)
        return added, damping, passing + scattered, passing, self._haskind(problem, potential)

    def _radiated(self, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Added mass and damping (6, 6), and the potentials (6, n) on the panels for unit velocities."""
        how, added, damping, potential = self._how(omega), [], [], []
        for name in self.names:
            solved = self.solver.solve(self.capytaine.RadiationProblem(radiating_dof=name, **how), **QUIET)
            added.append(self._named(solved.added_masses).real)
            damping.append(self._named(solved.radiation_dampings).real)
            potential.append(solved.potential[how["body"].hull_mask])
        factor = 1.0 if np.isinf(omega) else -1j * omega
        return np.array(added).T, np.array(damping).T, np.array(potential) / factor

    def _passing(self, problem) -> np.ndarray:
        return self._named(self.capytaine.bem.airy_waves.froude_krylov_force(problem))

    def _haskind(self, problem, potential: np.ndarray) -> np.ndarray:
        """X = −iωρ ∫ (φ_I n_j − φ_j ∂φ_I/∂n) dS (Haskind 1957) from the radiated potentials φ_j."""
        waves, mesh = self.capytaine.bem.airy_waves, self.bare.mesh
        incident = waves.airy_waves_potential(mesh.faces_centers, problem)
        slope = np.sum(waves.airy_waves_velocity(mesh.faces_centers, problem) * mesh.faces_normals, axis=1)
        whole = (self.normals * incident - potential * slope) @ mesh.faces_areas
        return -1j * problem.omega * self.water.density * whole

    def _how(self, omega: float) -> dict[str, object]:
        water = self.water
        how = {"omega": omega, "rho": water.density, "g": water.gravity, "water_depth": water.depth}
        return how | {"body": self._body(omega)}

    def _body(self, omega: float):
        """The hull, with a lid inside where standing waves within her would disturb the solution (John 1950).

        They are those of a surface of zero potential with water down to the hull, ω² = g k coth k T, and for a box
        around her none is lower. Below the lid there are none; above it, at a depth d, none lower than √(g/d).
        """
        length, breadth, draught = self.hull.box
        k = pi * np.hypot(1.0 / length, 1.0 / breadth)
        lowest = np.sqrt(self.water.gravity * k / np.tanh(k * draught))
        if np.isinf(omega) or omega < FREE * lowest:
            return self.bare
        depth = LID * min(draught, self.water.gravity / omega**2)
        lid = self._sides(*self.hull.lid(depth))
        return self.capytaine.FloatingBody(mesh=self.bare.mesh, lid_mesh=lid, dofs=self.dofs)

    def _named(self, values) -> np.ndarray:
        return np.array([values[name] for name in self.names])
