"""One picture of settled beds of several cargoes side by side, each scaled to its cell, in its cargo's colour."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from lab.base.files import replacing
from lab.base.turn import in_turn
from lab.paint import decorations as deco
from lab.paint import palette
from lab.paint.cargo.looks import UNKNOWN, Stowage, looks
from lab.paint.colours import colouring
from lab.paint.footage import Bed, open_footage
from lab.paint.painter import Camera, paint_grains, paint_tank, to_discs
from solvers.machine.runtime import initialise

COLOURS = {
    name: looks()[name].colour
    for name in ("wheat", "rice", "corn", "sunflower", "beans", "soybeans", "sand", "chickpeas")
}
COLUMNS, CELL, EDGE, TEXT = 2, (640, 292), 24, 22  # number; the others in pixels
ABOVE = 1.25  # height of the part of the tank that is shown, relative to the bed's height
WALL = 5.0  # pixels


@in_turn
def paint_cargoes(folders: Mapping[str, Path], out: Path) -> Path:
    """Paint the first frames of recordings into one PNG file; folders: by cargo name. Raises LabError."""
    initialise(fields=False)
    rows = -(-len(folders) // COLUMNS)
    image = Image.new("RGB", (COLUMNS * (CELL[0] + EDGE) + EDGE, rows * (CELL[1] + EDGE) + EDGE), palette.PAPER)
    for k, (name, folder) in enumerate(folders.items()):
        with open_footage(folder) as footage:
            footage.cargo = Stowage(name if name in looks() else UNKNOWN)
            cell = _cell(name, Bed(footage, 0, name))
        image.paste(cell, (EDGE + k % COLUMNS * (CELL[0] + EDGE), EDGE + k // COLUMNS * (CELL[1] + EDGE)))
    with replacing(out) as part:
        image.quantize(256).save(part, optimize=True)  # a third of the bytes
    return out


def _cell(name: str, bed: Bed) -> Image.Image:
    """The lower part of a tank with its cargo's name and a scale bar above it."""
    wide, high, head = *CELL, round(1.7 * TEXT)
    place, low, size = bed.position(0), bed.footage.outline.min(axis=0), np.ptp(bed.footage.outline, axis=0)
    height = min(size[1], ABOVE * (np.nanmax(place[:, 1]) - low[1]))
    scale = min((wide - 2.0 * WALL) / size[0], (high - head - WALL) / height)
    camera = Camera(scale, (0.5 * wide - scale * (low[0] + 0.5 * size[0]), high - WALL + scale * low[1]))
    picture = np.tile(np.array(palette.PAPER, dtype=np.uint8), (high, wide, 1))
    paint_tank(picture, camera, bed.footage.outline, WALL, palette.WALL, palette.HOLD, bed.footage.open_edges)
    scale_of = colouring("cargo", [bed])
    colour = scale_of.colours(bed, 0)
    paint_grains(picture, to_discs(camera, place, bed.radius, bed.angle(0)), colour, *scale_of.style(bed, colour))
    picture[:head] = palette.PAPER
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    draw.text((0, 0), name, palette.INK, deco.font(TEXT, True), anchor="la")
    deco.draw_scale_bar(draw, (0.62 * wide, 0.8 * TEXT), 0.2 * wide, scale, 0.8 * TEXT)
    return image
