"""Steps that are due by the clock, and garbage that waits for their end."""

import gc
from contextlib import ExitStack
from types import SimpleNamespace

import pytest

from tandemlift.apps.live.session.pacing import MOST_BEHIND, NEVER, WITHOUT_FULL_COLLECTIONS, Pacer


@pytest.fixture
def clock(monkeypatch):
    now = [0.0]
    monkeypatch.setattr("tandemlift.apps.live.session.pacing.time", SimpleNamespace(perf_counter=lambda: now[0]))
    return now


def test_steps_are_due_as_time_passes_at_the_speed_asked_for(clock):
    pacer = Pacer(0.001)
    clock[0] = 0.0105
    assert pacer.due() == 10
    pacer.flew(10)
    assert pacer.behind == pytest.approx(0.0005)
    pacer.speed = 0.5
    clock[0] += 0.02
    assert pacer.due() == 10


def test_what_a_machine_cannot_keep_up_with_is_forgotten(clock):
    pacer = Pacer(0.001)
    clock[0] = 10.0
    assert pacer.due() == round(MOST_BEHIND / 0.001)


def test_the_factor_is_time_flown_over_time_passed(clock):
    pacer = Pacer(0.001)
    for _ in range(300):
        clock[0] += 0.01
        pacer.due()
        pacer.flew(5)
    assert pacer.factor == pytest.approx(0.5, rel=0.02)


def test_the_collector_is_as_before_once_the_last_of_several_flights_has_ended():
    before = gc.get_threshold()
    first, second = ExitStack(), ExitStack()
    first.enter_context(WITHOUT_FULL_COLLECTIONS)
    second.enter_context(WITHOUT_FULL_COLLECTIONS)
    first.close()
    assert gc.get_threshold()[2] == NEVER
    second.close()
    assert gc.get_threshold() == before
