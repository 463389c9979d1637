"""One source everywhere, law by law: also the laws that no flight needs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from tandemlift.jit import install, load, store
from tandemlift.laws import admittance, expanded, parts, reference, rotation, sliding, virtual
from tandemlift.laws.body import Body, State, Wrench, motion
from tandemlift.laws.inertia import gyroscopic
from tandemlift.laws.push import PointPush
from tandemlift.ops import power
from tandemlift.vector import Mat3, Quat, Vec3, apply, apply_transposed, cross, hamilton, outer

from .helpers import flat, rebuilt

V = Vec3(0.0, 0.0, 0.0)
M = Mat3(V, V, V)
Q = Quat(0.0, 0.0, 0.0, 0.0)
EULER = rotation.Euler(V, *[0.0] * 7)
BODY = Body(0.0, V, V, V, V, V, V)
JOINT = parts.Joint(V, V)
SURFACE = sliding.Surface(V, V, sliding.Power(V), V, V, sliding.Tanh(V))
AXES = expanded.Axes(V, V)

LAWS: dict[str, tuple[Callable[..., Any], tuple[Any, ...]]] = {
    "cross": (cross, (V, V)),
    "apply": (apply, (M, V)),
    "apply transposed": (apply_transposed, (M, V)),
    "outer": (outer, (V, V)),
    "hamilton": (hamilton, (Q, Q)),
    "power": (power, (0.0, 0.0)),
    "rotation from Euler": (rotation.rotation_from_euler, (V,)),
    "quaternion from Euler": (rotation.quaternion_from_euler, (V,)),
    "rotation from quaternion": (rotation.rotation_from_quaternion, (Q,)),
    "rates from Euler rates": (rotation.rates_from_euler_rates, (EULER, V)),
    "Euler rates from rates": (rotation.euler_rates_from_rates, (EULER, V)),
    "quaternion rate": (rotation.quaternion_rate, (Q, V)),
    "gyroscopic, full": (gyroscopic, (M, V)),
    "point on body": (parts.point_on_body, (parts.Point(V, V, V), M, V, V, V)),
    "quadrotor acceleration": (parts.quadrotor_acceleration, (0.0, V, V, 0.0, V, V, JOINT)),
    "joint wrench, full": (parts.joint_wrench, (0.0, M, V, 0.0, V, V, parts.Acceleration(V, V))),
    "joint on payload": (parts.joint_on_payload, (M, V, JOINT)),
    "payload acceleration": (parts.payload_acceleration, (0.0, V, V, JOINT)),
    "virtual inputs": (virtual.virtual_inputs, (EULER, 0.0)),
    "total thrust": (virtual.total_thrust, (EULER, V)),
    "tilt, exact": (virtual.desired_orientation, (virtual.TiltZXY(), V, EULER, 0.0)),
    "tilt, printed": (virtual.desired_orientation, (virtual.TiltPrinted(), V, EULER, 0.0)),
    "smooth step": (reference.smoothstep, (0.0, 0.0, 0.0)),
    "soft gate": (admittance.gate, (admittance.SoftGate(V), V)),
    "sliding surface": (sliding.sliding_surface, (SURFACE, V, V)),
    "surface rate": (sliding.surface_rate, (SURFACE, V, V, V)),
    "wanted acceleration": (sliding.wanted_acceleration, (SURFACE, V, V)),
    "Lyapunov": (sliding.lyapunov, (V,)),
    "Lyapunov rate": (sliding.lyapunov_rate, (V, V)),
    "bound of the Lyapunov rate": (sliding.lyapunov_rate_bound, (V, V, V, V)),
    "reaching time": (sliding.reaching_time, (V, V, V, V)),
    "expanded dynamics": (expanded.expanded_dynamics, (BODY, V, V, AXES)),
    "Euler dynamics": (expanded.euler_dynamics, (BODY, EULER, V, V, Wrench(0.0, V))),
    "motion, pushed at points": (motion, (BODY, State(V, V, Q, V), Wrench(0.0, V), PointPush(V, M))),
}
POSITIVE = {"power", "smooth step", "soft gate", "sliding surface", "surface rate", "wanted acceleration"}
BATCH = 12
EACH = pytest.mark.parametrize("name", LAWS)


def record(name: str, values: Any) -> Any:
    """Any number of values as one nested value."""
    return NamedTuple(name, [(f"x{i}", Any) for i in range(len(values))])(*values)  # type: ignore[misc]


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


def agree(found: Any, wanted: np.ndarray) -> None:
    """To 1e-12 of the largest number of a law's answer."""
    assert np.abs(np.broadcast_to(found, wanted.shape) - wanted).max() < 1e-12 * (1.0 + np.abs(wanted).max())


@EACH
def test_numpy_broadcasts_the_law(name):
    agree(np.array([np.broadcast_to(row, BATCH) for row in evaluated(name, inputs(name))]), expected(name))


@EACH
def test_jax_evaluates_the_law(name, jax):
    rows = evaluated(name, list(jax.numpy.asarray(inputs(name))))
    agree(np.array([np.broadcast_to(row, BATCH) for row in rows]), expected(name))


@EACH
def test_casadi_traces_the_law(name, casadi):
    symbols = casadi.SX.sym("numbers", len(inputs(name)))
    outputs = casadi.vertcat(*evaluated(name, casadi.vertsplit(symbols)))
    agree(np.array(casadi.Function("law", [symbols], [outputs])(inputs(name))), expected(name))


@pytest.fixture(scope="module")
def compiled():
    """The answers of all laws from one compiled function."""
    install()
    like = record("Everything", [record(f"Of{i}", arguments) for i, (_, arguments) in enumerate(LAWS.values())])
    calls = ", ".join(f"f{i}(*x[{i}])" for i in range(len(LAWS)))
    scope: dict[str, Any] = {"load": load, "store": store, "like": like}
    scope |= {f"f{i}": law for i, (law, _) in enumerate(LAWS.values())}
    exec(f"def evaluate(a, y):\n    x = load(a, like)\n    store(y, ({calls}))", scope)
    evaluate = numba.njit(error_model="numpy")(scope["evaluate"])
    columns = np.vstack([inputs(name) for name in LAWS])
    wanted = {name: expected(name) for name in LAWS}
    found = np.zeros((sum(map(len, wanted.values())), BATCH))
    for i in range(BATCH):
        y = np.zeros(len(found))
        evaluate(columns[:, i].copy(), y)
        found[:, i] = y
    ends = np.cumsum([len(rows) for rows in wanted.values()])
    return dict(zip(LAWS, np.split(found, ends[:-1]), strict=True))


@EACH
def test_numba_compiles_the_law(name, compiled):
    agree(compiled[name], expected(name))
