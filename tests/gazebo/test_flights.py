"""Whole flights in Gazebo beside the compiled engine: the same pilot, bodies that share no equation."""

import signal
import subprocess
import sys

import numpy as np
import pytest
from patience import ended, said, until
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.engines import gazebo

from .conftest import WINDY, runs

pytestmark = pytest.mark.gazebo
DT = 1e-3
HALF_MINUTE = {"mission.duration": 30.0, "mission.log_interval": DT}
OFF_CENTRE = {"pushes": [{"force": [1.0, 0.5, 0.0], "time": 4.0, "sigma": 0.5, "point": [0.0, 0.8, 0.0]}]}
EXACT = {
    **{"mission.duration": 9.0, "mission.log_interval": DT},
    **{"phases.lift_start": 0.5, "phases.lift_duration": 2.0, "phases.land_start": None},
    **{"estimator.tare_start": 3.0, "estimator.tare_duration": 1.0},
    **{"vehicle.drag.force": [0.0, 0.0, 0.0], "vehicle.drag.moment": [0.0, 0.0, 0.0]},
    **{"sensors.errors": "none", "sensors.joints.force_resolution": 0.0, "sensors.joints.torque_resolution": 0.0},
    "pushes": [
        {"force": [3.0, 0.0, 0.0], "time": 5.5, "sigma": 0.3},
        {"force": [1.0, 2.0, 1.5], "time": 7.5, "sigma": 0.3, "point": [0.0, 0.8, 0.0]},
    ],
}


def both(name, changes):
    mission = tl.load_mission(name, HALF_MINUTE | changes)
    return tl.fly(mission), tl.fly(mission, engine="gazebo")


def apart(a, b, name, part=slice(None)):
    return np.abs(a[name][part] - b[name][part]).max()


@pytest.mark.parametrize(
    ("name", "changes"),
    [("paper", {}), ("one-push", WINDY), ("one-push", OFF_CENTRE)],
    ids=["paper", "another vehicle in the wind", "a push off the centre"],
)
def test_half_a_minute_without_contact_is_the_same_in_both(name, changes):
    a, b = both(name, changes)
    assert a.ending is None
    assert b.ending is None
    settled = a.time > 0.1
    assert apart(a, b, "position") < 1e-5  # m
    assert apart(a, b, "attitude") < 1e-4
    assert apart(a, b, "joint_force", settled) < 0.05  # N
    assert apart(a, b, "joint_torque", settled) < 0.05  # N m
    assert b.version["engine"] == "gazebo"


def test_a_vehicle_stands_takes_off_and_flies_on_its_sensors_as_in_the_compiled_engine():
    a, b = both("iris", {"mission.duration": 20.0})
    standing = a.time < 1.9
    assert apart(a, b, "position", standing) < 1e-6  # m
    assert apart(a, b, "contact_force", standing) < 1e-3  # N
    left = [f.time[np.flatnonzero(f["contact_force"][:, 2] == 0.0)[0]] for f in (a, b)]
    assert left[0] > 2.0
    assert abs(left[0] - left[1]) < 0.01  # s
    assert apart(a, b, "position") < 1e-3  # m
    assert apart(a, b, "push_estimate") < 0.01  # N


@pytest.mark.parametrize("wrench", ["kalman", "fused"])
def test_an_observer_finds_the_push_on_the_body_of_gazebo(wrench):
    """The truth is the wrench that Gazebo applies; the hand pushes with up to 3 N."""
    joints = {} if wrench == "fused" else {"sensors.joints.model": "none"}
    a, b = both("iris", {"mission.duration": 24.0, "estimator.wrench": wrench, **joints})
    pushed = a.time > 12.5
    assert np.abs(b["push_force"][pushed]).max() > 2.9  # N
    errors = [np.sqrt(np.mean((f["push_estimate"] - f["push_force"])[pushed] ** 2, axis=0)) for f in (a, b)]
    assert errors[1].max() < 0.06  # N
    assert np.abs(errors[0] - errors[1]).max() < 0.003  # N


