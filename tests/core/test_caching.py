"""Results are kept for the same tables and for equal ones, never for others."""

import math
import sys
from concurrent.futures import ThreadPoolExecutor

from tandemlift.core.caching import KEPT, LastUsed, cached
from tandemlift.core.vector import Absent, vec3
from tandemlift.missions import load_mission

POSITION = "initial.position"


def counted(function):
    calls = []

    @cached
    def call(*args):
        calls.append(args)
        return function(*args)

    return call, calls


def test_the_same_table_and_an_equal_one_give_the_same_object():
    start, calls = counted(lambda initial: vec3(initial.position))
    one, other = (load_mission("one-push", {POSITION: [1.0, 0.0, 2.0]}).initial for _ in range(2))
    assert one is not other
    assert start(one) is start(one) is start(other)
    assert len(calls) == 1


def test_a_table_with_minus_zero_is_not_taken_for_one_with_zero():
    start, _ = counted(lambda initial: vec3(initial.position))
    plus, minus = (load_mission("one-push", {POSITION: [zero, 0.0, 2.0]}).initial for zero in (0.0, -0.0))
    assert plus == minus  # as Python compares
    assert [math.copysign(1.0, start(table).x) for table in (plus, minus, plus)] == [1.0, -1.0, 1.0]


def test_plain_values_are_told_apart_by_type_and_sign():
    same, calls = counted(lambda value: value)
    values = [0.0, -0.0, 0, False, None, "0.0", (0.0,), (-0.0,)]
    assert [repr(same(value)) for value in (*values, *values)] == [repr(value) for value in (*values, *values)]
    assert len(calls) == len(values)


def test_nested_values_are_kept_by_identity_and_those_without_numbers_by_type():
    same, calls = counted(lambda value: value)
    a, b = vec3((1.0, 2.0, 3.0)), vec3((1.0, 2.0, 3.0))
    assert same(a) is a
    assert same(b) is b
    assert same(Absent()) is same(Absent())
    assert len(calls) == 3


def test_only_the_last_results_are_kept():
    same, calls = counted(lambda value: value)
    for i in (*range(KEPT + 1), 0):
        same(float(i))
    assert len(calls) == KEPT + 2


def test_what_was_used_last_is_kept_and_no_more():
    made, kept = [], LastUsed(2)
    for key in "abacab":  # c pushes out b, and b then c
        assert kept.of(key, lambda key=key: made.append(key) or key.upper()) == key.upper()
    assert made == ["a", "b", "c", "b"]
    assert list(kept) == ["a", "b"]


def test_threads_that_fill_a_cache_together_do_not_disturb_each_other():
    """Four of six threads raised before, as each drops the oldest result while others add theirs."""
    same, before = cached(lambda said: said), sys.getswitchinterval()

    def fill(number):
        return [same((number, i)) == (number, i) for i in range(20_000)]

    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(6) as pool:
            assert all(map(all, pool.map(fill, range(6))))
    finally:
        sys.setswitchinterval(before)
