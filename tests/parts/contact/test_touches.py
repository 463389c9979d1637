"""Contacts with two walls at once: as one, with the force of both at the place of the greater."""

import numpy as np
import pytest

from tandemlift.core.vector import Vec3, each
from tandemlift.parts.contact.spheres import ContactPair, WallContact
from tandemlift.parts.contact.touches import UNTOUCHED, PartContacts, harder_of, record_after

PAIR = each(2)


def pressed(normal, place):
    """A contact of which only force and place count."""
    return WallContact(**{**dict.fromkeys(WallContact._fields), "normal": normal, "place": place})


@pytest.mark.parametrize("turned", [False, True])
def test_two_walls_press_with_the_sum_of_their_forces_at_the_place_of_the_greater(turned):
    one = pressed(PAIR(3.0, 0.0), Vec3(PAIR(1.0, 1.0), PAIR(2.0, 2.0), PAIR(3.0, 3.0)))
    two = pressed(PAIR(2.0, 5.0), Vec3(PAIR(-1.0, -1.0), PAIR(-2.0, -2.0), PAIR(-3.0, -3.0)))
    force, place = harder_of(ContactPair(two, one) if turned else ContactPair(one, two))[:2]
    assert force == PAIR(5.0, 5.0)
    assert np.array(place) == pytest.approx(np.array([[1.0, -1.0], [2.0, -2.0], [3.0, -3.0]]))


@pytest.mark.parametrize("part", [1, 2])
def test_the_first_touch_stays_in_the_record_whichever_part_it_is_of(part):
    def touching(number, force, place):
        normal = PAIR(*[force if k == number else 0.0 for k in (1, 2)])
        return PartContacts(normal, Vec3(*[PAIR(place, place)] * 3))

    first = record_after(touching(part, 2.0, 0.5), UNTOUCHED, 1.0, 0.01)
    later = record_after(touching(3 - part, 9.0, 0.7), first, 2.0, 0.01)
    assert (first.part, first.time, first.place) == (part, 1.0, Vec3(0.5, 0.5, 0.5))
    assert later[:3] == first[:3]
    assert (later.force, later.impulse) == (9.0, pytest.approx(0.11))
