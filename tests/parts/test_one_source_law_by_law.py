"""One source everywhere, law by law: those that the steps of `test_one_source.py` do not need."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from law_values import flat, rebuilt, record
from machine_code import answers

from tandemlift.core import low_pass
from tandemlift.core.vector import Absent, Mat3, Quat, Vec3, each, outer
from tandemlift.parts.controllers import attitude_reference, sliding_surface
from tandemlift.parts.estimation import wind_compensation
from tandemlift.parts.estimation.wrench import delay, extended_kalman, fused, hybrid, kalman, momentum
from tandemlift.parts.estimation.wrench.observation import ExternalWrench, NominalBody, Observation, observe
from tandemlift.parts.guidance import guidance, policy
from tandemlift.parts.mechanics import equations_of_motion, parts, rotation
from tandemlift.parts.mechanics.rigid_body import RigidBody, State, Wrench
from tandemlift.parts.pilot import excitation, rotor_lead
from tandemlift.parts.rotor_loss import decision as rotor_loss_decision
from tandemlift.parts.rotor_loss import detection as rotor_loss_detection
from tandemlift.parts.rotors import allocation

V = Vec3(0.0, 0.0, 0.0)
M = Mat3(V, V, V)
Q = Quat(0.0, 0.0, 0.0, 0.0)
EULER = rotation.Euler(V, *[0.0] * 7)
BODY = RigidBody(0.0, V, V, V, V, V, V)
JOINT = parts.Joint(V, V)
SURFACE = sliding_surface.Surface(V, V, sliding_surface.Power(V), V, V, sliding_surface.Tanh(V))
AXES = equations_of_motion.GeneralizedVector(V, V)
STATE = State(V, V, Q, V)
TWO, EIGHT = each(2)(0.0, 0.0), each(8)(*[0.0] * 8)  # a value of every quadrotor, and of every rotor
MIXER = allocation.Mixer(EIGHT, EIGHT, EIGHT, EIGHT)
FOURS, LOW = each(4)(*[0.0] * 4), low_pass.LowPass(*[0.0] * 4)
SMOOTH, SMOOTHS = low_pass.LowPassState(FOURS, FOURS), low_pass.LowPassState(EIGHT, EIGHT)
DETECTION = rotor_loss_detection.RotorLossDetection(
    0.0, V, MIXER, LOW, LOW, LOW, LOW, FOURS, FOURS, EIGHT, EIGHT, rotor_loss_decision.DecisionRules(*[0.0] * 6)
)
WATCHING = rotor_loss_detection.DetectionState(
    *[SMOOTHS] * 2, *[SMOOTH] * 4, rotor_loss_decision.DecisionState(EIGHT, 0.0, 0.0, EIGHT, 0.0)
)
HEARD = guidance.PilotInput(STATE, V, V, 0.0, Absent())
SLOPE, STILL = low_pass.LowPassState(V, V), low_pass.LowPassState(0.0, 0.0)
BLOWN = wind_compensation.PayloadDragState(V, 0.0, SLOPE)
VEHICLE, OBSERVED = NominalBody(0.0, V, V), Observation(V, STATE, Wrench(0.0, V), V, V, Q, 0.0, 0.0)
ALONE, LOW_PASS = kalman.KalmanObserver(VEHICLE, V, V, V), low_pass.LowPass(*[0.0] * 4)
COMPARED = fused.Monitor(V, V, *[low_pass.LowPassState(V, V)] * 3)
SPREAD = extended_kalman.BlockCovariance(*[V] * 6)

SINES = excitation.Sines(*[each(4)(*[0.0] * 4)] * 3)
LAWS: dict[str, tuple[Callable[..., Any], tuple[Any, ...]]] = {
    "outer": (outer, (V, V)),
    "rates from Euler rates": (rotation.rates_from_euler_rates, (EULER, V)),
    "point on body": (parts.point_on_body, (parts.Point(V, V, V), M, V, V, V)),
    "quadrotor acceleration": (parts.quadrotor_acceleration, (0.0, V, V, 0.0, V, V, JOINT)),
    "joint wrench, full": (parts.joint_wrench, (0.0, M, V, 0.0, V, V, parts.Acceleration(V, V))),
    "joint on payload": (parts.joint_on_payload, (M, V, JOINT)),
    "payload acceleration": (parts.payload_acceleration, (0.0, V, V, JOINT)),
    "virtual inputs": (rotation.virtual_inputs, (EULER, 0.0)),
    "surface rate": (sliding_surface.surface_rate, (SURFACE, V, V, V)),
    "Lyapunov": (sliding_surface.lyapunov, (V,)),
    "Lyapunov rate": (sliding_surface.lyapunov_rate, (V, V)),
    "bound of the Lyapunov rate": (sliding_surface.lyapunov_rate_bound, (V, V, V, V)),
    "reaching time": (sliding_surface.reaching_time, (V, V, V, V)),
    "expanded dynamics": (equations_of_motion.expanded_dynamics, (BODY, V, V, AXES)),
    "Euler dynamics": (equations_of_motion.euler_dynamics, (BODY, EULER, V, V, Wrench(0.0, V))),
    "watching for a lost rotor": (
        rotor_loss_detection.detection_step,
        (DETECTION, WATCHING, HEARD, EIGHT, 0.0, 0.0, 0.0),
    ),
    "the wrench of rotors that are later than known": (
        delay.late_wrench,
        (
            delay.RotorDelay(LOW, 0.0, LOW_PASS, 0.0, 0.0),
            delay.RotorDelayState(STILL, low_pass.LowPassState(V, V), STILL, STILL, 0.0, 0.0, Wrench(0.0, V)),
            Wrench(0.0, V),
            *[0.0] * 3,
        ),
    ),
    "wind on the payload": (
        wind_compensation.wind_on_payload,
        (wind_compensation.PayloadDrag(0.0, 0.0, V, LOW), BLOWN, TWO, TWO, 1.0, 0.0, 0.0, 1.0),
    ),
    "a wrench with lead": (
        rotor_lead.lead_step,
        (
            rotor_lead.RotorLead(LOW, 0.0, V),
            rotor_lead.RotorLeadState(low_pass.LowPassState(0.0, 0.0), SLOPE),
            Wrench(0.0, V),
        ),
    ),
    "an excited wrench": (
        excitation.excited,
        (excitation.Excitation(0.0, 0.0, 0.0, 0.0, *[SINES] * 4, Absent()), Wrench(0.0, V), 0.0, 0.0),
    ),
    "the reference of an excitation": (
        excitation.excited_lead,
        (
            excitation.Excitation(*[0.0] * 4, *[Absent()] * 4, excitation.ReferenceSines(SINES, Absent(), SINES)),
            Absent(),
            0.0,
        ),
    ),
    "a smooth attitude reference": (
        attitude_reference.shape_reference,
        (
            attitude_reference.SmoothCommandFilter(LOW, attitude_reference.CommandFilter(0.0, LOW)),
            attitude_reference.SmoothCommandFilterState(SLOPE, attitude_reference.CommandFilterState(V, V)),
            V,
        ),
    ),
    "damping by a policy": (
        policy.policy_damping,
        (policy.Policy(each(14)(*[0.0] * 14), each(6)(*[0.0] * 6), 0.0, V), low_pass.LowPassState(V, V), V, 0.0),
    ),
    "pure delay": (delay.delayed, (LOW, low_pass.LowPassState(V, V), V)),
    "momentum": (
        observe,
        (momentum.MomentumObserver(VEHICLE, V, V), momentum.MomentumState(ExternalWrench(V, V), V, V, 0.0), OBSERVED),
    ),
    "hybrid": (observe, (hybrid.HybridObserver(VEHICLE, V, V), hybrid.HybridState(V, V, V, 0.0), OBSERVED)),
    "kalman": (observe, (kalman.KalmanObserver(VEHICLE, V, V, V), kalman.KalmanState(V, V, V, 0.0), OBSERVED)),
    "extended kalman": (
        observe,
        (
            extended_kalman.ExtendedKalmanFilter(VEHICLE, V, V, 0.0, 0.0, 0.0, 0.0),
            extended_kalman.FilterState(V, V, Q, V, V, V, SPREAD, SPREAD, 0.0),
            OBSERVED,
        ),
    ),
    "fused": (
        fused.fuse,
        (
            fused.FusedFilter(ALONE, V, V, 0.0, V, fused.TurningGains(V, V, V, V), V, V, LOW_PASS, LOW_PASS),
            fused.FusedState(kalman.KalmanState(V, V, V, 0.0), COMPARED, COMPARED, 0.0, 0.0),
            OBSERVED,
            fused.JointPush(V, V, V, V, 0.0, 0.0, 0.0, 0.0),
        ),
    ),
}
POSITIVE = {"extended kalman", "surface rate", "watching for a lost rotor"}
LONG_IN_XLA = {"extended kalman", "fused", "watching for a lost rotor"}  # some ten seconds to compile each
BATCH = 12
EACH = pytest.mark.parametrize("name", LAWS)


def inputs(name: str) -> np.ndarray:
    """Random numbers for a law's arguments: (numbers × BATCH)."""
    rng = np.random.default_rng(len(name))
    numbers = rng.uniform(-1.5, 1.5, (len(flat(LAWS[name][1])), BATCH))
    if name == "reaching time":  # λ₁ > 0, λ₂ > |δ|
        numbers[:6], numbers[9:] = 2.0 + np.abs(numbers[:6]), numbers[9:] * 0.5
    return np.abs(numbers) if name in POSITIVE else numbers


