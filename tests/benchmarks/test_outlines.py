"""The page on how irregular grains touch, from a hasty one."""

import pytest

from benchmarks.outlines import BENCH


@pytest.mark.slow
def test_rules_with_an_energy_keep_it_and_the_deepest_node_does_not(tmp_path):
    text = BENCH.run((), tmp_path, fast=True).read_text()
    rows = [line.split("|")[1:-1] for line in text.splitlines() if line.startswith("| ") and "e-0" in line]
    largest = {row[0].strip().split(",")[0]: float(row[2]) for row in rows}
    assert max(largest["continuous"], largest["area"]) < 1e-3 < 0.1 * largest["nodes"]
    assert (tmp_path / "outlines-cost.png").stat().st_size > 5000
