"""The record of touches that another engine's contacts are entered into, against a diary in plain Python."""

from __future__ import annotations

import numpy as np
import pytest
from law_values import rebuilt

import tandemlift as tl
from tandemlift.core.types import NEVER
from tandemlift.core.vector import Absent
from tandemlift.engines.touches import ContactLog
from tandemlift.parts.contact.standing import standing_on
from tandemlift.parts.contact.touches import start_touches
from tandemlift.parts.mechanics.vehicle import Vehicle

STEP, STEPS = 1e-3, 120  # s
MISSION = tl.load_mission("iris")
FLOOR = standing_on(
    MISSION.ground, Vehicle.from_settings(MISSION.vehicle), 1.0, MISSION.mission.step, MISSION.initial
).floor
COUNTS = {"rotor": 8, "guard": 2, "beam": 1}


def drawn_contacts(rng):
    """Of each step, the contacts with the floor: kind, number of the part, normal force [N], place [m]."""
    for _ in range(STEPS):
        yield [
            (kind, int(rng.integers(COUNTS[kind])), float(rng.exponential(5.0)), rng.standard_normal(3))
            for kind in rng.choice(list(COUNTS), int(rng.poisson(0.7)))
        ]


@pytest.mark.parametrize("seed", range(6))
def test_first_touch_greatest_force_and_impulse_are_those_of_a_diary(seed):
    """A part that several contacts press counts their sum; the place is that of its hardest one."""
    log, diary = ContactLog(FLOOR, Absent(), 2, STEP), {kind: [NEVER, None, 0, 0.0, 0.0] for kind in COUNTS}
    turning = np.ones(8)
    for k, contacts in enumerate(drawn_contacts(np.random.default_rng(seed))):
        for kind, index, normal, place in contacts:
            log.add("floor", kind, index, normal, place)
        log.end_step()
        for kind in {kind for kind, *_ in contacts}:
            pressed = [(index, normal, place) for one, index, normal, place in contacts if one == kind]
            sums = np.bincount([i for i, _, _ in pressed], [n for _, n, _ in pressed], COUNTS[kind])
            entry, hardest = diary[kind], int(sums.argmax())
            if not entry[2]:
                place = max((n, tuple(p)) for i, n, p in pressed if i == hardest)[1]
                entry[:3] = (k + 1) * STEP, place, hardest + 1
            entry[3], entry[4] = max(entry[3], sums.sum()), entry[4] + sums.sum() * STEP
            if kind == "rotor":
                turning[sums > 0.0] = 0.0
    found = rebuilt(log.numbers.tolist(), start_touches(FLOOR, Absent(), 8))
    assert list(found.turning) == turning.tolist()
    for kind, record in zip(COUNTS, (found.floor.rotors, found.floor.guards, found.floor.beam), strict=True):
        time, place, part, force, impulse = diary[kind]
        assert (record.time, record.part) == (pytest.approx(time), part)
        assert tuple(record.place) == (pytest.approx(place) if place else (0.0, 0.0, 0.0))
        assert (record.force, record.impulse) == (pytest.approx(force), pytest.approx(impulse))


def test_a_contact_that_presses_nothing_is_no_touch():
    log = ContactLog(FLOOR, Absent(), 2, STEP)
    before = log.numbers.copy()
    for normal in (0.0, -3.0, float("nan")):
        log.add("floor", "guard", 1, normal, [0.0, 0.0, 0.0])
    log.end_step()
    assert np.array_equal(log.numbers, before)


@pytest.mark.parametrize("normals", [(2.0, 5.0), (5.0, 2.0)])
def test_of_two_contacts_of_a_part_at_once_both_press_and_the_harder_is_the_place(normals):
    log, places = ContactLog(FLOOR, Absent(), 2, STEP), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    for normal, place in zip(normals, places, strict=True):
        log.add("floor", "beam", 0, normal, place)
    log.end_step()
    beam = rebuilt(log.numbers.tolist(), start_touches(FLOOR, Absent(), 8)).floor.beam
    assert list(beam.place) == places[int(np.argmax(normals))]
    assert (beam.force, beam.impulse) == (7.0, pytest.approx(7.0 * STEP))
