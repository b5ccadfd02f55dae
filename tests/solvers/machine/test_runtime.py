"""The runtime: its guard against a miscompile of Taichi, freeing of arrays, and starting once."""

import json
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from textwrap import dedent

import numpy as np
import pytest
import taichi as ti

from solvers.machine import runtime
from solvers.machine.state import State
from solvers.machine.units import ITERATIONS_A_THREAD
from tests.oracles.axes import axes

REPOSITORY = Path(__file__).parents[3]
GUARDED = "from solvers.machine import runtime; runtime.initialise(1)"
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
    """The last line printed by code in a new process; the code is in a file because Taichi reads a kernel's source."""
    script = folder / "script.py"
    script.write_text(code)
    environment = os.environ | {"PYTHONPATH": str(REPOSITORY)}
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=120, env=environment)
    assert done.returncode == 0, f"exit code {done.returncode}: {done.stderr[-2000:]}"
    return done.stdout.splitlines()[-1]


def answers(folder: Path, start: str) -> dict[str, float]:
    """The result of each kernel in a process that starts Taichi with these options."""
    lines = ["import json", "import taichi as ti", start, "answers = {}"]
    for name, (code, _) in KERNELS.items():
        lines += [dedent(code), f"answers[{name!r}] = answer"]
    return json.loads(fresh(folder, "\n".join([*lines, "print(json.dumps(answers))"])))


@pytest.fixture(scope="module")
def unguarded(tmp_path_factory):
    return answers(tmp_path_factory.mktemp("unguarded"), UNGUARDED)


@pytest.fixture(scope="module")
def guarded(tmp_path_factory, unguarded):
    """Run after the unguarded ones, whose kernels must not be loaded from Taichi's cache."""
    return answers(tmp_path_factory.mktemp("guarded"), GUARDED)


@pytest.mark.parametrize("name", KERNELS)
def test_the_runtime_reads_reassigned_vectors_rightly(guarded, name):
    assert guarded[name] == KERNELS[name][1]


@pytest.mark.parametrize("name", KERNELS)
def test_the_miscompile_is_still_there(unguarded, name):
    """Where this is skipped for every kernel, `runtime.initialise` may no longer need `cfg_optimization=False`."""
    right = unguarded[name] == KERNELS[name][1]
    if right and ti.__version__ > (1, 7, 4):
        pytest.skip(f"Taichi {'.'.join(map(str, ti.__version__))} compiles this kernel rightly")
    assert not right


MANY_ARRAYS = """
from solvers.machine import runtime
from solvers.machine.state import Axis, State
runtime.initialise(1)
for k in range(600):
    arrays = State()
    (numbers,) = arrays.reals((Axis("row", 2), Axis("column", 3)), "numbers")
    arrays.finish()
    if k == 599:
        numbers.fill(7.0)
        print(numbers.to_numpy().sum())
    arrays.release()
"""


@pytest.mark.slow
def test_released_arrays_leave_room_for_others(tmp_path):
    """Taichi crashes with more than 512 field trees."""
    assert fresh(tmp_path, MANY_ARRAYS) == "42.0"


def made(values: np.ndarray) -> tuple[State, ti.Field]:
    """Arrays that hold these values."""
    arrays = State()
    field = arrays.holding("field", values, "row")
    arrays.finish()
    return arrays, field


START_TWICE = """
import numpy as np
from solvers.machine import runtime
from solvers.machine.state import Axis, State
runtime.initialise(1)
arrays = State()
field = arrays.holding("field", np.array([1.0, 2.0, 4.0]), "row")
arrays.finish()
runtime.initialise(1)
print(field.to_numpy().sum())
"""


def test_starting_twice_keeps_the_fields(tmp_path):
    """In a separate process, since Taichi aborts if a field outlives its initialisation."""
    assert fresh(tmp_path, START_TWICE) == "7.0"


def test_arrays_may_be_released_twice_and_after_another_start():
    runtime.initialise(1)
    former, _ = made(np.ones(3))
    runtime.initialise(2)
    values = np.array([5.0, 6.0])
    arrays, field = made(values)
    former.release()
    assert np.array_equal(field.to_numpy(), values)
    arrays.release()
    arrays.release()
    runtime.initialise(1)


def test_declared_fields_start_at_zero_or_with_their_initial_values():
    runtime.initialise(1)
    arrays = State()
    reals, integers = arrays.reals(axes(2, 3), "a", "b"), arrays.integers(axes(4), "c")
    vectors = arrays.vectors(axes(2, 5, 2), "d")
    values = np.arange(24.0).reshape(2, 3, 4)
    held = arrays.holding("held", values, "a b c")
    arrays.finish()
    for field, shape in ((reals[0], (2, 3)), (reals[1], (2, 3)), (integers[0], (4,)), (vectors[0], (2, 5, 2))):
        assert field.to_numpy().shape == shape
        assert not field.to_numpy().any()
    assert np.array_equal(held.to_numpy(), values)
    assert arrays.bytes == 8 * (6 + 6 + 20 + 24) + 4 * 4
    arrays.release()


