"""Loads of the parts against NumPy: wrenches of rotors, wrenches on quadrotors carried to the joints; the whole box."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.vector import Quat, Vec3, each, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.mechanics.joint_loads import PartLoad, PerfectReadings, quadrotor_wrenches, readings_with_load
from tandemlift.parts.mechanics.vehicle import Vehicle

TWO = each(2)
VEHICLE = Vehicle.from_settings(tl.load_mission("iris").vehicle)
LAYOUT = parts_layout_from(VEHICLE)
CHANCE = np.random.default_rng(7)


def sets(rows):
    """A vector of sets from vectors (n, 3)."""
    return Vec3(*[TWO(*column) for column in np.transpose(rows).tolist()])


def test_the_wrench_of_each_quadrotor_is_that_of_its_rotors_about_its_own_centre():
    """Forces along z at the rotors' places; the torque about z is that of the whole vehicle's effect."""
    thrusts = CHANCE.uniform(1.0, 5.0, 8)
    found = quadrotor_wrenches(LAYOUT, each(8)(*thrusts.tolist()))
    for i, q in enumerate(VEHICLE.quadrotors):
        mine = thrusts[4 * i : 4 * i + 4]
        arms = np.column_stack([np.array(q.rotors), np.zeros(4)])
        moment = np.cross(arms, np.outer(mine, [0.0, 0.0, 1.0])).sum(axis=0)
        moment[2] = VEHICLE.effect[3, 4 * i : 4 * i + 4] @ mine
        assert found.thrust[i] == pytest.approx(mine.sum())
        assert [part[i] for part in found.moment] == pytest.approx(moment)


def test_a_force_on_a_quadrotor_loads_its_joint_by_the_force_and_its_moment_about_the_joint():
    attitude = Rotation.random(random_state=3)
    force, at = CHANCE.normal(size=(2, 3)), CHANCE.normal(size=(2, 3))  # world axes; body axes, from its centre
    in_body = attitude.inv().apply(force)
    frame, none = LAYOUT, sets(np.zeros((2, 3)))
    load = PartLoad(sets(force), sets(np.cross(at, in_body)))
    q = Quat(*attitude.as_quat(scalar_first=True).tolist())
    found = readings_with_load(load, frame, q, PerfectReadings(vec3([0.0] * 3), none, none, vec3([0.0] * 3)))
    joints = np.transpose(frame.joints)
    assert np.transpose(found.joint_force) == pytest.approx(in_body)
    assert np.transpose(found.joint_torque) == pytest.approx(np.cross(at - joints, in_body))


def test_the_box_of_all_parts_ends_at_the_highest_rotor_and_at_the_lowest_foot():
    low, high = VEHICLE.box
    tops = [z + q.rotor_height for q, (_, _, z) in zip(VEHICLE.quadrotors, VEHICLE.lever_arms, strict=True)]
    soles = [z - q.feet_depth for q, (_, _, z) in zip(VEHICLE.quadrotors, VEHICLE.lever_arms, strict=True)]
    assert (low[2], high[2]) == (pytest.approx(min(soles)), pytest.approx(max(tops)))


def test_the_box_of_a_vehicle_without_a_beam_is_that_of_the_quadrotors():
    point = VEHICLE.payload.model_copy(update={"length": None, "radius": None})
    alone = replace(VEHICLE, payload=point)
    assert alone.beam is None
    low, high = alone.box
    wide = max(np.hypot(*r) + q.rotor_radius for q in VEHICLE.quadrotors for r in q.rotors)
    assert (low[0], high[0]) == pytest.approx((-wide, wide), rel=0.2)


def test_the_box_of_all_parts_holds_the_whole_beam_wherever_the_quadrotors_stand():
    length, radius = VEHICLE.beam
    inner = [q.model_copy(update={"position": (0.0, 0.2 * q.position[1], q.position[2])}) for q in VEHICLE.quadrotors]
    low, high = replace(VEHICLE, quadrotors=tuple(inner)).box
    assert (low[1], high[1]) == (pytest.approx(-0.5 * length), pytest.approx(0.5 * length))
    assert low[0] < -radius < radius < high[0]
    assert VEHICLE.beside([0.0, -0.5 * length, 0.0]) == 0.0
