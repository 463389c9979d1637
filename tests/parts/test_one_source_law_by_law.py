"""One source everywhere, law by law: those that the steps of `test_one_source.py` do not need."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from law_values import flat, rebuilt, record, zeros
from machine_code import answers

from tandemlift.core import low_pass
from tandemlift.core.vector import Absent, Mat3, Quat, Vec3, each, outer
from tandemlift.parts.controllers import attitude_reference, sliding_surface
from tandemlift.parts.estimation import wind_compensation
from tandemlift.parts.estimation.wrench import delay, extended_kalman, fused, hybrid, kalman, momentum
from tandemlift.parts.estimation.wrench.observation import NominalBody, Observation, observe
from tandemlift.parts.guidance import guidance, policy
from tandemlift.parts.mechanics import equations_of_motion, parts, rotation
from tandemlift.parts.mechanics.rigid_body import RigidBody, State, Wrench
from tandemlift.parts.pilot import excitation, rotor_lead
from tandemlift.parts.rotor_loss import decision as rotor_loss_decision
from tandemlift.parts.rotor_loss import detection as rotor_loss_detection
from tandemlift.parts.rotors import allocation


def zeros_of(count: int) -> Any:
    """So many zeros."""
    return each(count)(*[0.0] * count)


V, Q = zeros(Vec3), zeros(Quat)
M = zeros(Mat3)
EULER, STATE, WRENCH, JOINT = zeros(rotation.Euler), zeros(State), zeros(Wrench), zeros(parts.Joint)
DIAGONAL = {"inertia": V, "inverse_inertia": V}
BODY, VEHICLE = zeros(RigidBody, **DIAGONAL), zeros(NominalBody, **DIAGONAL)
POWER, TANH = zeros(sliding_surface.Power), zeros(sliding_surface.Tanh)
SURFACE = zeros(sliding_surface.Surface, exponent=POWER, switching=TANH)
AXES = zeros(equations_of_motion.GeneralizedVector)
TWO, FOURS, EIGHT = (zeros_of(count) for count in (2, 4, 8))  # a value of every quadrotor, rotor, and all rotors
MIXER = allocation.Mixer(*[EIGHT] * len(allocation.Mixer._fields))
LOW = zeros(low_pass.LowPass)
SMOOTH, SMOOTHS, SLOPE = (low_pass.LowPassState(value, value) for value in (FOURS, EIGHT, V))
DETECTION = zeros(
    rotor_loss_detection.RotorLossDetection,
    inertia=V,
    effect=MIXER,
    scatter=FOURS,
    bound=FOURS,
    trial=EIGHT,
    numbers=EIGHT,
)
WATCHING = zeros(
    rotor_loss_detection.DetectionState,
    rotors=SMOOTHS,
    thrusts=SMOOTHS,
    **dict.fromkeys(("momentum", "others", "mean", "scatter"), SMOOTH),
    verdict=zeros(rotor_loss_decision.DecisionState, lost=EIGHT, above=EIGHT),
)
HEARD = zeros(guidance.PilotInput, sensed=Absent())
BLOWN, OBSERVED = zeros(wind_compensation.PayloadDragState, force=SLOPE), zeros(Observation)
ALONE = zeros(kalman.KalmanObserver, body=VEHICLE)
COMPARED = zeros(fused.Monitor)
SINES = excitation.Sines(*[FOURS] * len(excitation.Sines._fields))
ALL_AXES = dict.fromkeys(("thrust", "roll", "pitch", "yaw"), SINES)
NO_AXES = dict.fromkeys(("thrust", "roll", "pitch", "yaw"), Absent())
TWO_WAYS = excitation.ReferenceSines(x=SINES, y=Absent(), z=SINES)
LAWS: dict[str, tuple[Callable[..., Any], tuple[Any, ...]]] = {
    "outer": (outer, (V, V)),
    "rates from Euler rates": (rotation.rates_from_euler_rates, (EULER, V)),
    "point on body": (parts.point_on_body, (zeros(parts.Point), M, V, V, V)),
    "quadrotor acceleration": (parts.quadrotor_acceleration, (0.0, V, V, 0.0, V, V, JOINT)),
    "joint wrench, full": (parts.joint_wrench, (0.0, M, V, 0.0, V, V, zeros(parts.Acceleration))),
    "joint on payload": (parts.joint_on_payload, (M, V, JOINT)),
    "payload acceleration": (parts.payload_acceleration, (0.0, V, V, JOINT)),
    "virtual inputs": (rotation.virtual_inputs, (EULER, 0.0)),
    "surface rate": (sliding_surface.surface_rate, (SURFACE, V, V, V)),
    "Lyapunov": (sliding_surface.lyapunov, (V,)),
    "Lyapunov rate": (sliding_surface.lyapunov_rate, (V, V)),
    "bound of the Lyapunov rate": (sliding_surface.lyapunov_rate_bound, (V, V, V, V)),
    "reaching time": (sliding_surface.reaching_time, (V, V, V, V)),
    "expanded dynamics": (equations_of_motion.expanded_dynamics, (BODY, V, V, AXES)),
    "Euler dynamics": (equations_of_motion.euler_dynamics, (BODY, EULER, V, V, WRENCH)),
    "watching for a lost rotor": (
        rotor_loss_detection.detection_step,
        (DETECTION, WATCHING, HEARD, EIGHT, 0.0, 0.0, 0.0),
    ),
    "the wrench of rotors that are later than known": (
        delay.late_wrench,
        (zeros(delay.RotorDelay), zeros(delay.RotorDelayState), WRENCH, 0.0, 0.0, 0.0),
    ),
    "wind on the payload": (
        wind_compensation.wind_on_payload,
        (zeros(wind_compensation.PayloadDrag), BLOWN, TWO, TWO, 1.0, 0.0, 0.0, 1.0),
    ),
    "a wrench with lead": (
        rotor_lead.lead_step,
        (zeros(rotor_lead.RotorLead), zeros(rotor_lead.RotorLeadState), WRENCH),
    ),
    "an excited wrench": (
        excitation.excited,
        (zeros(excitation.Excitation, **ALL_AXES, motion=Absent()), WRENCH, 0.0, 0.0),
    ),
    "the reference of an excitation": (
        excitation.excited_lead,
        (zeros(excitation.Excitation, **NO_AXES, motion=TWO_WAYS), Absent(), 0.0),
    ),
    "a smooth attitude reference": (
        attitude_reference.shape_reference,
        (zeros(attitude_reference.SmoothCommandFilter), zeros(attitude_reference.SmoothCommandFilterState), V),
    ),
    "damping by a policy": (
        policy.policy_damping,
        (zeros(policy.Policy, hidden=zeros_of(14), outputs=zeros_of(6)), SLOPE, V, 0.0),
    ),
    "pure delay": (delay.delayed, (LOW, SLOPE, V)),
    "momentum": (observe, (zeros(momentum.MomentumObserver, body=VEHICLE), zeros(momentum.MomentumState), OBSERVED)),
    "hybrid": (observe, (zeros(hybrid.HybridObserver, body=VEHICLE), zeros(hybrid.HybridState), OBSERVED)),
    "kalman": (observe, (ALONE, zeros(kalman.KalmanState), OBSERVED)),
    "extended kalman": (
        observe,
        (zeros(extended_kalman.ExtendedKalmanFilter, body=VEHICLE), zeros(extended_kalman.FilterState), OBSERVED),
    ),
    "fused": (
        fused.fuse,
        (zeros(fused.FusedFilter, alone=ALONE, inertia=V), zeros(fused.FusedState), OBSERVED, zeros(fused.JointPush)),
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
