"""One source everywhere: the whole step in plain Python, NumPy, machine code, JAX and CasADi, for several variants."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from law_values import flat, rebuilt
from machine_code import answers

import tandemlift as tl
from tandemlift.compiler.machine_code.machine import QUICK
from tandemlift.core.types import leaves
from tandemlift.simulation.loop.step import FlightModel, StepInputs, step_flight
from tandemlift.simulation.preparation.assemble import assemble

IDEAL: dict[str, dict[str, Any]] = {
    "tanh, hard gate, zero derivatives, exact rates, exact tilt, cubic, diagonal inertia, central pushes": {},
    "saturation, soft gate, filtered, body rates, printed tilt, power, full inertia, pushes at points, feed-forward": {
        "controller.switching": "saturation",
        "controller.attitude_reference_derivatives": "filtered",
        "controller.euler_rates": "body",
        "controller.tilt_inverse": "printed",
        "controller.gains.a": 2.5,
        "controller.human_force_feedforward": True,
        "admittance.gate": "soft",
        "vehicle.quadrotors.1.position": [-0.2, -1.0, 0.3],
        "vehicle.quadrotors.1.layout": "x",
        "pushes.0.point": [0.1, 0.8, -0.06],
    },
    "sign, soft gate, filtered, exact rates, exact tilt, power, full inertia, pushes at points, re-anchoring": {
        "controller.switching": "sign",
        "controller.attitude_reference_derivatives": "filtered",
        "controller.gains.a": 1.5,
        "admittance.gate": "soft",
        "admittance.stiffness": 2.0,
        "admittance.hold_after_release": True,
        "vehicle.quadrotors.0.position": [0.3, 1.0, 0.2],
        "pushes.0.point": [0.1, 0.8, -0.06],
    },
}
REAL = "real rotors, limits, floor, walls, turbulence, gusts, sensors, estimators"
VARIANTS: dict[str, tuple[str, dict[str, Any]]] = {
    **{name: ("paper", changes) for name, changes in IDEAL.items()},
    REAL: (
        "iris",
        {
            "wind.model": "air",
            "wind.turbulence": 3.0,
            "wind.velocity": [3.0, 1.0, 0.0],
            "wind.gusts": [{"velocity": [1.0, 0.0, 0.5], "start": 4.0, "rise": 2.0}],
            "walls": [{"start": [1.0, -3.0], "end": [1.0, 3.0]}],
            "faults": [{"quadrotor": 1, "rotor": 2, "time": 3.0, "efficiency": 0.5}],
            "sensors.motion.delay": 0.01,
        },
    ),
}
BATCH = 16
T, DT = 5.0, 0.001


class Step(NamedTuple):
    """What a step depends on, apart from its time."""

    model: FlightModel
    given: StepInputs


class Case:
    """A variant, a batch of excited inputs (numbers × BATCH), and what plain Python makes of them."""

    def __init__(self, name: str, changes: dict[str, Any]) -> None:
        model, given, *_ = assemble(tl.load_mission(name, changes))
        self.like = Step(model, given)
        rng = np.random.default_rng(8)
        state_size, outside = len(flat(model.flight_state)), len(flat(given))
        numbers = np.repeat(np.array(flat(self.like), dtype=float)[:, None], BATCH, axis=1)
        numbers[:state_size] = 0.3 * rng.standard_normal((state_size, BATCH))
        numbers[-outside:] = rng.standard_normal((outside, BATCH))
        attitude = slice(6, 10)
        numbers[attitude] += [[1.0], [0.0], [0.0], [0.0]]
        numbers[attitude] /= np.linalg.norm(numbers[attitude], axis=0)
        self.numbers = numbers
        self.expected = np.array([self.step(map(float, column)) for column in numbers.T]).T

    def step(self, numbers: Any) -> list[Any]:
        """The numbers of (Moving, Sample) after a step."""
        step = rebuilt(numbers, self.like)
        return flat(step_flight(step.model, step.given, T, DT))

    def assert_agreement(self, found: Any) -> None:
        """Every number is that of plain Python to 1e-12 of the largest in its row."""
        difference = np.abs(np.broadcast_to(found, self.expected.shape) - self.expected)
        size = 1.0 + np.abs(self.expected).max(axis=1, keepdims=True)
        assert np.all(np.isfinite(self.expected))
        assert (difference / size).max() < 1e-12


@cache
def case_of(name: str) -> Case:
    return Case(*VARIANTS[name])


@pytest.fixture(params=VARIANTS)
def case(request):
    return case_of(request.param)


def test_variants_differ_in_type():
    """So that the tests below fly different loops."""
    from tandemlift.simulation.plan import FlightPlan

    assert len({FlightPlan(tl.load_mission(*variant)).variant for variant in VARIANTS.values()}) == len(VARIANTS)


def test_numpy_broadcasts_the_step(case):
    rows = case.step(case.numbers)
    case.assert_agreement(np.array([np.broadcast_to(row, BATCH) for row in rows]))


def test_jax_evaluates_the_step(case, jax):
    rows = case.step(list(jax.numpy.asarray(case.numbers)))  # operation by operation: XLA needs minutes for the longest
    case.assert_agreement(np.array([np.broadcast_to(row, BATCH) for row in rows]))


def test_casadi_traces_the_step(case, casadi):
    symbols = casadi.SX.sym("numbers", len(case.numbers))
    outputs = casadi.vertcat(*case.step(casadi.vertsplit(symbols)))
    case.assert_agreement(np.array(casadi.Function("step", [symbols], [outputs])(case.numbers)))


def test_casadi_traces_the_step_of_a_vehicle_whose_parameters_are_numbers(case, casadi):
    symbols = casadi.SX.sym("numbers", len(case.numbers))
    constant = (case.numbers == case.numbers[:, :1]).all(axis=1)  # also of limits that are infinite
    choices = zip(constant, casadi.vertsplit(symbols), case.numbers[:, 0], strict=True)
    outputs = casadi.vertcat(*case.step([float(number) if known else symbol for known, symbol, number in choices]))
    case.assert_agreement(np.array(casadi.Function("step", [symbols], [outputs])(case.numbers)))


def compiled_step(model, given):
    return step_flight(model, given, T, DT)


@pytest.mark.parametrize("lanes", [1, 8])
def test_machine_code_of_the_step(case, lanes):
    assert len(case.numbers) == leaves(case.like)
    found = answers(compiled_step, tuple(case.like), case.numbers.T, lanes, QUICK)  # the bits of optimised code
    case.assert_agreement(found.T)
