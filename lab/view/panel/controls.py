"""The controls of a live experiment, one line each: those that act at once, and those that need a restart."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi

from lab.preset.fields import taken_by
from lab.preset.schema import Preset
from lab.preset.sections.water.liquid import spacing
from lab.preset.units import parse
from lab.view.panel.sea_controls import RANDOM
from solvers.machine.marks import Usual
from solvers.scene import Scene

MOVES, ALTERS, RESTARTS = "moves the tank", "at once", "restarts"


@dataclass(frozen=True)
class Control:
    """A control of the preset's `key`, whose usual values it has unless `span` (SI) says others.

    `own` gives a preset's own value, None if the control does not apply to it. A control that ALTERS the scene has
    `changes`, a function from scene and value to the changed scene; one that RESTARTS starts with another `key`.
    """

    label: str
    key: str
    kind: str
    own: Callable[[Preset], float | None]
    changes: Callable[[Scene, float], Scene] | None = None
    span: Usual | None = None

    @cached_property
    def _usual(self) -> Usual:
        return self.span or taken_by(Preset, self.key).usual

    @property
    def low(self) -> float:
        """The least value (SI)."""
        return self._usual.low

    @property
    def high(self) -> float:
        """The largest value (SI)."""
        return self._usual.high

    @property
    def unit(self) -> str:
        """The unit in which values are shown."""
        return self._usual.unit

    @cached_property
    def scale(self) -> float:
        """The unit in SI."""
        return 1.0 if self.unit == "1" else parse(f"1 {self.unit}", taken_by(Preset, self.key).symbol)

    def shown(self, value: float) -> str:
        """A value (SI) with its unit."""
        number = f"{value / self.scale:.3g}"
        return number if self.unit == "1" else f"{number} {self.unit}".replace("^2", "²").replace(" deg", "°")


def _motion(name: str, quantity: str, otherwise: float) -> Callable[[Preset], float | None]:
    """A quantity of one of the preset's motions, else the value `otherwise`; None for ships, which move freely."""

    def own(preset: Preset) -> float | None:
        part = getattr(preset.motion, name)
        return None if preset.ship else getattr(part, quantity) if part else otherwise

    return own


def _centre(axis: int) -> Callable[[Preset], float | None]:
    def own(preset: Preset) -> float | None:
        part = preset.motion.roll or preset.motion.tilt
        return None if preset.ship else part.centre[axis] if part else 0.0

    return own


def _materials(name: str) -> Callable[[Scene, float], Scene]:
    """The same value for all grains and walls."""

    def changes(scene: Scene, value: float) -> Scene:
        kinds = ("grain", "wall", "others")
        now = {kind: getattr(scene.grains, kind) for kind in kinds}
        with_it = {kind: tuple(replace(one, **{name: value}) for one in materials) for kind, materials in now.items()}
        return scene.holding(replace(scene.grains, **with_it))

    return changes


def _humidity(preset: Preset) -> float | None:
    return preset.material.humidity if preset.contact.cohesion == "humid" else None


def _diameter(preset: Preset) -> float | None:
    return preset.mean_diameter if preset.grains and not (preset.shapes or preset.grains.table) else None


def _waves(name: str) -> Callable[[Preset], float | None]:
    """A quantity of the preset's regular waves; calm water and packets cannot be changed."""

    def own(preset: Preset) -> float | None:
        waves = preset.waves
        regular = preset.ship and waves and waves.kind == "regular"
        return getattr(waves, name) if regular else None

    return own


def _significant_height(preset: Preset) -> float | None:
    waves = preset.waves
    return waves.height if preset.ship and waves and waves.kind in RANDOM else None


CONTROLS: dict[str, Control] = {
    "tilt": Control("tilt", "motion.tilt.angle", MOVES, _motion("tilt", "angle", 0.0)),
    "tilt_rate": Control("tilt rate", "motion.tilt.rate", MOVES, _motion("tilt", "rate", pi / 36)),
    "sway": Control("sway", "motion.sway.amplitude", MOVES, _motion("sway", "amplitude", 0.0)),
    "sway_frequency": Control("frequency", "motion.sway.frequency", MOVES, _motion("sway", "frequency", 1.0)),
    "heave": Control("heave", "motion.heave.amplitude", MOVES, _motion("heave", "amplitude", 0.0)),
    "heave_frequency": Control("frequency", "motion.heave.frequency", MOVES, _motion("heave", "frequency", 1.0)),
    "roll": Control("roll", "motion.roll.amplitude", MOVES, _motion("roll", "amplitude", 0.0)),
    "roll_frequency": Control("frequency", "motion.roll.frequency", MOVES, _motion("roll", "frequency", 0.5)),
    "centre_y": Control("centre y", "motion.roll.centre", MOVES, _centre(0), span=Usual(-0.5, 0.5, "mm")),
    "centre_z": Control("centre z", "motion.roll.centre", MOVES, _centre(1), span=Usual(-0.5, 1.0, "mm")),
    "friction": Control(
        "friction",
        "material.friction",
        ALTERS,
        lambda preset: preset.material.friction if preset.grains else None,
        _materials("friction"),
    ),
    "humidity": Control("humidity", "material.humidity", ALTERS, _humidity, _materials("humidity")),
    "gravity": Control(
        "gravity",
        "run.gravity",
        ALTERS,
        lambda preset: None if preset.ship else preset.run.gravity,
        lambda scene, value: replace(scene, gravity=value),
    ),
    "wave_amplitude": Control("waves", "waves.amplitude", MOVES, _waves("amplitude")),
    "wave_height": Control("sea's height", "waves.height", MOVES, _significant_height),
    "wave_frequency": Control("frequency", "waves.frequency", MOVES, _waves("frequency")),
    "diameter": Control(
        "grains",
        "grains.diameter",
        RESTARTS,
        _diameter,
    ),
    "depth": Control("depth", "water.depth", RESTARTS, lambda preset: preset.water and preset.water.depth),
    "spacing": Control(
        "particles", "water.spacing", RESTARTS, lambda preset: spacing(preset) if preset.water else None
    ),
}


def offered(preset: Preset) -> dict[str, float]:
    """The controls that apply to a preset, with its own values (SI)."""
    found = {name: control.own(preset) for name, control in CONTROLS.items()}
    return {name: float(value) for name, value in found.items() if value is not None}
