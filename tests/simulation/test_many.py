"""Many missions fly in one way, whatever their engines."""

import pytest

import tandemlift as tl
from tandemlift.analysis.studies.execution.flying import fly_each

pytest.importorskip("mujoco")
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


def test_an_unknown_engine_is_refused_though_nothing_is_to_be_flown():
    with pytest.raises(tl.InputError, match="mujoko"):
        fly_each([], "mujoko")


@pytest.mark.parametrize("engine", ["compiled", "mujoco"])
def test_a_mission_that_cannot_be_built_is_told_by_its_place_and_the_others_fly(engine, heavy):
    one, two = hovers(1.0, 1.01)
    with pytest.raises(tl.InputError):
        fly_each([one, heavy, two], engine)
    flown = fly_each([one, heavy, two], engine, refusals=True)
    assert isinstance(flown[1], tl.InputError)
    assert [without_time(m) for m in (flown[0], flown[2])] == [without_time(m) for m in fly_each([one, two], engine)]
