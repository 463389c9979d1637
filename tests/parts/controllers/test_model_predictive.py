"""The model predictive controller of the examples: derivatives, quadratic program, flights."""

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import lsq_linear

import tandemlift as tl
from tandemlift.core.algebra import ZERO, Quat, Vec3
from tandemlift.parts.controllers import Reference, Trajectory

FILE = Path(__file__).parents[3] / "examples" / "controllers" / "model_predictive.py"


@pytest.fixture(scope="module")
def mpc():
    """The module of the file, as a flight loads it."""
    pytest.importorskip("piqp")
    return sys.modules[tl.load_controller(FILE).start.__module__]


@pytest.fixture(scope="module")
def planned(mpc):
    """The model of `iris` and its first plan."""
    mission = tl.load_mission("iris", controller=tl.load_controller(FILE))
    vehicle = tl.Vehicle.from_settings(mission.vehicle)
    return mpc.start(mission.controller, vehicle, mission.mission.step)


@pytest.fixture(scope="module")
def states():
    """States near hover, with unit quaternions."""
    rng = np.random.default_rng(0)
    x = 0.3 * rng.standard_normal((5, 13)) + np.eye(13)[6]
    x[:, 6:10] /= np.linalg.norm(x[:, 6:10], axis=1, keepdims=True)
    return x


LOAD = np.array([0.5, -0.3, 0.2, 0.02, 0.01, -0.03])


def thrusts_of(model, count):
    return model.hover * (1.0 + 0.2 * np.random.default_rng(1).standard_normal((count, model.hover.size)))


def test_the_predicted_motion_is_that_of_the_body_that_flies(mpc, planned, states):
    model, thrusts = planned[0], thrusts_of(planned[0], len(states))
    after = mpc.step(model, states, thrusts, LOAD, 0.05)[0]
    J = model.inertia

    def rate(_, x, u):
        w, i, j, k = x[6:10]
        body = np.array(
            [
                [1 - 2 * (j * j + k * k), 2 * (i * j - w * k), 2 * (i * k + w * j)],
                [2 * (i * j + w * k), 1 - 2 * (i * i + k * k), 2 * (j * k - w * i)],
                [2 * (i * k - w * j), 2 * (j * k + w * i), 1 - 2 * (i * i + j * j)],
            ]
        )
        wrench, spin = model.effect @ u, x[10:]
        force = body @ [0.0, 0.0, wrench[0]] - model.drag[0] * x[3:6] + LOAD[:3] - [0.0, 0.0, 9.81 * model.mass]
        torque = wrench[1:] + LOAD[3:] - model.drag[1] * spin - np.cross(spin, J @ spin)
        turn = 0.5 * np.array([-x[7:10] @ spin, *(w * spin + np.cross(x[7:10], spin))])
        return np.concatenate([x[3:6], force / model.mass, turn, np.linalg.solve(J, torque)])

    for x, u, end in zip(states, thrusts, after, strict=True):
        exact = solve_ivp(rate, (0.0, 0.05), x, args=(u,), rtol=1e-11, atol=1e-12).y[:, -1]
        np.testing.assert_allclose(end, exact, atol=2e-6)


def test_derivatives_of_the_prediction_are_those_of_central_differences(mpc, planned, states):
    model, thrusts, small = planned[0], thrusts_of(planned[0], len(states)), 1e-6

    def differences(size, moved):
        sides = [
            [mpc.step(model, *moved(sign * small * unit), LOAD, 0.05)[0] for sign in (1, -1)] for unit in np.eye(size)
        ]
        return np.stack([(up - down) / (2.0 * small) for up, down in sides], axis=2)

    _, by_states, by_thrusts = mpc.step(model, states, thrusts, LOAD, 0.05)
    np.testing.assert_allclose(by_states, differences(13, lambda d: (states + d, thrusts)), atol=1e-8)
    np.testing.assert_allclose(by_thrusts, differences(8, lambda d: (states, thrusts + d)), atol=1e-8)
    level = np.tile(np.eye(13)[6], (5, 1))
    by_error = [
        (mpc.errors(states + small * d, level)[0] - mpc.errors(states - small * d, level)[0]) for d in np.eye(13)
    ]
    np.testing.assert_allclose(mpc.errors(states, level)[1], np.stack(by_error, axis=2) / (2.0 * small), atol=1e-8)


def test_thrusts_solve_the_program_within_their_limits_as_scipy_does(mpc, planned, states):
    model, plan = planned
    low = plan._replace(states=np.tile(np.eye(13)[6], (mpc.NODES + 1, 1)))
    far = np.eye(13)[6] + 1.0 * np.eye(13)[0]  # 1 m away: some thrusts are at their limits
    wanted = np.tile(np.eye(13)[6], (mpc.NODES + 1, 1))
    program = mpc.condensed(model, low, far, wanted, LOAD)
    root = np.linalg.cholesky(program.hessian)
    best = lsq_linear(root.T, -np.linalg.solve(root, program.gradient), (program.low, program.high), tol=1e-12).x
    change = (mpc.solve(model, low, far, wanted, LOAD).thrusts - low.thrusts).ravel()
    at_limits = np.isclose(change, program.high, atol=1e-4) | np.isclose(change, program.low, atol=1e-4)
    assert 5 < at_limits.sum() < 100
    np.testing.assert_allclose(change, best, atol=1e-3)  # N


def test_without_a_solution_the_plan_stays(mpc, planned, monkeypatch):
    model, plan = planned
    level = np.tile(np.eye(13)[6], (mpc.NODES + 1, 1))
    monkeypatch.setattr(mpc, "TOLERANCE", 0.0)  # which no solution reaches
    after = mpc.solve(model, plan._replace(states=level), level[0] + 0.1, level, LOAD)
    assert np.array_equal(after.thrusts, plan.thrusts)
    assert after.wait == model.wait


def test_the_wanted_states_follow_the_reference(mpc, planned):
    model = planned[0]
    reference = Reference(Trajectory(Vec3(1.0, 2.0, 3.0), Vec3(0.5, 0.0, 0.0), ZERO), yaw=0.4)
    wanted = mpc.wanted_states(model, reference)
    assert wanted[-1, 0] - wanted[0, 0] == pytest.approx(0.5 * model.node * mpc.NODES)
    assert np.allclose(wanted[:, 6:10], Quat(np.cos(0.2), 0.0, 0.0, np.sin(0.2)))


@pytest.mark.thorough
def test_it_flies_to_a_place_away_with_thrusts_within_limits(mpc):
    changes = {"mission.duration": 5.0, "initial.position": [1.0, -1.0, 0.0], "phases.lift_start": 0.5}
    mission = tl.load_mission("hover", changes, controller=tl.load_controller(FILE))
    mpc.SOLVES.clear()
    flight = tl.fly(mission)
    assert flight.ending is None
    assert len(mpc.SOLVES) == 501
    assert np.abs(flight["position_error"][-1]).max() < 0.01  # m
