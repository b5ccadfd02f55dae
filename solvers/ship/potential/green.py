"""The Green function of waves in two dimensions, integrated over straight panels.

G has ∇²G = 2π δ, ∂G/∂z = K G on z = 0 (K = ω²/g) and outgoing waves, for time factors e^(−iωt). In deep water

    G = ln r − ln r′ − 2 ∫₀^∞ e^(μ(z+ζ)) cos μ(y−η) / (μ − K) dμ,   the path passing below the pole,

r and r′ the distances from the source (η, ζ) and its image above the surface (Wehausen and Laitone 1960, section 13).
With c = z + ζ + i (y − η) the integral is Re I(c) + iπ Re e^(Kc), I its principal value as an analytic function,
I = e^(Kc) [E₁(Kc) + iπ sgn Im c]. Since dc along a panel is its complex normal n times ds, and I′ = K I − 1/c, every
integral over a panel is a difference between its ends:

    ∫ Re f ds = Re (F(b) − F(a))/n,   ∫ ∂(Re f)/∂n ds = Im (f(b) − f(a)),   F′ = f.

Water of finite depth h adds a regular part, which follows from ∂G/∂z = 0 at z = −h for each wave number μ:

    G_h − G = −4 ∫ S(z) S(ζ) cos μ(y−η) / {μ (μ−K) [(μ−K) − (μ+K) e^(−2μh)]} dμ,

S(z) = (μ cosh μz + K sinh μz) e^(−μh), along a path below both poles, which are K and the wave number k.
"""

from math import inf, pi

import numpy as np

from solvers.ship.potential.panels import Panels
from solvers.ship.water import Water

ORDER = 16  # Gauss–Legendre points per piece of the path
DECAYED = 20.0  # the path ends where the integrand has fallen to e^−40


def panel_integrals(
    points: np.ndarray, panels: Panels, frequency: float, water: Water
) -> tuple[np.ndarray, np.ndarray]:
    """∫G ds and ∫∂G/∂n ds (m, n) of n panels at m points y + i z; n into the water at the panel, ω may be infinite.

    At a panel's own middle the second is the principal value.
    """
    number = frequency**2 / water.gravity
    single, double = _logarithm(points, panels)
    for part in (_surface(points, panels, number), _bottom(points, panels, number, frequency, water)):
        single, double = single + part[0], double + part[1]
    return single, double


def _logarithm(points: np.ndarray, panels: Panels) -> tuple[np.ndarray, np.ndarray]:
    """The panel integrals of ln r."""
    # In the panel's own axes: the end points as seen from the field point, turned back.
    to_start = (points[:, None] - panels.start) / panels.tangent
    to_end = to_start - panels.length
    single = (_x_log_x(to_start) - _x_log_x(to_end)).real - panels.length
    angle = np.angle(to_end / to_start)
    on_panel = np.abs(to_start + to_end) < 1e-9 * panels.length
    return single, np.where(on_panel, 0.0, angle)


def _surface(points: np.ndarray, panels: Panels, number: float) -> tuple[np.ndarray, np.ndarray]:
    """The panel integrals of the free surface's part of G in deep water."""
    first, last = (1j * np.conj(points[:, None] - np.conj(node)) for node in (panels.start, panels.end))
    value_a, integral_a = _surface_functions(first, number)
    value_b, integral_b = _surface_functions(last, number)
    normal = panels.normal
    double = np.imag(value_b[0] - value_a[0]) + 1j * np.imag(value_b[1] - value_a[1])
    single = ((integral_b[0] - integral_a[0]) / normal).real + 1j * ((integral_b[1] - integral_a[1]) / normal).real
    return single, double


def _surface_functions(c: np.ndarray, number: float):
    """Two functions of c, whose real parts are Re and Im of the surface's part of G, and their integrals over c."""
    log = np.log(-c)
    if number == inf:
        zero = np.zeros_like(c)
        return (-log, zero), (c - c * log, zero)
    wave = np.exp(number * c)
    upper = np.imag(c) >= 0.0
    # E₁ has its branch cut on real c: both sides are evaluated from above.
    principal = np.where(upper, c, np.conj(c)) + 0.0
    integral = wave * np.where(upper, 1.0, -1.0) * 1j * pi + wave * _with_cut(principal * number, upper)
    value = -log - 2.0 * integral
    return (value, -2.0 * pi * wave), (c - c * log - 2.0 * (integral + log) / number, -2.0 * pi * wave / number)


