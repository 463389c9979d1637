"""Joints that were wrong are trusted again once neither their force nor their moment is off by half a tolerance."""

import pytest

from tandemlift.core.low_pass import LowPassState
from tandemlift.core.vector import ZERO, Quat, Vec3
from tandemlift.parts.estimation.wrench.fused import JointPush, fuse, fused_filter
from tandemlift.parts.estimation.wrench.kalman import kalman_observer
from tandemlift.parts.estimation.wrench.observation import NominalBody, Observation
from tandemlift.parts.mechanics.rigid_body import State, Wrench

MASS, T = 3.5, 1e-3
ONE = Vec3(1.0, 1.0, 1.0)


@pytest.mark.parametrize(
    ("force", "moment", "wrong"), [(0.0, 0.0, 0.0), (0.3, 0.9, 0.0), (0.7, 0.0, 1.0), (-0.7, 0.0, 1.0), (0.0, 1.5, 1.0)]
)
@pytest.mark.parametrize("axis", range(3))
def test_joints_stay_wrong_while_force_or_moment_is_off(force, moment, wrong, axis):
    """Of tolerances of 1 N and 2 N m, on a vehicle that hovers."""
    alone, _ = kalman_observer(NominalBody(MASS, ONE, ONE), ONE, ONE, 0.03, 0.0025, T)
    noise = (0.03, 0.0025, 0.05, 0.005)
    k, memory = fused_filter(alone, (ONE, ONE), (1.0, 2.0), (0.0, ZERO, ZERO), noise, [[0.0, 1.0, 0.0]], T)

    def off(monitor, by):
        value = Vec3(*(by if i == axis else 0.0 for i in range(3)))
        return monitor._replace(difference=LowPassState(value, ZERO))

    memory = memory._replace(wrong=1.0, force=off(memory.force, force), moment=off(memory.moment, moment))
    level = State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
    seen = Observation(Vec3(0.0, 0.0, 9.81), level, Wrench(MASS * 9.81, ZERO), ZERO, ZERO, level.attitude, 0.0, T)
    _, after = fuse(k, memory, seen, JointPush(ZERO, ZERO, ZERO, ZERO, 0.0, 1.0, 1.0, 1.0))
    assert after.wrong == wrong
