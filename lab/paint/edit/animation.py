"""Animated pictures for pages: GIF, and WebP, which is smaller and keeps all colours."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from PIL import Image

from lab.base.errors import LabError
from lab.base.files import replacing

FORMATS = {".gif": 20.0, ".webp": 30.0}  # pictures a second at most
MOST = 1200  # pictures, which are all held in memory
COLOURS = 255
QUALITY = 80  # of WebP
SAMPLES = 4  # pictures from which the colours of a GIF are chosen


def stride_of(suffix: str, rate: float) -> int:
    """k, if only every k-th picture of a film of this rate goes into an animated picture."""
    return max(1, int(np.ceil(rate / FORMATS[suffix] - 1e-9)))


def write_animation(out: Path, pictures: Iterable[np.ndarray], rate: float) -> Path:
    """Write pictures (height, width, 3), u8, as an animated picture that runs for ever; returns `out`.

    Raises LabError if there are too many.
    """
    images = []
    for picture in pictures:
        images.append(Image.fromarray(picture))
        if len(images) > MOST:
            raise LabError(f"{out} would have more than {MOST} pictures: film a shorter part, or faster with --speed.")
    lasts = round(1000.0 / rate)
    if out.suffix == ".gif":
        chosen = images[:: max(1, len(images) // SAMPLES)]
        strip = Image.new("RGB", (images[0].width, images[0].height * len(chosen)))
        for k, image in enumerate(chosen):
            strip.paste(image, (0, k * images[0].height))
        palette = strip.quantize(COLOURS)
        images = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
        options = {"optimize": False}
    else:
        options = {"quality": QUALITY, "method": 3, "minimize_size": False}
    with replacing(out) as part:
        images[0].save(part, save_all=True, append_images=images[1:], duration=lasts, loop=0, **options)
    return out
