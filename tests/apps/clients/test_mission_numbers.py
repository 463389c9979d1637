"""Numbers that clients change in flight: bounds, components of a list, and a client that sends too many."""

import math
import threading
from types import SimpleNamespace
from typing import ClassVar

import pytest
from patience import joined, until

import tandemlift as tl
from tandemlift.apps.clients.mission_numbers import mission_numbers
from tandemlift.missions import changed


@pytest.fixture
def flight():
    """A flight that makes no change until `go` is set, and whose changes have all ended with the test."""
    go, made, before = threading.Event(), [], threading.enumerate()

    def apply(message):
        go.wait()
        set_to(message.value)
        made.append((message.key, message.value))

    def set_to(wind):
        session.flight.now = changed(session.flight.now, "wind.velocity", list(wind))

    shown = {"key": "wind.velocity", "value": (1.0, 2.0, 3.0), "min": -8.0, "max": 8.0}
    named = {"key": "controller.name", "value": "nftsmc"}
    began = SimpleNamespace(now=tl.load_mission("two-x500", {"wind.velocity": [1.0, 2.0, 3.0]}))
    session = SimpleNamespace(scene={"parameters": [shown, named]}, apply=apply, flight=began, turn=threading.RLock())
    yield SimpleNamespace(session=session, go=go, made=made, set_to=set_to)
    go.set()
    joined(*(thread for thread in threading.enumerate() if thread not in before))


def test_each_component_of_a_list_is_a_number_within_its_bounds(flight):
    numbers = {f"{table}.{name}": one for table, name, one in mission_numbers(flight)}
    assert {name: one.read() for name, one in numbers.items()} == {f"wind.velocity_{n}": float(n) for n in (1, 2, 3)}
    y = numbers["wind.velocity_2"]
    assert not any(y.take(bad) for bad in (8.1, -9.0, math.nan, math.inf))
    assert y.read() == 2.0
    flight.set_to([5.0, 6.0, 7.0])  # by a page
    assert [one.read() for one in numbers.values()] == [5.0, 6.0, 7.0]
    assert y.take(-4.0)
    assert y.read() == -4.0  # the answer of a client, although the flight does not have it yet
    flight.go.set()
    until(lambda: flight.made == [("wind.velocity", (5.0, -4.0, 7.0))], "the change")


def test_a_flood_of_changes_is_refused_until_some_are_made(flight):
    x = next(one for _, _, one in mission_numbers(flight))
    taken = [x.take(0.01 * i) for i in range(100)]
    assert taken == [True] * 8 + [False] * 92
    flight.go.set()
    until(lambda: flight.made[-1:] == [("wind.velocity", (0.07, 2.0, 3.0))], "the last change that was taken")
    until(lambda: x.take(5.0), "a change once others are made")


class LateThread(threading.Thread):
    """A thread that runs when the test says so."""

    made: ClassVar = []

    def start(self):
        self.made.append(self)


def test_of_two_changes_the_later_one_counts_whichever_thread_is_the_first(flight, monkeypatch):
    flight.go.set()
    x = next(one for _, _, one in mission_numbers(flight))
    with monkeypatch.context() as late:
        late.setattr(threading, "Thread", LateThread)
        assert x.take(4.0)
        assert x.take(5.0)
    for thread in reversed(LateThread.made):
        thread.run()
    assert x.read() == 5.0
    assert flight.made == [("wind.velocity", (5.0, 2.0, 3.0))]
