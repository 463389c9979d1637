"""The watchdogs' numbers from the tables, and what counts as an invalid sample."""

import math

import pytest

import tandemlift as tl
from tandemlift.parts.sensors.health import PerSensor, SensorHealth
from tandemlift.parts.sensors.watchdog import any_invalid, watchdog_from

VALID = SensorHealth(**dict.fromkeys(SensorHealth._fields, 0.0))


def test_gains_of_the_watchdogs_are_those_of_the_motion_sensors_interval():
    mission = tl.load_mission("iris", {"sensors.motion.interval": 0.01})
    found = watchdog_from(mission.supervision.watchdog, mission.sensors, mission.mission.step)
    w = mission.supervision.watchdog
    assert 1.0 / found.motion_rate == pytest.approx(0.01)
    assert found.rates_gain == pytest.approx(1.0 - math.exp(-0.01 * w.rates_bandwidth))
    assert found.velocity_gain == pytest.approx(1.0 - math.exp(-0.01 * w.velocity_bandwidth))
    assert found.forgetting == pytest.approx(0.01 / w.window)


@pytest.mark.parametrize("sensor", ["attitude", "position", "velocity", "gyroscope", "accelerometer"])
def test_one_invalid_sensor_of_those_that_are_compared_is_enough(sensor):
    health = PerSensor(*[VALID] * len(PerSensor._fields))
    assert any_invalid(health) == 0.0
    assert any_invalid(health._replace(**{sensor: VALID._replace(failure=1.0)})) == 1.0
