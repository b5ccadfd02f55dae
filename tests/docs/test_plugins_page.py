"""The page on plug-ins: its files run as they stand."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "plugins.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_its_files_run(tmp_path):
    for name, text in re.findall(r"^```(?:python|toml)\n# (\S+)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL):
        (tmp_path / name).write_text(text, encoding="utf-8")
    small = ["grains.count=16", "run.repeats=1", 'motion.tilt={rate="60 deg/s", angle="20 deg", hold="0.2 s"}']
    sets = [word for one in small for word in ("--set", one)]
    env = os.environ | {"PYTHONPATH": str(ROOT), "CARGOLAB_COMPILE": "quick"}
    words = [sys.executable, "-m", "cargolab", "run", "mine.toml", "--plugins", "--out", "run", *sets]
    told = subprocess.run(words, cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr[-2000:]
    numbers = json.loads((tmp_path / "run" / "summary.json").read_text())["measures"]
    assert numbers["largest_rise"]["unit"] == "mm" and (tmp_path / "run" / "highest.png").exists()
    assert (tmp_path / "run" / "video.mp4").exists()
