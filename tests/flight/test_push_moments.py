"""The moment of a push is about the vehicle's centre of mass, true or estimated; about another point it is named so."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.analysis.logs.log import Log, log_of

pytestmark = pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")
OLD = "moment of the push about the payload's centre of mass"  # of version 1.0, in the header of a record


@pytest.fixture(scope="module")
def flown():
    """A flight of exact sensors under a long push, off the centre."""
    push = {"force": [3.0, 1.0, 0.5], "time": 14.0, "sigma": 1.0, "point": [0.0, 0.4, 0.0]}
    changes = {"mission.duration": 15.0, "pushes": [push], "sensors.errors": "none"}
    return tl.fly(tl.load_mission("iris", changes))


def center(flight):
    """The vehicle's centre of mass from the payload's origin, which is its centre [m], by its definition."""
    vehicle = flight.mission["vehicle"]
    parts = [
        (vehicle["payload"]["mass"], [0.0, 0.0, 0.0]),
        *((q["mass"], q["position"]) for q in vehicle["quadrotors"]),
    ]
    return sum(m * np.array(at) for m, at in parts) / sum(m for m, _ in parts)


def at_payload(flight):
    """The moment of the estimated push about the payload's centre of mass, from its definition."""
    turned = Rotation.from_quat(flight["estimated_attitude"], scalar_first=True)
    force = turned.apply(flight["push_estimate"], inverse=True)
    return flight["push_moment_estimate"] + np.cross(center(flight), force)


def test_the_estimated_moment_is_about_the_point_of_the_true_one(flown):
    at = np.argmax(np.linalg.norm(flown["push_force"], axis=1))
    true, estimated = flown["push_moment"][at], flown["push_moment_estimate"][at]
    assert np.linalg.norm(true) > 1.0
    assert estimated == pytest.approx(true, abs=0.04)
    other = at_payload(flown)[at]
    assert np.abs(other - true).max() > 0.15, "about the payload's centre it is another moment"


def test_a_record_of_version_1_0_is_read_with_its_moment_about_that_point(flown, tmp_path):
    channels = flown.channels | {"push_moment_estimate": at_payload(flown)}
    path = replace(flown, channels=channels).save(tmp_path / "flight.npz")
    with np.load(path) as content:
        arrays = dict(content)
    header = json.loads(str(arrays["header"]))
    header["channels"]["push_moment_estimate"]["meaning"] = OLD
    np.savez(path, **{**arrays, "header": np.array(json.dumps(header))})
    found = tl.Flight.load(path)
    np.testing.assert_allclose(found["push_moment_estimate"], flown["push_moment_estimate"], rtol=0.0, atol=1e-12)


def test_the_moment_about_the_payload_s_origin_has_a_name_of_its_own_in_a_log(flown):
    log = log_of(flown)
    assert "push_moment" not in list(log)
    turned = Rotation.from_quat(flown["attitude"], scalar_first=True).apply(flown["push_force"], inverse=True)
    place = np.add(center(flown), [0.0, 0.4, 0.0])  # the mission's point is from the centre of mass
    expected = np.cross(place, turned)
    np.testing.assert_allclose(log["push_moment_at_origin"].values, expected, rtol=0.0, atol=1e-3)


def test_a_log_under_the_name_of_version_1_0_has_the_new_one_and_says_it(flown):
    stream = log_of(flown)["push_moment_at_origin"]
    log = Log({"push_moment": stream})
    assert list(log) == ["push_moment_at_origin"]
    assert np.array_equal(log["push_moment"].values, stream.values)
    assert log.notes == ("push_moment of a log is now called push_moment_at_origin",)
