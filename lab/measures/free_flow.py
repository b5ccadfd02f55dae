"""Water that starts with a flow of its own, beside the closed form of that flow, from the picture frames.

A round drop that is strained by σ0 at first and pulled to a point by Ω stays an ellipse, with half axes a along y and b
along z: σ' = (σ² + Ω²)(b² − a²)/(a² + b²), a' = σ a, b' = −σ b (Monaghan & Rafiee 2013, eq. 4.3). long_axis, short_axis
(mm): the longest and shortest half axis in any frame, the root mean square of the places over that of the first frame,
along y and z. axes_error (%): the largest deviation of either from the closed form. swing_period (s): when the
difference a − b, zero at first, has come back to zero with the same sign of its rate, between two frames by a line.
energy_lost (%): of the energy at the start; an ideal drop loses none.

Water that turns freely: angular_momentum (%), about its centre, at the end, of that at the start, which is kept.
corner_flight (%): mean distance at the end of the particles in the corners of its region, over that of free flight,
|r + u t|; no pressure holds the water in a corner.

Vortices of a viscous liquid: vortex_amplitude (%), the velocities at the end projected on those at the start, over
exp(−ν (a² + b²) t), a and b the wave numbers along y and z (Taylor & Green 1937).
Error: none of their own.
"""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.fluid.start.flow import stirred, vortices

OF = "water"
LEAST_FRAMES = 2
FINE = 2000  # times of the closed form, for its extremes and period


def applies(recording: Recording) -> bool:
    """The water flows at first, and there are pictures of it."""
    return recording.preset.water.flow is not None and len(recording.frames["time"]) >= LEAST_FRAMES


def measure(recording: Recording) -> dict[str, Value]:
    """Of drops their axes (mm, %), period (s) and energy (%), of turning water its momentum (%), and of vortices."""
    flow, found = recording.preset.water.flow, {}
    if is_ellipse(recording):
        found |= _of_drop(recording)
    if flow.rotation:
        found |= _of_turning(recording)
    if is_viscous(recording):
        amplitude = vortex_amplitude(recording)[-1] / decay(recording)[-1]
        note = f"{100.0 * decay(recording)[-1]:.3g} % of the start are left by the closed form"
        found["vortex_amplitude"] = over_worlds(100.0 * amplitude, "%", note=note)
    return found


def is_ellipse(recording: Recording) -> bool:
    """Whether the water is a drop whose axes are known."""
    water = recording.preset.water
    return water.radius is not None and bool(water.flow.strain) and not water.flow.rotation


def is_viscous(recording: Recording) -> bool:
    """Whether the water is of vortices whose decay is known."""
    water = recording.preset.water
    return bool(water.flow.vortices) and water.kinematic_viscosity is not None


def ellipse(strain: float, pull: float, times: np.ndarray) -> np.ndarray:
    """Half axes (T, 2), of the radius, of a drop strained by σ0 (1/s) at first and pulled by Ω (rad/s)."""
    from scipy.integrate import solve_ivp  # slow to import

    def motion(_, state):
        s, a, b = state
        return [(s * s + pull * pull) * (b * b - a * a) / (a * a + b * b), s * a, -s * b]

    span = 0.0, float(np.max(times, initial=1e-12))
    return solve_ivp(motion, span, [strain, 1.0, 1.0], "DOP853", t_eval=times, rtol=1e-12, atol=1e-12).y[1:].T


def half_axes(recording: Recording) -> np.ndarray:
    """Half axes (F, W, 2) of a drop in the frames, of its radius."""
    place = recording.frames["water_position"][:].astype(float)
    size = place.std(axis=2)
    return size / size[0]


def swing_period(time: np.ndarray, axes: np.ndarray, strain: float) -> float:
    """When (s) the difference of half axes (T, 2) has come back to zero with the sign of its first rate; NaN: never."""
    gap = np.sign(strain) * (axes[:, 0] - axes[:, 1])
    for k, (before, after) in enumerate(pairwise(gap)):
        if before < 0.0 <= after:
            return float(time[k] - before * (time[k + 1] - time[k]) / (after - before))
    return float("nan")


def _of_drop(recording: Recording) -> dict[str, Value]:
    """Numbers of a drop whose axes are known."""
    water, time, axes = recording.preset.water, recording.frames["time"][:], half_axes(recording)
    of = water.flow.strain, water.flow.pull
    fine = np.linspace(time[0], time[-1], FINE)
    known, size = ellipse(*of, fine), 1e3 * water.radius
    off = np.abs(axes / ellipse(*of, time)[:, None] - 1.0).max(axis=(0, 2))
    energy = recording.series["water_total"]
    found = {
        "long_axis": _beside(size * axes.max(axis=(0, 2)), "mm", size * known.max()),
        "short_axis": _beside(size * axes.min(axis=(0, 2)), "mm", size * known.min()),
        "axes_error": over_worlds(100.0 * off, "%"),
        "energy_lost": over_worlds(100.0 * (1.0 - energy[-1] / energy[0]), "%", note="closed form 0"),
    }
    period = swing_period(fine, known, of[0])
    if np.isfinite(period):
        periods = [swing_period(time, axes[:, w], of[0]) for w in range(recording.worlds)]
        found["swing_period"] = _beside(periods, "s", period)
    return found


