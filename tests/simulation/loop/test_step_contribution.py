"""What a step adds to the running metrics, from its sample and the pilot's decision."""

from types import SimpleNamespace

import numpy as np
import pytest

from tandemlift.core.vector import Absent, each, vec3
from tandemlift.parts.guidance.guidance import ThrustFraction
from tandemlift.parts.rotors.rotors import Rotors
from tandemlift.simulation.loop.running_metrics import at_limit, contribution_of

ROTORS = Rotors(**{**dict.fromkeys(Rotors._fields), "max_thrust": each(2)(5.0, 5.0)})
RNG = np.random.default_rng(0)
NAMES = (
    "position", "velocity", "euler", "rates", "moment", "push_force", "push_moment",
    "reference_position", "reference_velocity", "reference_euler",
)  # fmt: skip
ROWS = {name: RNG.uniform(-1.0, 1.0, 3) for name in NAMES}
SAMPLE = SimpleNamespace(thrust=20.0, **{name: vec3(row) for name, row in ROWS.items()})


def errors(running=1.0):
    decision = SimpleNamespace(
        thrusts=each(2)(1.0, 0.0), guidance=SimpleNamespace(running=ThrustFraction(running), channels=Absent())
    )
    plant = SimpleNamespace(walls=Absent(), frame=None)
    state = SimpleNamespace(near=Absent(), state=None, person=Absent())
    model = SimpleNamespace(rotors=ROTORS, plant=plant, flight_state=state)
    return contribution_of(model, SimpleNamespace(decision=decision), SAMPLE, Absent())


def test_errors_are_the_reference_less_what_is_and_power_is_force_times_speed():
    found, x = errors(), ROWS
    assert found.position == pytest.approx(x["reference_position"] - x["position"])
    assert found.velocity == pytest.approx(x["reference_velocity"] - x["velocity"])
    assert found.attitude == pytest.approx(x["reference_euler"] - x["euler"])
    assert found.power == pytest.approx(x["push_force"] @ x["velocity"] + x["push_moment"] @ x["rates"])
    assert (found.thrust, found.height) == (20.0, x["position"][2])
    assert (found.tilt, found.moment, found.push) == (SAMPLE.euler, SAMPLE.moment, SAMPLE.push_force)


def test_rotors_that_stand_still_are_not_saturated():
    assert (errors(1.0).saturated, errors(0.0).saturated) == (1.0, 0.0)
    assert [at_limit(f, 5.0) for f in (-1.0, 0.0, 1e-9, 4.9, 5.0, 6.0)] == [1.0, 1.0, 0.0, 0.0, 1.0, 1.0]
