"""A push that the body's own simulator applies, beside the loop: it is in the record, and in what the person did."""

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.engines.mujoco import MuJoCoBody
from tandemlift.engines.registry import ENGINES, Engine
from tandemlift.missions import changed
from tandemlift.pictures.report.printed_summary import summary_lines

DT, FIRST, LAST = 1e-3, 13_000, 15_000
FORCE, POINT = np.array([2.0, 0.0, 0.0]), np.array([0.0, 0.5, 0.0])


class PushedMuJoCo(MuJoCoBody):
    """A MuJoCo that is pushed for some time by someone whom the flight's loop does not know."""

    first, last = FIRST, LAST

    def __init__(self, *given):
        super().__init__(*given)
        self.pushed, self.steps = np.zeros(6), 0

    def advance(self, thrusts, loads, force, moment):
        self.pushed[:] = 0.0
        if self.first <= self.steps < self.last:
            body = Rotation.from_quat(self.state[6:10], scalar_first=True).inv().apply(FORCE)
            self.pushed[:3], self.pushed[3:] = FORCE, np.cross(POINT, body)
        super().advance(thrusts, loads, force + self.pushed[:3], moment + self.pushed[3:])
        self.steps += 1


@pytest.fixture
def engine(monkeypatch):
    monkeypatch.setitem(ENGINES, "pushed", Engine("pushed", "for this test", lambda: PushedMuJoCo, pushable=True))
    return "pushed"


@pytest.mark.thorough
def test_its_force_moment_impulse_and_work_are_those_that_the_body_felt(engine):
    every_step = {"mission.duration": 16.0, "mission.log_interval": DT, "pushes": []}
    flight = tl.fly(tl.load_mission("iris", every_step), engine)
    acting = np.flatnonzero(flight["push_force"].any(axis=1))
    assert (acting[0], acting[-1]) == (FIRST, LAST - 1)
    np.testing.assert_array_equal(flight["push_force"][acting], np.tile(FORCE, (LAST - FIRST, 1)))
    assert np.abs(flight["push_moment"][acting] - [0.0, 0.0, -1.0]).max() < 0.2  # N m: it yields, and leans
    metrics = flight.metrics()
    np.testing.assert_allclose(metrics["human_impulse_n_s"], FORCE * (LAST - FIRST) * DT, rtol=1e-12)
    power = (flight["push_force"] * flight["velocity"]).sum(axis=1) + (flight["push_moment"] * flight["rates"]).sum(
        axis=1
    )
    assert metrics["human_work_j"] == pytest.approx(power.sum() * DT, rel=1e-9)
    assert metrics["human_work_j"] > 1.0  # J
    assert flight["push_estimate"][acting, 0].max() == pytest.approx(2.0, abs=0.1)  # the pilot's sensors feel it


@pytest.mark.thorough
def test_whoever_pushes_so_holds_the_vehicle_for_as_long(engine):
    by_hand = changed(interactive_mission(tl.load_mission("zigzag")), "mission.duration", 16.0)
    metrics = tl.fly(by_hand, engine).metrics()
    assert metrics["human_time_s"] == pytest.approx((LAST - FIRST) * DT, rel=1e-12)
    assert metrics["human_force_mean_n"] == pytest.approx(2.0, rel=1e-12)
    assert metrics["human_work_per_path_j_m"] == pytest.approx(metrics["human_work_j"] / metrics["human_path_m"])


def test_a_moment_that_is_not_known_makes_the_work_unknown_and_never_zero(monkeypatch):
    class Unknown(PushedMuJoCo):
        first, last = 500, 1500

        def advance(self, *given):
            super().advance(*given)
            self.pushed[3:] = np.nan if self.pushed.any() else 0.0

    monkeypatch.setitem(ENGINES, "pushed", Engine("pushed", "for this test", lambda: Unknown, pushable=True))
    flight = tl.fly(tl.load_mission("hover", {"mission.duration": 2.0}), "pushed")
    metrics = flight.metrics()
    assert metrics["human_work_j"] is None
    assert metrics["human_impulse_n_s"] == pytest.approx([2.0, 0.0, 0.0], rel=1e-12)
    assert metrics["final_position_m"] is not None
    assert [line for line in summary_lines(flight) if re.search("human work +not known$", line)]


def test_a_body_that_nobody_can_push_has_no_such_numbers(monkeypatch):
    monkeypatch.setitem(ENGINES, "pushed", Engine("pushed", "for this test", lambda: MuJoCoBody))
    flight = tl.fly(tl.load_mission("hover", {"mission.duration": 0.1}), "pushed")
    assert flight.metrics()["human_impulse_n_s"] == [0.0, 0.0, 0.0]
