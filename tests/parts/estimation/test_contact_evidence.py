"""Evidence of a contact by its table of causes: guard, hand, beam, joint sensor; and the contact that is told."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tandemlift.core.low_pass import LowPassState, low_pass
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, each
from tandemlift.parts.contact.wall_geometry import Wall
from tandemlift.parts.contact.walls import NearWalls
from tandemlift.parts.estimation.contact_detection import (
    AWAY,
    NO_CONTACT,
    QUIET_TIME,
    axis_of,
    begun,
    is_over,
    radius_of,
)
from tandemlift.parts.estimation.contact_evidence import (
    BEAM,
    DOUBT_TIME,
    LEAST_DOUBT,
    RISE_ANYWHERE,
    RISE_AT_WALL,
    ContactDetector,
    Deviations,
    ForceBand,
    doubt_after,
    heard,
    start_evidence,
    touching_part,
    with_means_of_now,
)
from tandemlift.parts.estimation.contact_map import (
    UNMATCHED,
    BeamMatch,
    GuardMatch,
    TouchGeometry,
    guards_matched,
)
from tandemlift.parts.estimation.push_estimate import PushEstimator
from tandemlift.parts.estimation.tare import SideForces
from tandemlift.parts.mechanics.rigid_body import State

PAIR, DT = each(2), 1e-3
GEOMETRY = TouchGeometry(
    quadrotors=Vec3(PAIR(0.1, -0.1), PAIR(1.0, -1.0), PAIR(0.2, 0.3)),
    guards=PAIR(0.3, 0.4), payload=Vec3(0.0, 0.05, -0.1), half=0.8, radius=0.06, margin=0.05,
)  # fmt: skip
DETECTOR = ContactDetector(low_pass(100.0, DT), 0.5, 2.0, 3.0, GEOMETRY, PAIR(1.0, 2.0))
NOWHERE = GuardMatch(PAIR(0.0, 0.0), Vec3(PAIR(0.0, 0.0), PAIR(0.0, 0.0), PAIR(0.0, 0.0)))
STEEPLY = start_evidence(DETECTOR)._replace(steepest=1.01 * RISE_ANYWHERE * RISE_ANYWHERE)
FORCE = np.array([3.0, -4.0])
NO_FORCE = np.zeros(2)


def sides(first, second=NO_FORCE):
    """Forces on two quadrotors, each (x, y)."""
    return SideForces(PAIR(float(first[0]), float(second[0])), PAIR(float(first[1]), float(second[1])))


def plain(f):
    return SideForces(*map(float, f))


def seen(guard=NO_FORCE, other=NO_FORCE, push=NO_FORCE, moves=NO_FORCE, joint=0.1 * FORCE):
    """The deviations: forces on both guards and on the payload, what moves the whole, what one joint carries."""
    outside = sides(guard, other)
    return Deviations(outside, outside, sides(joint), plain(moves), plain(push))


CAUSES = {  # the table of the module: deviations, the part that touches
    "the first guard": (seen(guard=FORCE, moves=FORCE), 1.0),
    "the second guard": (seen(other=FORCE, moves=FORCE), 2.0),
    "both, the first harder": (seen(guard=FORCE, other=0.8 * FORCE, moves=1.8 * FORCE), 1.0),
    "the beam": (seen(push=FORCE, moves=FORCE), BEAM),
    "a joint's sensor": (seen(guard=FORCE, push=-FORCE, joint=FORCE), 0.0),
    "the gyroscope": (seen(guard=FORCE, other=-FORCE, joint=NO_FORCE), 0.0),
    "less than the threshold": (seen(guard=0.39 * FORCE, moves=0.39 * FORCE), 0.0),
    "a guard on which the joints have seen nothing": (seen(guard=FORCE, moves=FORCE, joint=0.01 * FORCE), 0.0),
    "a guard that the motion confirms": (seen(guard=FORCE, moves=0.71 * FORCE), 1.0),
    "a guard that the motion hardly confirms": (seen(guard=FORCE, moves=0.69 * FORCE), 0.0),
    "a beam that the motion hardly confirms": (seen(push=FORCE, moves=0.69 * FORCE), 0.0),
    "a push beside a larger force on a guard": (seen(guard=[-6.0, 0.0], push=FORCE, moves=FORCE), 0.0),
    "a guard with less than the push": (seen(guard=FORCE, push=1.1 * FORCE, moves=FORCE), BEAM),
}  # fmt: skip


@pytest.mark.parametrize("cause", list(CAUSES))
def test_each_cause_is_told_by_what_it_shows(cause):
    deviations, part = CAUSES[cause]
    assert touching_part(DETECTOR, STEEPLY, deviations, NOWHERE, UNMATCHED, 1.0) == part


def test_doubt_and_joints_that_disagree_exclude_a_contact_but_not_one_at_a_known_wall():
    guard, beam = CAUSES["the first guard"][0], CAUSES["the beam"][0]
    doubted = STEEPLY._replace(doubt=LEAST_DOUBT)
    for deviations in (guard, beam):
        assert touching_part(DETECTOR, doubted, deviations, NOWHERE, UNMATCHED, 1.0) == 0.0
        assert touching_part(DETECTOR, STEEPLY, deviations, NOWHERE, UNMATCHED, 0.0) == 0.0
    known = NOWHERE._replace(matched=PAIR(1.0, 0.0))
    assert touching_part(DETECTOR, doubted, guard, known, UNMATCHED, 0.0) == 1.0
    assert touching_part(DETECTOR, doubted, seen(other=FORCE, moves=FORCE), known, UNMATCHED, 0.0) == 0.0


def test_a_beam_differs_from_a_hand_by_its_rise_and_less_is_enough_at_a_known_wall():
    beam, known = CAUSES["the beam"][0], BeamMatch(1.0, 0.2, Vec3(0.0, 0.05, 0.0))
    for match, rise in ((UNMATCHED, RISE_ANYWHERE), (known, RISE_AT_WALL)):
        for slope, part in ((0.99 * rise, 0.0), (1.01 * rise, BEAM)):
            risen = STEEPLY._replace(steepest=slope * slope)
            assert touching_part(DETECTOR, risen, beam, NOWHERE, match, 1.0) == part


def test_a_force_that_the_motion_does_not_confirm_is_doubted_for_as_long_and_at_most_for_a_time():
    unconfirmed, confirmed = seen(guard=FORCE, moves=0.69 * FORCE), seen(guard=FORCE, moves=0.71 * FORCE)
    for name, deviations, after in (
        ("unconfirmed", unconfirmed, 0.1 + DT),
        ("confirmed", confirmed, 0.1 - DT),
        ("small", seen(guard=0.39 * FORCE), 0.1 - DT),
        ("push", seen(push=FORCE, moves=0.69 * FORCE), 0.1 + DT),
        ("confirmed push", seen(push=FORCE, guard=0.9 * FORCE, moves=0.71 * FORCE), 0.1 - DT),
        ("opposite", seen(guard=FORCE, moves=-FORCE), 0.1 + DT),
    ):
        assert doubt_after(DETECTOR, 0.1, deviations, DT) == pytest.approx(after), name
    assert doubt_after(DETECTOR, DOUBT_TIME, unconfirmed, DT) == DOUBT_TIME
    assert doubt_after(DETECTOR, 0.0, confirmed, DT) == 0.0


def test_means_that_begin_anew_are_the_present_forces_and_the_steady_one_stays():
    band = ForceBand(LowPassState(3.0, 0.5), LowPassState(-1.0, 0.2), 1.0, 2.0)
    outside = ForceBand(
        LowPassState(PAIR(4.0, 5.0), 0.0), LowPassState(PAIR(6.0, 7.0), 0.0), PAIR(0.5, 0.6), PAIR(0.7, 0.8)
    )
    memory = STEEPLY._replace(push=band, momentum=band, outside=outside, joints=outside)
    assert with_means_of_now(memory, 0.0) == memory
    begun_anew = with_means_of_now(memory, 1.0)
    for name in ("push", "momentum", "outside", "joints"):
        now = getattr(begun_anew, name)
        assert (now.mean_x, now.mean_y) == (now.x.value, now.y.value)
    assert begun_anew.steady == memory.steady


# The contact that begins


TURNED = Rotation.from_euler("z", 0.7)
STATE = State(Vec3(1.0, 2.0, 3.0), ZERO, Quat(*TURNED.as_quat(scalar_first=True).tolist()), ZERO)


def in_world(*v):
    return TURNED.apply(v)


@pytest.mark.parametrize(("part", "center", "radius"), [(1.0, (0.1, 1.0, 0.2), 0.3), (2.0, (-0.1, -1.0, 0.3), 0.4)])
def test_a_guard_that_touches_is_told_with_force_normal_and_point(part, center, radius):
    d = seen(guard=FORCE, other=-0.5 * FORCE)
    mine = FORCE if part == 1.0 else -0.5 * FORCE
    slope = np.array([200.0, 100.0])
    x, y = (LowPassState(PAIR(9.0, 9.0), PAIR(*np.where([part == 1.0, part == 2.0], s, 7.0).tolist())) for s in slope)
    m = STEEPLY._replace(outside=STEEPLY.outside._replace(x=x, y=y))
    c = begun(DETECTOR, m, d, part, NOWHERE, UNMATCHED, STATE, 0.4)
    force, normal = in_world(*mine, 0.0), in_world(*mine, 0.0) / np.linalg.norm(mine)
    assert c.part == part
    assert c.force == pytest.approx(force)
    assert c.normal == pytest.approx(normal)
    assert c.point == pytest.approx(np.array(STATE.position) + in_world(*center) - normal * radius)
    assert (c.along, c.on_map) == (pytest.approx(center[1] - 0.05), 0.0)
    assert c.rise == pytest.approx(np.linalg.norm(mine) / np.linalg.norm(slope))
    known = NOWHERE._replace(matched=PAIR(1.0, 1.0), offset=Vec3(PAIR(0.0, 0.0), PAIR(-0.3, -0.3), PAIR(0.2, 0.2)))
    mapped = begun(DETECTOR, m, d, part, known, UNMATCHED, STATE, 0.4)
    assert (mapped.normal, mapped.on_map) == (Vec3(0.0, -1.0, 0.0), 1.0)


@pytest.mark.parametrize("beam", [UNMATCHED, BeamMatch(1.0, -0.3, Vec3(0.0, 0.05, 0.0))])
def test_a_beam_that_touches_is_told_where_the_push_acts_or_where_the_map_has_a_wall(beam):
    d, along = seen(push=FORCE), -0.3 if beam.matched else 0.4
    m = STEEPLY._replace(push=STEEPLY.push._replace(x=LowPassState(9.0, 30.0), y=LowPassState(9.0, 40.0)))
    c = begun(DETECTOR, m, d, BEAM, NOWHERE, beam, STATE, 0.4)
    normal = np.array([0.0, 1.0, 0.0]) if beam.matched else in_world(*FORCE, 0.0) / 5.0
    assert c.force == pytest.approx(in_world(*FORCE, 0.0))
    assert c.normal == pytest.approx(normal)
    assert c.point == pytest.approx(np.array(STATE.position) + in_world(0.0, 0.05 + along, -0.1) - normal * 0.06)
    assert (c.along, c.on_map, c.rise) == (along, beam.matched, pytest.approx(5.0 / 50.0))


def test_a_contact_is_over_without_force_or_once_the_part_has_moved_away_and_not_along_the_wall():
    c = NO_CONTACT._replace(part=1.0, normal=Vec3(-1.0, 0.0, 0.0), along=0.95)
    at = axis_of(DETECTOR, 1.0, 0.95, STATE)
    c = c._replace(point=at - c.normal * radius_of(DETECTOR, 1.0))
    for shift, quiet, over in (
        ((0.0, 0.0, 0.0), QUIET_TIME, 0.0),
        ((0.0, 0.0, 0.0), QUIET_TIME + 1e-9, 1.0),
        ((-AWAY - 1e-6, 0.0, 0.0), 0.0, 1.0),
        ((-AWAY + 1e-6, 0.5, 0.5), 0.0, 0.0),
        ((0.5, 0.0, 0.0), 0.0, 0.0),
        ((-1.0, 0.0, 0.0), 1.0, 1.0),
    ):
        assert is_over(DETECTOR, c, quiet, STATE._replace(position=STATE.position + Vec3(*shift))) == over


# Known walls


def wall_beside(x):
    """Upright walls parallel to y, at these x [m], one for each quadrotor."""
    zero = PAIR(0.0, 0.0)
    return Wall(PAIR(*x), PAIR(-50.0, -50.0), zero, PAIR(100.0, 100.0), PAIR(1e-4, 1e-4), PAIR(9.0, 9.0))


def test_a_force_away_from_a_near_wall_is_explained_by_the_first_wall_that_can():
    level = STATE._replace(position=ZERO, attitude=Quat(1.0, 0.0, 0.0, 0.0))
    far, near = wall_beside([5.0, 5.0]), wall_beside([0.1 + 0.32, -0.1 + 0.42])  # within the margin of both guards
    out = Vec3(PAIR(-3.0, -3.0), PAIR(1.0, 3.9), PAIR(0.0, 0.0))  # of the second, the cosine is just above the least
    for first, second in ((near, far), (far, near), (near, near)):
        found = guards_matched(NearWalls(first, second, Absent(), Absent()), GEOMETRY, level, out)
        assert found.matched == PAIR(1.0, 1.0)
        assert np.array(found.offset) == pytest.approx(np.array([[-0.32, -0.42], [0.0, 0.0], [0.0, 0.0]]))
    none = NearWalls(far, far, Absent(), Absent())
    walls = NearWalls(near, far, Absent(), Absent())
    sideways = Vec3(PAIR(-3.0, -3.0), PAIR(4.1, -4.1), PAIR(0.0, 0.0))
    into = Vec3(PAIR(3.0, 3.0), PAIR(0.0, 0.0), PAIR(0.0, 0.0))
    for known, force in ((none, out), (walls, sideways), (walls, into), (Absent(), out)):
        found = guards_matched(known, GEOMETRY, level, force)
        assert found.matched == PAIR(0.0, 0.0)
        assert not np.array(found.offset).any()


def test_of_two_posts_that_explain_a_force_the_first_counts():
    level, zero = STATE._replace(position=ZERO, attitude=Quat(1.0, 0.0, 0.0, 0.0)), PAIR(0.0, 0.0)
    near = Wall(PAIR(0.3, 0.1), PAIR(1.25, -0.7), zero, zero, zero, PAIR(9.0, 9.0))  # 0.2 and 0.25 or 0.3 m beside
    far = near._replace(x=PAIR(5.0, 5.0))
    out = Vec3(PAIR(-2.0, -2.0), PAIR(-2.5, -3.0), zero)
    for first, second in ((near, near), (near, far), (far, near)):
        found = guards_matched(NearWalls(first, second, Absent(), Absent()), GEOMETRY, level, out)
        assert found.matched == PAIR(1.0, 1.0)
        assert np.array(found.offset) == pytest.approx(np.array([[-0.2, -0.2], [-0.25, -0.3], [0.0, 0.0]]))


@pytest.mark.thorough
def test_what_is_heard_of_a_steady_force_is_nothing_and_of_a_sudden_one_all():
    """Deviations from slow means: c_i = f_i + m_i s_i on the guards, p = m_L s − Σ f_i, T = m s, j_i = f_i."""
    base = dict.fromkeys(PushEstimator._fields, 0.0)
    e = PushEstimator(**{**base, "quadrotors": GEOMETRY.quadrotors, "quadrotor_mass": PAIR(0.5, 0.7), "mass": 1.8})
    memory, hold = start_evidence(DETECTOR), 0.0

    def reading(a, first, second):
        imu = SimpleNamespace(
            specific_force=Vec3(a[0], a[1], 9.8),
            rates=ZERO,
            joint_force=Vec3(PAIR(first[0], second[0]), PAIR(first[1], second[1]), PAIR(0.0, 0.0)),
        )
        return SimpleNamespace(imu=imu, angular=ZERO, push=SimpleNamespace(armed=0.0))

    for _ in range(15000):
        memory, d = heard(DETECTOR, memory, e, reading((0.1, 0.2), (0.3, -0.1), (0.2, 0.4)), hold, DT)
    assert max(np.abs(np.array(part)).max() for part in d) < 1e-3
    for _ in range(100):  # long for the low-pass, short for the means
        memory, d = heard(DETECTOR, memory, e, reading((0.6, -0.2), (1.3, 0.9), (0.5, 1.4)), hold, DT)
    a, f = np.array([0.5, -0.4]), np.array([[1.0, 0.3], [1.0, 1.0]])  # the jumps; f: x and y by quadrotor
    wanted = Deviations(f + np.outer(a, [0.5, 0.7]), f + np.outer(a, [0.5, 0.7]), f, 3.0 * a, 1.8 * a - f.sum(axis=1))
    for found, part in zip(d, wanted, strict=True):
        assert np.array(found) == pytest.approx(part, abs=0.11)  # by which the slow means have followed
