"""Flights without force sensors: a hand is followed by an observer of the external wrench."""

from __future__ import annotations

import numpy as np
import pytest

import tandemlift as tl

WITHOUT = {"sensors.joints.model": "none", "estimator.wrench": "kalman"}
AFTER_TARE, BEFORE_LANDING = 12.5, 69.0  # s


def lag_of(found, true, most=75):
    """The delay [ms] with which `found` agrees best with `true`; samples every 2 ms."""
    errors = [np.mean((found[k:] - true[: len(true) - k]) ** 2) for k in range(most)]
    return 2 * int(np.argmin(errors))


@pytest.fixture(scope="module")
def flights():
    logged = {**WITHOUT, "mission.log_interval": 0.002}
    return tl.fly_many([tl.load_mission("iris", {**logged, "actuators.delay": delay}) for delay in (0.01, 0.015)])


@pytest.fixture(params=[0, 1], ids=["delay as believed", "delay 5 ms more"])
def flown(request, flights):
    return flights[request.param]


def test_a_hand_guides_the_vehicle_without_force_sensors(flown):
    assert flown.metrics()["outcome"] == "landed"
    assert not flown.findings
    assert flown.metrics()["push_triggers_after_10s"] == 8  # as many as there are pushes
    assert np.max(flown.metrics()["position_rmse_after_10s_m"]) < 0.005


def test_force_and_moment_are_found_within_their_goals(flown):
    t = flown.time
    within = (t > AFTER_TARE) & (t < BEFORE_LANDING)
    force, true = flown["push_estimate"][within], flown["push_force"][within]
    rmse = np.sqrt(np.mean((force - true) ** 2, axis=0))
    assert np.all(rmse < [0.08, 0.07, 0.06])
    assert max(lag_of(force[:, axis], true[:, axis]) for axis in range(3)) <= 60
    moment = flown["push_moment_estimate"][within]  # of a push at the centre of mass: none
    assert np.all(np.sqrt(np.mean(moment**2, axis=0)) < 0.03)


def test_there_is_no_reading_of_joints_that_have_no_sensors(flown):
    assert "measured_joint_force" not in flown.channels
    assert "measured_specific_force" in flown.channels


def test_the_tare_without_joint_sensors_finds_an_excess_mass_and_leaves_no_force():
    heavy = tl.load_mission("iris", {**WITHOUT, "plant.mass_scale": 1.1, "mission.duration": 14.0, "pushes": []})
    flown = tl.fly(heavy)
    after = flown.time > AFTER_TARE
    assert flown["payload_mass_estimate"][-1] == pytest.approx(0.5 + 0.35, abs=0.02)
    assert np.abs(flown["push_estimate"][after].mean(axis=0)).max() < 0.1


@pytest.mark.thorough
def test_a_lost_rotor_is_named_beside_an_observer_and_landed_with():
    fault = {"quadrotor": 2, "rotor": 3, "time": 14.0}
    flight = tl.fly(tl.load_mission("rotor-loss", {**WITHOUT, "faults": [fault], "mission.log_interval": 0.01}))
    m = flight.metrics()
    assert m["outcome"] == "landed"
    assert set(flight["failed_rotor"]) == {0.0, 7.0}
    assert 0.0 < m["rotor_failure_detection_delay_s"] < 0.1
    held = (flight.time > 14.0) & (flight.time < 14.2)
    assert np.ptp(flight["position"][held, 2]) < 0.05
    assert np.abs(flight["push_estimate"][(flight.time > 15.0) & (flight.time < 17.0), 2]).max() < 0.3


@pytest.mark.thorough
@pytest.mark.parametrize("wrench", ["kalman", "fused"])
def test_a_hand_is_no_lost_rotor(wrench):
    """Pushes down at the ends of the beam leave thrust and roll as a lost rotor does, but not pitch and yaw."""
    hands = [
        {"force": [0.0, 0.0, -3.0], "point": [0.0, y, 0.0], "time": 14.0 + 5.0 * i, "sigma": 0.3}
        for i, y in enumerate((0.9, -0.9, 0.0))
    ]
    sensed = WITHOUT if wrench == "kalman" else {"estimator.wrench": wrench}
    changes = {**sensed, "pushes": hands, "detection.model": "residual", "mission.duration": 28.0}
    assert tl.fly(tl.load_mission("iris", changes)).metrics()["rotor_failure_detections"] == 0.0


