"""Kernels that compile fast where the environment asks for it."""

import pytest
import taichi as ti
from taichi.lang import impl

from solvers.machine import compiling, wide
from solvers.machine.errors import Unavailable


@pytest.mark.parametrize(("bits", "lanes"), [(512, 16), (256, 8), (0, 0)])
def test_real_vectors_are_for_processors_that_have_them_and_who_has_time(bits, lanes, monkeypatch):
    monkeypatch.setattr(wide, "registers", lambda: bits)
    monkeypatch.setenv("CARGOLAB_COMPILE", "quick")
    assert wide.lanes() == 0
    monkeypatch.delenv("CARGOLAB_COMPILE")
    assert wide.lanes() == lanes


def test_another_word_is_refused_in_a_sentence(monkeypatch):
    monkeypatch.setenv("CARGOLAB_COMPILE", "fast")
    with pytest.raises(Unavailable, match=r"CARGOLAB_COMPILE is 'fast': set it to quick, or not at all\."):
        compiling.quick()


@ti.func
def halved(number):
    number *= 0.5
    return number


@ti.func
def with_half(number):
    return number + halved(number)


@ti.func
def raised(number: ti.template(), by):
    number += by
    return number + by


@ti.func
def first_raised(pair, single):
    pair[0] += single
    return pair[0]


@ti.func
def passed_on(number):
    return raised(number, 1.0)


@ti.data_oriented
class Copies:
    """Assignments and calls in which it shows whether a value was copied."""

    def __init__(self):
        self.found, self.count = ti.field(ti.f64, 16), ti.field(ti.i32, ())

    @ti.kernel
    def fill(self):
        a, b = 1.0, 2.0
        a, b = b, a + b
        self.found[0], self.found[1] = a, b  # 2 3
        c = a
        a = a * 10.0
        self.found[2], self.found[3] = c, a  # 2 20
        self.found[4], self.found[5] = with_half(c), c  # 3 2
        self.found[6], self.found[7] = raised(c, c), c  # 6 4
        self.found[8], self.found[9] = passed_on(c), c  # 6 4
        pair = ti.Vector([c, 1.0])
        self.found[10], self.found[11] = first_raised(pair, c), pair[0]  # 8 4
        self.found[12 + ti.atomic_add(self.count[None], 1)] = ti.cast(self.count[None], ti.f64)  # 0, before it is added
        d = e = self.count[None] + 1
        e += d
        self.found[13], self.found[14] = d, e  # 2 4
        self.found[15] = ti.cast(0.1, ti.f64) + ti.cast(7, ti.f64)


@pytest.mark.usefixtures("one_start")
def test_values_that_are_copied_once_stay_apart():
    copies = Copies()
    copies.fill()
    found = copies.found.to_numpy()
    assert found[:15].tolist() == [2, 3, 2, 20, 3, 2, 6, 4, 6, 4, 8, 4, 0, 2, 4]
    assert found[15] == 7.1


@pytest.mark.usefixtures("one_start")
def test_a_value_is_copied_once_and_an_argument_only_where_it_is_changed(monkeypatch):
    @ti.func
    def twice(number):
        return number + number

    @ti.kernel
    def told(given: ti.f64) -> ti.f64:
        one = given
        both = twice(one) + twice(one)
        other, both = halved(one), both
        return other + both

    copies, made = [], impl.expr_init
    monkeypatch.setattr(impl, "expr_init", lambda value: copies.append(value) or made(value))
    assert told(2.0) == 9.0
    assert sum(not isinstance(value, tuple) for value in copies) <= 5  # one, both, what is halved, and the two
