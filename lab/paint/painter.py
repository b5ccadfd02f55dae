"""The painter: grains, walls and lines in a picture. Its parts are in `lab.paint.raster`."""

from lab.paint.raster.base import (
    BAND,
    PER_TASK,
    Camera,
    Colour,
    Index,
    Picture,
    Shares,
    Table,
    colour_of,
    mix,
    sort_into_bands,
    whole,
)
from lab.paint.raster.grains import DIRECTIONS, Edges, paint_grains, to_discs
from lab.paint.raster.lines import paint_strokes
from lab.paint.raster.walls import off_outline, paint_plate, paint_shape, paint_tank
from lab.paint.raster.water import paint_below, paint_lines

__all__ = [
    "BAND",
    "DIRECTIONS",
    "PER_TASK",
    "Camera",
    "Colour",
    "Edges",
    "Index",
    "Picture",
    "Shares",
    "Table",
    "colour_of",
    "mix",
    "off_outline",
    "paint_below",
    "paint_grains",
    "paint_lines",
    "paint_plate",
    "paint_shape",
    "paint_strokes",
    "paint_tank",
    "sort_into_bands",
    "to_discs",
    "whole",
]
