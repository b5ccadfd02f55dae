"""The names of the openings of hulls, beside them."""

import numpy as np
from PIL import Image, ImageDraw

from lab.paint.painter import Camera
from lab.paint.water.gauges import LETTERS, SMALLEST, write_beside


def name_openings(image: Image.Image, camera: Camera, bed, row: float, time: float, unit: float, theme) -> None:
    """Write the names of the openings of a bed's bodies beside them; those that are covered at a time (s) pale."""
    if LETTERS * unit < SMALLEST:
        return
    draw, written = ImageDraw.Draw(image), []
    for body in bed.footage.bodies:
        for name, (corners, opens) in zip(body.names, body.openings, strict=True):
            middle, across = corners.mean(axis=0), corners[3] - corners[0]
            out = across * np.sign(across @ (middle - body.outline.mean(axis=0)) or 1.0)
            at, end = camera.pixels(bed.moved(np.array([middle, middle + out]), number=body.number, frame=row))
            towards = (end - at) / np.linalg.norm(end - at)
            hue = theme.accent if opens <= time else theme.quiet
            write_beside(draw, name, (at, towards), unit, hue, theme.paper, written)
