"""Limits of a flight and checks before it: each at its limit, and only where it applies."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tandemlift.core.faults import CHECKS
from tandemlift.core.phases import CONTACT, GUIDED, HOLD, IDLE, LAND, LIFT, LIMITED, STOPPED
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Quat, Vec3
from tandemlift.parts.guidance.fault_detection import (
    NO_TIME,
    Fence,
    SupervisionLimits,
    active_faults,
    distance_outside,
    update_timers,
)
from tandemlift.parts.guidance.preflight_checks import (
    PreflightChecks,
    SensorStatus,
    failed_guidance_check,
    failed_lift_check,
)
from tandemlift.parts.guidance.requests import VehicleStatus
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.health import WELL

DT, MASS, AVAILABLE = 0.01, 3.0, 60.0
PHASES = (IDLE, LIFT, GUIDED, HOLD, LAND, STOPPED, CONTACT, LIMITED)
IN_FLIGHT = {LIFT, GUIDED, HOLD, LAND, CONTACT, LIMITED}
BOUNDS = SupervisionLimits(0.9, np.cos(0.5), 3.0, 0.4, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.1)
FENCE = Fence(Vec3(-2.0, -1.0, 0.0), Vec3(2.0, 1.0, 3.0), 0.25, 1.0)
SENSORS = SensorStatus(WELL, 0.0, 1.0, 1.0)
STATUS = VehicleStatus(0.0, 30.0, 0.0)
REST = State(Vec3(0.0, 0.0, 1.0), ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)


def tilted(angle):
    q = Rotation.from_rotvec([0.6 * angle, 0.8 * angle, 0.0]).as_quat(scalar_first=True)
    return REST._replace(attitude=Quat(*q.tolist()))


def timers(phase=GUIDED, seconds=1.0, sensors=SENSORS, state=REST, status=STATUS, error=ZERO, thrust=0.5):
    """The timers after seconds of the same."""
    found = NO_TIME
    for _ in range(round(seconds / DT)):
        found = update_timers(BOUNDS, found, sensors, state, status, error, thrust, phase, DT)
    return found


EXCEEDED = {  # what exceeds a limit by a little, what does not yet, and in which phases it counts
    "joints": ({"sensors": SENSORS._replace(joints_inconsistent=1.0)}, {}, set(PHASES)),
    "thrust": ({"thrust": 0.901}, {"thrust": 0.9}, IN_FLIGHT - {LAND}),
    "tilt": ({"state": tilted(0.501)}, {"state": tilted(0.499)}, IN_FLIGHT),
    "rates": (
        {"state": REST._replace(rates=Vec3(2.0, -2.0, 1.001))},
        {"state": REST._replace(rates=Vec3(2.0, -2.0, 0.999))},
        IN_FLIGHT,
    ),
    "tracking_error": ({"error": Vec3(0.0, 0.241, 0.32)}, {"error": Vec3(0.0, 0.239, 0.32)}, IN_FLIGHT - {LAND}),
    "state": ({"status": STATUS._replace(state_invalid=1.0)}, {}, set(PHASES)),
    "touchdown": ({"error": Vec3(0.0, 0.0, -0.101)}, {"error": Vec3(0.0, 0.0, -0.099)}, {LAND}),
}


@pytest.mark.parametrize("name", list(EXCEEDED))
@pytest.mark.parametrize("phase", PHASES)
def test_a_timer_counts_while_its_limit_is_exceeded_where_it_applies_and_no_other_does(name, phase):
    beyond, within, counts = EXCEEDED[name]
    found = timers(phase, **beyond)
    wanted = NO_TIME._replace(**{name: pytest.approx(1.0)}) if phase in counts else NO_TIME
    assert found == wanted
    assert timers(phase, **within) == NO_TIME
    again = update_timers(BOUNDS, found, SENSORS, REST, STATUS, ZERO, 0.5, phase, DT)
    assert again == NO_TIME


def faults(phase=GUIDED, state=REST, status=STATUS, report=WELL, times=NO_TIME):
    found = active_faults(BOUNDS, FENCE, SENSORS._replace(report=report), times, state, status, phase)
    return {key: value for key, value in found._asdict().items() if value}


@pytest.mark.parametrize(
    ("name", "timer", "limit"),
    [
        ("joints_inconsistent", "joints", BOUNDS.joints_time),
        ("thrust", "thrust", BOUNDS.thrust_time),
        ("tilt", "tilt", BOUNDS.tilt_time),
        ("rates", "rates", BOUNDS.rates_time),
        ("tracking_error", "tracking_error", BOUNDS.tracking_error_time),
        ("state", "state", BOUNDS.invalid_state_time),
    ],
)
def test_a_limit_is_a_fault_once_its_time_is_over(name, timer, limit):
    assert faults(times=NO_TIME._replace(**{timer: limit})) == {}
    assert faults(times=NO_TIME._replace(**{timer: limit + 1e-9})) == {name: 1.0}


@pytest.mark.parametrize("phase", PHASES)
def test_a_vehicle_outside_its_fence_is_a_fault_while_it_hovers(phase):
    for position, over in (
        ((2.26, 0.0, 1.0), 0.26),
        ((0.0, -1.3, 1.0), 0.3),
        ((2.4, 0.0, 3.3), 0.4),
        ((0.0, 0.0, -0.2), 0.2),
    ):
        state = REST._replace(position=Vec3(*position))
        assert distance_outside(FENCE.low, FENCE.high, state.position) == pytest.approx(over)
        hovers = phase in {GUIDED, HOLD, CONTACT, LIMITED}
        assert faults(phase, state) == ({"fence": 1.0} if hovers and over > FENCE.margin else {})
    assert distance_outside(FENCE.low, FENCE.high, Vec3(1.0, 0.5, 2.0)) == pytest.approx(-0.5)


def test_orientation_is_lost_without_attitude_and_without_rates():
    for lost in ({"attitude": 1.0}, {"motion": 1.0}, {"gyroscope": 1.0}, {"imu": 1.0}):
        assert faults(report=WELL._replace(**lost)) == lost
    for attitude in ("attitude", "motion"):
        for rates in ("gyroscope", "imu"):
            both = {attitude: 2.0, rates: 3.0}
            assert faults(report=WELL._replace(**both)) == both | {"orientation": 1.0}
    assert faults(status=STATUS._replace(rotor_failed=1.0, limited=4.0)) == {"rotor": 1.0, "limited": 4.0}


PREFLIGHT = PreflightChecks(0.8, np.cos(0.2), 0.3, 0.5, 0.5, 2.0)
SENSOR_NAMES = ("joints", "accelerometer", "gyroscope", "position", "velocity", "attitude")
NUMBERS = {(check.before, check.key): float(check.number) for check in CHECKS}


def lift(sensors=SENSORS, state=REST, status=STATUS, mass=MASS, reaction=0.0):
    return failed_lift_check(PREFLIGHT, sensors, state, status, mass, reaction, AVAILABLE)


def reporting(**report):
    return {"sensors": SENSORS._replace(report=WELL._replace(**report))}


@pytest.mark.parametrize(
    ("check", "fails"),
    [
        ("imu", reporting(imu=1.0)),
        ("motion", reporting(motion=1.0)),
        ("imu", reporting(seen=0.0)),
        *[("sensors", reporting(**{name: 1.0})) for name in SENSOR_NAMES],
        ("sensors", {"sensors": SENSORS._replace(joints_inconsistent=1.0)}),
        ("sensors", {"status": STATUS._replace(state_invalid=1.0)}),
        ("sensors", {"reaction": 1.0}),
        ("hover", {"mass": 0.801 * AVAILABLE / GRAVITY}),
        ("level", {"state": tilted(0.201)}),
        ("rest", {"state": REST._replace(velocity=Vec3(0.2, 0.2, 0.11))}),
        ("rest", {"state": REST._replace(rates=Vec3(0.3, 0.41, 0.0))}),
        ("rotors", {"status": STATUS._replace(rotor_failed=1.0)}),
    ],
)
def test_each_check_before_a_lift_fails_beyond_its_limit(check, fails):
    assert lift(**fails) == NUMBERS["lift", check]


def test_a_vehicle_within_all_limits_may_lift_and_the_first_check_that_fails_is_told():
    assert lift() == 0.0
    assert lift(mass=0.799 * AVAILABLE / GRAVITY) == lift(state=tilted(0.199)) == 0.0
    near = REST._replace(velocity=Vec3(0.2, 0.2, 0.09), rates=Vec3(0.3, 0.39, 0.0))
    assert lift(state=near) == 0.0
    assert lift(mass=6.0, **reporting(motion=1.0)) == NUMBERS["lift", "motion"]
    assert lift(mass=6.0, state=tilted(0.5)) == NUMBERS["lift", "hover"]


@pytest.mark.parametrize(
    ("check", "fails"),
    [
        (None, {"payload": 0.5}),
        (None, {"payload": 2.0}),
        ("tare", {"tared": 0.0}),
        ("payload", {"payload": 0.499}),
        ("payload", {"payload": 2.001}),
        ("joints", {"joints_inconsistent": 1.0}),
        ("tare", {"tared": 0.0, "payload": 9.0}),
    ],
)
def test_each_check_before_pushes_are_followed_fails_beyond_its_limit(check, fails):
    wanted = NUMBERS["guided", check] if check else 0.0
    assert failed_guidance_check(PREFLIGHT, SENSORS._replace(**fails)) == wanted
