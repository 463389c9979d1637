"""Nobody pushes, and the vehicle stays: no error of a sensor and no wind passes for a hand. A real hand is followed."""

import numpy as np
import pytest
from hands import gusts, steady
from validation.scenarios import drawn

import tandemlift as tl
from tandemlift.core.phases import IDLE, LAND

HOVER, AWAY = 12.5, 1.0  # s, m


def fault(sensor, size, time=15.0, **more):
    """A bias of a size along each axis, or along given ones."""
    sizes = size if isinstance(size, list) else [size] * 3
    return {"sensor_faults": [{"sensor": sensor, "kind": "bias", "time": time, "size": sizes, **more}]}


FALSE = {  # on top of mission iris, without a push
    "joints": fault("joints", 0.5),
    "joints, supervised": {**fault("joints", 0.5), "supervision.model": "on"},
    "joints, upwards": fault("joints", -1.0),
    "joints, little": fault("joints", -0.2, 13.0),
    "joints, for a while": fault("joints", 0.6, 25.0, until=40.0),
    "one joint": fault("joints", 0.8, quadrotor=1),
    "accelerometer": fault("accelerometer", 2.0),
    "accelerometer, downwards": fault("accelerometer", -1.0, 30.0),
    "drift of the accelerometer": {"sensors.accelerometer.drift": 0.2},
    "drift of the joints": {"sensors.joints.force_drift": 0.2},
    "drift of the torques": {"sensors.joints.torque_drift": 0.05},
    "gust that stays": gusts(([2.0, 0.0, 0.0], 20.0, 0.5)),
    "gust": gusts(([4.0, 0.0, 0.0], 20.0, 0.5, 2.0)),
    "gust over the tare": gusts(([2.0, 0.0, 0.0], 8.0, 0.5, 6.0)),
    "light gust": gusts(([1.6, 0.0, 0.0], 25.0, 1.0)),
    "gust from below": gusts(([0.0, 0.0, 2.0], 20.0, 0.5)),
    "gusts one after the other": gusts(
        ([3.4, -3.6, 0.0], 17.6, 1.0, 6.2), ([-1.5, 3.4, 1.1], 42.2, 0.5), ([1.9, -2.5, 0.0], 31.5, 1.0)
    ),
}
SPARSE = {"mission.log_interval": 0.05}  # s: a few logs in memory, not hundreds of megabytes of them
QUIET = {"pushes": [], **SPARSE}


@pytest.fixture(scope="module")
def flights():
    """Flights without a push by name, and with none of the errors: "calm"."""
    missions = [tl.load_mission("iris", {**QUIET, **changes}) for changes in ({}, *FALSE.values())]
    return dict(zip(("calm", *FALSE), tl.fly_many(missions, keep="flights"), strict=True))


def away(flight):
    """The largest distance per axis from where it hovered, until it touches down; a landing may go down."""
    p, phase = flight["position"], flight["phase"][:, 0] if flight["phase"].ndim > 1 else flight["phase"]
    off = p - p[np.searchsorted(flight.time, HOVER)]
    off[:, 2] = np.where((phase == LAND) | (phase == IDLE), np.maximum(off[:, 2], 0.0), off[:, 2])
    aloft = (flight.time >= HOVER) & (p[:, 2] > p[0, 2] + 0.01)
    return np.abs(off[aloft]).max(axis=0)


def of_kind(flight, kind):
    return [f for f in flight.findings if f.kind == kind]


@pytest.mark.thorough
@pytest.mark.parametrize("name", FALSE)
def test_where_nobody_pushes_the_vehicle_stays_where_it_hovers(flights, name):
    assert away(flights[name]).max() < AWAY
    assert flights[name].outcome == "landed"


@pytest.mark.thorough
def test_it_stays_whatever_else_the_sensors_err_by_and_however_long_its_joints_drift():
    names = ("joints", "accelerometer", "gust that stays", "gust over the tare")
    drifts = [(0.05, 109), (0.05, 111), (0.2, 111), (0.2, 147)]
    cases = {name: {**FALSE[name], "mission.seed": 3} for name in names}
    cases |= {f"drift {d}, seed {s}": {"sensors.joints.force_drift": d, "mission.seed": s} for d, s in drifts}
    flights = tl.fly_many([tl.load_mission("iris", {**QUIET, **changes}) for changes in cases.values()])
    assert {name: a for name, f in zip(cases, flights, strict=True) if (a := away(f).max()) > AWAY} == {}


@pytest.mark.thorough
def test_a_gust_on_the_quadrotors_against_a_push_does_not_end_it():
    chance = np.random.default_rng(4)
    gusty = [drawn(chance, number) for number in range(13)][12]  # 1.8 N of gust while a hand pushes with 2.3 N
    flight = tl.fly(gusty)
    late = flight.time > 10.0
    assert np.sqrt((flight["position_error"][late, 2] ** 2).mean()) < 3e-3
    assert np.linalg.norm(flight["push_withheld"][late], axis=1).max() < 1.5


