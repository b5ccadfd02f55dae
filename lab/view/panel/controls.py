"""The controls of a live experiment, one line each: those that act at once, and those that need a restart."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import pi

from lab.preset.schema import Resolved
from lab.view.panel.swell import RANDOM
from solvers.scene import Scene

UNITS = {"deg": pi / 180, "deg/s": pi / 180, "mm": 1e-3, "%": 1e-2}  # in SI; all others are SI
MOVES, ALTERS, RESTARTS = "moves the tank", "at once", "restarts"


@dataclass(frozen=True)
class Control:
    """A control with values from `low` to `high` (SI), shown in `unit`.

    `own` gives a preset's own value, None if the control does not apply to it. A control that ALTERS the scene has
    `changes`, a function from scene and value to the changed fields; one that RESTARTS names the preset's `key`.
    """

    label: str
    unit: str
    low: float
    high: float
    kind: str
    own: Callable[[Resolved], float | None]
    changes: Callable[[Scene, float], dict] | None = None
    key: str = ""

    def shown(self, value: float) -> str:
        """A value (SI) with its unit."""
        number = f"{value / UNITS.get(self.unit, 1.0):.3g}"
        return number if self.unit == "1" else f"{number} {self.unit}".replace("^2", "²").replace(" deg", "°")


def _motion(name: str, quantity: str, otherwise: float) -> Callable[[Resolved], float | None]:
    """A quantity of one of the preset's motions, else the value `otherwise`; None for ships, which move freely."""

    def own(preset: Resolved) -> float | None:
        part = getattr(preset.motion, name)
        return None if preset.ship else getattr(part, quantity) if part else otherwise

    return own


def _centre(axis: int) -> Callable[[Resolved], float | None]:
    def own(preset: Resolved) -> float | None:
        part = preset.motion.roll or preset.motion.tilt
        return None if preset.ship else part.centre[axis] if part else 0.0

    return own


def _materials(name: str) -> Callable[[Scene, float], dict]:
    """The same value for all grains and walls."""

    def changes(scene: Scene, value: float) -> dict:
        return {
            "grain": tuple(replace(material, **{name: value}) for material in scene.grain),
            "wall": tuple(replace(material, **{name: value}) for material in scene.wall),
            "others": tuple(replace(material, **{name: value}) for material in scene.others),
        }

    return changes


def _humidity(preset: Resolved) -> float | None:
    return preset.material.humidity if preset.contact.cohesion == "humid" else None


def _waves(name: str) -> Callable[[Resolved], float | None]:
    """A quantity of the preset's regular waves; calm water and packets cannot be changed."""

    def own(preset: Resolved) -> float | None:
        waves = preset.waves
        regular = preset.ship and waves and waves.kind == "regular"
        return getattr(waves, name) if regular else None

    return own


def _significant_height(preset: Resolved) -> float | None:
    waves = preset.waves
    return waves.height if preset.ship and waves and waves.kind in RANDOM else None


CONTROLS: dict[str, Control] = {
    "tilt": Control("tilt", "deg", -pi / 2, pi / 2, MOVES, _motion("tilt", "angle", 0.0)),
    "tilt_rate": Control("tilt rate", "deg/s", pi / 1800, pi / 3, MOVES, _motion("tilt", "rate", pi / 36)),
    "sway": Control("sway", "mm", 0.0, 0.1, MOVES, _motion("sway", "amplitude", 0.0)),
    "sway_frequency": Control("frequency", "Hz", 0.1, 4.0, MOVES, _motion("sway", "frequency", 1.0)),
    "heave": Control("heave", "mm", 0.0, 0.1, MOVES, _motion("heave", "amplitude", 0.0)),
    "heave_frequency": Control("frequency", "Hz", 0.1, 4.0, MOVES, _motion("heave", "frequency", 1.0)),
    "roll": Control("roll", "deg", 0.0, pi / 4, MOVES, _motion("roll", "amplitude", 0.0)),
    "roll_frequency": Control("frequency", "Hz", 0.1, 3.0, MOVES, _motion("roll", "frequency", 0.5)),
    "centre_y": Control("centre y", "mm", -0.5, 0.5, MOVES, _centre(0)),
    "centre_z": Control("centre z", "mm", -0.5, 1.0, MOVES, _centre(1)),
    "friction": Control(
        "friction", "1", 0.0, 1.0, ALTERS, lambda preset: preset.material.friction, _materials("friction")
    ),
    "humidity": Control("humidity", "%", 0.3, 0.99, ALTERS, _humidity, _materials("humidity")),
    "gravity": Control(
        "gravity",
        "m/s^2",
        0.1,
        9.81,
        ALTERS,
        lambda preset: None if preset.ship else preset.run.gravity,
        lambda _, value: {"gravity": value},
    ),
    "wave_amplitude": Control("waves", "mm", 0.0, 0.05, MOVES, _waves("amplitude")),
    "wave_height": Control("sea's height", "mm", 0.0, 0.1, MOVES, _significant_height),
    "wave_frequency": Control("frequency", "rad/s", 2.5, 10.0, MOVES, _waves("frequency")),
    "diameter": Control(
        "grains",
        "mm",
        1e-3,
        1e-2,
        RESTARTS,
        lambda preset: None if preset.shapes or preset.grains.table else preset.grains.diameter,
        key="grains.diameter",
    ),
}


def offered(preset: Resolved) -> dict[str, float]:
    """The controls that apply to a preset, with its own values (SI)."""
    found = {name: control.own(preset) for name, control in CONTROLS.items()}
    return {name: float(value) for name, value in found.items() if value is not None}
