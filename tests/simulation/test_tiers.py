"""Quick and optimised machine code: the same bits, exchanged in flight, and made once."""

import threading

import numpy as np
import pytest
from flights import different, lanes
from patience import COMPILING

import tandemlift as tl
from tandemlift.compiler.machine_code import code, store
from tandemlift.core.caching import LastUsed
from tandemlift.core.types import leaves
from tandemlift.simulation import fly, plan
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import LANES, FlightMemory


@pytest.fixture
def empty(tmp_path, monkeypatch):
    """No code on disk and none in this process; none is optimised unless it is asked for."""
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(plan, "LOOP_CODE", LastUsed(8))
    monkeypatch.setenv("TANDEMLIFT_OPTIMISE", "0")


def check_optimised(mission, count):
    """The code of a mission's loop, once the optimised one is in its place."""
    found = FlightPlan(mission).loop_code.loop(count)
    assert not found.is_best
    thread = found.optimise()
    assert found.optimise() is None  # it is being made
    thread.join(COMPILING)
    assert found.is_best
    assert found.optimise() is None
    return found


LOST = {"detection.model": "residual"}  # in a corridor: with it, a step has nearly all parts that there are
IN_TARGETS = [pytest.param("zigzag", LOST, marks=pytest.mark.targets)]  # whose code takes long to optimise


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "changes"), [("four", {}), *IN_TARGETS])
def test_optimised_code_gives_the_bits_of_quick_code(name, changes, empty):
    missions = lanes(name, **changes)
    quick = [tl.fly(missions[1]), *tl.fly_many(missions)]
    for count in (1, LANES):
        check_optimised(missions[1], count)
    best = [tl.fly(missions[1]), *tl.fly_many(missions)]
    for a, b in zip(quick, best, strict=True):
        assert different(a, b) == []


@pytest.mark.thorough
def test_blocks_of_any_length_give_the_same_bits(empty, monkeypatch):
    mission, flights = tl.load_mission("iris", {"mission.duration": 20.0}), []
    for number, length in enumerate((10**9, 2)):
        monkeypatch.setattr(code.machine, "BLOCK", length)
        monkeypatch.setenv("TANDEMLIFT_CACHE", f"{store.folder()}{number}")
        plan.LOOP_CODE.clear()
        flights.append(tl.fly(mission))
    assert different(*flights) == []


def test_code_is_exchanged_in_the_middle_of_a_flight(empty):
    mission = lanes("paper")[2]
    whole = tl.fly(mission)
    p = FlightPlan(mission)
    memory = FlightMemory(p.loop_code.loop(1), [p.start()], p.grid(p.steps // p.every + 1, p.every), leaves(p.sample))
    assert memory.fly(700) == 700
    check_optimised(mission, 1)
    assert memory.fly(p.steps + 1) == p.steps
    assert np.array_equal(memory.log[0][:, 1:], log_of(p))
    assert whole.ending is None


def log_of(p):
    """The log of a flight in one go, but for its first column."""
    memory = FlightMemory(p.loop_code.loop(1), [p.start()], p.grid(p.steps // p.every + 1, p.every), leaves(p.sample))
    memory.fly(p.steps + 1)
    return memory.log[0][:, 1:]


def test_a_long_flight_has_its_code_optimised_and_the_next_process_finds_it(empty, monkeypatch):
    monkeypatch.delenv("TANDEMLIFT_OPTIMISE")
    monkeypatch.setattr(code, "PAYS", 0.0)
    monkeypatch.setattr(fly, "FIRST_STRETCH", 100)
    mission = tl.load_mission("one-push", {"mission.duration": 1.0})
    found = FlightPlan(mission).loop_code.loop(1)
    tl.fly(mission)
    for thread in threading.enumerate():
        if thread.name == "optimising":
            thread.join(COMPILING)
    assert found.is_best
    assert sorted(f.name.split("-")[1] for f in store.folder().iterdir()) == ["best.o", "module.o", "quick.o"]
    plan.LOOP_CODE.clear()
    assert FlightPlan(mission).loop_code.loop(1).is_best


def test_without_optimised_code_the_quick_one_flies_on(empty, monkeypatch):
    mission = tl.load_mission("one-push", {"mission.duration": 0.5})
    before = tl.fly(mission)
    found = FlightPlan(mission).loop_code.loop(1)
    monkeypatch.setattr(code, "optimise_in_process", lambda *given: None)
    found.optimise().join(COMPILING)
    assert not found.is_best
    assert different(tl.fly(mission), before) == []
    assert not list(store.folder().glob("*-best.o"))


def test_eight_threads_that_ask_for_the_same_code_at_once_make_it_once(empty, monkeypatch):
    made, compiled = [], code.machine.compiled
    monkeypatch.setattr(code.machine, "compiled", lambda *given: made.append(given) or compiled(*given))
    mission, flights = tl.load_mission("one-push", {"mission.duration": 0.5}), [None] * 8
    threads = [threading.Thread(target=lambda i=i: flights.__setitem__(i, tl.fly(mission))) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(COMPILING)
    assert len(made) == 1
    assert all(different(flight, flights[0]) == [] for flight in flights)