def _beside(numbers: np.ndarray, unit: str, known: float) -> Value:
    """A number of each world with that of the closed form in its note."""
    return over_worlds(numbers, unit, note=f"closed form {known:.4g} {unit}")


def angular_momentum(recording: Recording) -> np.ndarray:
    """Angular momentum (F, W) per mass, m²/s, of the water about its centre of mass."""
    place, velocity = (recording.frames[f"water_{name}"][:].astype(float) for name in ("position", "velocity"))
    arm = place - place.mean(axis=2, keepdims=True)
    return (arm[..., 0] * velocity[..., 1] - arm[..., 1] * velocity[..., 0]).mean(axis=2)


def _of_turning(recording: Recording) -> dict[str, Value]:
    """Numbers of water that turns freely."""
    water, momentum = recording.preset.water, angular_momentum(recording)
    found = {"angular_momentum": over_worlds(100.0 * momentum[-1] / momentum[0], "%", note="closed form 100 %")}
    if water.region is None or water.flow.pull:
        return found
    first, last = (recording.frames["water_position"][k].astype(float) for k in (0, -1))
    time, shares = recording.frames["time"][-1] - recording.frames["time"][0], []
    for w in range(recording.worlds):
        centre = first[w].mean(axis=0)
        corners = [np.hypot(*(first[w] - corner).T).argmin() for corner in water.shape]
        arm = first[w, corners] - centre
        free = arm + time * stirred(arm, water.flow.strain, water.flow.rotation)
        shares.append(np.hypot(*(last[w, corners] - centre).T).mean() / np.hypot(*free.T).mean())
    return found | {"corner_flight": over_worlds(100.0 * np.array(shares), "%", note="free flight 100 %")}


def vortex_amplitude(recording: Recording) -> np.ndarray:
    """What of the vortices of the start is left in the frames (F, W)."""
    tank = recording.preset.tank
    corner, sides = np.array(tank.corners).min(axis=0), np.array(tank.extent)
    left = []
    for frame in range(len(recording.frames["time"])):
        place, velocity = (recording.frames[f"water_{name}"][frame].astype(float) for name in ("position", "velocity"))
        shape = np.array([vortices(world - corner, sides) for world in place])
        left.append((velocity * shape).sum(axis=(1, 2)) / (shape**2).sum(axis=(1, 2)))
    return np.array(left) / recording.preset.water.flow.vortices


def decay(recording: Recording) -> np.ndarray:
    """What is left of the vortices (F,) by the closed form."""
    waves = 2.0 * np.pi / np.array(recording.preset.tank.extent)
    rate = recording.preset.water.kinematic_viscosity * float((waves**2).sum())
    return np.exp(-rate * recording.frames["time"][:])


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The half axes of a drop, the vortices' amplitude, or the angular momentum, beside the closed form."""
    time, flow = recording.frames["time"][:], recording.preset.water.flow
    if is_ellipse(recording):
        ((axes,),) = sheet.panels()
        size, known = recording.preset.water.radius, ellipse(flow.strain, flow.pull, time)
        for k, (name, colour) in enumerate((("y", BLUE), ("z", VERMILION))):
            axes.plot(time, size * known[:, k], color=GREY, lw=2.5, alpha=0.5, label="closed form" if k == 0 else None)
            band(axes, time, size * half_axes(recording)[..., k], colour, f"along {name}")
        axes.set_ylabel("half axis (m)")
    elif is_viscous(recording):
        ((axes,),) = sheet.panels()
        axes.plot(time, decay(recording), color=GREY, lw=2.5, alpha=0.5, label="closed form")
        band(axes, time, vortex_amplitude(recording), BLUE, "vortices")
        axes.set_ylabel("amplitude, of the first")
    elif flow.rotation:
        ((axes,),) = sheet.panels()
        axes.axhline(1.0, color=GREY, lw=2.5, alpha=0.5, label="kept")
        momentum = angular_momentum(recording)
        band(axes, time, momentum / momentum[0], BLUE, "angular momentum")
        axes.set_ylabel("angular momentum, of the first")
    else:
        return
    axes.set_xlim(time[0], time[-1])
    axes.set_xlabel("time (s)")


FIGURES = {"free_flow": draw}
