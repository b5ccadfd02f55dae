"""What the tests of benchmarks share with those of the application."""

from tests.lab.conftest import coarse_figures, coarse_hulls, no_plots, one_core  # noqa: F401
