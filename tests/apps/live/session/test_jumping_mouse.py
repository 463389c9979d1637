"""Thrusts while the mouse jumps: the vehicle follows, and its rotors do not chatter."""

import warnings

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.core.types import unflat
from tandemlift.core.vector import Vec3
from tandemlift.parts.person.virtual_hand import HAND_RELEASED
from tandemlift.simulation.recorded_flight import RecordedFlight

RATE = 60  # targets a second
GRABBED = 14.0  # s, when the vehicle hovers and its sensors are tared
PULLED = 6.0  # s
CHATTER = 0.6  # N: 1.7 to 2.0 N with a damper between hand and grip; 0.2 N at most with a still hand


def jumping_mouse(rng):
    """Targets (n, 3) [m] from where the mouse began: steps of some centimetres, and jumps of 0.3 m."""
    n = round(PULLED * RATE)
    at, targets = np.zeros(3), np.zeros((n, 3))
    for i in range(n):
        if i % 6 == 0:
            step = rng.normal(0.0, 0.02, 3) * [1.0, 1.0, 0.3]
        at = 0.97 * at + step * (i % 6 < 2)
        targets[i] = at
    targets[:, 0] += np.where(np.arange(n) // (2.5 * RATE) % 2 == 0, 0.15, -0.15)
    return targets


@pytest.mark.thorough
def test_rotors_do_not_chatter_while_the_mouse_jumps():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tl.FlightWarning)
        flight = RecordedFlight(interactive_mission(tl.load_mission("iris")))
    lift = round(1.0 / flight.dt)
    while flight.step * flight.dt < GRABBED:
        flight.hold(HAND_RELEASED._replace(lift=float(lift <= flight.step < lift + 200)))
        flight.advance()
    start, begun, thrusts, way = unflat(flight.sample, flight.layout).position, flight.step, [], []
    targets = jumping_mouse(np.random.default_rng(1))
    while (flight.step - begun) * flight.dt < PULLED:
        place = Vec3(*targets[min(int((flight.step - begun) * flight.dt * RATE), len(targets) - 1)])
        flight.hold(HAND_RELEASED._replace(held=1.0, target=start + place))
        flight.advance()
        sample = unflat(flight.sample, flight.layout)
        thrusts.append(list(sample.rotor_thrusts))
        way.append(sample.position.x)
    assert np.std(thrusts, axis=0).mean() < CHATTER
    assert np.ptp(way) > 0.05
