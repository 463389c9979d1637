"""Model predictive control of all rotor thrusts, by real-time iteration.

At each solve the predicted trajectory of the last one, shifted, is linearised at every node
(multiple shooting). The states are eliminated (condensing), and PIQP solves a quadratic program of
the thrusts, whose limits are a box: one Gauss-Newton step of the optimal control problem (Diehl et
al., Journal of Process Control 12, 2002).

    pip install piqp
    tandemlift compare iris --controllers nftsmc,examples/controllers/model_predictive.py
"""

from collections.abc import Callable
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
import piqp

import tandemlift.parts.controllers as tc
from tandemlift.core.algebra import Quat, Vec3
from tandemlift.core.keys import Positive, Positive3, key

NODES = 20
TOLERANCE = 1e-6  # of the quadratic program: its thrusts are right to a millinewton
POSITION, VELOCITY, ATTITUDE, RATES = slice(3), slice(3, 6), slice(6, 10), slice(10, 13)
GRAVITY, UP = 9.81, np.array([[0.0], [0.0], [1.0]])  # m/s²; world z
Times = tuple[float, float]
SOLVES: list[Times] = []  # of each solve, and of PIQP in it [s], for whoever measures them


class Settings(tc.ControllerTable):
    """`[controller]`: the horizon, the lag, and weights of errors at a node."""

    node_interval: Positive = key(0.05, "s", "time from a node to the next")
    interval: Positive = key(0.01, "s", "time from a solve to the next; the wrench is held between")
    lag: Positive = key(0.03, "s", "lag and delay of the rotors: the horizon begins so much later")
    preview: Positive = key(0.5, "s", "time in which the reference's acceleration dies away")
    position_weight: Positive3 = key(400.0, "1/m²", "weight of the position error")
    velocity_weight: Positive3 = key(40.0, "s²/m²", "weight of the velocity error")
    attitude_weight: Positive3 = key(0.5, "1/rad²", "weight of the attitude error: tilt, heading")
    rates_weight: Positive3 = key(0.5, "s²/rad²", "weight of the rates")
    thrust_weight: Positive = key(0.05, "1/N²", "weight of a rotor's thrust beyond that of hover")
    final_weight: Positive = key(10.0, None, "weights at the last node, over those at the others")


class Model(NamedTuple):
    """The pilot's model of the vehicle, and the weights as factors (12) of the errors of a node.

    `effect` (4, rotors): thrust and moments from the rotors' thrusts. `wait`: steps between solves.
    """

    mass: float
    inertia: np.ndarray
    inverse: np.ndarray
    drag: tuple[np.ndarray, np.ndarray]
    effect: np.ndarray
    limits: tuple[np.ndarray, np.ndarray]
    hover: np.ndarray
    roots: np.ndarray
    final: float
    thrust_weight: float
    node: float
    lag: float
    preview: float
    interval: float
    wait: int


class Plan(NamedTuple):
    """Memory: planned states (NODES + 1, 13) and thrusts (NODES, rotors), steps until a solve."""

    states: np.ndarray
    thrusts: np.ndarray
    wait: int


def linear(
    matrix: Callable[..., list[list[float]]], size: int
) -> Callable[[np.ndarray], np.ndarray]:
    """The function of vectors (n, size) that gives for each a matrix, which is linear in it."""
    units = np.array([matrix(*unit) for unit in np.eye(size)])
    flat, shape = units.reshape(size, -1), units.shape[1:]
    return lambda vectors: (vectors @ flat).reshape(-1, *shape)


# Of a quaternion (w, i, j, k): half of ∂(body z)/∂q; twice ∂q̇/∂ω; half of the error of another one.
body_z = linear(lambda w, i, j, k: [[j, k, w, i], [-i, -w, k, j], [0, -2 * i, -2 * j, 0]], 4)
by_rates = linear(lambda w, i, j, k: [[-i, -j, -k], [w, -k, j], [k, w, -i], [-j, i, w]], 4)
attitude_error = linear(lambda w, i, j, k: [[-i, w, k, -j], [-j, -k, w, i], [-k, j, -i, w]], 4)
# Of rates (p, q, r): twice ∂q̇/∂q. Of a vector: the matrix of its vector product.
by_attitude = linear(
    lambda p, q, r: [[0, -p, -q, -r], [p, 0, r, -q], [q, -r, 0, p], [r, q, -p, 0]], 3
)
cross_matrix = linear(lambda x, y, z: [[0, -z, y], [z, 0, -x], [-y, x, 0]], 3)