def evaluated(name: str, numbers: Any) -> list[Any]:
    law, arguments = LAWS[name]
    return flat(law(*rebuilt(numbers, record("Arguments", arguments))))


def expected(name: str) -> np.ndarray:
    return np.array([evaluated(name, map(float, column)) for column in inputs(name).T]).T


def assert_agreement(found: Any, wanted: np.ndarray) -> None:
    """To 1e-12 of the largest number of a law's answer."""
    assert np.abs(np.broadcast_to(found, wanted.shape) - wanted).max() < 1e-12 * (1.0 + np.abs(wanted).max())


@EACH
def test_numpy_broadcasts_the_law(name):
    assert_agreement(np.array([np.broadcast_to(row, BATCH) for row in evaluated(name, inputs(name))]), expected(name))


@EACH
def test_jax_evaluates_the_law(name, jax):
    rows = evaluated(name, list(jax.numpy.asarray(inputs(name))))
    assert_agreement(np.array([np.broadcast_to(row, BATCH) for row in rows]), expected(name))


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.learning] * (name in LONG_IN_XLA)) for name in LAWS]
)
def test_jax_compiles_the_law_for_more_rows_than_it_takes_in_one_piece(name, jax):
    many = 16_500  # 0.10.2 repeated rows of sums from row 16,384 on
    numbers = np.tile(inputs(name), -(-many // BATCH))[:, :many] * np.linspace(0.9, 1.1, many)
    found = np.array(
        jax.jit(jax.vmap(lambda row: jax.numpy.stack(jax.numpy.broadcast_arrays(*evaluated(name, list(row))))))(
            numbers.T
        )
    )
    assert_agreement(found.T, np.array([np.broadcast_to(row, many) for row in evaluated(name, numbers)]))


@EACH
def test_casadi_traces_the_law(name, casadi):
    symbols = casadi.SX.sym("numbers", len(inputs(name)))
    outputs = casadi.vertcat(*evaluated(name, casadi.vertsplit(symbols)))
    assert_agreement(np.array(casadi.Function("law", [symbols], [outputs])(inputs(name))), expected(name))


@EACH
def test_machine_code_of_the_law(name):
    law, arguments = LAWS[name]
    alone, block = (answers(law, arguments, inputs(name).T, lanes) for lanes in (1, 8))
    assert_agreement(alone.T, expected(name))
    assert np.array_equal(alone, block)
