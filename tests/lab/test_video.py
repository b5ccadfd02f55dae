"""Videos, pictures and posters of a recording, and what is said when there can be none."""

import json

import h5py
import imageio.v2 as imageio
import numpy as np
import pytest

from lab.errors import LabError
from lab.paint.colours import MODES
from lab.paint.film import Film, choose_look
from lab.paint.footage import open_footage
from lab.paint.video import playback, poster, render_recording
from solvers.runtime import initialise

WIDTH, HEIGHT, DIAMETER = 0.18, 0.09, 4e-3


def make_recording(path, worlds=1, frames=6, samples=40, tilt=0.6, sway=0.0, duration=8.0):
    """Write a made-up recording: a bed whose upper layers slide the more the further the tank tilts."""
    random = np.random.default_rng(1)
    y, z = np.meshgrid(
        np.arange(-WIDTH / 2 + DIAMETER / 2, WIDTH / 2 - DIAMETER / 4, DIAMETER),
        np.arange(DIAMETER / 2, 0.5 * HEIGHT, DIAMETER),
    )
    start = np.column_stack([y.ravel(), z.ravel()])
    grains = len(start)

    def slide(time, world):
        share = np.clip(time / duration - 0.3 - 0.05 * world, 0, 1)
        return -0.4 * WIDTH * share[..., None] * np.exp((start[:, 1] - 0.5 * HEIGHT) / 0.012)

    def poses(time):
        swing = sway * np.sin(2 * np.pi * time)
        return np.repeat(
            np.stack([swing, 0 * time, tilt * time / duration], axis=-1)[:, None], worlds, axis=1
        )

    with h5py.File(path, "w") as file:
        file.attrs.update(format="cargo-shift-lab 1", preset="made-up", status="complete")
        resolved = {"title": "A made-up bed of discs", "video": {"width": 640, "height": 360}}
        file["preset/resolved"] = json.dumps(resolved)
        radius = DIAMETER / 2 * random.uniform(0.9, 1.0, (worlds, grains))
        file["grains/radius"] = radius
        w, h = WIDTH / 2, HEIGHT
        file["tank/outline"] = np.array([(-w, 0.0), (w, 0.0), (w, h), (-w, h)])
        for group, count in (("series", samples), ("frames", frames)):
            time = np.linspace(0, duration, count)
            moved = np.stack([slide(time, world) for world in range(worlds)], axis=1)
            file[f"{group}/time"] = time
            file[f"{group}/pose"] = poses(time)
            if group == "series":
                centre = np.stack([moved.mean(axis=2), 0 * moved.mean(axis=2)], axis=-1)
                file["series/centre_of_mass"] = centre
                continue
            place = np.broadcast_to(start, (count, worlds, grains, 2)).copy()
            place[..., 0] += moved
            np.clip(place[..., 0], -w + DIAMETER / 2, w - DIAMETER / 2, out=place[..., 0])
            velocity = np.zeros_like(place)
            velocity[1:, ..., 0] = np.diff(place[..., 0], axis=0) * (count - 1) / duration
            file["frames/position"] = place.astype("f4")
            file["frames/velocity"] = velocity.astype("f4")
            file["frames/angle"] = (moved / radius).astype("f4")
            file["frames/spin"] = np.zeros_like(moved, dtype="f4")
    return path
