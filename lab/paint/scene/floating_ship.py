"""A ship and the sea around her within a box of a picture."""

from dataclasses import dataclass, replace

import numpy as np

from lab.paint.page.layout import Box
from lab.paint.page.theme import Theme
from lab.paint.painter import Camera
from lab.paint.scene.ship import silhouette
from lab.paint.sea import LINE, Sea


@dataclass(frozen=True)
class FloatingShip:
    """A ship at one time (s): her camera, that of the still water, plates `thick` pixels thick, pixels a unit."""

    sea: Sea
    camera: Camera
    still: Camera
    time: float
    thick: float
    unit: float

    def paint(self, picture: np.ndarray, box: Box, theme: Theme) -> None:
        """Paint superstructure, sea and hull into a box of pixels and nowhere else, in place."""
        if self._keeps_within(box):
            self._paint(picture, box, theme)
            return
        left, top, right, bottom = box
        part = np.ascontiguousarray(picture[top:bottom, left:right])
        moved = replace(self, camera=self.camera.shifted(left, top), still=self.still.shifted(left, top))
        moved._paint(part, (0, 0, right - left, bottom - top), theme)
        picture[top:bottom, left:right] = part

    def _paint(self, picture: np.ndarray, box: Box, theme: Theme) -> None:
        self.sea.paint_superstructure(picture, self.camera, theme)
        self.sea.paint_box(picture, self.still, box, self.time, LINE * self.unit, theme)
        self.sea.paint_hull(picture, self.camera, self.thick, theme, self.unit)

    def _keeps_within(self, box: Box) -> bool:
        """Whether all of her is in the box."""
        house, points = silhouette(self.sea.ship), self.sea.hull
        if house is not None:
            points = np.concatenate([points, house - np.array(self.sea.ship.hold)])
        seen, room = self.camera.pixels(points), self.thick + self.unit
        low, high = seen.min(axis=0) - room, seen.max(axis=0) + room
        return bool((low >= box[:2]).all() and (high <= box[2:]).all())
