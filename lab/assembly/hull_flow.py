"""Potential flow about a whole hull in space; integrals by Capytaine (Ancellin & Dias 2019, J. Open Source Softw. 4).

Green's third identity on the wetted hull, as of a section in `solvers.ship.potential.radiation`: D φ = S v with panels
of constant potential φ and normal velocity v, and the free surface's Green function in deep water or water of finite
depth. At frequencies of standing waves inside the hull it has more than one solution (John 1950); inside, the same
integrals vanish, and asking this at points of the waterplane within her, by least squares, leaves the one that is
wanted (Ohmatsu 1983; in space Lau & Hearn 1989, Int. J. Num. Meth. Fluids 9). Capytaine comes with the extra `ship3d`.
"""

from collections.abc import Sequence
from math import pi

import numpy as np

from lab.base.errors import LabError
from solvers.ship.potential.mesh import HullMesh
from solvers.ship.potential.radiation import Hydrodynamics
from solvers.ship.water import Water

ABSENT = "needs Capytaine, which is not installed: pip install 'cargo-shift-lab[ship3d]'."
TO_STARBOARD = 0.5 * pi  # heading of waves that travel to starboard
QUADRATURE = "Gauss-Legendre 2"  # of waves on a panel: its middle alone is 5 % off at a sixth of a wavelength
MIRROR = np.array([1.0, -1.0, 1.0])  # starboard to port


def capytaine(key: str):
    """The library. Raises LabError, one sentence that begins with the preset's key, where it is missing."""
    try:
        import capytaine as found
        import threadpoolctl  # noqa: F401 (comes with the same extra)
    except ImportError:
        raise LabError(f"{key}: {ABSENT}") from None
    found.set_logging("ERROR")
    return found


class Flow:
    """The flow about a hull's mesh that turns about a point `height` (m) above calm water."""

    def __init__(self, mesh: HullMesh, height: float, water: Water, key: str = "ship.hydrodynamics"):
        self.capytaine, self.water = capytaine(key), water
        self.half = self.capytaine.Mesh(mesh.corners, mesh.panels, quadrature_method=QUADRATURE)
        whole = self.capytaine.ReflectionSymmetricMesh(self.half, plane="xOz")
        self.body = self.capytaine.FloatingBody(mesh=whole)
        self.places, self.slopes = whole.faces_centers, whole.faces_normals
        turned = np.cross(self.places - [0.0, 0.0, height], self.slopes)
        self.normals = np.hstack([self.slopes, turned])  # (n, 6), normal velocities of unit motion in each mode
        self.weights = self.normals * whole.faces_areas[:, None]
        self.points = np.vstack([whole.faces_centers, mesh.inner(), mesh.inner() * MIRROR])
        self.green, self.known = self.capytaine.Delhommeau(), (None, ())

    def table(self, frequency: Sequence[float]) -> Hydrodynamics:
        """Coefficients (n, 6) at frequencies (n,) rad/s in waves to starboard; kg, kg m, kg m² and so on."""
        rows = [self._at(float(omega)) for omega in frequency]
        columns = [np.array(values) for values in zip(*rows, strict=True)]
        return Hydrodynamics(np.asarray(frequency, dtype=float), *columns, self._force(self._radiated(np.inf)).real)

    def excitation(self, omega: float, heading: float = TO_STARBOARD) -> np.ndarray:
        """Force and moment (6,) per metre of amplitude in waves of a heading (rad), π/2 to starboard."""
        incident, slope = self._incident(omega, heading)
        scattered = self._solved(omega, -slope[:, None])[:, 0]
        return 1j * omega * self._force(incident + scattered)

    def _at(self, omega: float):
        """Added mass, damping, excitation, its Froude–Krylov part, and excitation by Haskind's relation."""
        radiated = self._radiated(omega)
        force, (incident, slope) = self._force(radiated), self._incident(omega, TO_STARBOARD)
        passing = 1j * omega * self._force(incident)
        crossed = slope * self.body.mesh.faces_areas @ radiated
        haskind = passing + 1j * omega * self.water.density * crossed  # Haskind 1957: −iωρ ∫ (φ_I n_j − φ_j ∂φ_I/∂n) dS
        return force.real, omega * force.imag, self.excitation(omega), passing, haskind

    def _force(self, potential: np.ndarray) -> np.ndarray:
        """−ρ ∫ φ n_j dS of potentials (n, …)."""
        return -self.water.density * self.weights.T @ potential

    def _radiated(self, omega: float) -> np.ndarray:
        """The potentials (n, 6) on the panels for unit velocities."""
        return self._solved(omega, self.normals)

    def _incident(self, omega: float, heading: float) -> tuple[np.ndarray, np.ndarray]:
        """The potential (n,) of waves of unit amplitude, and its slope along the normals."""
        waves, water = self.capytaine.bem.airy_waves, self.water
        how = {"omega": omega, "rho": water.density, "g": water.gravity, "water_depth": water.depth}
        problem = self.capytaine.DiffractionProblem(body=self.body, wave_direction=heading, **how)
        slope = np.sum(waves.airy_waves_velocity(self.places, problem) * self.slopes, axis=1)
        return waves.airy_waves_potential(self.places, problem), slope

    def _solved(self, omega: float, velocity: np.ndarray) -> np.ndarray:
        """Potentials (n, m) of normal velocities (n, m): what is alike on both sides, and what is opposite, apart."""
        from threadpoolctl import threadpool_limits

        here, there = np.split(velocity, 2)
        with threadpool_limits(limits=1):  # the same bits on any number of cores
            alike, opposite = (
                np.linalg.solve(square, adjoint @ (single @ (0.5 * (here + sign * there))))
                for sign, (square, adjoint, single) in zip((1.0, -1.0), self._equations(omega), strict=True)
            )
        return np.vstack([alike + opposite, alike - opposite])

    def _equations(self, omega: float) -> tuple:
        """D*D, D* and S of each symmetry, with a row for each panel of the half and each point within her."""
        if self.known[0] != omega:
            single, double = (self._by_side(one) for one in self._integrals(omega))
            both = [(single[0] + sign * single[1], double[0] + sign * double[1]) for sign in (1.0, -1.0)]
            self.known = omega, tuple((d.conj().T @ d, d.conj().T, s) for s, d in both)
        return self.known[1]

    def _integrals(self, omega: float) -> tuple[np.ndarray, np.ndarray]:
        """S and D over the panels of the half, ∫ G dS and φ/2 + ∫ φ ∂G/∂n dS, at their middles and points within."""
        k = omega if np.isinf(omega) else float(self.water.wave_number(omega))
        how = {"free_surface": 0.0, "water_depth": self.water.depth, "wavenumber": k, "adjoint_double_layer": False}
        single, double = self.green.evaluate(self.points, self.half, diagonal_term_in_double_layer=False, **how)
        double[np.diag_indices(len(self.half.faces))] += 0.5
        return single, double

    def _by_side(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rows of places to starboard, and those of their images."""
        panels, inner = np.split(rows, [len(self.places)])
        return tuple(np.vstack(pair) for pair in zip(np.split(panels, 2), np.split(inner, 2), strict=True))
