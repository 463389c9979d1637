"""What is compared with a push: the load beside it, by the modelled rotors; and what is taken from the push."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.vector import ZERO, Quat, Vec3, vec3
from tandemlift.parts.estimation.push_confirmation import outside_load, rotor_model, withheld
from tandemlift.parts.estimation.push_estimate import PushEstimate
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.sensors.readings import ImuReading

STEP = 1e-3
VEHICLE = Vehicle.from_settings(tl.load_mission("iris").vehicle)


def test_rotors_at_their_speed_leave_the_load_that_is_not_theirs():
    """Force and moment about z beside those of the thrusts by the mixer matrix, whatever the thrusts are."""
    rotors, at_rest = rotor_model(VEHICLE, STEP)
    thrusts = np.random.default_rng(4).uniform(1.0, 5.0, VEHICLE.rotor_count)
    constants = np.array([q.thrust_constant for q in VEHICLE.quadrotors for _ in range(4)])
    speeds, commands = type(at_rest)(*np.sqrt(thrusts / constants)), type(at_rest)(*thrusts)
    lift, _, _, yaw = VEHICLE.effect @ thrusts
    load, after = outside_load(rotors, speeds, commands, Vec3(0.3, -0.2, lift + 0.5), yaw + 0.07)
    assert np.array(load.force) == pytest.approx([0.3, -0.2, 0.5], abs=1e-12)
    assert load.turning == pytest.approx(0.07, abs=1e-12)
    assert abs(yaw) > 0.05  # so that its sign counts
    assert np.array(after) == pytest.approx(np.array(speeds))


@pytest.mark.parametrize(("applies", "left"), [(1.0, 1.0), (0.0, 0.0)])
def test_what_is_not_confirmed_is_taken_from_force_and_moment_unless_a_contact_explains_it(applies, left):
    frame = Quat(np.cos(0.4), 0.0, 0.0, np.sin(0.4))
    imu = ImuReading(*[None] * len(ImuReading._fields))._replace(frame=frame)
    force, moment = Vec3(1.0, 2.0, 3.0), Vec3(0.1, 0.2, 0.3)
    push = PushEstimate(force, moment, force, moment, 0.0, 1.0, 0.0, 1.0, 1.0, force)
    rest = withheld(push, imu, Vec3(0.5, -0.4, 0.3), 0.08, applies, 1.0)
    less = left * np.array(rotation_from_quaternion(frame)) @ [0.5, -0.4, 0.3]
    for found in (rest.force, rest.measured, rest.usable):
        assert np.array(found) == pytest.approx(np.array(force) - less)
    for found in (rest.moment, rest.measured_moment):
        assert found == pytest.approx((0.1, 0.2, 0.3 - left * 0.08))
    assert np.array(rest.withheld) == pytest.approx(less)
    assert rest.refuted == left
    assert withheld(push._replace(trusted=0.0), imu, ZERO, 0.0, applies, 0.0).usable == vec3([0.0] * 3)
