"""Whole flights in MuJoCo beside the compiled engine: the same pilot, bodies that share no equation."""

from importlib import metadata

import numpy as np
import pytest
from flights import in_both
from storm import DT, storm

import tandemlift as tl
from tandemlift.engines.registry import ENGINES

HALF_MINUTE = {"mission.duration": 30.0}
FAR = {"walls": [{"start": [900.0, 0.0], "end": [900.0, 1.0]}]}


def apart(a, b, name, part=slice(None)):
    return np.abs(a[name][part] - b[name][part]).max()


def take_off(flight):
    """When the floor first carries nothing [s]."""
    return flight.time[np.flatnonzero(flight["contact_force"][:, 2] == 0.0)[0]]


@pytest.fixture(scope="module")
def iris():
    return in_both(tl.load_mission("iris", {"mission.duration": 20.0, "mission.log_interval": DT}))


DIFFERENT = {"plant.mass_scale": 0.9, "plant.inertia_scale": [0.7, 1.3, 1.5], "disturbance.moment": [0.1, 0.05, 0.02]}


@pytest.mark.parametrize("changes", [{}, DIFFERENT], ids=["as known", "as it really is"])
def test_half_a_minute_of_the_papers_mission_is_the_same_in_both(changes):
    a, b = in_both(tl.load_mission("paper", HALF_MINUTE | changes))
    assert np.abs(a["rates"]).max() > 0.2  # rad/s
    assert apart(a, b, "position") < 1e-6  # m
    assert apart(a, b, "attitude") < 1e-6
    assert apart(a, b, "joint_force") < 1e-3  # N: MuJoCo feels the push's mean over a step, we its start
    assert apart(a, b, "joint_torque") < 1e-3  # N m
    rmse = [f.metrics()["position_rmse_after_10s_m"] for f in (a, b)]
    np.testing.assert_allclose(*rmse, atol=1e-7)


def test_a_vehicle_rests_at_the_same_height_and_takes_off_at_the_same_time(iris):
    a, b = iris
    standing = a.time < 1.9
    assert apart(a, b, "position", standing) < 1e-9  # m
    assert apart(a, b, "contact_force", standing) < 1e-6  # N
    assert 2.0 < take_off(a) < 3.0
    assert abs(take_off(a) - take_off(b)) < 5e-3  # s


def test_a_flight_on_sensors_and_real_rotors_is_the_same_in_both(iris):
    a, b = iris
    assert a.ending is None
    assert b.ending is None
    assert apart(a, b, "position") < 1e-3  # m: the push is felt half a step apart
    assert apart(a, b, "attitude") < 2e-4
    flying = a.time > take_off(a) + 0.5
    assert apart(a, b, "joint_force", flying) < 1e-2  # N
    assert apart(a, b, "push_estimate") < 1e-2  # N
    felt = np.abs(b["push_estimate"] - b["push_force"])[b.time > 12.5]
    assert b["push_force"].max() > 1.0
    assert felt.max() < 0.25  # N


def test_a_flight_has_the_same_channels_in_both_and_says_which_engine_it_flew_in(iris):
    a, b = iris
    assert [(name, a[name].shape) for name in a] == [(name, b[name].shape) for name in b]
    assert (a.version["engine"], b.version["engine"]) == ("compiled", "mujoco")
    assert b.version["mujoco"] == metadata.version("mujoco")
    assert np.array_equal(a.time, b.time)
    assert set(a.metrics()) == set(b.metrics())


def test_a_controller_in_plain_python_flies_in_mujoco_too(by_hand):
    pytest.importorskip("mujoco")
    a, b = tl.fly(storm(FAR)), tl.fly(storm(FAR | by_hand), engine="mujoco")
    assert a.ending is None
    assert b.ending is None
    assert apart(a, b, "position", a.time < 4.5) < 1e-3  # m, through wind, a fault and a push
    assert apart(a, b, "position") < 0.02  # m, at the end of a landing with a skid
    assert abs(take_off(a) - take_off(b)) <= 0.01 + 1e-9  # s, the interval of the log


def test_an_engine_that_is_not_known_is_refused_with_those_that_are():
    with pytest.raises(
        tl.InputError, match=r"^unknown engine 'mujoko'; there are compiled, mujoco, gazebo, gazebo-ros\. Did you mean"
    ) as e:
        tl.fly(tl.load_mission("hover"), engine="mujoko")
    assert all(name in str(e.value) and engine.summary for name, engine in ENGINES.items())
