"""A contact beside an observer: the part and the place by the wrench that a rigid body shows, without joint sensors."""

from types import SimpleNamespace

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.vector import Absent, Vec3, each
from tandemlift.parts.estimation.contact_detection import ContactTable, start_contact_detection
from tandemlift.parts.estimation.contact_evidence import BEAM, by_line_of_action, heard, start_evidence
from tandemlift.parts.estimation.contact_map import UNMATCHED, BeamMatch, GuardMatch

DT = 1e-3
VEHICLE = tl.Vehicle.from_settings(tl.load_mission("iris").vehicle)
J, MASS, PAYLOAD = np.array(VEHICLE.inertia), VEHICLE.mass, np.array(VEHICLE.payload_center)
TURNING = np.array([0.2, -0.1, 0.3])  # rad/s, throughout
NONE = each(2)(0.0, 0.0)
NO_WALLS = GuardMatch(NONE, Vec3(NONE, NONE, NONE))
GUARD, RIM = np.array(VEHICLE.lever_arms), 0.375  # m


def reading(force, at):
    """The reading of an unmoved sensor in the payload's centre of mass while a force acts at a place [m, body axes]."""
    angular = np.linalg.solve(J, np.cross(at, force) - np.cross(TURNING, J @ TURNING))
    own = np.cross(angular, PAYLOAD) + np.cross(TURNING, np.cross(TURNING, PAYLOAD))
    a = Vec3(*(force / MASS + [0.0, 0.0, 9.81] + own).tolist())
    imu = SimpleNamespace(specific_force=a, rates=Vec3(*TURNING.tolist()), joint_force=Absent())
    return SimpleNamespace(imu=imu, angular=Vec3(*angular.tolist()), push=SimpleNamespace(armed=1.0))


def told(force, at, rise, guards=NO_WALLS, beam=UNMATCHED):
    """(part, place on the beam) once a force has risen within a time [s] and stayed for 15 ms."""
    k, _ = start_contact_detection(ContactTable(model="on"), VEHICLE, DT, joints=False)
    memory = start_evidence(k)
    share = np.append(np.zeros(500), np.minimum(np.arange(1, 1e3 * rise + 16) * DT / rise, 1))
    for s in share:
        memory, _ = heard(k, memory, Absent(), reading(np.array(force) * s, np.array(at)), 0.0, DT)
    return by_line_of_action(k.whole, 0.0, 0.0, k, memory, (guards, beam))


@pytest.mark.parametrize("number", [1, 2])
@pytest.mark.parametrize("direction", [[-1.0, 0.0], [0.6, 0.8]])
def test_a_guard_is_told_by_a_force_on_its_rim_towards_its_centre(number, direction):
    way = np.array([*direction, 0.0])
    inward = way if way[1] * GUARD[number - 1][1] <= 0.0 else way * [1.0, -1.0, 1.0]  # none reaches it from the beam
    part, _ = told(20.0 * inward, GUARD[number - 1] - RIM * inward, rise=0.01)
    assert part == number


@pytest.mark.parametrize("place", [-0.5, 0.0, 0.3])
def test_a_force_on_the_beam_is_told_with_its_place(place):
    part, along = told([-20.0, 1.0, 0.0], PAYLOAD + np.array([0.05, place, 0.0]), rise=0.01)
    assert part == BEAM
    assert along == pytest.approx(place - 0.05 / 20.0, abs=0.02)  # where its line crosses the axis


def test_a_hand_is_told_from_a_wall_by_its_rise_alone_and_less_is_enough_at_a_known_wall():
    """A hand's force rises with 100 N/s at most. By place and size it is that of a wall."""
    at = PAYLOAD + np.array([0.05, 0.3, 0.0])
    assert told([-20.0, 0.0, 0.0], at, rise=0.25)[0] == 0.0
    known = BeamMatch(1.0, 0.3, Vec3(-0.05, 0.0, 0.0))
    assert told([-20.0, 0.0, 0.0], at, rise=0.25, beam=known)[0] == BEAM
    assert told([-20.0, 0.0, 0.0], at, rise=0.5, beam=known)[0] == 0.0
    walls = NO_WALLS._replace(matched=each(2)(1.0, 0.0))
    assert told([-20.0, 0.0, 0.0], GUARD[0] + np.array([RIM, 0.0, 0.0]), rise=0.25, guards=walls)[0] == 1.0
    elsewhere = told([-20.0, 0.0, 0.0], GUARD[1] + np.array([RIM, 0.0, 0.0]), rise=0.25, guards=walls)
    assert elsewhere[0] == 0.0
