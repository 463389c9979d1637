"""Parameters that are equal in all lanes of a block are scalars of its code; the bits are those of flights alone."""

import numpy as np
import pytest
from flights import different

import tandemlift as tl
from tandemlift.core.caching import LastUsed
from tandemlift.simulation import plan
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import LANES

SHORT = {"mission.duration": 1.5, "mission.log_interval": 0.005, "phases.lift_start": 0.1}
HEAVY, SOFT, SMOOTH = {"plant.mass_scale": 1.1}, {"admittance.damping": 3.3}, {"estimator.push_bandwidth": 30.0}


@pytest.fixture
def new_code(monkeypatch):
    """The code of any earlier test is forgotten in this process."""
    monkeypatch.setattr(plan, "LOOP_CODE", LastUsed(8))


def missions(name, *keys, **changes):
    """A block of flights that differ in their seeds, and in some keys: one set of keys after the other."""
    own = [keys[i % len(keys)] if keys else {} for i in range(LANES)]
    return [tl.load_mission(name, {**SHORT, **changes, "mission.seed": i, **own[i]}) for i in range(LANES)]


def starts(flown):
    return [FlightPlan(mission).start() for mission in flown]


def code_of(flown):
    """The code that a block of missions flies in."""
    code = FlightPlan(flown[0]).loop_code
    return code.loop(LANES, differ=code.parts_that_differ(starts(flown)))


def parts_of(code):
    """The parts of flights in which lanes of this code may differ."""
    return {name.partition(".")[0] for name in code.about["own"]}


def whole(flight, *parts):
    """All values in some parts of a flight, or in all of them."""
    values = FlightPlan(flight).loop_code.values
    return sorted(name for name in values if not parts or name.partition(".")[0] in parts)


def assert_as_alone(flown):
    for together, mission in zip(tl.fly_many(flown), flown, strict=True):
        assert different(together, tl.fly(mission)) == []


def test_of_a_part_in_which_flights_differ_only_the_values_that_do_are_no_scalars(new_code):
    flown = missions("iris", {}, HEAVY)
    assert_as_alone(flown)
    of_mass = {
        "plant.body",
        "plant.floor",
        "plant.floor.hull",
        "limits.strike",
    }  # with the inverse of a mass, or forces
    own = set(code_of(flown).about["own"])
    assert {name for name in own if not name.startswith("sensors")} == of_mass
    assert FlightPlan(flown[0]).loop_code.values.keys() >= own | {"plant.frame.mass", "pilot.controller"}


@pytest.mark.parametrize("name", ["gusts", "zigzag"])
def test_flights_of_other_seeds_alone_fly_in_a_block_with_the_bits_and_logs_of_flights_alone(name, new_code):
    flown = missions(name)
    assert_as_alone(flown)
    assert parts_of(code_of(flown)) == {"sensors"}


@pytest.mark.thorough
def test_five_quadrotors_whose_sets_are_loops_do_so_too(new_code):
    one = tl.load_mission("iris").vehicle.quadrotors[0].model_dump(mode="json", exclude_none=True)
    places = [{**one, "position": [0.0, y, 0.075]} for y in (-1.6, -0.8, 0.0, 0.8, 1.6)]
    flown = missions("rotor-loss", **{"vehicle.quadrotors": places, "mission.duration": 0.5})
    assert_as_alone(flown)
    assert parts_of(code_of(flown)) == {"sensors"}


def test_a_bit_is_a_difference_even_of_zero():
    flown = missions("paper")
    code, (one, *others) = FlightPlan(flown[0]).loop_code, starts(flown)
    assert code.parts_that_differ([one, *others]) == set()
    at = int(np.flatnonzero(one.numbers == 0.0)[-1])  # of the plant
    other = one._replace(numbers=one.numbers.copy())
    other.numbers[at] = -0.0
    assert code.parts_that_differ([one, *others, other]) == {
        next(name for name, places in code.values.items() if at in places)
    }
    assert all(name.startswith("plant.") for name in code.parts_that_differ([one, *others, other]))


@pytest.mark.thorough
def test_a_block_keeps_its_scalars_until_a_lane_differs_and_every_lane_flies_on_with_its_bits(new_code):
    name, lanes = "iris", 2 * LANES
    flight = tl.load_mission(name, SHORT)
    block = tl.Block(flight, lanes)
    differ = "limits", "plant", "pilot", "finding_limits"
    sims = [tl.Simulation(tl.load_mission(name, {**SHORT, "mission.seed": i})) for i in range(lanes)]

    def step(steps):
        block.step(np.full((lanes, 3), 0.3), steps=steps)
        for i, sim in enumerate(sims):
            sim.step(push=[0.3] * 3, steps=steps)
            np.testing.assert_array_equal(block.state[i], sim.state, err_msg=f"lane {i}")

    def reset(places, keys):
        block.reset(places, keys=keys)
        for i in places:
            sims[i] = tl.Simulation(tl.load_mission(name, {**SHORT, "mission.seed": i, **keys}))

    step(210)
    reset(range(lanes), HEAVY)  # all alike again
    step(150)
    assert parts_of(block._memory.code) == {"sensors"}
    reset([2], SOFT)
    step(250)
    assert block._memory.code.about["own"] == whole(flight, "sensors", *differ)
    reset([9], SMOOTH)
    step(60)
    assert block._memory.code.about["own"] == whole(flight)
    reset([9], {})
    step(140)
    reset([1], {**HEAVY, **SOFT})
    assert block.metrics(1)["steps"] == 0
    step(77)
    for channel in block.channels:
        np.testing.assert_array_equal(block[channel], [sim[channel] for sim in sims], err_msg=channel)
