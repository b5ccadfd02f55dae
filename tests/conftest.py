"""What all tests share."""

import os

import pytest


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory):
    """Tests neither read nor fill the cache of the person who runs them."""
    os.environ["CARGOLAB_CACHE"] = str(tmp_path_factory.mktemp("cache"))