def test_the_push_is_the_wrench_on_the_beam_that_gazebos_own_joints_and_motion_leave():
    """Newton and Euler of the beam: ODE's wrenches of its fixed joints, and the motion, know nothing of the push."""
    flight = tl.fly(tl.load_mission("iris", EXACT | {"estimator.wrench": "kalman"}), engine="gazebo")
    beam, R = flight.vehicle.payload, Rotation.from_quat(flight["attitude"], scalar_first=True)
    a, w = flight["measured_specific_force"], flight["measured_rates"]
    felt, turned = (flight[f"measured_joint_{kind}"].reshape(len(a), -1, 3) for kind in ("force", "torque"))
    at = np.array([np.subtract(q.joint_position, beam.center_of_mass) for q in flight.vehicle.quadrotors])
    force = beam.mass * a - felt.sum(axis=1)
    angular = np.diff(w, axis=0, append=w[-1:]) / DT
    turning = angular @ beam.tensor + np.cross(w, w @ beam.tensor)
    moment = turning - (turned + np.cross(at, felt)).sum(axis=1)
    moment += np.cross(flight.vehicle.payload_center, force)
    left = {"push_force": R.apply(force), "push_moment": moment}
    hovers = slice(4200, -2)
    for name, size in (("push_force", 2.9), ("push_moment", 1.2)):
        applied = 0.5 * (flight[name][1:] + flight[name][:-1])  # over the step before
        assert np.abs(applied).max() > size
        assert np.abs(left[name][1:] - applied)[hovers].max() < 1e-3  # N, N m
    errors = (flight["push_estimate"] - left["push_force"])[hovers]
    assert np.sqrt(np.mean(errors**2, axis=0)).max() < 0.08  # N


def test_a_landing_ends_at_the_same_height():
    a, b = both("iris", {"mission.duration": 90.0, "mission.log_interval": 0.01})
    assert a.ending is None
    assert b.ending is None
    assert abs(a["contact_force"][-1, 2] - b["contact_force"][-1, 2]) < 0.5  # N
    assert np.abs(a["position"][-1] - b["position"][-1]).max() < 0.01  # m


def test_the_same_flight_twice_is_the_same_to_the_last_bit():
    mission = tl.load_mission("iris", {"mission.duration": 6.0})
    a, b = (tl.fly(mission, engine="gazebo") for _ in range(2))
    assert all(np.array_equal(a[name], b[name], equal_nan=True) for name in a)


def test_a_flight_that_is_lost_is_told_of_as_in_the_compiled_engine():
    weak = {
        "controller.gains.lambda_1": 0.0,
        "controller.gains.lambda_2": 0.0,
        "controller.gains.xi": [4.0, 2.0, 11.0, 0.1, 0.1, 0.1],
    }
    mission = tl.load_mission("paper", weak)
    a, b = tl.fly(mission), tl.fly(mission, engine="gazebo")
    assert b.ending.quantity == a.ending.quantity
    assert b.ending.time == pytest.approx(a.ending.time, abs=0.02)


def test_a_flight_that_is_killed_takes_its_server_with_it():
    code = (
        "import numpy as np, tandemlift as tl\nfrom tandemlift.engines.gazebo import GazeboBody\n"
        "m = tl.load_mission('hover')\nbody = GazeboBody(m, tl.Vehicle.from_settings(m.vehicle))\n"
        "print(body.server._process.pid, flush=True)\n"
        "while True: body.advance(np.full(8, 4.0), np.zeros(0), np.zeros(3), np.zeros(3))"
    )
    pilot = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    server = int(said(pilot, r"\d+")[0])
    assert runs(server)
    ended(pilot, signal.SIGKILL)
    until(lambda: not runs(server), "the end of its server")


def test_a_server_without_the_plugin_is_told_of(monkeypatch):
    plain = gazebo.world_from
    other = ("libtandemlift_", "libtandemlift_not_")
    monkeypatch.setattr(gazebo, "world_from", lambda *given: plain(*given).replace(*other))
    with pytest.raises(tl.InputError, match=r"needs its plugin .* Failed to load plugin libtandemlift_not_gazebo\.so"):
        tl.fly(tl.load_mission("hover", {"mission.duration": 1.0}), engine="gazebo")
