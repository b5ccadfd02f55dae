"""Arrays over time in a page: whole numbers of one or two bytes, differences in time, packed by zlib, as base64.

A value is low + step · number. The largest number stands for "not there". `decode` in `codec.js` is the inverse, and so
is `unpacked` here.
"""

import zlib
from base64 import b64decode, b64encode

import numpy as np

FINE, COARSE = "<u2", "u1"  # kinds of numbers
TURN = 2.0 * np.pi
LEVEL = 9  # of zlib: the file is written once and read often


def quantised(values: np.ndarray, kind: str = FINE, ends: tuple[np.ndarray, np.ndarray] | None = None) -> dict:
    """Values (F, n) or (F, n, c) as whole numbers, each component over its own range, or from end to end where given.

    The error of a value within the range is half a step at most; NaN is kept as such.
    """
    most = np.iinfo(kind).max - 1
    over = tuple(range(values.ndim - 1)) if values.ndim == 3 else None
    there = np.isfinite(values)
    low, high = ends or (
        np.min(values, axis=over, where=there, initial=np.inf),
        np.max(values, axis=over, where=there, initial=-np.inf),
    )
    low, high = (np.where(np.isfinite(end), end, 0.0) for end in (low, high))
    step = np.where(high > low, (high - low) / most, 1.0)
    numbers = np.clip(np.round((np.where(there, values, low) - low) / step), 0, most)
    numbers = np.where(there, numbers, most + 1).astype(kind)
    return packed(numbers) | {"low": np.atleast_1d(low).tolist(), "step": np.atleast_1d(step).tolist()}


def turned(angles: np.ndarray) -> dict:
    """Angles (F, n) rad as parts of a turn, of which there are as many as two bytes hold."""
    parts = np.iinfo(FINE).max + 1
    numbers = np.mod(np.round(np.nan_to_num(angles) / TURN * parts), parts).astype(FINE)
    return packed(numbers) | {"low": [0.0], "step": [TURN / parts], "turn": True}


def packed(numbers: np.ndarray) -> dict:
    """Whole numbers (F, ...) as text: differences in time, high bytes before low ones."""
    steps = numbers.copy()
    steps[1:] -= numbers[:-1]  # modulo the range of the kind
    planes = steps.astype(steps.dtype.newbyteorder(">")).reshape(-1, 1).view("u1").reshape(-1, steps.itemsize).T
    text = b64encode(zlib.compress(np.ascontiguousarray(planes).tobytes(), LEVEL)).decode()
    return {"data": text, "shape": list(numbers.shape), "bytes": numbers.itemsize}


def unpacked(stream: dict) -> np.ndarray:
    """The values of what `quantised` or `turned` gave; NaN where they are not there."""
    kind = FINE if stream["bytes"] == 2 else COARSE
    planes = np.frombuffer(zlib.decompress(b64decode(stream["data"])), "u1").reshape(stream["bytes"], -1).astype(kind)
    steps = planes[0] if len(planes) == 1 else (planes[0].astype(int) * 256 + planes[1]).astype(kind)
    numbers = np.cumsum(steps.reshape(stream["shape"]), axis=0, dtype=kind)
    values = np.array(stream["low"]) + np.array(stream["step"]) * numbers
    return values if stream.get("turn") else np.where(numbers == np.iinfo(kind).max, np.nan, values)
