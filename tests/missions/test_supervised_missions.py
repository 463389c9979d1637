"""Requests and failing sensors in a mission: what is taken, and how it starts."""

from tandemlift.missions import load_mission
from tandemlift.parts.guidance.requests import start_requests

BY_HAND = {"pilot.guidance": "interactive"}
FROZEN = {"sensor": "gyroscope", "kind": "frozen", "time": 5.0}


def test_two_joints_may_fail_each_on_its_own_and_a_device_be_silent_besides():
    joint = {"sensor": "joints", "kind": "frozen", "time": 5.0}
    faults = [
        {**joint, "quadrotor": 1},
        {**joint, "quadrotor": 2, "time": 6.0},
        {**FROZEN, "sensor": "imu", "kind": "stale"},
    ]
    assert len(load_mission("iris", {"sensor_faults": faults}).sensor_faults) == 3


def asked(*requests):
    told = [{"time": t, "action": a} for t, a in requests]
    return start_requests(load_mission("iris", {**BY_HAND, "requests": told}).requests)


def test_it_starts_disabled_if_enable_is_asked_first_and_else_enabled():
    assert asked((1.0, "enable")).enabled == 0.0
    assert asked((1.0, "disable"), (2.0, "enable")).enabled == 1.0
    assert asked((1.0, "lift")).enabled == 1.0


def test_whatever_is_asked_the_vehicle_is_enabled_or_not():
    r = asked((1.0, "disable"), (2.0, "disable"), (3.0, "enable"), (4.0, "land"), (5.0, "enable"))
    levels = [r.enabled + sum(c for t, c in zip(r.time, r.change, strict=True) if t <= now) for now in range(7)]
    assert levels == [1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]
