"""The pilot as an object gives the thrusts that it gives in a flight, measurement by measurement."""

import numpy as np
import pytest

import tandemlift as tl


def measurements(flight):
    """What the pilot read at every step of a flight that was logged at every step (T, 16)."""
    names = ("position", "velocity", "attitude", "rates", "push_force")
    return np.ascontiguousarray(np.hstack([flight[name] for name in names]))


@pytest.fixture(scope="module", params=["paper", "flight-ready"])
def flown(request):
    mission = tl.load_mission(request.param, {"mission.duration": 24.0, "mission.log_interval": 0.001})
    return mission, tl.fly(mission)


def test_it_gives_the_thrusts_of_the_flight_to_the_last_bit_and_again_after_a_reset(flown):
    mission, flight = flown
    pilot = tl.Pilot(mission)
    for _ in range(2):
        thrusts = np.array([pilot.step(x).copy() for x in measurements(flight)])
        assert np.array_equal(thrusts, flight["rotor_thrusts"])
        pilot.reset()


@pytest.mark.parametrize(
    "measurement", [np.zeros(15), np.zeros((1, 16)), np.zeros(16, dtype=np.float32), [0.0] * 16, None]
)
def test_what_is_no_measurement_is_refused(measurement):
    with pytest.raises(tl.InputError, match=r"must be a float64 array of shape \(16,\)"):
        tl.Pilot(tl.load_mission("hover")).step(measurement)


def test_by_hand_it_stops_its_rotors_for_good_when_asked():
    pilot, level = tl.Pilot(tl.load_mission("hover", {"pilot.guidance": "interactive"})), np.zeros(16)
    level[6] = 1.0
    assert pilot.step(level).sum() > 0.0
    assert not pilot.step(level, stop=True).any()
    assert not pilot.step(level, lift=True).any()
    pilot.reset()
    assert pilot.step(level, enabled=False).sum() > 0.0
