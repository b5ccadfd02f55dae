"""The runtime: its guard against a miscompile of Taichi, freeing of arrays, and starting once."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import taichi as ti

from solvers import runtime
from solvers.runtime import Arrays

REPOSITORY = Path(__file__).parents[2]
GUARDED = "from solvers import runtime; runtime.initialise(1)"
UNGUARDED = "ti.init(arch=ti.cpu, default_fp=ti.f64, cpu_max_num_threads=1, log_level=ti.WARN)"

# Each reads an element of a vector, passes a branch or a loop, reassigns the vector and reads the element again:
# the miscompiled kernel answers with the first reading.
KERNELS = {
    "scaled": (
        """
        @ti.kernel
        def read(n: ti.i32, a: ti.f64) -> ti.f64:
            v = ti.Vector([a, 2.0])
            first = v[0]
            if n > 0:
                first += 0.0
            v *= 3.0
            return 10.0 * first + v[0]

        answer = read(0, 1.0)
        """,
        13.0,
    ),
    "field": (
        """
        field = ti.Vector.field(2, ti.f64, shape=2)

        @ti.kernel
        def read(n: ti.i32) -> ti.f64:
            total = 0.0
            for _ in range(1):
                v = field[0]
                first = v[0]
                if n > 0:
                    first += 0.0
                v = field[1]
                total += 10.0 * first + v[0]
            return total

        field[0], field[1] = [1.0, 2.0], [3.0, 4.0]
        answer = read(0)
        """,
        13.0,
    ),
    "loop": (
        """
        @ti.kernel
        def read(n: ti.i32, a: ti.f64) -> ti.f64:
            v = ti.Vector([a, 2.0])
            first = v[0]
            for k in range(n):
                first += 1.0
            v += ti.Vector([a, 0.0])
            return 10.0 * first + v[0]

        answer = read(4, 1.0)
        """,
        52.0,
    ),
}


def fresh(folder: Path, code: str) -> str:
    """What the code prints in a new process; kernels need their source in a file."""
    script = folder / "script.py"
    script.write_text(code)
    done = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, timeout=120, env={"PYTHONPATH": str(REPOSITORY)}
    )
    assert done.returncode == 0, f"exit code {done.returncode}: {done.stderr[-2000:]}"
    return done.stdout.splitlines()[-1]
