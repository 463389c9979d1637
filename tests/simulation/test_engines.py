"""Two engines fly the same missions: a compiled rigid body, and MuJoCo, which shares no equation with it."""

import sys

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.engines import ENGINES
from tandemlift.errors import InputError

mujoco = pytest.importorskip("mujoco")


def turned(a, b):
    same = np.sign(np.sum(a * b, axis=1))[:, None]
    return 4.0 * np.arcsin(0.5 * np.linalg.norm(a - same * b, axis=1)).max()


@pytest.fixture(scope="module")
def paper():
    mission = tl.load_mission("paper", {"mission.duration": 30.0})
    return tl.fly(mission), tl.fly(mission, "mujoco")


@pytest.fixture(scope="module")
def iris():
    mission = tl.load_mission("iris", {"mission.duration": 14.0, "mission.log_interval": 0.001})
    return tl.fly(mission), tl.fly(mission, "mujoco")


def test_both_fly_the_paper_alike(paper):
    ours, theirs = paper
    assert np.abs(ours["position"] - theirs["position"]).max() < 5e-5
    assert turned(ours["attitude"], theirs["attitude"]) < 2e-4
    for channel in ("joint_force", "joint_torque"):
        assert np.abs(ours[channel] - theirs[channel]).max() < 1e-3
    assert theirs.metrics()["position_rmse_after_10s_m"] == pytest.approx(
        ours.metrics()["position_rmse_after_10s_m"], abs=1e-7
    )


def test_a_flight_says_which_engine_flew_it(paper):
    ours, theirs = paper
    assert ours.version["engine"] == "compiled"
    assert theirs.version["engine"] == "mujoco"
    assert theirs.version["mujoco"] == mujoco.__version__
    assert list(ours) == list(theirs)


def test_both_stand_alike_and_take_off_at_the_same_time(iris):
    def off(flight):
        carried = flight["contact_force"][:, 2] > 0.0
        return flight.time[np.flatnonzero(carried[:-1] & ~carried[1:])[0] + 1]

    ours, theirs = iris
    standing = ours.time < 1.9
    assert np.abs(ours["position"][standing] - theirs["position"][standing]).max() < 1e-4
    assert off(ours) == pytest.approx(off(theirs), abs=5e-3)
    assert off(ours) > 2.0


def test_both_feel_the_same_push_behind_the_same_noise(iris):
    ours, theirs = iris
    late = ours.time > 12.5
    assert np.abs(ours["push_estimate"][late] - theirs["push_estimate"][late]).max() < 0.01
    assert np.abs(theirs["push_estimate"][late] - theirs["push_force"][late]).max() < 0.25


def test_an_unknown_engine_is_refused_with_what_there_is():
    with pytest.raises(InputError, match=r"unknown engine 'mujuco'.*compiled, mujoco.*mean 'mujoco'"):
        tl.fly(tl.load_mission("hover"), "mujuco")


def test_an_engine_that_is_not_installed_says_how_to_get_it(monkeypatch):
    for name in [n for n in sys.modules if n.startswith("tandemlift.engines.mujoco")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(InputError, match=r"pip install 'tandemlift\[mujoco\]'"):
        tl.fly(tl.load_mission("hover", {"mission.duration": 0.1}), "mujoco")


def test_every_engine_has_a_summary():
    assert all(engine.summary for engine in ENGINES.values())
