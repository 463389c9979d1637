"""Flights in blocks and on threads are the flights flown alone, to the last bit."""

import threading

import numpy as np
import pytest
from flights import different
from patience import joined

import tandemlift as tl
from tandemlift.core.errors import InputError
from tandemlift.missions import MissionTemplate
from tandemlift.simulation import fly as fly_module
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import LANES

SHORT = {"mission.duration": 20.0}


def spread(mission, count, **changes):
    """Missions that differ in start, gains, pushes and what the body really weighs."""
    return [
        tl.load_mission(
            mission,
            {
                **SHORT,
                "initial.position": [0.05 * i, -0.3, 0.01 * i],
                "controller.gains.xi": [4.0 + 0.1 * i, 2.0, 11.0, 25.0, 80.0, 25.0],
                "plant.mass_scale": 1.0 + 0.01 * i,
                "pushes": [{"force": [1.0 + 0.2 * j, 0.0, 0.5], "time": 12.0 + j, "sigma": 0.4} for j in range(i % 4)],
                **changes,
            },
        )
        for i in range(count)
    ]


def test_a_mixture_of_variants_and_lengths_comes_back_in_the_order_given():
    missions = []
    for i in range(6):
        missions.append(spread("paper", 8)[i])
        missions.append(tl.load_mission("one-push", {"mission.duration": 12.0 + i}))
        missions.append(tl.load_mission("one-push", {"pushes.0.point": [0.0, 0.1 * i + 0.1, 0.0]}))
    together = tl.fly_many(missions, threads=2)
    for mission, flight in zip(missions, together, strict=True):
        assert flight.mission["mission"]["duration"] == mission.mission.duration
    for i in (0, 4, 5, 16, 17):
        assert different(together[i], tl.fly(missions[i])) == []


def test_the_number_of_threads_changes_nothing():
    missions = spread("paper", 19)
    for one, two in zip(tl.fly_many(missions, threads=1), tl.fly_many(missions, threads=3), strict=True):
        assert different(one, two) == []


def test_keeping_metrics_only_gives_the_same_metrics():
    missions = [*spread("paper", 9), tl.load_mission("hover")]
    kept = tl.fly_many(missions, keep="metrics")
    for flight, metrics in zip(tl.fly_many(missions), kept, strict=True):
        del metrics["wall_s"]
        assert {k: v for k, v in flight.metrics().items() if k != "wall_s"} == metrics


def test_no_missions_make_no_flights():
    assert tl.fly_many([]) == []


def tiny(count, **changes):
    """Missions of some steps each."""
    template = MissionTemplate.read("one-push", {"mission.duration": 0.02, **changes}, quiet=True)
    return (template.mission({"mission.seed": i, "plant.mass_scale": 1.0 + 1e-3 * i}) for i in range(count))


def timeless(metrics):
    return [{k: v for k, v in m.items() if k != "wall_s"} for m in metrics]


def test_missions_of_an_iterator_are_read_while_others_fly_and_come_back_in_order():
    read, ahead, totals = [], [], []

    def reading():
        for mission in tiny(200):
            read.append(mission)
            yield mission

    def progress(flown, total):
        ahead.append(len(read) - flown)
        totals.append((flown, total))

    found = tl.fly_many(reading(), "metrics", 2, progress=progress)
    assert timeless(found) == timeless(tl.fly_many(list(tiny(200)), "metrics", 1))
    assert max(ahead) <= 3 * LANES
    assert totals[-1] == (200, 200)
    assert all(flown <= total <= 200 for flown, total in totals)


