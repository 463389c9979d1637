"""The built-in missions with real rotors, sensors and a floor end standing on it, and show what they are there for."""

import numpy as np
import pytest

import tandemlift as tl

NAMES = ["gusts", "heavy-payload", "iris", "off-centre-push", "rotor-loss"]


@pytest.fixture(scope="module")
def flown():
    """Flights of the built-in missions by name, each flown once."""
    kept = {}

    def fly(name):
        if name not in kept:
            kept[name] = tl.fly(tl.load_mission(name))
        return kept[name]

    return fly


def hovering(flight):
    """The samples after the tare and before the landing."""
    estimator, phases = flight.mission["estimator"], flight.mission["phases"]
    return (flight.time > estimator["tare_start"] + estimator["tare_duration"]) & (flight.time < phases["land_start"])


def error_of_push(flight):
    """Estimated less true push [N], in hover."""
    return (flight["push_estimate"] - flight["push_force"])[hovering(flight)]


@pytest.mark.parametrize("name", NAMES)
def test_it_ends_standing_on_the_floor_with_its_rotors_stopped(name, flown):
    flight = flown(name)
    weight = 9.81 * 3.5 * flight.mission["plant"]["mass_scale"]
    assert flight.ending is None
    assert np.degrees(np.abs(flight["euler"][-1, :2])).max() < 1.0
    landing = flight.time > flight.mission["phases"]["land_start"]
    assert np.degrees(np.ptp(np.unwrap(flight["euler"][landing, 2]))) < 3.0  # where the hand has turned it to
    assert np.abs(flight["velocity"][-1]).max() < 1e-3
    assert flight["position"][-1, 2] == pytest.approx(flight["position"][0, 2], abs=1e-3)
    assert flight["contact_force"][-1, 2] == pytest.approx(weight, rel=0.02)
    assert flight["rotor_thrusts"][-1].max() < 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_it_touches_down_softly_and_upright(name, flown):
    flight = flown(name)
    landing = flight.time > flight.mission["phases"]["land_start"]
    first = np.flatnonzero(landing & (flight["contact_force"][:, 2] > 0.0))[0] - 1
    assert -0.15 < flight["velocity"][first, 2] < 0.0
    assert np.degrees(np.abs(flight["euler"][first, :2])).max() < 5.0


@pytest.mark.parametrize("name", NAMES)
def test_the_pilot_s_estimate_is_good_enough_to_fly_by(name, flown):
    flight = flown(name)
    assert np.abs(flight["estimated_position"] - flight["position"]).max() < 0.01
    assert np.abs(flight["estimated_velocity"] - flight["velocity"]).max() < 0.05
    assert flight["push_usable"][hovering(flight)].all()
    if name != "gusts":
        assert np.abs(error_of_push(flight)).max() < 0.3  # the threshold of the gate


def test_the_payload_s_mass_is_found_and_pushes_are_read_aright(flown):
    flight = flown("heavy-payload")
    assert flight["payload_mass_estimate"][0] == 0.5
    assert flight["payload_mass_estimate"][-1] == pytest.approx(0.8, abs=0.09)  # two joints' bias of 0.3 N over g, 2 σ
    assert np.sqrt(np.mean(error_of_push(flight) ** 2)) < 0.08


def test_where_the_beam_is_pushed_is_found(flown):
    flight = flown("off-centre-push")
    for push in flight.mission["pushes"]:
        at = np.abs(flight.time - push["time"]) < push["sigma"]
        assert flight["push_point_estimate"][at] == pytest.approx(push["point"][1], abs=0.12)
        assert flight["push_point_estimate"][at].mean() == pytest.approx(push["point"][1], abs=0.05)
    assert np.abs(flight["moment"][hovering(flight), 2]).max() < 1.33  # what the rotors can give about z


def test_wind_across_the_beam_feels_like_a_hand_and_wind_along_it_does_not(flown):
    flight = flown("gusts")
    withheld = flight["push_withheld"][hovering(flight)]
    x, y, _ = np.sqrt(np.mean((error_of_push(flight) + withheld) ** 2, axis=0))
    assert x > 0.3 > 0.1 > y
    confirmed, _, _ = np.sqrt(np.mean(error_of_push(flight) ** 2, axis=0))
    assert confirmed < 0.6 * x
