"""Numbers that clients change in flight: bounds, components of a list, and a client that sends too many."""

import math
import threading
from types import SimpleNamespace

import pytest
from patience import joined, until

from tandemlift.apps.clients.mission_numbers import mission_numbers


@pytest.fixture
def flight():
    """A flight that makes no change until `go` is set, and whose changes have all ended with the test."""
    go, made, before = threading.Event(), [], threading.enumerate()

    def apply(message):
        go.wait()
        made.append((message.key, message.value))

    shown = {"key": "wind.velocity", "value": (1.0, 2.0, 3.0), "min": -8.0, "max": 8.0}
    named = {"key": "controller.name", "value": "nftsmc"}
    session = SimpleNamespace(scene={"parameters": [shown, named]}, apply=apply)
    yield SimpleNamespace(session=session, go=go, made=made)
    go.set()
    joined(*(thread for thread in threading.enumerate() if thread not in before))


def test_each_component_of_a_list_is_a_number_within_its_bounds(flight):
    numbers = {f"{table}.{name}": one for table, name, one in mission_numbers(flight)}
    assert {name: one.value for name, one in numbers.items()} == {f"wind.velocity_{n}": float(n) for n in (1, 2, 3)}
    y = numbers["wind.velocity_2"]
    assert not any(y.take(bad) for bad in (8.1, -9.0, math.nan, math.inf))
    assert y.value == 2.0
    flight.go.set()
    assert y.take(-4.0)
    until(lambda: flight.made == [("wind.velocity", (1.0, -4.0, 3.0))], "the change")


def test_a_flood_of_changes_is_refused_until_some_are_made(flight):
    x = next(one for _, _, one in mission_numbers(flight))
    taken = [x.take(0.01 * i) for i in range(100)]
    assert taken == [True] * 8 + [False] * 92
    flight.go.set()
    until(lambda: len(flight.made) == 8, "the changes")
    until(lambda: x.take(5.0), "a change once others are made")
