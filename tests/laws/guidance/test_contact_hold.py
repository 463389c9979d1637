"""The reaction to a contact, sample by sample: when it begins, what it remembers, and when it leads to a landing."""

from typing import NamedTuple

import pytest

from tandemlift.algebra.vector import ZERO, Quat, Vec3
from tandemlift.laws.estimation.contact_detection import NO_CONTACT
from tandemlift.laws.guidance.contact_hold import ContactReaction, contact_of, react_to_contact, start_reaction
from tandemlift.laws.guidance.guidance import PilotInput
from tandemlift.laws.mechanics.rigid_body import State

DT = 0.01
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


def test_a_contact_longer_than_its_time_leads_to_a_landing():
    assert lands_at(lambda t: WALL, 5.0) == pytest.approx(3.0, abs=2 * DT)
    assert lands_at(lambda t: NO_CONTACT, 5.0) is None


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
