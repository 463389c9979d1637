"""The reference: lift and landing as smooth steps on top of the admittance, with exact derivatives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from law_values import array, vectors

from tandemlift.core.trajectories import ScheduledPhases, Trajectory, reference, smoothstep
from tandemlift.core.vector import ZERO, Vec3

PHASES = ScheduledPhases(height=1.0, lift_start=2.0, lift_rate=1.0 / 6.0, land_start=70.0, land_rate=1.0 / 12.0)


@given(st.floats(-10.0, 20.0))
def test_the_smooth_step_is_the_quintic_held_at_its_ends(t):
    s = min(max((t - 2.0) / 6.0, 0.0), 1.0)
    assert smoothstep(t, 2.0, 1.0 / 6.0).value == pytest.approx(np.polyval([6, -15, 10, 0, 0, 0], s), abs=1e-14)


def test_a_step_of_rate_zero_never_comes():
    assert smoothstep(1e6, 0.0, 0.0) == (0.0, 0.0, 0.0)


def test_the_reference_carries_the_derivatives_of_its_position(jax):
    """By automatic differentiation, with the admittance under way during lift and landing."""

    def admittance(t):
        return Vec3(jax.numpy.sin(0.3 * t), 0.1 * t * t, 0.2 * jax.numpy.cos(0.5 * t))

    def rate(f):
        return lambda t: jax.jvp(f, (t,), (1.0,))[1]

    def position(t):
        T = Trajectory(admittance(t), rate(admittance)(t), rate(rate(admittance))(t))
        return reference(PHASES, T, t)

    for t in (0.5, 2.7, 7.9, 40.0, 76.0):
        found = position(t)
        assert array(found.velocity) == pytest.approx(array(rate(lambda t: position(t).position)(t)), abs=1e-14)
        assert array(found.acceleration) == pytest.approx(array(rate(lambda t: position(t).velocity)(t)), abs=1e-14)


@given(vectors(), st.floats(82.0, 100.0))
def test_the_reference_lands_at_zero_height_wherever_it_was_pushed(pushed, t):
    down = reference(PHASES, Trajectory(pushed, ZERO, ZERO), t)
    assert array(down.position) == pytest.approx([pushed.x, pushed.y, 0.0])
    assert array(down.velocity) == pytest.approx(np.zeros(3))


@given(vectors(), st.floats(8.0, 70.0))
def test_between_lift_and_landing_the_reference_is_the_admittance_at_height(pushed, t):
    up = reference(PHASES, Trajectory(pushed, ZERO, ZERO), t)
    assert array(up.position) == pytest.approx([pushed.x, pushed.y, pushed.z + 1.0], abs=1e-14)
