"""Missions alone, in a block of eight different lanes and step by step: the same to the last bit.

There is one mission of each loop that built-in missions fly in.

Lanes differ in seed, start, true mass and pushes. Where there are real rotors, one is lost at another time in each
lane. Two lanes are thrown over, one after the other, and the rest fly on.
"""

import numpy as np
import pytest
from flights import LOST, different, lanes

import tandemlift as tl
from tandemlift.missions import built_in
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import LANES
from tandemlift.simulation.results import flight_of
from tandemlift.simulation.stepping import fly_stepwise

NAMES = ["flight-ready", "four", "gusts", "iris", "one-push", "paper", "rotor-loss", "zigzag"]


def step_by_step(mission):
    p = FlightPlan(mission)
    return flight_of(p, fly_stepwise(p, p.steps // p.every + 1, p.every))


def check_same_bits(missions):
    """Fly them alone, in a block, and four of them step by step; the flights."""
    assert len({FlightPlan(m).variant for m in missions}) == 1  # one block
    assert len(missions) == LANES
    together = tl.fly_many(missions)
    for i, mission in enumerate(missions):
        assert different(together[i], tl.fly(mission)) == []
        if i in (2, *LOST):
            assert different(together[i], step_by_step(mission)) == []
    assert len({f["position"].tobytes() for f in together}) == LANES
    return together


def test_every_built_in_mission_flies_in_one_of_these_loops():
    loops = {name: FlightPlan(lanes(name)[1]).variant for name in built_in()}
    assert set(loops.values()) == {loops[name] for name in NAMES}


@pytest.mark.parametrize("name", NAMES)
def test_a_built_in_mission_flies_alone_in_a_block_and_step_by_step_with_the_same_bits(name):
    flights = check_same_bits(lanes(name))
    ends = {str(flights[i].ending) for i in LOST}
    assert len(ends) == 2
    assert any(flights[i].ending for i in LOST)
    assert flights[1].ending is None


@pytest.mark.parametrize("count", [1, 5])
def test_any_number_of_quadrotors_flies_so_with_rotors_lost_in_flight(count):
    one = tl.load_mission("iris").vehicle.quadrotors[0].model_dump(mode="json", exclude_none=True)
    places = np.linspace(1.6, -1.6, count) if count > 1 else [0.0]
    quadrotors = [{**one, "position": [0.02 * i, float(y), 0.075]} for i, y in enumerate(places)]
    check_same_bits(lanes("rotor-loss", **{"vehicle.quadrotors": quadrotors}))
