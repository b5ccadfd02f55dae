"""The parts of a picture that grow with the film."""

import numpy as np
from PIL import ImageChops

from lab.paint.page.live_plot import LivePlot


def plot_of(curves):
    """A plot of such curves, with lines thick enough for rounded joints."""
    colours = [(0, 114, 178), (213, 94, 0), (0, 138, 100)]
    return LivePlot((300, 200), curves, colours[: len(curves)], ("time (s)", "shift"), 20.0)


def made_curves():
    """Three curves that cross: one wild, one with gaps, one with a single point."""
    rng = np.random.default_rng(3)
    time = np.linspace(0.0, 8.0, 60)
    wild, gaps = np.cumsum(rng.normal(size=60)), np.sin(time)
    gaps[[0, 7, 8, 30, 59]] = np.nan
    return [(time, wild), (time, gaps), (time[:1], np.zeros(1))]


def test_a_plot_that_grew_or_went_back_is_the_plot_drawn_at_once():
    curves = made_curves()
    grown = plot_of(curves)
    for count in (1, 2, 3, 9, 10, 33, 60, 12, 13, 60, 1):
        counts = [count, max(1, count - 1), 1]
        at_once = plot_of(curves).picture(counts)
        assert ImageChops.difference(grown.picture(counts), at_once).getbbox() is None, count
    assert ImageChops.difference(grown.picture([1, 1, 1]), grown.picture([60, 60, 1])).getbbox() is not None
