"""Moving parts: a gate or a floor reaches its end position within its speed and acceleration, and stops there."""

from math import pi

import numpy as np
import pytest
import taichi as ti
from hypothesis import given, settings
from hypothesis import strategies as st

from solvers.machine import runtime
from solvers.machine.state import State
from solvers.tank.parts import Part, travel

PLATE = ((0.0, 0.0), (0.0, 0.1))
ROWS = 8  # parts at a time
AHEAD = 2  # columns before a part's own, as a table may have


@ti.data_oriented
class Probe:
    """Reads `travel` of up to ROWS parts at many times."""

    def __init__(self):
        runtime.initialise(1)
        self.arrays = State()
        self.table = self.arrays.holding("table", np.zeros((ROWS, AHEAD + 6)), "row number")
        self.arrays.finish()

    @ti.kernel
    def read(self, times: ti.types.ndarray(ti.f64, ndim=1), rows: ti.types.ndarray(ti.f64, ndim=3)):
        for p in range(rows.shape[0]):
            for k in range(times.shape[0]):
                state = travel(self.table, p, AHEAD, times[k])
                rows[p, k, 0], rows[p, k, 1] = state[0], state[1]

    def at(self, parts, times) -> tuple[np.ndarray, np.ndarray]:
        """Share of the distance covered and its rate (1/s), (P, T), at `times` (T,) s."""
        table = np.full((ROWS, AHEAD + 6), np.nan)
        table[: len(parts), AHEAD:] = [part.parameters() for part in parts]
        self.table.from_numpy(table)
        times = np.ascontiguousarray(times, dtype=float)
        rows = np.zeros((len(parts), len(times), 2))
        self.read(times, rows)
        return rows[..., 0], rows[..., 1]


@pytest.fixture(scope="module")
def probe():
    reading = Probe()
    yield reading
    reading.arrays.release()


def programme(part: Part, times) -> tuple[np.ndarray, np.ndarray]:
    """Distance (m) and speed (m/s) at `times`: constant acceleration, constant speed, constant deceleration.

    In extended precision, each phase going on from where the one before ended.
    """
    way, top, slope = (np.longdouble(x) for x in (part.way, part.speed, part.acceleration))
    top = min(top, np.sqrt(way * slope))
    ramp, cruise = top / slope, way / top - top / slope
    passed = np.asarray(times, dtype=np.longdouble) - np.longdouble(part.start)
    rising, running = np.clip(passed, 0, ramp), np.clip(passed - ramp, 0, cruise)
    falling = np.clip(passed - ramp - cruise, 0, ramp)
    distance = slope * rising**2 / 2 + top * running + top * falling - slope * falling**2 / 2
    under_way = (passed > 0) & (passed < 2 * ramp + cruise)
    return distance, np.where(under_way, slope * (rising - falling), 0)


PARTS = st.builds(
    Part,
    points=st.just(PLATE),
    move=st.tuples(st.floats(-2.0, 2.0), st.floats(0.01, 2.0)),
    start=st.floats(0.0, 2.0),
    speed=st.floats(0.01, 20.0),
    acceleration=st.floats(0.01, 1e6),
)


@settings(max_examples=60, deadline=None)
@given(st.lists(PARTS, min_size=1, max_size=ROWS))
def test_displacement_and_speed_at_any_time(probe, parts):
    for part in parts:
        end = part.duration()
        times = np.concatenate(
            [np.linspace(0.0, 1.2 * end, 60), part.start + (end - part.start) * np.geomspace(1e-9, 1)]
        )
        way, pace = probe.at([part], times)
        distance, speed = programme(part, times)
        # A rounding of t is a change of the way by the rate of it.
        rounding = 4e-16 * (4.0 + 2.0 * times * part.fastest() / part.way)
        assert np.all(np.abs(way[0] - distance / part.way) <= rounding)
        steepest = part.acceleration * times + part.fastest()
        assert np.all(np.abs(pace[0] * part.way - speed) <= 1e-15 * steepest + 1e-15 * part.acceleration)
        assert np.all(pace[0] * part.way <= part.fastest() * (1 + 1e-12)) and np.all(pace >= 0.0)


