"""A rotor is lost in flight, found, and landed with."""

import numpy as np
import pytest

import tandemlift as tl

TIME = 14.0  # s, of the loss


def lost(quadrotor, rotor, time=TIME, **changes):
    fault = {"quadrotor": quadrotor, "rotor": rotor, "time": time}
    return tl.load_mission("rotor-loss", {"faults": [fault], "mission.log_interval": 0.002, **changes})


ROTORS = [(1, 1), (1, 2), (2, 3), (2, 4)]


@pytest.fixture(scope="module")
def flights():
    """Flights that lose a rotor each, and last one that loses none."""
    losses = [lost(quadrotor, rotor, **{"mission.seed": rotor}) for quadrotor, rotor in ROTORS]
    return tl.fly_many([*losses, lost(1, 1, time=1e6)])


@pytest.fixture(params=range(len(ROTORS)), ids=lambda i: "quadrotor {} rotor {}".format(*ROTORS[i]))
def flown(request, flights):
    quadrotor, rotor = ROTORS[request.param]
    return 4 * (quadrotor - 1) + rotor, flights[request.param]


def test_it_is_named_rightly_and_once_within_100_ms(flown):
    number, flight = flown
    m = flight.metrics()
    assert m["rotor_failure_detections"] == 1.0
    assert 0.0 < m["rotor_failure_detection_delay_s"] < 0.1
    assert set(flight["failed_rotor"]) == {0.0, float(number)}
    named = flight.time[np.argmax(flight["failed_rotor"] > 0.0)]
    assert named == pytest.approx(TIME + m["rotor_failure_detection_delay_s"], abs=0.003)


def test_no_thrust_is_asked_of_it_once_it_was_tried_again(flown):
    number, flight = flown
    after = flight.time > TIME + flight.metrics()["rotor_failure_detection_delay_s"] + 0.21
    assert not flight["rotor_commands"][after, number - 1].any()
    assert flight["rotor_commands"][after].any(axis=0).sum() == 7


def test_seven_rotors_carry_it_to_the_floor_where_it_was_and_softly(flown):
    _, flight = flown
    assert flight.ending is None
    before = np.searchsorted(flight.time, TIME)
    touch = before + np.flatnonzero(np.abs(flight["contact_force"][before:, 2]) > 0.0)[0]
    way = slice(before, touch)
    away = np.hypot(*(flight["position"][way, :2] - flight["position"][before, :2]).T)
    assert away.max() < 0.3
    assert np.hypot(*flight["euler"][touch - 1, :2]) < np.radians(8.0)
    assert -flight["velocity"][touch - 1, 2] < 0.5
    assert flight["position"][way, 2].max() < flight["position"][before, 2] + 0.1
    assert flight["phase"][-1] == 0.0


def test_what_the_rotor_gave_is_not_taken_for_wind(flown):
    _, flight = flown
    held = (flight.time > TIME) & (flight.time < TIME + 2.0)
    off = flight["disturbance_force"][held] - flight["disturbance_force"][held][0]
    assert np.abs(off[:, 2]).max() < 2.0  # N; it gave 4.3


def test_without_a_loss_none_is_named_and_nothing_makes_it_land_before_its_time(flights):
    flight = flights[-1]
    assert flight.metrics()["rotor_failure_detections"] == 0.0
    assert flight.metrics()["rotor_failure_detection_delay_s"] is None
    assert set(flight["phase"][(flight.time > 7.0) & (flight.time < 20.0)]) == {2.0}
    assert flight["phase"][-1] == 0.0