def motion(m: Model, x: np.ndarray, u: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, ...]:
    """(ẋ, ∂ẋ/∂x, ∂ẋ/∂u) of states (n, 13) under thrusts (n, rotors).

    `load` (6): a constant force [N, world axes] and moment [N·m, body axes].
    """
    q, rates, wrench = x[:, ATTITUDE], x[:, RATES, None], u @ m.effect.T
    turned, spin = body_z(q), m.inertia @ rates
    up = UP + turned @ q[:, :, None]
    cross = cross_matrix(x[:, RATES])
    torque = wrench[:, 1:, None] + load[3:, None] - cross @ spin - m.drag[1][:, None] * rates
    force = up[:, :, 0] * wrench[:, :1] - m.drag[0] * x[:, VELOCITY] + load[:3]
    motions = (
        x[:, VELOCITY],
        force / m.mass - GRAVITY * UP[:, 0],
        0.5 * by_rates(q) @ rates,
        m.inverse @ torque,
    )
    a, b = np.zeros((len(x), 13, 13)), np.zeros((len(x), 13, u.shape[1]))
    a[:, POSITION, VELOCITY] = np.eye(3)
    a[:, VELOCITY, VELOCITY] = np.diag(-m.drag[0] / m.mass)
    a[:, VELOCITY, ATTITUDE] = turned * (2.0 / m.mass * wrench[:, :1, None])
    a[:, ATTITUDE, ATTITUDE] = 0.5 * by_attitude(x[:, RATES])
    a[:, ATTITUDE, RATES] = 0.5 * by_rates(q)
    a[:, RATES, RATES] = m.inverse @ (
        cross_matrix(spin[:, :, 0]) - cross @ m.inertia - np.diag(m.drag[1])
    )
    b[:, VELOCITY] = up * (m.effect[0] / m.mass)
    b[:, RATES] = m.inverse @ m.effect[1:]
    return np.concatenate([part.reshape(len(x), -1) for part in motions], axis=1), a, b


def step(
    m: Model, x: np.ndarray, u: np.ndarray, load: np.ndarray, h: float
) -> tuple[np.ndarray, ...]:
    """(States after a Runge-Kutta step of h [s], their derivatives by states, by thrusts)."""
    unit = np.eye(13)
    k1, a1, b1 = motion(m, x, u, load)
    k2, a, b = motion(m, x + 0.5 * h * k1, u, load)
    a2, b2 = a @ (unit + 0.5 * h * a1), b + 0.5 * h * a @ b1
    k3, a, b = motion(m, x + 0.5 * h * k2, u, load)
    a3, b3 = a @ (unit + 0.5 * h * a2), b + 0.5 * h * a @ b2
    k4, a, b = motion(m, x + h * k3, u, load)
    a4, b4 = a @ (unit + h * a3), b + h * a @ b3
    sixth = h / 6.0
    return (
        x + sixth * (k1 + 2.0 * k2 + 2.0 * k3 + k4),
        unit + sixth * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
        sixth * (b1 + 2.0 * b2 + 2.0 * b3 + b4),
    )


