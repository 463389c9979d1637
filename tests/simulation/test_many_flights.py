"""Flights in blocks, on threads and in several engines are the flights flown alone, to the last bit."""

import numpy as np
import pytest
from flights import different

import tandemlift as tl
from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.core.errors import InputError
from tandemlift.missions import MissionTemplate
from tandemlift.simulation import flight_groups as groups
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
    together = tl.fly_many(missions, threads=np.int64(2))
    for mission, flight in zip(missions, together, strict=True):
        assert flight.mission["mission"]["duration"] == mission.mission.duration
    for i in (0, 4, 5, 16, 17):
        assert different(together[i], tl.fly(missions[i])) == []


def test_the_number_of_threads_changes_nothing_and_metrics_alone_are_those_of_the_flights():
    missions = spread("paper", 19)
    flights = tl.fly_many(missions, threads=1)
    for one, two in zip(flights, tl.fly_many(missions, threads=3), strict=True):
        assert different(one, two) == []
    assert timeless(tl.fly_many(missions, keep="metrics")) == timeless(flight.metrics() for flight in flights)
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


def test_no_more_missions_wait_for_others_of_their_variant_than_allowed(monkeypatch):
    monkeypatch.setattr(groups, "WAITING", 20)
    read, ahead = [], []

    def reading():  # no two have as many steps
        for i in range(80):
            read.append(i)
            yield tl.load_mission("one-push", {"mission.duration": 0.01 + 0.001 * i})

    found = tl.fly_many(reading(), "metrics", 1, progress=lambda flown, _: ahead.append(len(read) - flown))
    assert [m["steps"] for m in found] == [10 + i for i in range(80)]
    assert max(ahead) <= 20 + 1


def test_a_mission_that_cannot_be_built_stops_all_or_gives_its_refusal(monkeypatch):
    def plan(mission, **how):
        if mission.mission.seed in (3, 30):
            raise InputError(f"seed {mission.mission.seed} cannot be built")
        return FlightPlan(mission, **how)

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


def test_the_number_of_pushes_is_data():
    counts = [0, 1, 8, 9, 40]
    pushes = [{"force": [0.5, 0.0, 0.0], "time": 5.0 + 0.3 * i, "sigma": 0.4} for i in range(max(counts))]
    missions = [tl.load_mission("one-push", {"pushes": pushes[:n], "mission.duration": 30.0}) for n in counts]
    assert len({FlightPlan(mission).variant for mission in missions}) == 1
    found = [m["human_impulse_n_s"][0] for m in tl.fly_many(missions, keep="metrics")]
    assert found == pytest.approx(np.array(counts) * 0.5 * 0.4 * np.sqrt(2 * np.pi), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(("keyword", "value"), [("keep", "all"), ("threads", 0), ("threads", 1.5)])
def test_what_is_not_a_choice_is_refused_by_name(keyword, value):
    with pytest.raises(InputError, match=keyword):
        tl.fly_many([], **{keyword: value})


# in whatever engine

BRIEF = {"mission.duration": 0.2}


def hovers(*masses):
    return [tl.load_mission("hover", {**BRIEF, "plant.mass_scale": mass}) for mass in masses]


@pytest.fixture
def heavy():
    """A mission that loads, and that no plan can be made of."""
    mission = hovers(1.0)[0]
    return mission.model_copy(update={"vehicle": mission.vehicle.model_copy(update={"quadrotors": ()})})


def without_time(metrics):
    return {key: value for key, value in metrics.items() if key != "wall_s"}


def test_each_mission_flies_in_its_engine_in_the_order_given():
    missions, engines = hovers(1.0, 1.01, 0.99, 1.02), ("mujoco", "compiled", "mujoco", "compiled")
    heard = []
    flown = fly_each(missions, engines, keep="flights", progress=lambda *now: heard.append(now))
    for mission, engine, flight in zip(missions, engines, flown, strict=True):
        assert without_time(flight.metrics()) == without_time(tl.fly(mission, engine).metrics())
    assert heard[-1] == (4, 4)
    assert [done for done, _ in heard] == sorted(done for done, _ in heard)


def test_metrics_are_those_of_the_flights():
    missions = hovers(1.0, 1.01)
    for engine in ("compiled", "mujoco"):
        flights = fly_each(missions, engine, keep="flights")
        metrics = fly_each(missions, engine)
        assert list(map(without_time, metrics)) == [without_time(flight.metrics()) for flight in flights]


def test_the_refusal_of_a_mission_that_could_not_be_made_keeps_its_place():
    one, two = hovers(1.0, 1.01)
    refusal = tl.InputError("no mission")
    for engine in ("compiled", "mujoco"):
        flown = fly_each(iter([one, refusal, two]), engine, refusals=True)
        assert flown[1] is refusal
        assert without_time(flown[2]) == without_time(tl.fly(two, engine).metrics())
        with pytest.raises(tl.InputError, match="no mission"):
            fly_each([one, refusal], engine)


def test_in_mujoco_too_a_mission_that_cannot_be_built_is_told_by_its_place_and_the_others_fly(heavy):
    one, two = hovers(1.0, 1.01)
    with pytest.raises(tl.InputError):
        fly_each([one, heavy, two], "mujoco")
    flown = fly_each([one, heavy, two], "mujoco", refusals=True)
    assert isinstance(flown[1], tl.InputError)
    assert [without_time(m) for m in (flown[0], flown[2])] == [without_time(m) for m in fly_each([one, two], "mujoco")]