@pytest.mark.thorough
def test_a_supervised_vehicle_without_joint_sensors_survives_a_lost_accelerometer():
    changes = {
        **WITHOUT,
        "supervision.model": "on",
        "sensor_faults": [{"sensor": "accelerometer", "kind": "frozen", "time": 20.0}],
        "mission.duration": 40.0,
    }
    assert tl.fly(tl.load_mission("iris", changes)).metrics()["outcome"].startswith("landed")


@pytest.mark.thorough
@pytest.mark.parametrize(("wrench", "part"), [("kalman", -1.0), ("fused", 1.0)])
def test_a_wall_is_told_from_a_hand_by_motion_and_thrusts(wrench, part):
    """A push leads the beam onto a post between the guards, or a guard onto a post in its way; nobody feels a wall."""
    y = 0.2 if part < 0.0 else 1.1
    hand = [{"force": [2.5, 0.0, 0.0], "time": 9.0 + 0.5 * i, "sigma": 0.5} for i in range(6)]
    changes = {
        **(WITHOUT if wrench == "kalman" else {}),
        "estimator.wrench": wrench,
        "person.model": "none",
        "corridor.centreline": [],
        "walls": [{"start": [1.5, y], "end": [2.0, y]}],
        "compliance.max_speed": [0.5, 0.5, 1.0],
        "pushes": hand,
        "mission.duration": 20.0,
        "mission.log_interval": 0.002,
    }
    flight = tl.fly(tl.load_mission("zigzag", {**changes, "pilot.map": "none"}))
    touched = flight.time[np.flatnonzero(flight["contact_force"][:, 0] < 0.0)]
    first = touched[touched > 8.0][0]
    told = np.flatnonzero(flight["contact_part"] != 0.0)
    assert 0.0 < flight.time[told[0]] - first < 0.03
    assert flight["contact_part"][told[0]] == part
    assert flight["contact_normal"][told[0], 0] < -0.8
    assert flight.time[told[-1]] < first + 5.0  # the hand leads it away again, or stops
    assert np.abs(flight["position"][flight.time > first + 2.0, 0]).max() < 1.6


@pytest.mark.parametrize(("wrench", "tare"), [("kalman", "hover"), ("fused", "at-time")])
def test_the_force_of_a_floor_is_no_bias_of_a_tare_that_a_landing_interrupts(wrench, tare):
    phases = {"lift_start": 0.1, "lift_duration": 1.0, "height": 0.3, "land_start": 100.0, "land_duration": 1.5}
    changes = {
        "estimator.wrench": wrench,
        **{"estimator.tare": tare, "estimator.tare_start": 2.4, "estimator.tare_duration": 3.5},
        **{f"phases.{key}": value for key, value in phases.items()},
        "requests": [{"time": 3.5, "action": "land"}, {"time": 6.5, "action": "lift"}],
        **{"pushes": [], "mission.duration": 14.0, "mission.log_interval": 0.01},
    }
    flight = tl.fly(tl.load_mission("iris", changes))
    usable, z = flight["push_usable"] > 0.0, flight["position"][:, 2]
    assert z[(flight.time > 5.8) & (flight.time < 6.5)] == pytest.approx(0.03, abs=0.001)  # it stands
    assert usable[-1]
    assert np.abs(flight["push_measured"][usable]).max() < 0.5
    assert z[-1] == pytest.approx(0.33, abs=0.01)


def test_a_schedule_takes_a_floor_neither_for_a_disturbance_nor_for_a_push():
    """The rotors run on the floor, before the lift and after the landing."""
    phases = {"lift_start": 2.0, "lift_duration": 1.0, "height": 0.3, "land_start": 4.0, "land_duration": 1.5}
    changes = {
        **{**WITHOUT, "pilot.guidance": "scheduled", "estimator.tare_start": 3.2, "estimator.tare_duration": 0.5},
        **{f"phases.{key}": value for key, value in phases.items()},
        **{"phases.rotors": "always", "actuators.start": "hover", "compliance.yaw.model": "held"},
        **{"pushes": [], "mission.duration": 8.0, "mission.log_interval": 0.01},
    }
    flight = tl.fly(tl.load_mission("iris", changes))
    before, t = flight.time < 2.0, flight.time
    assert not flight["disturbance_force"][before].any()
    assert np.abs(flight["push_measured"]).max() < 0.5
    assert np.abs(flight["admittance_position"]).max() < 0.01
    assert flight["position"][(t > 3.0) & (t < 4.0), 2] == pytest.approx(0.3, abs=0.02)
    assert flight["position"][(t < 2.0) | (t > 5.5), 2] == pytest.approx(0.03, abs=0.002)