def test_it_stays_as_the_wind_goes_though_the_joints_have_drifted_by_what_it_shows_on_the_quadrotors():
    over_tare = {**QUIET, **FALSE["gust over the tare"]}
    flights = tl.fly_many([tl.load_mission("iris", {**over_tare, "mission.seed": seed}) for seed in (26, 58)])
    assert [a for f in flights if (a := away(f).max()) > AWAY] == []


@pytest.mark.thorough
def test_without_confirmation_a_finding_has_the_distance_by_which_the_reference_moved(flights):
    flight = tl.fly(tl.load_mission("iris", {"pushes": [], **FALSE["joints"], "estimator.confirmation": "none"}))
    (found,) = of_kind(flight, "response-without-push")
    moved = np.linalg.norm(flight["admittance_position"] - flight["admittance_position"][0], axis=1)
    assert found.value == pytest.approx(moved[flight.time <= found.time + found.duration].max(), rel=0.01)
    assert found.time == pytest.approx(flight.time[np.argmax(moved > 0.1)], abs=0.02)
    assert found.limit == 0.1
    assert not of_kind(flights["calm"], "response-without-push")


def test_a_push_that_the_motion_refutes_is_told_with_its_size(flights):
    (found,) = of_kind(flights["joints, upwards"], "push-refuted")
    assert found.time == pytest.approx(15.0, abs=0.3)
    assert found.value == pytest.approx(2.0 * np.sqrt(3.0), rel=0.15)  # two joints, three axes
    assert not of_kind(flights["calm"], "push-refuted")
    assert not of_kind(flights["gust that stays"], "push-refuted")


def test_a_joint_that_jumped_is_tared_again_within_seconds():
    jumped = {**fault("joints", 0.5), "pushes": steady([0.0, 1.0, 0.0], 30.0, 10.0)}
    sound = {"pushes": jumped["pushes"]}
    a, b = tl.fly_many([tl.load_mission("iris", x) for x in (jumped, sound)], keep="flights")
    moved = [flight["position"][-1, 1] - flight["position"][np.searchsorted(flight.time, 29.0), 1] for flight in (a, b)]
    assert moved[1] > 3.5
    assert moved[0] == pytest.approx(moved[1], rel=0.2)  # up to 0.15 N of the error are left


def test_a_push_of_one_newton_is_followed_for_half_a_minute():
    directions = np.array([(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)])
    calm = {"phases.land_start": 60.0, "mission.duration": 45.0}
    missions = [tl.load_mission("iris", {"pushes": steady(direction), **calm}) for direction in directions]
    for direction, flight in zip(directions, tl.fly_many(missions), strict=True):
        along = flight["velocity"] @ direction
        part = (flight.time > 20.0) & (flight.time < 44.5)
        speed = 0.7 / 1.6  # beyond the threshold of 0.3 N, over the damping
        assert along[part].min() > 0.6 * speed
        assert along[part].mean() == pytest.approx(speed, rel=0.15)


@pytest.mark.thorough
def test_a_hand_is_followed_closer_to_its_true_push_than_without_confirmation():
    how = {"motion": {}, "none": {"estimator.confirmation": "none"}, "truth": {"pilot.push": "truth"}}
    many = [tl.load_mission("iris", {**c, "mission.seed": seed}) for c in how.values() for seed in range(8)]
    metrics = tl.fly_many(many, keep="metrics")
    ends = dict(zip(how, np.array([m["final_position_m"] for m in metrics]).reshape(3, 8, 3), strict=True))
    far = {name: np.linalg.norm(ends[name] - ends["truth"], axis=1) for name in ("motion", "none")}
    assert np.median(far["motion"]) < 0.7 * np.median(far["none"])
    assert far["motion"].max() < 0.4  # of nearly 9 m
    assert not metrics[0]["findings"]


def test_a_push_of_little_more_than_half_a_newton_is_felt_within_55_milliseconds():
    pushes = steady([0.6, 0.0, 0.0], 15.0, 2.0, 0.01)
    flight = tl.fly(
        tl.load_mission("iris", {"pushes": pushes, "mission.log_interval": 0.001, "mission.duration": 16.0})
    )
    active = flight.time[np.argmax(flight["push_active"][:, 0] > 0.0)]
    assert 15.0 < active < 15.055


def test_what_is_withheld_and_what_is_used_are_the_measured_push(flights):
    """The push by NumPy from the logged readings, less its mean over the tare, at the same time constants."""
    flight = flights["joints, upwards"]
    joints, s = flight["measured_joint_force"], flight["measured_specific_force"]
    joints = joints.reshape(len(joints), 2, 3).sum(axis=1)
    mass = flight["payload_mass_estimate"][-1]
    raw = mass * s - joints
    tare, late = (flight.time > 9.0) & (flight.time < 12.0), flight.time > 20.0
    late &= flight.time < 65.0
    expected = (raw - raw[tare].mean(axis=0))[late].mean(axis=0)
    assert expected == pytest.approx([2.0, 2.0, 2.0], abs=0.1)
    both = (flight["push_estimate"] + flight["push_withheld"])[late].mean(axis=0)
    assert both == pytest.approx(expected, abs=0.03)
