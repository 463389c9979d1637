"""The derivative over a period against the compiled flight itself, and against hand-made models."""

from __future__ import annotations

import numpy as np
import pytest
from linearized import QUIET, NativePeriod, linearized

import tandemlift as tl
from tandemlift.missions import tables_of

MOST_ROTORS = {f"vehicle.quadrotors.{i}.max_speed": 862.0 for i in (0, 1)}  # rad/s, little more than hovering takes
FOLLOWING = {"compliance.thrust_fraction": 1.0, "compliance.following.time": 5.0}  # although no thrust is left
POLICY = {"compliance.policy.model": "network"}
MOVING = {"initial.euler": [0.05, -0.04, 0.1], "initial.position": [0.3, -0.2, 0.0]}


def check_differences(of, found, skipped=()):
    """Central differences of the compiled flight agree, but for columns of states on a known edge."""
    names = [*[of.recipe.graph.names[i] for i in of.recipe.choice.kept], *["under way"] * len(of.recipe.waiting)]
    columns = [j for j, name in enumerate(names) if not name.startswith(tuple(skipped))]
    size = 1.0 + np.abs(of.made.A).max(axis=1, keepdims=True)
    error = (np.abs(found - of.made.A) / size)[:, columns]
    worst = [(names[i], names[columns[j]]) for i, j in np.argwhere(error > 1e-5)[:5]]
    assert error.max() < 1e-5, worst


@pytest.mark.parametrize(
    ("name", "changes", "at"),
    [("paper", MOVING, 22.3), ("hover", MOVING, 2.2), ("iris", QUIET, 13.6), ("iris", QUIET | POLICY, 13.6)],
    ids=["paper", "hover", "iris: five steps, delays, sensors", "policy"],
)
def test_a_period_is_that_of_the_compiled_flight(name, changes, at):
    of = linearized(name, changes, at)
    native = NativePeriod(of.recipe)
    assert native(of.made.x0) == pytest.approx(of.made.x1, rel=1e-12, abs=1e-12)
    check_differences(of, native.jacobian(of.made.x0, 1e-7))


def test_many_quadrotors_whose_flight_is_compiled_in_loops_are_linearized_too():
    (first, _) = tables_of(tl.load_mission("hover"))["vehicle"]["quadrotors"]
    turns = 2.0 * np.pi * np.arange(6) / 6.0
    fleet = [{**first, "position": [1.2 * np.cos(turn), 1.2 * np.sin(turn), 0.075]} for turn in turns]
    of = linearized("hover", {"vehicle.quadrotors": fleet, **MOVING}, 2.2)
    native = NativePeriod(of.recipe)
    assert native(of.made.x0) == pytest.approx(of.made.x1, rel=1e-12, abs=1e-12)
    check_differences(of, native.jacobian(of.made.x0, 1e-7))


def test_a_mission_that_rounds_products_and_sums_apart_is_linearized_as_it_flies():
    of = linearized("hover", {"mission.fma": False, **MOVING}, 2.2)
    assert "fma" not in of.recipe.graph.graph.ops
    assert np.array_equal(NativePeriod(of.recipe)(of.made.x0), of.made.x1)


@pytest.mark.thorough
def test_a_sensor_period_is_composed_of_single_steps():
    of = linearized("iris", QUIET, 13.6)
    assert of.recipe.steps == 5
    product = np.eye(len(of.made.A))
    for step in range(5):
        one = linearized("iris", QUIET, 13.6 + 0.001 * step, steps=1)
        product = one.made.A @ product
    assert pytest.approx(product, rel=1e-9, abs=1e-9 * np.abs(product).max()) == of.made.A


def test_the_solver_of_limits_is_differentiated_at_its_active_set():
    """Limits act from 13.426 s; from 13.431 s, free rotors are closer to them than the differences."""
    of = linearized("iris", QUIET | MOST_ROTORS | FOLLOWING, 13.428, steps=1)
    (step,) = of.made.steps
    assert step.limits_active
    held = [of.recipe.graph.next[i] for i, n in enumerate(of.recipe.graph.names) if n.startswith("memory.allocation.a")]
    assert 0 < np.count_nonzero(step.nodes.values_of(held)) < 8
    native = NativePeriod(of.recipe)
    check_differences(of, native.jacobian(of.made.x0, 1e-7))


def test_a_body_that_stands_on_the_floor_is_linearized_with_its_contact():
    of = linearized("iris", QUIET, 0.3, steps=1)
    assert of.made.steps[0].may_touch
    native = NativePeriod(of.recipe)
    check_differences(
        of, native.jacobian(of.made.x0, 1e-9), ["rotors", "under way", "estimator.confirmation.speeds"]
    )  # rotors at rest: at their limit
    names = [of.recipe.graph.names[i] for i in of.recipe.choice.kept]
    z, v = names.index("state.position.z"), names.index("state.velocity.z")
    assert of.made.A[v, z] < -1.0  # the floor is a stiff spring


def test_the_vertical_axis_of_paper_has_the_poles_of_its_transfer_function():
    """By hand: thrust m (g + κ S), S = −v − ξ z, κ = λ₁ + λ₂/Φ, held over a step, on a mass with drag."""
    model = tl.linearize(tl.load_mission("paper"), 9.5)
    gains = {"xi": 11.0, "lambda_1": 200.0, "lambda_2": 100.0, "boundary_layer": 0.1}
    kappa, T, drag = gains["lambda_1"] + gains["lambda_2"] / gains["boundary_layer"], 0.001, 6e-3 / 3.5
    decay = np.exp(-drag * T)
    A = np.array([[1.0, (1.0 - decay) / drag], [0.0, decay]])
    B = np.array([0.5 * T * T * (1.0 - drag * T / 3.0), (1.0 - decay) / drag])  # of a held acceleration
    closed = A - np.outer(B, [kappa * gains["xi"], kappa + gains["xi"] - drag])
    poles = np.sort(np.linalg.eigvals(closed))
    names = [v.name for v in model.states]
    rows = [names.index("position.z"), names.index("velocity.z")]
    assert np.sort(np.linalg.eigvals(model.A[np.ix_(rows, rows)]).real) == pytest.approx(poles, rel=1e-9)
    eigenvalues = np.linalg.eigvals(model.A)
    assert all(np.abs(eigenvalues - pole).min() < 1e-9 for pole in poles)


def test_the_body_alone_is_a_free_body_under_its_thrusts():
    model = tl.linearize(tl.load_mission("hover"), of="body", inputs=["rotor_thrusts", "push_force"])
    names, T, mass = [v.name for v in model.states], 0.001, 3.5
    v = [names.index(f"velocity.{axis}") for axis in "xyz"]
    assert model.B[v[2], :8] == pytest.approx(T / mass, rel=1e-5)
    assert model.B[v, 8:] == pytest.approx(T / mass * np.eye(3), rel=1e-5, abs=1e-12)
    assert np.abs(model.B[v[:2], :8]).max() < 1e-7  # a torque tilts the thrust within the step
