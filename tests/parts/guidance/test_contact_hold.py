"""The reaction to a contact, sample by sample: when it begins, what it remembers, and when it leads to a landing."""

from typing import NamedTuple

import numpy as np
import pytest

from tandemlift.core.vector import ZERO, Quat, Vec3, vec3
from tandemlift.parts.estimation.contact_detection import NO_CONTACT
from tandemlift.parts.guidance.compliance import ComplianceState
from tandemlift.parts.guidance.contact_hold import (
    LEAD,
    LEAVING_SPEED,
    ContactReaction,
    code_of,
    contact_of,
    kept_out,
    react_to_contact,
    start_reaction,
)
from tandemlift.parts.guidance.guidance import PilotInput
from tandemlift.parts.mechanics.rigid_body import State

DT = 0.01
COMPLIANCE = ComplianceState(*[None] * 5, *[ZERO] * 5)
REACTION = ContactReaction(gap=0.3, recovery_time=0.2, hold_timeout=3.0)
STATE = State(Vec3(0.0, 0.0, 1.0), ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
WALL = NO_CONTACT._replace(part=1.0, normal=Vec3(-1.0, 0.0, 0.0), point=Vec3(1.0, 0.0, 1.0))


class Felt(NamedTuple):
    """What the pilot's sensors say of a contact."""

    contact: object


@contact_of.register(Felt)
def _felt(sensed: Felt) -> object:
    return sensed.contact


def reacting(contact, seconds, aloft=1.0, state=STATE, memory=None):
    """[(time, boundary)] of a contact(t), and the memory at the end."""
    memory, boundaries = memory or start_reaction(), []
    for k in range(round(seconds / DT)):
        sensed = PilotInput(state, ZERO, ZERO, 0.0, Felt(contact(k * DT)))
        boundary, memory = react_to_contact(REACTION, memory, sensed, aloft, DT)
        boundaries.append((k * DT, boundary))
    return boundaries, memory


def lands_at(contact, seconds):
    """When the first landing is asked for [s], or None."""
    return next((t for t, boundary in reacting(contact, seconds)[0] if boundary.land), None)


@pytest.mark.parametrize(("pause", "lands"), [(0.5, True), (2.8, False)])
def test_time_without_a_contact_takes_back_the_time_in_contact(pause, lands):
    """Contacts of 1.6 s, each held for the recovery time longer; a pause beyond that takes back as much as it lasts."""
    time = lands_at(lambda t: WALL if t % (1.6 + pause) < 1.6 else NO_CONTACT, 12.0)
    held = 1.6 + REACTION.recovery_time
    if lands:
        left = held - (pause - REACTION.recovery_time)  # of the first contact as the second begins: that lands it
        assert time == pytest.approx(1.6 + pause + REACTION.hold_timeout - left, abs=5 * DT)
    else:
        assert held < pause - REACTION.recovery_time + 0.8 * held
        assert time is None


def test_the_code_of_a_contact_is_that_of_its_first_touch_until_another_part_touches_or_it_is_over():
    other_side = WALL._replace(normal=Vec3(0.0, 1.0, 0.0), along=0.5)
    other_part = WALL._replace(part=2.0, normal=Vec3(0.0, -1.0, 0.0))

    def story(t):
        return (
            WALL if t < 0.5 else other_side if t < 1.0 else other_part if t < 1.5 else NO_CONTACT if t < 2.0 else WALL
        )

    found = {round(t, 2): boundary.code for t, boundary in reacting(story, 2.5)[0]}
    first, second, third = (code_of(c.part, c.normal, c.along) for c in (WALL, other_part, other_side))
    assert len({first, second, third, 0.0}) == 4
    assert found[0.0] == found[0.49] == found[0.5] == found[0.99] == first
    assert found[1.0] == found[1.49] == found[1.6] == second  # also while the boundary is left
    assert found[1.9] == 0.0
    assert found[2.0] == found[2.49] == first


def test_along_a_wall_the_reference_leads_the_vehicle_by_so_much_and_leaves_the_wall_slowly():
    """A wall at 60° to the axes: the plane through the vehicle's place; level, so that height is left alone."""
    normal, aside = np.array([0.5, np.sqrt(0.75), 0.0]), np.array([-np.sqrt(0.75), 0.5, 0.0])
    wall = WALL._replace(normal=vec3(normal))
    boundary = reacting(lambda t: wall, 0.1)[0][-1][1]
    place = np.array(STATE.position)
    for out, along, up in ((-0.2, 0.1, 0.3), (0.05, 0.6, -0.2), (-0.1, -0.9, 0.0), (0.5, 0.0, 0.1)):
        at = place + out * normal + along * aside + [0.0, 0.0, up]
        m = COMPLIANCE._replace(position=vec3(at), velocity=vec3(-normal + aside), acceleration=vec3(normal))
        kept = kept_out(boundary, m, DT)
        found = np.array(kept.position) - place
        assert found @ normal == pytest.approx(max(out, min(REACTION.gap, max(out, 0.0) + LEAVING_SPEED * DT)))
        assert found @ aside == pytest.approx(np.clip(along, -LEAD, LEAD))
        assert found[2] == pytest.approx(up)
        assert kept.velocity == pytest.approx(aside)  # nothing into the wall
        assert kept.acceleration == m.acceleration


def test_the_boundarys_lever_is_the_distance_that_a_turn_takes_the_touching_part_from_the_wall():
    """By differences: the vehicle turned by a small yaw about its centre, the part with it."""
    centre, touch, angle = np.array([0.2, 0.4, 1.0]), np.array([1.0, -0.5, 1.3]), 1e-6
    normal = np.array([-0.8, 0.6, 0.0])
    turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    leaves = normal @ (turn @ (touch - centre) - (touch - centre)) / angle
    contact = WALL._replace(normal=vec3(normal), point=vec3(touch))
    boundaries, _ = reacting(lambda t: contact, DT, state=STATE._replace(position=vec3(centre)))
    assert boundaries[0][1].lever == pytest.approx(leaves, abs=1e-5)
