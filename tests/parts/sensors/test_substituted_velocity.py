"""The velocity that stands in for a lost measurement: the position's derivative, as long as there is a position."""

from types import SimpleNamespace

import pytest

from tandemlift.core.vector import Vec3
from tandemlift.parts.sensors.health import NO_NUMBER, WELL, PerSensor, SensorHealth
from tandemlift.parts.sensors.watchdog import substitute_velocity

SOUND, BAD = SensorHealth(0.0, 0.0, 0.0), SensorHealth(0.0, 0.0, NO_NUMBER)
HEALTHY = PerSensor(*[SOUND] * 6)
DOG = SimpleNamespace(motion_rate=100.0, velocity_gain=0.25)
BEFORE = SimpleNamespace(
    velocity=Vec3(1.0, 2.0, 3.0), valid=SimpleNamespace(motion=SimpleNamespace(position=Vec3(0.5, 0.5, 0.5)))
)
SAMPLE = SimpleNamespace(position=Vec3(0.53, 0.5, 0.46), velocity=Vec3(9.0, 9.0, 9.0), fresh=1.0)


@pytest.mark.parametrize("lost", [{"healths": HEALTHY._replace(velocity=BAD)}, {"report": WELL._replace(velocity=2.0)}])
def test_it_follows_the_derivative_of_the_position_by_the_gain_while_there_is_a_new_one(lost):
    def found(sample=SAMPLE, healths=HEALTHY, report=WELL):
        return substitute_velocity(DOG, BEFORE, sample, healths, report)

    assert found() == SAMPLE.velocity
    assert found(**lost) == pytest.approx([1.0 + 0.25 * (3.0 - 1.0), 2.0 * 0.75, 3.0 + 0.25 * (-4.0 - 3.0)])
    held = SimpleNamespace(**{**vars(SAMPLE), "fresh": 0.0})
    assert found(held, **lost) == BEFORE.velocity
    no_position = lost.get("healths", HEALTHY)._replace(position=BAD)
    assert found(**{**lost, "healths": no_position}) == BEFORE.velocity
