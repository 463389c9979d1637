"""What the joints carry in flight, against Newton and Euler, and the person's push that is read out of it."""

import numpy as np
from scipy.spatial.transform import Rotation
from storm import DT, UNIT, calm

import tandemlift as tl
from tandemlift.core.types import GRAVITY

EVERY = {"mission.log_interval": DT}
KNOWN = UNIT + 1  # steps from a reading to the row in which the pilot has it


def rotations(q):
    """Body to world."""
    return Rotation.from_quat(np.roll(q, -1, axis=1))


def joints(flight, name):
    """A channel of the joints as (T, N, 3)."""
    return flight[name].reshape(len(flight.time), -1, 3)


PUSHED = {
    **EVERY,
    "mission.duration": 8.0,
    "vehicle.drag.force": 0.0,
    "vehicle.drag.moment": 0.0,
    "phases.lift_start": 0.5,
    "phases.lift_duration": 1.5,
    "pushes": [
        {"force": [2.0, 1.0, -1.5], "time": 3.0, "sigma": 0.2, "point": [0.0, 0.4, -0.0642857]},
        {"force": [-1.0, 1.5, 1.0], "time": 5.0, "sigma": 0.3, "point": [0.0, -0.5, -0.0642857]},
    ],
}


def test_joints_push_and_gravity_make_the_motion_of_the_payload():
    """Finite differences of the recorded velocities know nothing of the joints; their error is jerk × dt/2."""
    flight = tl.fly(tl.load_mission("flight-ready", PUSHED))
    vehicle = tl.Vehicle.from_settings(tl.load_mission("flight-ready").vehicle)
    payload, r = vehicle.payload, -vehicle.center_of_mass
    R, w = rotations(flight["attitude"]), flight["rates"]
    velocity = flight["velocity"] + R.apply(np.cross(w, r))
    acceleration, angular = np.diff(velocity, axis=0) / DT, np.diff(w, axis=0) / DT
    force, torque = joints(flight, "joint_force"), joints(flight, "joint_torque")
    on_payload = R.apply(force.sum(axis=1)) + flight["push_force"] - [0.0, 0.0, payload.mass * GRAVITY]
    error = on_payload[:-1] - payload.mass * acceleration
    assert np.abs(acceleration).max() > 1.0
    assert np.abs(error).max() < 5e-3  # N
    arms = np.array([q.joint_position for q in vehicle.quadrotors])
    at_payload = (torque + np.cross(arms, force)).sum(axis=1)
    pushed = flight["push_moment"] - np.cross(r, R.inv().apply(flight["push_force"]))
    J, at_start = np.array(payload.moments), w[:-1]
    turning = J * angular + np.cross(at_start, J * at_start)
    assert np.abs(turning).max() > 0.1
    assert np.abs((at_payload + pushed)[:-1] - turning).max() < 5e-3  # N m


CALM = {
    **EVERY,
    "pushes": [  # exactly zero until the tare is over at 2.4 s
        {"force": [2.0, 1.0, -1.0], "time": 2.9, "sigma": 0.05, "point": [0.0, 0.6, -0.06]},
        {"force": [-1.0, 0.5, 1.0], "time": 3.3, "sigma": 0.09, "point": [0.02, -0.4, -0.06]},
    ],
}


def measured_and_true(flight):
    """The push as measured and as it is, of the same steps, each in the body axes that it was taken in."""
    believed, truth = rotations(flight["estimated_attitude"]), rotations(flight["attitude"])
    measured = believed[:-KNOWN].inv().apply(flight["push_measured"][KNOWN:])
    return measured, truth[:-KNOWN].inv().apply(flight["push_force"][:-KNOWN])


def test_perfect_sensors_measure_the_push_as_soon_as_their_delay_allows():
    """Standing, lifting off, flying and landing: the floor acts on the quadrotors and is no push."""
    flight = tl.fly(calm(CALM))
    measured, true = measured_and_true(flight)
    assert flight.ending is None
    assert np.sum(flight["contact_force"][:, 2] > 1.0) > 300
    assert np.abs(true).max() > 1.5
    assert np.abs(measured - true).max() < 1e-9  # N
