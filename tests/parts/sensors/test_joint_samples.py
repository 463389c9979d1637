"""Samples of joints: one bad number of one joint is found, whichever it is."""

import pytest

from tandemlift.core.vector import Vec3, each
from tandemlift.parts.sensors.health import JointLimits, check_sample

TWO = each(2)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("quantity", range(2))
def test_one_bad_number_of_one_joint_is_found_along_any_axis(axis, quantity):
    limits = JointLimits(10.0, 1.0, 5.0)

    def sample(number):
        """Force and torque at two joints, one number of which is given."""
        parts = [[TWO(0.5, 0.25) for _ in range(3)] for _ in range(2)]
        parts[quantity][axis] = TWO(0.5, number)
        return tuple(Vec3(*part) for part in parts)

    sound = sample(0.75)
    assert check_sample(limits, sound, sample(0.75)) == (0.0, 0.0, 1.0)
    assert check_sample(limits, sample(0.8), sound) == (0.0, 0.0, 1.0)  # the other joint stands still
    assert check_sample(limits, sample(float("nan")), sound)[:2] == (1.0, 1.0)
    assert check_sample(limits, sample(-10.5), sound)[:2] == (0.0, 1.0)
