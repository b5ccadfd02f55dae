"""What a run records, and how it is filmed."""

from collections.abc import Collection
from dataclasses import dataclass
from math import pi
from typing import Annotated, Literal

from lab.base.errors import LabError
from lab.preset.fields import Alike, Of
from solvers.machine.marks import Doc, Interval, Unit

OF_GRAINS = (
    "cargo",
    "speed",
    "displacement",
    "pressure",
    "layer",
    "size",
    "kind",
    "shape",
    "spin",
)  # what `lab.paint.colours` paints
OF_WATER = ("water", "pressure", "speed", "vorticity", "particles", "excess-pressure")  # what `lab.paint.water` paints
OF_WET = ("porosity",)  # of water between grains
OF_AIR = ("air",)  # the air's pressure, and water as it is
OF_BULK = ("sliding", "speed", "pressure", "strain")  # what `lab.paint.bulk` paints
CARGOES = (  # whose looks are in `lab.paint.cargo`
    *("wheat", "rice", "corn", "sunflower", "beans", "soybeans", "chickpeas", "sand"),
    *("acetate", "coal", "iron-ore", "copper-ore", "gold-ore", "aluminium", "stone"),
)
COLOURS = (
    *OF_GRAINS,
    *(colour for colour in OF_WATER if colour not in OF_GRAINS),
    *OF_AIR,
    *OF_WET,
    "sliding",
    "strain",
)
PLANE_ALONE = "vorticity", "excess-pressure"
OF_MATTERS = {"grains": OF_GRAINS, "water": OF_WATER, "air": OF_AIR, "bulk": OF_BULK}

OF_SPACE = "azimuth", "elevation", "orbit", "cut", "slice"  # keys of scenes in space

Rate = Annotated[float, Unit("Hz"), Interval(gt=0, le=1e6)]


@dataclass(frozen=True)
class Record:
    """What a run writes down, and how often."""

    series_rate: Annotated[Rate, Alike(), Doc("Samples of forces, energies and the like a second.")] = 100.0
    picture_rate: Annotated[Rate, Alike(), Doc("Frames with all grains a second.")] = 25.0
    checkpoint_every: Annotated[
        float, Unit("s"), Alike(), Interval(ge=0), Doc("Wall-clock time between checkpoints.")
    ] = 60.0


@dataclass(frozen=True)
class Video:
    """How the run is filmed."""

    width: Annotated[int, Interval(ge=320, le=7680), Doc("Width of the picture in pixels, an even number.")] = 1280
    height: Annotated[int, Interval(ge=180, le=4320), Doc("Height of the picture in pixels, an even number.")] = 720
    colour: Annotated[
        Literal[*COLOURS] | None,
        Doc("What the colour of the grains or of the water shows; by default they look like what they are."),
    ] = None
    cargo: Annotated[
        Literal[*CARGOES] | None,
        Of("grains"),
        Doc("What the grains look like; by default the cargo of their outlines, or of their density."),
    ] = None
    frame: Annotated[
        Literal["tank", "earth"] | None,
        Doc("Whether the camera moves with the tank or stands still, as it does by default where the tank moves."),
    ] = None
    theme: Annotated[Literal["light", "dark"], Doc("Colours of the page.")] = "light"
    overlay: Annotated[
        Literal["none", "trails", "forces"],
        Doc("What is drawn over the grains: nothing, the ways that they have come, or the forces between them."),
    ] = "none"
    inset: Annotated[
        Literal["none", "surface", "impact"] | None,
        Doc(
            "What is shown larger beside the tank: nothing, the surface where it flows, or the gauge that is hit. "
            "By default the surface in a long low tank."
        ),
    ] = None
    speed: Annotated[float, Interval(gt=0), Doc("Playback speed; 1 is as in nature.")] = 1.0
    azimuth: Annotated[
        Annotated[float, Unit("rad"), Interval(ge=-2.0 * pi, le=2.0 * pi)] | None,
        Doc("In space, how far to the right of the plane's view the camera stands; 25 deg without it."),
    ] = None
    elevation: Annotated[
        Annotated[float, Unit("rad"), Interval(ge=-0.5 * pi, le=0.5 * pi)] | None,
        Doc("In space, how steeply the camera looks down; 20 deg without it."),
    ] = None
    orbit: Annotated[
        Annotated[float, Interval(ge=-100, le=100)] | None,
        Doc("In space, how often the camera goes round the tank during the film, to the right."),
    ] = None
    cut: Annotated[
        Annotated[float, Unit("m")] | None,
        Doc("In space, grains whose x is larger, nearer to the viewer, are left out; with slice, its middle."),
    ] = None
    slice: Annotated[
        Annotated[float, Unit("m"), Interval(gt=0)] | None,
        Doc("In space, only grains in a slice across x of this thickness are shown."),
    ] = None


def colours_of(matters: Collection[str]) -> tuple[str, ...]:
    """The colours of these matters; the first one is painted where none is named. Those of grains for an empty tank."""
    words = dict.fromkeys(word for matter in matters or ("grains",) for word in OF_MATTERS.get(matter, ()))
    return (*words, *(OF_WET if {"grains", "water"} <= set(matters) else ()))


def check_viewpoint(chosen: Video, in_space: bool, matters: Collection[str] = ("grains",)) -> None:
    """Raise LabError for wishes that pictures of a scene in space, or in the plane, cannot fulfil; also of a `Look`."""
    for name in OF_SPACE:
        if getattr(chosen, name) is not None and not in_space:
            raise LabError(f"video.{name}: goes with a scene in space; leave this out in the plane.")
    if in_space and chosen.overlay == "forces":
        raise LabError("video.overlay: forces are drawn in the plane only; set trails or none.")
    if in_space and chosen.inset not in (None, "none"):
        raise LabError("video.inset: pictures in space have none; leave this out.")
    if in_space and chosen.colour in PLANE_ALONE:
        raise LabError(f"video.colour: {chosen.colour} is known in the plane only; set another, such as speed.")
    if in_space and chosen.colour == "pressure" and "water" not in matters:
        raise LabError("video.colour: the pressure in grains is known in the plane only; set another, such as speed.")


def check_video(video: Video, matters: Collection[str], in_space: bool = False) -> None:
    """Raise LabError for what cannot be shown, and for picture sizes that the video codec cannot encode."""
    check_viewpoint(video, in_space, matters)
    fitting = [name for name, words in OF_MATTERS.items() if video.colour in words]
    if video.colour in OF_WET:
        if not {"grains", "water"} <= set(matters):
            raise LabError(f"video.colour: {video.colour} is of water between grains; add [grains] and [water].")
    elif video.colour and not set(fitting) & set(matters):
        said = f"{' or '.join(fitting)}, and there {'are' if 'grains' in fitting else 'is'} none"
        raise LabError(f"video.colour: goes with {said}; add a table [{fitting[0]}], or leave this out.")
    for name in ("width", "height"):
        if getattr(video, name) % 2:
            raise LabError(f"video.{name}: must be even for H.264 (got {getattr(video, name)}).")
