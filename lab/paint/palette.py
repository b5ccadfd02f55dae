"""The colours of a picture other than those of its grains, in 0..255."""

PAPER = (255, 255, 255)
INK = (33, 41, 52)
QUIET = (104, 114, 126)
LINE = (176, 184, 193)
GRID = (232, 235, 239)
WALL = (86, 97, 110)
HOLD = (246, 247, 249)
LOST = (190, 60, 20)
FIXED = (158, 166, 175)
PART = (128, 70, 27)
SERIES = (  # curves and names of the beds: after Okabe and Ito, darkened to a contrast of 4.5, apart by lightness
    (0, 108, 170),
    (186, 76, 0),
    (0, 118, 86),
    (166, 50, 134),
    (96, 70, 0),
    (44, 50, 58),
)
