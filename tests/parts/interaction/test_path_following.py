"""How a person guides along a leg: which point, and with what force."""

import numpy as np
import pytest

from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.interaction.person import PathFollowing, PathLeg, PersonSettings, PersonView, guided_point, pursue

VIEW = PersonView(Vec3(1.0, 2.0, 3.0), Vec3(0.1, 0.2, 0.3), Vec3(4.0, 5.0, 6.0), Vec3(0.4, 0.5, 0.6), 0.0, 0.0)
LEG = PathLeg(ZERO, Vec3(8.0, 0.0, 0.0), *[0.0] * (len(PathLeg._fields) - 2))
FOLLOWING = PathFollowing(**dict.fromkeys(PathFollowing._fields, 0.0))._replace(
    speed=0.5, gain=6.0, look_ahead=1.0, approach_gain=1.0
)


@pytest.mark.parametrize(
    ("at_grip", "place", "velocity"), [(1.0, VIEW.grip, VIEW.grip_velocity), (0.0, VIEW.position, VIEW.velocity)]
)
def test_the_grip_is_guided_or_the_centre_of_mass(at_grip, place, velocity):
    found = guided_point(PersonSettings(at_grip, 0.0, 0.0, 0.0), VIEW)
    assert found == (place, velocity)


def test_the_force_is_the_missing_speed_towards_a_place_ahead_on_the_leg_and_more_where_little_moves_nothing():
    """From beside the leg, at rest: along the line to the place `look_ahead` farther on the leg."""
    place = Vec3(2.0, 1.0, 0.0)
    aim = np.array([3.0, 0.0, 0.0]) - np.array(place)
    expected = 6.0 * 0.5 * aim / np.linalg.norm(aim)
    assert np.array(pursue(FOLLOWING, LEG, place, ZERO)) == pytest.approx(expected)
    more = np.array(pursue(FOLLOWING._replace(breakaway_force=0.4), LEG, place, ZERO))
    size, extra = np.linalg.norm(expected), 0.4
    assert np.cross(more, expected) == pytest.approx([0.0] * 3, abs=1e-12)
    assert np.linalg.norm(more) == pytest.approx(size * (1.0 + extra / np.hypot(size, extra)))
