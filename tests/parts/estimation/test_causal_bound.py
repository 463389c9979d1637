"""Filters of the wrench against the causal Cramér-Rao bound: the steady covariance of the same model, by SciPy."""

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from tandemlift.core.vector import ZERO, Quat, vec3
from tandemlift.parts.estimation.wrench.fused import JointPush, fuse, fused_filter
from tandemlift.parts.estimation.wrench.kalman import kalman_observer
from tandemlift.parts.estimation.wrench.observation import NominalBody, Observation, observe
from tandemlift.parts.mechanics.rigid_body import State, Wrench

MASS, INERTIA, GRAVITY, T, STEPS, SETTLED = 3.5, np.array([3.2, 0.06, 3.3]), 9.81, 1e-3, 6000, 1000
BODY = NominalBody(MASS, vec3(INERTIA), vec3(1.0 / INERTIA))
FORCE, MOMENT = np.array([0.1, 0.1, 0.06]), np.array([0.1, 0.01, 0.1])  # N/√s, N m/√s
ACCELEROMETER, GYROSCOPE, JOINT, TORQUE = 0.03, 0.0025, 0.05, 0.005
ARMS = np.array([2.0, 0.0, 2.0])  # m², Σ of the squares of the joints' arms
BOUND = 1.25


def bound(A, Q, C, R):
    """The steady covariance after a measurement."""
    P = solve_discrete_are(A.T, C.T, Q, R)
    return P - P @ C.T @ np.linalg.inv(C @ P @ C.T + R) @ C @ P


@pytest.mark.parametrize("joints", [False, True])
def test_force_and_moment_are_within_a_quarter_of_the_bound(joints):
    """A level vehicle under a force and a moment that are random walks, as the filters assume."""
    rng = np.random.default_rng(11)
    by_force = 2 * JOINT**2
    by_moment = np.sqrt(2 * TORQUE**2 + ARMS * JOINT**2)
    force = np.cumsum(rng.normal(size=(STEPS, 3)) * FORCE * np.sqrt(T), axis=0)
    moment = np.cumsum(rng.normal(size=(STEPS, 3)) * MOMENT * np.sqrt(T), axis=0)
    rates = (np.cumsum(moment, axis=0) - moment) * T / INERTIA
    noise = [rng.normal(size=(STEPS, 3)) for _ in range(4)]
    alone, memory = kalman_observer(BODY, vec3(FORCE), vec3(MOMENT), ACCELEROMETER, GYROSCOPE, T)
    k, both = fused_filter(
        alone,
        (vec3(FORCE), vec3(MOMENT)),
        (1e3, 1e3),
        (0.0, ZERO, ZERO),
        (ACCELEROMETER, GYROSCOPE, JOINT, TORQUE),
        [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]],
        T,
    )
    found, before = np.zeros((STEPS, 6)), np.zeros(3)
    for i in range(STEPS):
        measured = rates[i] + noise[1][i] * GYROSCOPE
        specific = force[i] / MASS + noise[0][i] * ACCELEROMETER + [0.0, 0.0, GRAVITY]
        state = State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), vec3(measured))
        gyroscopic = np.cross(measured, INERTIA * measured)  # which the rotors take out: the model is linear
        rotors = Wrench(MASS * GRAVITY, vec3(gyroscopic))
        x = Observation(vec3(specific), state, rotors, ZERO, ZERO, state.attitude, 0.0, T)
        if joints:
            pushed, turned = force[i] + noise[2][i] * np.sqrt(by_force), moment[i] + noise[3][i] * by_moment
            push = JointPush(
                vec3(pushed), vec3(turned), vec3((measured - before) / T), ZERO, 0.0, armed=1.0, trusted=1.0, free=1.0
            )
            wrench, both = fuse(k, both, x, push)
        else:
            wrench, memory = observe(alone, memory, x)
        found[i], before = [*wrench.force, *wrench.moment], measured
    errors = np.sqrt(np.mean((found - np.hstack([force, moment]))[SETTLED:] ** 2, axis=0))
    for axis in range(3):
        one, walk = np.ones((2, 1)), np.array([[FORCE[axis] ** 2 * T]])
        R = np.diag([(MASS * ACCELEROMETER) ** 2, by_force])[: 1 + joints, : 1 + joints]
        least = np.sqrt(bound(np.eye(1), walk, one[: 1 + joints], R)[0, 0])
        assert 0.8 * least < errors[axis] < BOUND * least
        A = np.array([[1.0, T / INERTIA[axis]], [0.0, 1.0]])
        Q, R = np.diag([0.0, MOMENT[axis] ** 2 * T]), np.diag([GYROSCOPE**2, by_moment[axis] ** 2])
        least = np.sqrt(bound(A, Q, np.eye(2)[: 1 + joints], R[: 1 + joints, : 1 + joints])[1, 1])
        assert 0.8 * least < errors[3 + axis] < BOUND * least
