"""The page on Python: its blocks run as they stand, one after the other."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import cargolab

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
MOST_WORDS = 800
# What the installed lab announces to xarray, which the sources alone do not
ENGINE = """
import xarray.backends.plugins as plugins
from cargolab._xarray import Engine
listed = plugins.list_engines
plugins.list_engines = lambda: {"cargolab": Engine(), **listed()}
"""
AFTER = """
assert number.n == 2 and 5.0 < number.value < 30.0 and str(number).endswith("deg (2 beds)")
assert abs(end - 0.15) < 0.02 and len(highest) >= 7 and highest[-1] > 0.0
assert series["kinetic"].dims == ("time", "world") and len(table) == 4
assert data["largest_shift"].shape == (2, 2) and data["largest_shift_n"].values.tolist() == [[2, 2], [2, 2]]
assert result.video._repr_html_().startswith("<video") and result.plot("shift")._repr_png_()[1:4] == b"PNG"
"""


def test_the_page_is_short_and_names_what_there_is():
    assert len(PAGE.split()) <= MOST_WORDS and len(BLOCKS) >= 6
    assert set(re.findall(r"cargolab\.(\w+)", PAGE)) <= {*cargolab.__all__}


@pytest.mark.slow
def test_its_blocks_run(tmp_path):
    script = tmp_path / "page.py"
    script.write_text("\n".join([ENGINE, *BLOCKS, AFTER]), encoding="utf-8")
    env = os.environ | {"PYTHONPATH": str(ROOT), "CARGOLAB_COMPILE": "quick"}
    told = subprocess.run([sys.executable, script], cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr[-3000:]