def test_flights_are_sorted_by_when_rotors_fail_and_come_back_in_the_order_given(monkeypatch):
    monkeypatch.setattr(fly_module, "SORTED", 2 * LANES)
    template = MissionTemplate.read("rotor-loss", {"mission.duration": 1.5, "phases.lift_start": 0.1}, quiet=True)
    times = [
        *np.random.default_rng(0).permutation(np.linspace(0.3, 1.4, 2 * LANES + 3)),
        *[9.0 + i for i in range(LANES)],
    ]
    missions = [template.mission({"mission.seed": i, "faults.0.time": float(t)}) for i, t in enumerate(times)]
    groups = fly_module._FlightGroups(missions)
    blocks = [sorted(times[place] for place in group.places) for group in iter(groups.take, None)]
    assert sorted(map(len, blocks)) == [3, LANES, LANES, LANES]
    assert [9.0 + i for i in range(LANES)] in blocks  # after the end, where they are alike and wait for no others
    early, late = (block for block in blocks if len(block) == LANES and block[0] < 1.5)
    assert max(early) < min(late)
    for flown, mission in zip(tl.fly_many(missions), missions, strict=True):
        assert different(flown, tl.fly(mission)) == []


def test_no_more_missions_wait_for_others_of_their_variant_than_allowed(monkeypatch):
    monkeypatch.setattr(fly_module, "WAITING", 20)
    read, ahead = [], []

    def reading():  # no two have as many steps
        for i in range(80):
            read.append(i)
            yield tl.load_mission("one-push", {"mission.duration": 0.01 + 0.001 * i})

    found = tl.fly_many(reading(), "metrics", 1, progress=lambda flown, _: ahead.append(len(read) - flown))
    assert [m["steps"] for m in found] == [10 + i for i in range(80)]
    assert max(ahead) <= 20 + 1


def test_a_mission_that_cannot_be_built_stops_all_or_gives_its_refusal(monkeypatch):
    def plan(mission):
        if mission.mission.seed in (3, 30):
            raise InputError(f"seed {mission.mission.seed} cannot be built")
        return FlightPlan(mission)

    monkeypatch.setattr(fly_module, "FlightPlan", plan)
    with pytest.raises(InputError, match="seed 3 "):
        tl.fly_many(tiny(40), "metrics", 1)
    found = tl.fly_many(tiny(40), "metrics", 2, refusals=True)
    assert [i for i, m in enumerate(found) if isinstance(m, InputError)] == [3, 30]
    assert str(found[30]) == "seed 30 cannot be built"
    monkeypatch.undo()
    expected = timeless(tl.fly_many(tiny(40), "metrics"))
    assert timeless(m for m in found if isinstance(m, dict)) == [m for i, m in enumerate(expected) if i not in (3, 30)]


def test_an_error_of_the_callers_iterator_ends_the_call():
    def reading():
        yield from tiny(20)
        raise OSError("the list of missions ends early")

    with pytest.raises(OSError, match="ends early"):
        tl.fly_many(reading(), "metrics", 2)


@pytest.mark.parametrize("count", [0, 1, 3, 8, 9, 40])
def test_the_number_of_pushes_is_data(count):
    pushes = [{"force": [0.5, 0.0, 0.0], "time": 5.0 + 0.3 * i, "sigma": 0.4} for i in range(count)]
    metrics = tl.fly(tl.load_mission("one-push", {"pushes": pushes, "mission.duration": 30.0})).metrics()
    assert metrics["human_impulse_n_s"][0] == pytest.approx(count * 0.5 * 0.4 * np.sqrt(2 * np.pi), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(("keyword", "value"), [("keep", "all"), ("threads", 0), ("threads", 1.5)])
def test_what_is_not_a_choice_is_refused_by_name(keyword, value):
    with pytest.raises(InputError, match=keyword):
        tl.fly_many([], **{keyword: value})


def test_threads_of_the_users_own_may_fly_at_once():
    missions = spread("paper", 4)
    alone = [tl.fly(m) for m in missions]
    results = [None] * 4

    def work(i):
        results[i] = tl.fly(missions[i])

    threads = [threading.Thread(target=work, args=(i,), daemon=True) for i in range(4)]
    for thread in threads:
        thread.start()
    joined(*threads)
    assert all(different(a, b) == [] for a, b in zip(alone, results, strict=True))
