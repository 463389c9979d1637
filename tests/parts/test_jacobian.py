"""The derivative of a closed-loop step at hover, by JAX and by CasADi, against central differences."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from law_values import flat, rebuilt

import tandemlift as tl
from tandemlift.core.vector import Quat, Vec3
from tandemlift.simulation.loop.step import step_flight
from tandemlift.simulation.preparation.assemble import assemble

SETTINGS: dict[str, tuple[str, dict[str, Any]]] = {
    "paper": ("paper", {}),
    "flight-ready": ("flight-ready", {}),
    "power, full inertia": (
        "paper",
        {"controller.gains.a": 2.5, "vehicle.quadrotors.0.position": [0.3, 1.0, 0.2], "controller.euler_rates": "body"},
    ),
}


class Hover:
    """A step from hover at 1 m as a function of the state and the pilot's memory, and its central differences."""

    def __init__(self, name: str, changes: dict[str, Any]) -> None:
        self.mission = tl.load_mission(name, {"pushes": [], **changes})
        self.model, self.given, *_ = assemble(self.mission)
        state = self.model.flight_state.state._replace(
            position=Vec3(0.0, 0.0, 1.0), velocity=Vec3(0.0, 0.0, 0.0), attitude=Quat(1.0, 0.0, 0.0, 0.0)
        )
        self.like = state, self.model.flight_state.memory
        self.x0 = np.array([*flat(state), *flat(self.model.flight_state.memory)])

    def __call__(self, x: Any) -> list[Any]:
        """State and memory after a step of 1 ms at t = 40 s."""
        values = list(x)
        size = len(flat(self.like[0]))
        state, memory = rebuilt(values[:size], self.like[0]), rebuilt(values[size:], self.like[1])
        flight_state = self.model.flight_state._replace(state=state, memory=memory)
        after, _ = step_flight(self.model._replace(flight_state=flight_state), self.given, 40.0, 0.001)
        return flat((after.state, after.memory))

    def differences(self) -> np.ndarray:
        """Central differences, extrapolated to order four; all columns at once by broadcasting."""
        h, n = 1e-6, len(self.x0)
        columns = self.x0[:, None] + h * np.hstack([k * np.eye(n) for k in (1.0, -1.0, 2.0, -2.0)])
        rows = np.array([np.broadcast_to(row, 4 * n) for row in self(columns)])
        ahead, behind, far_ahead, far_behind = np.split(rows, 4, axis=1)
        return (8.0 * (ahead - behind) - (far_ahead - far_behind)) / (12.0 * h)


@pytest.fixture(scope="module", params=SETTINGS.values(), ids=SETTINGS)
def hover(request):
    return Hover(*request.param)


def test_hover_is_an_equilibrium(hover):
    assert hover(hover.x0) == pytest.approx(hover.x0, abs=1e-15)


def test_the_jacobian_by_jax_is_that_by_differences(hover, jax):
    J = jax.jit(jax.jacfwd(lambda x: jax.numpy.stack([jax.numpy.asarray(y) for y in hover(x)])))(hover.x0)
    assert np.asarray(J) == pytest.approx(hover.differences(), abs=2e-6)  # entries reach 224


def test_the_jacobian_by_casadi_is_that_by_differences(hover, casadi):
    x = casadi.SX.sym("x", len(hover.x0))
    J = casadi.Function("J", [x], [casadi.jacobian(casadi.vertcat(*hover(casadi.vertsplit(x))), x)])
    assert np.array(J(hover.x0)) == pytest.approx(hover.differences(), abs=2e-6)


def test_the_closed_loop_at_hover_is_stable(hover):
    """No eigenvalue outside the unit circle; on it only position held by no spring, and the quaternion's norm."""
    eigenvalues = np.linalg.eigvals(hover.differences())
    assert np.abs(eigenvalues).max() < 1.0 + 1e-6