GATE = Part(PLATE, (0.0, 0.3), start=0.5, speed=1.0, acceleration=10.0)
SHORT = Part(PLATE, (0.03, -0.04), speed=100.0, acceleration=20.0)  # reaches 1 m/s halfway
ABRUPT = Part(PLATE, (0.2, 0.0), start=0.1, speed=2.0, acceleration=1e300)
STILL = Part(PLATE)


def test_gate_rises_to_its_speed_runs_and_stops(probe):
    # 0.1 s and 50 mm to 1 m/s, 200 mm in 0.2 s, 0.1 s to a stand.
    assert GATE.duration() == pytest.approx(0.9) and GATE.fastest() == 1.0
    way, pace = probe.at([GATE], [0.55, 0.6, 0.7, 0.8, 0.85])
    assert 0.3 * way[0] == pytest.approx([0.0125, 0.05, 0.15, 0.25, 0.2875], rel=1e-12)
    assert 0.3 * pace[0] == pytest.approx([0.5, 1.0, 1.0, 1.0, 0.5], rel=1e-12)


def test_part_rests_before_its_start_and_exactly_at_its_end(probe):
    for part in (GATE, SHORT, ABRUPT):
        way, pace = probe.at([part], [-1e9, -1.0, 0.0, part.start, part.duration() + 1e-12, 1e9])
        assert way[0].tolist() == [0.0, 0.0, 0.0, 0.0, 1.0, 1.0]
        assert pace[0, [0, 1, 2, 4, 5]].tolist() == [0.0] * 5


def test_a_short_move_has_a_lower_top_speed(probe):
    assert SHORT.way == pytest.approx(0.05) and SHORT.fastest() == pytest.approx(1.0)
    assert SHORT.duration() == pytest.approx(0.1)
    way, pace = probe.at([SHORT], [0.025, 0.05, 0.075])
    assert way[0] == pytest.approx([0.125, 0.5, 0.875]) and 0.05 * pace[0] == pytest.approx([0.5, 1.0, 0.5])


def test_sudden_part_is_at_its_speed_at_once(probe):
    way, pace = probe.at([ABRUPT], [0.1 + 1e-9, 0.15, 0.2 - 1e-9])
    assert 0.2 * pace[0] == pytest.approx([2.0] * 3) and way[0, 1] == pytest.approx(0.5)
    assert ABRUPT.duration() == pytest.approx(0.2)


def test_floor_that_drops_at_three_g_leaves_a_falling_grain_behind(probe):
    floor = Part(PLATE, (0.0, -50.0), start=0.2, speed=1e3, acceleration=3 * 9.81)
    times = 0.2 + np.linspace(0.0, 0.5, 20)
    way, _ = probe.at([floor], times)
    assert np.allclose(-50.0 * way[0], -1.5 * 9.81 * (times - 0.2) ** 2, rtol=1e-12, atol=1e-15)


def test_a_part_without_a_move_stays_at_rest(probe):
    assert STILL.duration() == STILL.fastest() == 0.0
    move = STILL.parameters()[4:]
    assert move == [0.0, 0.0]
    way, pace = probe.at([STILL, GATE], [-1.0, 0.0, 3.0])
    assert np.all(np.isfinite(way)) and np.all(pace[0] == 0.0)


def test_parts_have_separate_rows(probe):
    together = probe.at([GATE, SHORT, ABRUPT], np.linspace(0, 1, 50))
    for p, part in enumerate((GATE, SHORT, ABRUPT)):
        alone = probe.at([part], np.linspace(0, 1, 50))
        assert all(np.array_equal(many[p], one[0]) for many, one in zip(together, alone, strict=True))


def test_direction_of_the_move_does_not_change_its_course():
    turned = [Part(PLATE, (0.3 * np.sin(a), 0.3 * np.cos(a)), 0.5, 1.0, 10.0) for a in np.linspace(0, 2 * pi, 9)]
    for part in turned:
        assert part.parameters()[:4] == pytest.approx(GATE.parameters()[:4], rel=1e-14)
