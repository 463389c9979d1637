"""Running metrics: effort, saturation and the errors of an estimate.

All others are proven on whole flights, in `tests/flight/test_flight.py`.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from tandemlift.core.vector import ZERO, Absent, Vec3, each
from tandemlift.parts.guidance.guidance import ThrustFraction
from tandemlift.parts.rotors.allocation import ConstrainedAllocation
from tandemlift.parts.rotors.rotor_faults import RotorFaults
from tandemlift.parts.rotors.rotors import Rotors
from tandemlift.simulation.loop.estimate_errors import NO_ERRORS, PushErrors, error_metrics, with_errors
from tandemlift.simulation.loop.running_metrics import (
    EMPTY,
    NO_EFFORT,
    added,
    at_limit,
    contribution_of,
    effort_of,
)


def test_effort_counts_only_while_the_grip_is_held():
    effort = NO_EFFORT
    for k in range(10):
        effort = added(effort, effort_of(float(k < 4), Vec3(0.0, 3.0, 4.0), Vec3(0.6, 0.0, -0.8)))
    assert effort == pytest.approx((4.0, 20.0, 4.0))


def saturated(running, known_from=None):
    """Whether a step at 1 s counts as saturated whose first rotor is within its limits and whose second one is at one.

    `known_from`: time [s] from which on the pilot knows that the second one has failed.
    """
    rotors = Rotors(**{**dict.fromkeys(Rotors._fields), "max_thrust": each(2)(5.0, 5.0)})
    names = ("position", "velocity", "euler", "rates", "moment", "push_force", "push_moment")
    references = ("reference_position", "reference_velocity", "reference_euler")
    sample = SimpleNamespace(thrust=1.0, **dict.fromkeys((*names, *references), ZERO))
    guidance = SimpleNamespace(running=ThrustFraction(running), channels=Absent())
    decision = SimpleNamespace(thrusts=each(2)(1.0, 0.0), guidance=guidance)
    plant = SimpleNamespace(walls=Absent(), frame=None)
    memory = SimpleNamespace(detection=Absent())
    state = SimpleNamespace(near=Absent(), state=None, person=Absent(), metrics=EMPTY, memory=memory)
    known = Absent() if known_from is None else RotorFaults(each(2)(9.0, known_from), each(2)(0.0, 0.0))
    allocation = ConstrainedAllocation(None, None, None, None, known)
    pilot = SimpleNamespace(allocation=allocation, detection=Absent())
    model, output = SimpleNamespace(rotors=rotors, plant=plant, flight_state=state, pilot=pilot), SimpleNamespace()
    output.decision, output.estimates = decision, Absent()
    return contribution_of(model, output, sample, Absent(), 1.0).saturated


def test_rotors_that_stand_still_are_not_saturated():
    assert (saturated(1.0), saturated(0.0)) == (1.0, 0.0)
    assert (saturated(1.0, known_from=0.5), saturated(1.0, known_from=2.0)) == (0.0, 1.0)
    assert [at_limit(f, 5.0) for f in (-1.0, 0.0, 1e-9, 4.9, 5.0, 6.0)] == [1.0, 1.0, 0.0, 0.0, 1.0, 1.0]


def test_errors_of_an_estimate_give_its_delay_and_its_noise():
    """A late estimate of a smooth push, with an offset of the moment: least squares find the delay."""
    step, delay, t = 1e-3, 0.02, 1e-3 * np.arange(4000)
    true, found = (3.0 * np.exp(-(((t - late) - 2.0) ** 2) / 0.72) for late in (0.0, delay))
    sums = NO_ERRORS
    for k in range(len(t)):
        off = Vec3(found[k] - true[k], 0.0, 0.0)
        sums = with_errors(sums, PushErrors(1.0, off, Vec3(0.0, 0.1, 0.0), Vec3(true[k], 0.0, 0.0)))
    metrics = error_metrics(sums, Absent(), step)
    assert metrics["push_delay_s"] == pytest.approx(delay, rel=0.02)
    assert metrics["push_force_rmse_n"] == pytest.approx([np.sqrt(np.mean((found - true) ** 2)), 0.0, 0.0])
    assert metrics["push_moment_rmse_n_m"] == pytest.approx([0.0, 0.1, 0.0])
    assert error_metrics(Absent(), Absent(), step) == {}
