"""What all tests share."""

import os

import pytest

# Workers share the cores; threads of numpy's that wait for each other by spinning would take all of a busy machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory):
    """Tests neither read nor fill the cache of the person who runs them."""
    os.environ["CARGOLAB_CACHE"] = str(tmp_path_factory.mktemp("cache"))
