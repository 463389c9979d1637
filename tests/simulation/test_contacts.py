"""Touches of walls are named as such, quickly, and nothing else is; the reference stays out of the wall."""

import itertools

import numpy as np
import pytest
from validation.contacts import (
    ACROSS,
    KINDS,
    POST,
    SIDE,
    SOON,
    broken,
    contacts_named,
    is_blamed,
    jerky,
    touch_of,
    touching,
)
from validation.persons import random_persons

import tandemlift as tl
from tandemlift.core.phases import CONTACT
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.estimation.contact_detection import ContactEstimate
from tandemlift.parts.guidance.contact_hold import code_of
from tandemlift.simulation.touches import contact_codes, describe_contact

pytestmark = pytest.mark.filterwarnings("ignore::tandemlift.core.errors.FlightWarning")


def lasting(mission, seconds):
    """The mission with another duration [s]."""
    return mission.model_copy(update={"mission": mission.mission.model_copy(update={"duration": seconds})})


def events(flight):
    return [text for _, text in flight.metrics()["events"]]


def check_named(touch):
    """A touch is named soon, with the way out of the wall, and nothing else comes of it."""
    assert touch.named <= SOON
    assert touch.right
    assert not touch.sensor_fault
    assert not touch.crashed


@pytest.fixture(scope="module")
def touches():
    """Flights with a touch, two of each kind, at 0.2 m/s to 0.9 m/s."""
    flights = tl.fly_many([lasting(touching(kind, i), 18.0) for i, kind in enumerate(KINDS * 2, 5)])
    return dict(zip(enumerate(KINDS * 2), flights, strict=True))


@pytest.mark.thorough
def test_touches_are_named_soon_in_their_direction_and_no_sensor_is_blamed(touches):
    for key, flight in touches.items():
        touch = touch_of(flight)
        assert touch is not None, key
        check_named(touch)
        assert any(text.startswith("contact: ") for text in events(flight)), key


@pytest.mark.thorough
def test_the_part_the_place_and_the_wall_are_those_of_the_mission(touches):
    for (i, kind), flight in touches.items():
        found = np.flatnonzero(flight["contact_part"])[0]
        part, point = flight["contact_part"][found], flight["contact_point_estimate"][found]
        assert flight["contact_on_map"][found] == 1.0
        if kind == POST:
            wall = flight.mission["walls"][0]["start"]
            assert part == -1.0
            assert flight["contact_along_beam"][found] == pytest.approx(wall[1], abs=0.05)
            assert point[:2] == pytest.approx(wall, abs=0.05)
        if kind == SIDE:
            assert part in (1.0, 2.0), i
            assert abs(point[1]) == pytest.approx(2.0, abs=0.05)
            assert -flight["contact_normal"][found, 1] * np.sign(point[1]) > 0.9  # out of the side, or of its edge


def test_the_reference_leaves_the_wall_and_does_not_return_while_the_contact_lasts(touches):
    for key, flight in touches.items():
        found, gap = np.flatnonzero(flight["contact_part"])[0], flight.mission["contact"]["gap"]
        over = found + np.flatnonzero(flight["phase"][found + 5 :] != CONTACT)[0]
        again = np.flatnonzero(np.diff(flight["contact_part"][found:over]) > 0.0)
        until = found + again[0] if len(again) else over  # another touch has another boundary
        normal = flight["contact_normal"][found]
        level = flight["position"][found] @ normal
        way = flight["reference_position"][found + 5 : until] @ normal - level
        assert way.min() > -0.005, key
        assert way[-1] > 0.9 * min(gap, 0.1 * (until - found) * 0.002), key


@pytest.mark.thorough
def test_without_a_map_a_guard_that_touches_is_named_all_the_same():
    mission = touching(SIDE, 5)
    flight = tl.fly(
        lasting(mission.model_copy(update={"pilot": mission.pilot.model_copy(update={"map": "none"})}), 14.0)
    )
    check_named(touch_of(flight))
    assert not flight["contact_on_map"].any()


def test_a_contact_that_does_not_end_lands_the_vehicle():
    mission = touching(ACROSS, 6)
    assert mission.contact.hold_timeout == 10.0
    short = mission.model_copy(update={"contact": mission.contact.model_copy(update={"hold_timeout": 1.0})})
    flight = tl.fly(lasting(short, 18.0))
    assert "land" in events(flight)
    assert not flight["alarm"][flight["phase"] == CONTACT].any()


@pytest.mark.thorough
def test_the_same_touch_in_mujoco_is_named_likewise():
    mission = touching(SIDE, 5)
    ours, other = (touch_of(tl.fly(lasting(mission, 13.0), engine)) for engine in ("compiled", "mujoco"))
    check_named(other)
    assert other.speed == pytest.approx(ours.speed, abs=0.05)


@pytest.mark.thorough
def test_hands_are_no_contacts():
    led = random_persons("zigzag", 4, seed=3, changes={"supervision.model": "on", "mission.duration": 30.0})
    flown = tl.fly_many([*[lasting(jerky(i), 30.0) for i in range(4)], *led], keep="metrics")
    assert [contacts_named(metrics) for metrics in flown] == [0] * 8


@pytest.mark.thorough
def test_a_joint_sensor_that_breaks_under_a_hand_is_blamed_and_is_no_contact():
    flown = tl.fly_many([broken(i) for i in range(8)], keep="metrics")
    assert all(map(is_blamed, flown))
    assert [contacts_named(metrics) for metrics in flown] == [0] * 8


@pytest.mark.thorough
def test_a_flight_that_touches_nothing_is_the_same_with_and_without_the_watch():
    watched, other = (
        tl.fly(tl.load_mission("doorway", {"mission.duration": 25.0, "contact.model": model}))
        for model in ("on", "none")
    )
    assert not watched["contact_part"].any()
    assert np.array_equal(watched["position"], other["position"])
    assert np.array_equal(watched["rotor_thrusts"], other["rotor_thrusts"])


def test_an_event_says_part_place_and_direction(touches):
    for part, along, (x, y) in itertools.product(
        (-1.0, 1.0, 2.0, 64.0), (-0.42, 0.0, 1.37), ((1, 0), (0, -1), (0.7, 0.7))
    ):
        contact = ContactEstimate(part, ZERO, ZERO, along, Vec3(float(x), float(y), 0.0), 0.0, 0.0)
        where = f"beam, {abs(along):.2f} m from its centre" if part < 0.0 else f"guard of quadrotor {part:.0f}"
        side = {(1, 0): "−x", (0, -1): "+y", (0.7, 0.7): "−x −y"}[x, y]
        assert describe_contact(int(code_of(contact.part, contact.normal, contact.along))) == f"{where}, towards {side}"
    for flight in touches.values():
        first = next(code for code in contact_codes(flight) if code)
        assert f"contact: {describe_contact(first)}" in events(flight)
