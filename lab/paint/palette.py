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
SERIES = (  # curves and names of the beds: Okabe and Ito's colour-blind-safe palette, darkened
    (0, 114, 178),
    (213, 94, 0),
    (0, 138, 100),
    (180, 90, 145),
    (176, 126, 0),
    (60, 140, 190),
)
