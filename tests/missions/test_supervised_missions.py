"""Supervision, requests and failing sensors in a mission: what is refused, and how it says so."""

import pytest

import tandemlift as tl
from tandemlift.missions import load_mission
from tandemlift.parts.interaction.requests import start_requests

BY_HAND = {"pilot.guidance": "interactive"}
WATCHED = {**BY_HAND, "supervision.model": "on"}
BY_CLOCK = {"pilot.guidance": "scheduled"}
FROZEN = {"sensor": "gyroscope", "kind": "frozen", "time": 5.0}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({**BY_CLOCK, "supervision.model": "on"}, 'supervision.model = "on": must be "none"'),
        ({**BY_CLOCK, "requests": [{"time": 1.0, "action": "land"}]}, 'requests.0.action = "land": must be left out'),
        ({**BY_CLOCK, "estimator.tare": "hover"}, 'estimator.tare = "hover": must be "at-time"'),
        ({**BY_HAND, "requests": [{"time": 1.0, "action": "jump"}]}, 'requests.0.action = "jump": must be'),
        (
            {"sensors.model": "none", "pilot": {"state": "truth", "push": "truth"}, "sensor_faults": [FROZEN]},
            "sensors.model",
        ),
        ({"sensor_faults": [FROZEN, FROZEN]}, "fails already in sensor_faults.0"),
        ({"sensor_faults": [FROZEN, {**FROZEN, "sensor": "imu", "kind": "nan"}]}, "fails already in sensor_faults.0"),
        ({"sensor_faults": [{**FROZEN, "kind": "stale"}]}, "must be of a device"),
        ({"sensor_faults": [{**FROZEN, "sensor": "imu", "kind": "bias"}]}, "must be of a sensor"),
        ({"sensor_faults": [{**FROZEN, "quadrotor": 1}]}, 'unless the sensor is "joints"'),
        ({"sensor_faults": [{**FROZEN, "sensor": "joints", "quadrotor": 3}]}, "must be from 1 to 2"),
        ({"sensor_faults": [{**FROZEN, "until": 5.0}]}, "must be after sensor_faults.0.time"),
        ({**BY_HAND, "supervision": {"model": "on", "fence": {"low": 2.0, "high": 1.0}}}, "supervision.fence.low"),
        ({**WATCHED, "supervision.watchdog.stale_time": 0.004}, "supervision.watchdog.stale_time = 0.004"),
        ({**WATCHED, "supervision.checks.min_payload_ratio": 3.0}, "min_payload_ratio = 3.0"),
        (
            {**WATCHED, "crash.tilt": 0.9, "promise.tilt": 0.3},
            "crash.tilt = 0.9: must be above supervision.limits.tilt",
        ),
        ({**WATCHED, "crash.fence_margin": 0.2}, "crash.fence_margin = 0.2: must be at least supervision.fence.margin"),
        ({**WATCHED, "supervision.fence.low": [-9.0, -9.0, 1.5]}, "starts 1.47 m outside supervision.fence"),
    ],
)
def test_what_cannot_be_is_refused(changes, message):
    with pytest.raises(tl.InputError, match=r".") as refused:
        load_mission("iris", changes)
    assert message in str(refused.value)


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