def _with_cut(argument: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """E₁ of arguments in the upper half-plane, conjugated where `upper` is false."""
    from scipy.special import exp1  # slow to import

    value = exp1(argument)
    return np.where(upper, value, np.conj(value))


def _x_log_x(x: np.ndarray) -> np.ndarray:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(x == 0.0, 0.0, x * np.log(x))


def _bottom(points: np.ndarray, panels: Panels, number: float, frequency: float, water: Water):
    """The panel integrals of the bottom's part of G in water of finite depth."""
    if water.depth == inf:
        return 0.0, 0.0
    depth = water.depth
    lowest = min(panels.start.imag.min(), panels.end.imag.min())
    width = np.ptp(np.concatenate([panels.start.real, panels.end.real, points.real]))
    wave_number = inf if number == inf else float(water.wave_number(frequency))
    mu, step = _path(number, wave_number, 2.0 * (depth + lowest), depth, width)
    weight = _spectrum(mu, number, depth) * step
    single, double = 0.0, 0.0
    for side in (1j, -1j):  # cos μ(y − η) from two exponentials
        field = _shape(mu, points, number, depth, side)
        source, slope = _shape_integrals(mu, panels, number, depth, -side)
        single = single + (0.5 * weight * field) @ source
        double = double + (0.5 * weight * field) @ slope
    return single, double


def _path(number: float, wave_number: float, decay: float, depth: float, width: float):
    """Quadrature points μ and weights of a path below the poles, from 0 to where e^(−μ × decay) is negligible."""
    finish, longest = 2.0 * DECAYED / decay, min(2.0 * pi / width, 2.0 / depth)
    if not 0.0 < number < finish:  # no poles, or none within the path
        return _quadrature(0.0, finish, longest, longest)
    # The path dips from 0 at an angle, since the poles of the evanescent modes lie on the imaginary axis.
    end = 2.0 * wave_number
    sink = min(0.25 * end, 0.5 * longest)
    real, share = _quadrature(0.0, end, 0.5 * number, 0.5 * longest)
    dip = real - 1j * sink * np.sin(pi * real / end)
    steps = share * (1.0 - 1j * sink * pi / end * np.cos(pi * real / end))
    beyond, further = _quadrature(end, max(finish, 2.0 * end), end, longest)
    return np.concatenate([dip, beyond]), np.concatenate([steps, further])


def _quadrature(begin: float, end: float, first: float, longest: float) -> tuple[np.ndarray, np.ndarray]:
    """Gauss–Legendre points and weights on pieces whose lengths double from `first` up to `longest`."""
    breaks, piece = [begin], first
    while breaks[-1] < end:
        breaks.append(min(end, breaks[-1] + min(piece, longest)))
        piece *= 2.0
    nodes, weights = np.polynomial.legendre.leggauss(ORDER)
    breaks = np.array(breaks)
    start, half = breaks[:-1, None], 0.5 * np.diff(breaks)[:, None]
    return (start + half * (1.0 + nodes)).ravel(), (half * weights).ravel()


def _spectrum(mu: np.ndarray, number: float, depth: float) -> np.ndarray:
    """The factor of S(z) S(ζ) cos μ(y − η) in the bottom's part of G."""
    gone = np.exp(-2.0 * mu * depth)
    if number == inf:  # of S/K
        return -4.0 / (mu * (1.0 + gone))
    return -4.0 / (mu * (mu - number) * ((mu - number) - (mu + number) * gone))


def _factors(mu: np.ndarray, number: float) -> tuple[np.ndarray, np.ndarray]:
    """The factors of e^(μz) and e^(−μz) in S e^(μh), or in that of S/K for an infinite K."""
    if number == inf:
        return np.full_like(mu, 0.5), np.full_like(mu, -0.5)
    return 0.5 * (mu + number), 0.5 * (mu - number)


def _shape(mu: np.ndarray, points: np.ndarray, number: float, depth: float, side: complex) -> np.ndarray:
    """S(z) e^(side μ y) at points (m,): (m, q)."""
    up, down = _factors(mu, number)
    y, z = points.real[:, None], points.imag[:, None]
    return up * np.exp(mu * (z - depth + side * y)) + down * np.exp(mu * (-z - depth + side * y))


def _shape_integrals(mu: np.ndarray, panels: Panels, number: float, depth: float, side: complex):
    """∫ S(ζ) e^(side μ η) ds over panels and the integral of its slope along their normals: (q, n) each."""
    single, double = 0.0, 0.0
    mu = mu[:, None]
    middle, tangent, normal = panels.middle, panels.tangent, panels.normal
    for factor, sign in zip(_factors(mu, number), (1.0, -1.0), strict=True):
        rate = mu * (sign * tangent.imag + side * tangent.real)  # along the panel
        half = 0.5 * rate * panels.length
        wave = factor * np.exp(mu * (sign * middle.imag - depth + side * middle.real)) * panels.length
        wave = wave * np.where(
            np.abs(half) < 1e-4, 1.0 + half * half / 6.0, np.sinh(half) / np.where(half == 0, 1, half)
        )
        single = single + wave
        double = double + wave * mu * (sign * normal.imag + side * normal.real)
    return single, double
