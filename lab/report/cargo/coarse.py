"""The section of `cargolab explain` on coarse grains: the model's grain and the real one side by side.

A grain of the model, s times as large as a real one, stands for s³ of them. The bulk is the same where stresses are:
so density, Hertz's moduli, restitution, friction and rolling friction (its torque goes with the radius) are kept.
The stiffness of a linear spring goes with s, an adhesive force with s² (Thakur, Ooi and Ahmadian 2015, confirmed there
in compression), the coefficient of a linear dashpot with s², as forces do at equal speeds (Feng and Owen 2014, exact
scaling laws). A capillary force, 2 π γ cos θ R, goes with s by itself: its surface tension has to go with s too.
What is not kept is the number of grains across the hold: the error of that grows with s, and is to be looked at by
grains of half the size.
"""

from math import pi

from lab.preset.schema import Preset
from lab.preset.units import show

Rows = list[tuple[str, str]]
KEPT = "density, Young's modulus, restitution, friction, rolling friction"


def described(preset: Preset) -> Rows:
    """Rows of a name and "model; real", each with its rule; none where each grain stands for itself."""
    real = preset.grains.stands_for
    if real is None:
        return []
    model, given = preset.mean_diameter, preset.material
    s = model / real
    mass = given.density * pi / 6.0
    across = preset.tank.extent[0]
    rows = [
        ("", "model; full scale"),
        ("grain", f"{show(model, 'm')}; {show(real, 'm')}, s = {s:.4g}"),
        ("its mass", f"{show(mass * model**3, 'kg')}; {show(mass * real**3, 'kg')}, s^3"),
        ("across the tank", f"{across / model:.0f}; {across / real:.0f}, 1/s"),
        ("kept", KEPT),
    ]
    if preset.contact.tangential in ("haff-werner", "viscous"):
        rows.append(("shear damping", _scaled(given.shear_damping, s**2, "N s/m", "s^2")))
    if preset.contact.cohesion != "none":
        rows.append(("surface tension", _scaled(given.surface_tension, s, "N/m", "s, so that forces go with s^2")))
    return rows


def _scaled(value: float, factor: float, symbol: str, rule: str) -> str:
    return f"{show(value, symbol)}; {show(value / factor, symbol)}, {rule}"