def errors(x: np.ndarray, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(Errors (n, 12): position, velocity, attitude [rad], rates; their derivative by states)."""
    derivative = np.zeros((len(x), 12, 13))
    derivative[:, :6, :6], derivative[:, 9:, RATES] = np.eye(6), np.eye(3)
    sign = np.sign(
        np.sum(x[:, ATTITUDE] * wanted[:, ATTITUDE], axis=1)
    )  # q and −q are one attitude
    derivative[:, 6:9, ATTITUDE] = (2.0 * sign)[:, None, None] * attitude_error(wanted[:, ATTITUDE])
    error, turn = x - wanted, derivative[:, 6:9, ATTITUDE] @ x[:, ATTITUDE, None]
    return np.concatenate([error[:, :6], turn[:, :, 0], error[:, RATES]], axis=1), derivative


class Program(NamedTuple):
    """½ zᵀ H z + gᵀ z for changes z of all planned thrusts within their limits.

    `states` (NODES + 1, 13, size + 1): how the planned states change with (z, 1).
    """

    hessian: np.ndarray
    gradient: np.ndarray
    low: np.ndarray
    high: np.ndarray
    states: np.ndarray


def condensed(
    m: Model, plan: Plan, start: np.ndarray, wanted: np.ndarray, load: np.ndarray
) -> Program:
    """The program of a plan from a state (13) towards states (NODES + 1, 13) under a load (6)."""
    size, rotors = plan.thrusts.size, plan.thrusts.shape[1]
    after, a, b = step(m, plan.states[:-1], plan.thrusts, load, m.node)
    gap = after - plan.states[1:]
    states = np.zeros((NODES + 1, 13, size + 1))
    states[0, :, -1] = start - plan.states[0]
    for n in range(NODES):
        np.matmul(a[n], states[n], out=states[n + 1])
        states[n + 1, :, n * rotors : (n + 1) * rotors] = b[n]
        states[n + 1, :, -1] += gap[n]
    error, derivative = errors(plan.states[1:], wanted[1:])
    factors = np.tile(m.roots, (NODES, 1))
    factors[-1] *= np.sqrt(m.final)
    rows = (factors[:, :, None] * derivative @ states[1:]).reshape(-1, size + 1)
    rows[:, -1] += (factors * error).ravel()
    by_thrusts, constant = rows[:, :-1], rows[:, -1]
    hessian = by_thrusts.T @ by_thrusts
    hessian[np.diag_indices(size)] += m.thrust_weight
    hover = m.hover * (1.0 - load[2] / (m.mass * GRAVITY))
    gradient = by_thrusts.T @ constant + m.thrust_weight * (plan.thrusts - hover).ravel()
    low, high = (np.tile(limit, NODES) - plan.thrusts.ravel() for limit in m.limits)
    return Program(hessian, gradient, low, high, states)


def solve(m: Model, plan: Plan, start: np.ndarray, wanted: np.ndarray, load: np.ndarray) -> Plan:
    """The plan after one Gauss-Newton step, or as it is; arguments as of `condensed`."""
    began = perf_counter()
    program = condensed(m, plan, start, wanted, load)
    prepared = perf_counter()
    solver = piqp.DenseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = TOLERANCE
    solver.settings.preconditioner_iter = 0  # box and weights are scaled well enough
    solver.setup(program.hessian, program.gradient, x_l=program.low, x_u=program.high)
    is_solved = solver.solve() == piqp.PIQP_SOLVED
    SOLVES.append((perf_counter() - began, perf_counter() - prepared))
    if not is_solved:  # the plan goes on, shifted by each solve
        return plan._replace(wait=m.wait)
    change = np.clip(solver.result.x, program.low, program.high)
    states = plan.states + program.states @ np.append(change, 1.0)
    return Plan(states, plan.thrusts + change.reshape(plan.thrusts.shape), m.wait)


def shifted(m: Model, plan: Plan) -> Plan:
    """The plan one solve later: each node moves on by so much of the way to the next."""
    part = min(1.0, m.interval / m.node)
    states, thrusts = plan.states.copy(), plan.thrusts.copy()
    states[:-1] += part * (states[1:] - states[:-1])
    thrusts[:-1] += part * (thrusts[1:] - thrusts[:-1])
    states[:, ATTITUDE] /= np.linalg.norm(states[:, ATTITUDE], axis=1, keepdims=True)
    return Plan(states, thrusts, plan.wait)


def wanted_states(m: Model, reference: tc.Reference) -> np.ndarray:
    """The reference at each node (NODES + 1, 13), level; its acceleration dies away."""
    ahead = m.lag + m.node * np.arange(NODES + 1)[:, None]
    wanted = np.zeros((NODES + 1, 13))
    position, velocity, acceleration = (np.array(part) for part in reference.trajectory)
    gained = m.preview * (1.0 - np.exp(-ahead / m.preview))
    wanted[:, POSITION] = position + velocity * ahead + acceleration * m.preview * (ahead - gained)
    wanted[:, VELOCITY] = velocity + acceleration * gained
    half = 0.5 * (reference.yaw + reference.yaw_rate * ahead[:, 0])
    wanted[:, 6], wanted[:, 9], wanted[:, 12] = np.cos(half), np.sin(half), reference.yaw_rate
    return wanted


@tc.control.register(Model, compiled=False)
def model_predictive(
    m: Model, plan: Plan, measured: tc.Measured, reference: tc.Reference
) -> tuple[tc.Command, Plan]:
    """The wrench of the first planned thrusts, after a solve where one is due."""
    if plan.wait == 0:
        s, d = measured.state, measured.disturbance
        state = np.array([*s.position, *s.velocity, *s.attitude, *s.rates])
        load = np.array([*(measured.push + d.force), *d.moment])
        if not plan.states.any():
            plan = plan._replace(states=np.tile(state, (NODES + 1, 1)))
        plan = shifted(m, plan)
        begin = step(m, state[None], plan.thrusts[:1], load, m.lag)[0][0]
        plan = solve(m, plan, begin, wanted_states(m, reference), load)
    thrust, *moment = m.effect @ plan.thrusts[0]
    planned = tc.euler_from_quaternion(Quat(*map(float, plan.states[1, ATTITUDE])))
    command = tc.Command(tc.Wrench(float(thrust), Vec3(*map(float, moment))), planned.angles)
    return command, plan._replace(wait=plan.wait - 1)


@tc.register("mpc", Settings)
def start(s: Settings, vehicle: Any, step: float) -> tuple[Model, Plan]:
    """Model predictive control of all thrusts (real-time iteration; PIQP)."""
    rotors = vehicle.rotor_count
    limits = np.zeros(rotors), np.repeat([q.thrust_limit for q in vehicle.quadrotors], 4)
    hover = vehicle.allocation() @ [vehicle.weight, 0.0, 0.0, 0.0]
    weights = s.position_weight, s.velocity_weight, s.attitude_weight, s.rates_weight
    model = Model(
        mass=vehicle.mass,
        inertia=vehicle.inertia,
        inverse=np.linalg.inv(vehicle.inertia),
        drag=(np.array(vehicle.drag.force), np.array(vehicle.drag.moment)),
        effect=vehicle.effect,
        limits=limits,
        hover=hover,
        roots=np.sqrt(np.concatenate(weights)),
        final=s.final_weight,
        thrust_weight=s.thrust_weight,
        node=s.node_interval,
        lag=s.lag,
        preview=s.preview,
        interval=s.interval,
        wait=max(1, round(s.interval / step)),
    )
    return model, Plan(np.zeros((NODES + 1, 13)), np.tile(hover, (NODES, 1)), 0)