def test_larger_arrays_keep_the_values_of_smaller_ones():
    runtime.initialise(1)
    small = State()
    (little,), (words,) = small.reals(axes(2, 3), "a"), small.vectors(axes(2, 2, 2), "b")
    small.finish()
    large = State()
    (roomy,), (more_words,) = large.reals(axes(2, 6), "a"), large.vectors(axes(2, 4, 2), "b")
    large.finish()
    values, vectors = np.arange(6.0).reshape(2, 3), np.arange(8.0).reshape(2, 2, 2)
    little.from_numpy(values)
    words.from_numpy(vectors)
    roomy.fill(-1.0)
    large.take_over(small)
    assert np.array_equal(roomy.to_numpy(), np.hstack([values, np.full((2, 3), -1.0)]))
    assert np.array_equal(more_words.to_numpy()[:, :2], vectors)
    small.release()
    large.release()


def test_available_cores():
    assert 1 <= runtime.available_cores() <= os.cpu_count()


def test_fields_in_use_stay_and_field_numbers_restart_after_all_are_released():
    """Taichi identifies compiled kernels by the numbers of their fields, which grow until it is initialised again."""

    def begun() -> tuple[State, ti.Field]:
        runtime.initialise(1)
        arrays = State()
        (field,) = arrays.reals(axes(3), "row")
        arrays.finish()
        return arrays, field

    runtime.initialise(2)  # whatever was there before
    first, field = begun()
    number = field.snode.ptr.id
    second, other = begun()
    field.fill(2.0)
    assert other.snode.ptr.id > number
    assert field.to_numpy().tolist() == [2.0, 2.0, 2.0]
    first.release()
    second.release()
    third, field = begun()
    assert field.snode.ptr.id == number
    third.release()


def test_kernels_without_fields_are_kept_and_leave_the_numbers_of_fields_alone(monkeypatch):
    """As painters' kernels: pictures one after another, also after a run, need one start of Taichi."""
    starts, start = [], runtime._start
    monkeypatch.setattr(runtime, "_start", lambda *plan: (starts.append(plan), start(*plan)))

    def numbered() -> int:
        runtime.initialise(1)
        arrays = State()
        (field,) = arrays.reals(axes(3), "row")
        arrays.finish()
        number = field.snode.ptr.id
        field.fill(1.0)
        arrays.release()
        return number

    def paint() -> None:
        runtime.initialise(1, fields=False)
        assert _work(1, 2) == pytest.approx(np.sin(1.0))

    runtime.initialise(2)  # whatever was there before
    starts.clear()
    paint()
    paint()
    assert len(starts) == 1
    first = numbered()
    paint()
    assert len(starts) == 2
    assert numbered() == first


@ti.kernel
def _work(tasks: ti.i32, turns: ti.i32) -> ti.f64:
    total = 0.0
    for k in range(tasks * ITERATIONS_A_THREAD):
        if k % ITERATIONS_A_THREAD == 0:
            for turn in range(turns):
                total += ti.sin(1.0 * turn)
    return total


@pytest.mark.skipif(sys.platform != "linux" or runtime.available_cores() < 2, reason="two cores on Linux are needed")
def test_pinned_threads_run_on_separate_cores():
    """The threads that a kernel has kept busy, found by their CPU times."""

    def busy():
        times = {}
        for thread in os.listdir("/proc/self/task"):
            with suppress(OSError):  # it has ended, as other tests' threads do
                ticks = Path(f"/proc/self/task/{thread}/stat").read_text().rsplit(")", 1)[1].split()
                times[thread] = int(ticks[11]) + int(ticks[12])
        return times

    cores = len(os.sched_getaffinity(0))
    runtime.initialise(cores)
    runtime.spread_threads()
    before = busy()
    _work(cores, 20_000_000)
    spent = {thread: ticks - before.get(thread, 0) for thread, ticks in busy().items()}
    worked = sorted(spent, key=spent.get)[-cores:]
    held = [os.sched_getaffinity(int(thread)) for thread in worked]
    assert all(len(places) == 1 for places in held)
    assert len(set.union(*held)) == cores
    assert len(os.sched_getaffinity(0)) == cores


@pytest.mark.skipif(sys.platform != "linux", reason="limits on memory as Linux has them")
@pytest.mark.parametrize("limit", [500_000_000, pytest.param(1_000_000_000, marks=pytest.mark.slow)])
def test_too_little_memory_to_start_is_reported_in_one_sentence(limit):
    code = f"""
import resource
resource.setrlimit(resource.RLIMIT_AS, ({limit}, {limit}))
from solvers.machine import runtime
from solvers.machine.errors import Unavailable
try:
    runtime.initialise(1)
except Unavailable as error:
    print(error)
"""
    lone = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=REPOSITORY, env=lone, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0 and "raise it with ulimit -v" in done.stdout, done.stderr
