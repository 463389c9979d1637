"""A load beyond the rotors passes if it carries the vehicle less far than allowed: the closed form of a pulse."""

import math

import numpy as np
import pytest

from tandemlift.parts.flight_checks.hover_loads import Loads, VehicleLoads

MASS, LEFT = 3.5, 6.0  # kg; N by which the rotors brake without the load
NONE = np.zeros(3)


def pulse(force, duration, parts=1):
    """A load of constant force [N] for a duration [s], once or in parts with pauses of as long, and then none."""
    on = VehicleLoads("", np.array([force, 0.0, 0.0]), NONE, NONE, NONE)
    off = on._replace(force=NONE)
    spans = [(duration / parts, on), (duration / parts, off)] * parts
    return on._replace(course=lambda: [*spans, (100.0, off)])


def excess(load):
    return load.across - LEFT


def way_of(force, duration):
    """While it acts ½ a T², and until it stands v²/2b, with v = a T."""
    a, b = (force - LEFT) / MASS, LEFT / MASS
    return 0.5 * a * duration**2 + (a * duration) ** 2 / (2.0 * b)


@pytest.mark.parametrize(("force", "duration"), [(10.0, 0.3), (40.0, 0.05), (7.0, 1.5)])
def test_a_pulse_carries_the_vehicle_as_far_as_the_closed_form_says(force, duration):
    way, load = way_of(force, duration), pulse(force, duration)
    allowed = Loads([], way, way, way, math.inf, lag=0.0)
    assert allowed.pass_by(load, excess, MASS, 1.001 * way)
    assert not allowed.pass_by(load, excess, MASS, 0.999 * way)


def test_rotors_that_brake_later_let_it_go_farther_by_its_speed():
    force, duration, lag = 40.0, 0.05, 0.2
    way = way_of(force, duration) + (force - LEFT) / MASS * duration * lag
    late = Loads([], way, way, way, math.inf, lag)
    assert late.pass_by(pulse(force, duration), excess, MASS, 1.001 * way)
    assert not late.pass_by(pulse(force, duration), excess, MASS, 0.999 * way)


def test_a_pulse_that_lasts_too_long_does_not_pass_however_weak_it_is():
    barely = pulse(LEFT + 1e-6, 0.5)
    assert Loads([], 1.0, 1.0, 1.0, 0.501, 0.0).pass_by(barely, excess, MASS, 1.0)
    assert not Loads([], 1.0, 1.0, 1.0, 0.499, 0.0).pass_by(barely, excess, MASS, 1.0)


def test_pulses_add_up_while_the_vehicle_moves():
    one, five = pulse(40.0, 0.05), pulse(40.0, 0.25, parts=5)
    allowed = Loads([], 0.2, 0.2, 0.2, math.inf, 0.0)
    assert allowed.pass_by(one, excess, MASS, 0.2)
    assert not allowed.pass_by(five, excess, MASS, 0.2)


def test_a_load_without_an_end_does_not_pass():
    assert not Loads([], 1e9, 1e9, 1e9, 1e9, 0.0).pass_by(
        pulse(LEFT + 1.0, 1.0)._replace(course=tuple), excess, MASS, 1e9
    )


def test_the_worst_load_is_one_that_does_not_pass():
    tap, weak = pulse(40.0, 0.01), pulse(LEFT + 1.0, 1.0)._replace(course=tuple)
    assert Loads([tap, weak], 0.2, 0.2, 0.2, 0.5, 0.0).worst(excess, MASS, 0.2) is weak
