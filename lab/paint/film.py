"""A film: the picture of any moment of some beds, on a page that is laid out once."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from PIL import Image

from lab.base.errors import LabError
from lab.paint import decorations as deco
from lab.paint.bulk.layer import BulkLayer
from lab.paint.colours import bed_colours, colouring
from lab.paint.curves import TOLERANCE, plots
from lab.paint.footage import Bed
from lab.paint.page.layout import TEXT, TITLE, Needs, lay_out
from lab.paint.page.look import Look, choose_beds, choose_look
from lab.paint.page.panel import Panel, moving
from lab.paint.page.texts import Texts
from lab.paint.page.theme import THEMES
from lab.paint.painter import Camera
from lab.paint.scene.inset import Inset
from lab.paint.scene.view import SceneView, ViewSetting
from lab.paint.space.camera import SpaceCamera
from lab.paint.space.view import SpaceView
from lab.paint.space.viewpoint import Viewpoint
from lab.paint.water.layer import WaterLayer
from lab.preset.sections.ship import axis_motion

__all__ = ["MOST_BEDS", "Film", "Look", "Timeline", "choose_beds", "choose_look"]

MOST_BEDS = 6  # beds of one recording shown side by side


@dataclass(frozen=True)
class Timeline:
    """When each picture of a film is: time (F,) s; notes: a text for each, such as that on slow motion; verdict: the
    sentence on the last one, and `held`, the number of pictures at the end that show it.
    """

    time: np.ndarray
    notes: Sequence[str] = ()
    verdict: str = ""
    held: int = 0


class Film:
    """The pictures of some beds in one look; Taichi must be running (`solvers.machine.runtime`).

    beds: of one or several recordings, all drawn to one scale and with the times of the longest recording; the others
    keep their last frame. most: how many are shown; the plot has all. timeline: when the pictures are, the frames'
    times without it; moments: times (K,) at which the beds are shown in one picture. time (F,): of the pictures, s.
    """

    def __init__(
        self,
        beds: Sequence[Bed],
        look: Look,
        title: str | None = None,
        most: int = MOST_BEDS,
        timeline: Timeline | None = None,
        moments: Sequence[float] | None = None,
    ) -> None:
        self._look, self._all, self._beds = look, list(beds), list(beds)[:most]
        if len({bed.footage.space is None for bed in self._beds}) > 1:
            raise LabError("Scenes in the plane and in space have no common picture: film them apart.")
        self._theme, self._timeline, self._moments = THEMES[look.theme], timeline, moments
        self._title = title or beds[0].footage.title
        self._name_cargo()
        self._find_times()
        self._together = moments is None and bool(np.ptp(self._pose, axis=1).max() < TOLERANCE)
        series = self._theme.series
        self._hues = series if len(self._beds) <= len(series) else bed_colours(len(self._beds))
        grains = colouring(look.colour, self._beds, look.theme == "dark")
        drawn = plots(self._one(self._all), self._one(self._hues[: len(self._beds)]), series)
        self._lay_out(len(drawn), grains)
        self._water = WaterLayer(self._beds, look.colour, self._layout.unit)
        self._bulk = BulkLayer(self._beds, look.colour, self._layout.unit)
        self._bar = self._bulk.colouring or self._water.colouring or grains
        self._view = self._make_view()
        self._view.style(grains, self._water, self._bulk, self._hues[: len(self._beds)])
        self._panel = Panel(self._layout, self._theme, self.time, self._moved, self._together)
        self._panel.prepare(drawn)
        self._inset = Inset.of(self._view, self._beds[0], look.inset, self._layout)
        self._page, self._still = self._draw_page()
        self.written: dict[str, tuple] = {}

    def picture(self, frame: int) -> np.ndarray:
        """The picture (height, width, 3), u8, of one frame; `written` has then the boxes of its texts by name."""
        picture = self._page.copy()
        self._view.paint(picture, frame)
        if self._inset:
            self._inset.paint(picture, frame, self._theme)
        image = Image.fromarray(picture)
        texts = Texts(image)
        self._write_foot(texts, frame)
        self._panel.draw(image, texts, frame, self._moments)
        self._write_names(texts, frame)
        self._draw_verdict(image, texts, frame)
        self._view.write_names(image, frame)
        self.written = {**self._still, **texts.written}
        return np.asarray(image)

    @property
    def lost(self) -> bool:
        """Whether a ship that is shown capsizes or floods."""
        return any(bed.footage.ends[bed.world] for bed in self._beds)

    @property
    def held(self) -> int:
        """How many pictures at the end of a timeline show what came of it; 0 without a timeline."""
        return self._timeline.held if self._timeline else 0

    def tank_camera(self, bed: int, frame: int) -> Camera | SpaceCamera:
        """The camera for points of the tank of a shown bed at the time of a picture."""
        return self._view.tank_camera(bed, frame)

    @property
    def layout(self) -> dict[str, tuple]:
        """The boxes of the page by name, in pixels."""
        return dict(self._layout.boxes)

    def _one(self, items: Sequence) -> Sequence:
        """Of a bed at several moments, what belongs to it once."""
        return items if self._moments is None else items[:1]

    def _name_cargo(self) -> None:
        """Give the grains the cargo that the user names."""
        if self._look.cargo:
            for footage in {id(bed.footage): bed.footage for bed in self._all}.values():
                footage.cargo = replace(footage.cargo, named=self._look.cargo)

    def _find_times(self) -> None:
        """The times of the pictures, and the frame and the pose of each bed at each."""
        longest = max((bed.footage.time for bed in self._beds), key=lambda time: time[-1])
        if self._moments is not None:
            self.time = np.array([max(self._moments)])
            times = [np.array([time]) for time in self._moments]
        else:
            self.time = self._timeline.time if self._timeline else longest
            times = [self.time] * len(self._beds)
        pairs = list(zip(self._beds, times, strict=True))
        if self._timeline:
            self._rows = [np.interp(time, bed.footage.time, np.arange(bed.frames)) for bed, time in pairs]
        else:
            self._rows = [_nearest(bed.footage.time, time) for bed, time in pairs]
        self._pose = self._at(pairs, lambda bed: (bed.pose, bed.footage.series_pose[:, bed.world]))
        self._stance = self._at(pairs, _stances) if self._beds[0].footage.space else None
        moved = [_motion(bed, self._pose[:, k]) for k, bed in enumerate(self._beds)]
        if self._timeline:  # an axis that stands still between two samples, too
            moved = [_between(bed, time, _motion(bed, bed.footage.series_pose[:, bed.world])) for bed, time in pairs]
        self._moved = np.stack(moved, axis=1)

    def _at(self, pairs: Sequence[tuple], poses: Callable) -> np.ndarray:
        """Poses (F, K, ...) at the pictures' times; `poses` gives those of a bed in its frames and in its series."""
        if self._timeline:
            found = [_between(bed, time, poses(bed)[1]) for bed, time in pairs]
        else:
            found = [poses(bed)[0][rows] for (bed, _), rows in zip(pairs, self._rows, strict=True)]
        return np.stack(found, axis=1)

    def _lay_out(self, count: int, grains: object) -> None:
        look, moves = self._look, moving(self._moved)
        needs = Needs(
            plots=count,
            lines=int(moves.sum()) if self._together else 0,
            legend=grains is not None or look.colour not in ("water", "cargo"),
            inset=look.inset != "none" and self._moments is None,
            dial=self._together and look.frame == "tank" and bool(moves[0]),
            band=bool(len(self._beds) == 1 and (self.lost or (self._timeline and self._timeline.verdict))),
        )
        self._layout = lay_out(look.width, look.height, needs)

    def _make_view(self) -> SceneView | SpaceView:
        look, layout = self._look, self._layout
        setting = ViewSetting(layout["view"], layout.canvas, layout.unit, self._theme, look.frame, look.overlay)
        if self._stance is not None:
            return SpaceView(self._beds, setting, Viewpoint.of(look), np.array(self._rows), self._stance, self.time)
        return SceneView(self._beds, setting, np.array(self._rows), self._pose, self.time)

    @property
    def _on_sea(self) -> bool:
        """Whether the foot of the view is water."""
        return len(self._beds) == 1 and self._look.frame == "earth" and self._beds[0].footage.sea is not None

    def _draw_page(self) -> tuple[np.ndarray, dict[str, tuple]]:
        """The parts that stay the same in all frames, and the boxes of their texts."""
        look, layout, theme, text = self._look, self._layout, self._theme, TEXT * self._layout.unit
        page = np.empty((look.height, look.width, 3), dtype=np.uint8)
        page[:] = theme.panel
        left, top, right, bottom = layout.canvas
        page[top:bottom, left:right] = theme.paper
        self._view.paint_backdrop(page)
        image = Image.fromarray(page)
        texts = Texts(image)
        texts.write("title", layout["title"], self._title, TITLE * layout.unit, theme.ink, bold=True)
        if self._bar and "legend" in layout.boxes:
            deco.draw_colour_bar(image, layout["legend"], self._bar, text, theme)
        return np.array(image), texts.written

    def _write_foot(self, texts: Texts, frame: int) -> None:
        """The scale at the left, and at the right what drives the tank or how fast the film is."""
        layout, text, theme = self._layout, TEXT * self._layout.unit, self._theme
        ink, quiet = (theme.on_sea, theme.on_sea) if self._on_sea else (theme.ink, theme.quiet)
        left, top, right, bottom = layout["scale"]
        longest = 0.55 * (right - left)
        place = left, 0.5 * (top + bottom) + 0.3 * text
        texts.written["scale"] = deco.draw_scale_bar(texts.draw, place, longest, self._view.cameras[0].scale, text, ink)
        left, *rest = layout["note"]
        thick, room = self._view.overlay.thickness(self._view.cameras[0]), round(3.2 * text)
        texts.write("note", (left + room * bool(thick), *rest), self._note(frame), text, quiet, anchor="rm")
        if thick and "note" in texts.written:
            left, top, *_ = texts.written["note"]
            line, middle = (left - room, left - 0.6 * text), 0.5 * (top + texts.written["note"][3])
            texts.draw.line([(line[0], middle), (line[1], middle)], theme.force, max(1, round(thick)))

    def _note(self, frame: int) -> str:
        """A note on playback speed and number of beds shown, if they need one, else on what drives the tank."""
        notes = []
        if self._timeline and len(self._timeline.notes):
            notes.append(self._timeline.notes[frame])
        elif self._look.speed != 1 and self._moments is None:
            notes.append(f"{self._look.speed:g} × real time")
        if len(self._all) > len(self._beds):
            notes.append(f"{len(self._beds)} of {len(self._all)} beds")
        notes.append(self._view.overlay.says)
        footage = self._beds[0].footage
        if any(basin.lift for basin in footage.basins):
            notes.append("the upper tank stands behind the lower one")
        return ", ".join(note for note in notes if note) or footage.drive

    def _write_names(self, texts: Texts, frame: int) -> None:
        """The beds' names and, for a few beds, the readings in which their poses differ."""
        view, size = self._view, TEXT * self._layout.unit
        with_readings = not self._together and len(self._beds) <= MOST_BEDS
        for k, bed in enumerate(self._beds):
            if not bed.name:
                continue
            told = self._panel.readings(frame, k) if with_readings else []
            text, (x, y) = bed.name + (f" ({told[0][1]})" if told else ""), view.names_at[k]
            colour = self._theme.ink if self._moments is not None else self._hues[k]
            texts.write(f"bed {k}", (x, y - 1.2 * size, x + view.name_width, y), text, size, colour, anchor="ls")

    def _draw_verdict(self, image: Image.Image, texts: Texts, frame: int) -> None:
        """The band with what came of it: the loss of a ship from then on, or the verdict on the last pictures."""
        if self._moments is not None:
            return
        if len(self._beds) > 1 or "band" not in self._layout.boxes:
            self._view.draw_ends(image, frame)
            return
        end, box = self._beds[0].footage.ends[self._beds[0].world], self._layout["band"]
        if end and end.time <= self.time[frame] + TOLERANCE:
            said = f"She {end.words}"
        elif self._timeline and self._timeline.verdict and frame >= len(self.time) - self._timeline.held:
            said = self._timeline.verdict
        else:
            return
        deco.draw_band(texts.draw, box, said, TITLE * self._layout.unit, self._theme)
        texts.written["band"] = box


def _between(bed: Bed, time: np.ndarray, series: np.ndarray) -> np.ndarray:
    """A series (T, 3) of a bed, which is denser than its frames, at these times (F,)."""
    return np.column_stack([np.interp(time, bed.footage.series_time, column) for column in series.T])


def _stances(bed: Bed) -> tuple[np.ndarray, np.ndarray]:
    """How the tank of a bed in space stands in its frames (F, 6) and in its series (T, 6)."""
    space = bed.footage.space
    return space.stance[:, bed.world], space.series_stance[:, bed.world]


def _motion(bed: Bed, pose: np.ndarray) -> np.ndarray:
    """Sway, heave and roll (F, 3) as displayed: of the tank, or of a ship's axis."""
    return axis_motion(bed.footage.sea.ship, pose) if bed.footage.sea else pose


def _nearest(there: np.ndarray, time: np.ndarray) -> np.ndarray:
    """The rows of `there` (K,), ascending, that are nearest to each of `time` (F,)."""
    after = np.clip(np.searchsorted(there, time), 1, max(len(there) - 1, 1))
    before = after - 1
    after = np.minimum(after, len(there) - 1)
    return np.where(time - there[before] <= there[after] - time, before, after)
