"""Flies a recorded flight again in MuJoCo with the same thrusts, pushes and wind, and nothing else of it.

The record's state at the start is the replay's. Where the replay has come apart from the record by more than `APART`,
it starts again from the record's state there: a restart. Between restarts it is MuJoCo's own trajectory.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import mujoco
import numpy as np

from judge.model import GRAVITY, Model, model_of, turn_of

LOST = 1e5  # m/s, rad/s, beyond which the flight has diverged and is not followed
EVERY = 0.01  # s between comparisons of the replay with the record
APART = (0.005, 0.02, 0.005, 0.1)  # m, m/s, rad, rad/s: distance between replay and record at which it starts again


class Replay(NamedTuple):
    """MuJoCo's own flight, at the times of the record and one step beyond its last.

    `time` (T + 1) [s]; `position` [m], `velocity` [m/s], `attitude` (quaternion), `rates` [rad/s, body axes];
    `up` (T + 1): cosine between body z and world z; `load` (T + 1): normal forces of floor and walls [N];
    `energy` (T + 1) [J]; `restarts`: time [s], what was apart, and whether anything had touched since the one before.
    """

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    attitude: np.ndarray
    rates: np.ndarray
    up: np.ndarray
    load: np.ndarray
    energy: np.ndarray
    restarts: list[tuple[float, str, bool]]
    model: Model


def replay(mission: dict[str, Any], time: np.ndarray, channels: dict[str, np.ndarray]) -> Replay:
    """Fly the commands of a record again.

    Args:
        mission: nested tables, all keys resolved.
        time: of the record's samples, one for every step [s].
        channels: position, velocity, attitude, rates, rotor_thrusts, push_force, push_moment, and with wind
            wind_velocity, each (T, n).
    """
    model = model_of(mission)
    data, step = mujoco.MjData(model.mujoco), mission["mission"]["step"]
    states = np.hstack([channels[name] for name in ("position", "attitude", "velocity", "rates")])
    loads = _loads(mission, model, time, channels, states)
    flown, restarts = _fly(mission, model, data, loads, states)
    position, velocity, rates = flown[:, :3], flown[:, 7:10], flown[:, 10:13]
    mass, x, y = model.body.mass, flown[:, 4], flown[:, 5]
    turning = np.einsum("ti,ij,tj->t", rates, model.body.inertia, rates)
    return Replay(
        time=np.append(time, time[-1] + step),
        position=position,
        velocity=velocity,
        attitude=flown[:, 3:7],
        rates=rates,
        up=1.0 - 2.0 * (x * x + y * y),
        load=flown[:, 13],
        energy=mass * (0.5 * (velocity**2).sum(axis=1) + GRAVITY * position[:, 2]) + 0.5 * turning,
        restarts=[(float(time[k]), what, touched) for k, what, touched in restarts],
        model=model,
    )


class Loads(NamedTuple):
    """The loads over each step: thrusts [N], force [N, world] and moment [N m, body] held, pushes, air and its drag."""

    thrusts: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    pushes: Pushes
    air: np.ndarray | None
    drag: np.ndarray


def _loads(mission: dict[str, Any], model: Model, time: np.ndarray, channels: Any, states: np.ndarray) -> Loads:
    """The mission's pushes are computed again; the rest of the record's pushes is a person's, held over a step."""
    step = mission["mission"]["step"]
    pushes = pushes_of(mission, time, step)
    force = channels["push_force"] - pushes.force
    moment = channels["push_moment"] - moments(rotations(states[:, 3:7]), pushes.levers)
    if mission["person"]["model"] not in ("none", "virtual-hand"):
        moment += _turned(mission, model, force, states, 0.5 * step)
    force = force + pushes.mean + np.array(mission["disturbance"]["force"])
    moment = moment + np.array(mission["disturbance"]["moment"])
    thrusts = np.clip(np.nan_to_num(channels["rotor_thrusts"]), -1e9, 1e9)
    return Loads(thrusts, force, moment, pushes, channels.get("wind_velocity"), drag_of(mission))


def _turned(mission: dict[str, Any], model: Model, force: np.ndarray, states: np.ndarray, time: float) -> np.ndarray:
    """The change of the moment of a person's force [N m, body axes] within a time [s], as the body rotates."""
    person = mission["person"]
    grip = np.add(model.body.payload, [0.0, 0.0 if person["model"] == "two-hands" else person["grip"], 0.0])
    felt = np.einsum("tij,ti->tj", rotations(states[:, 3:7]), force)
    return -time * np.cross(grip, np.cross(states[:, 10:], felt))


def _fly(mission: dict[str, Any], model: Model, data: Any, loads: Loads, states: np.ndarray) -> Any:
    """The states (T + 1, 13) with the normal force (T + 1, 14), and the restarts."""
    count, step, compiled = len(states), mission["mission"]["step"], model.mujoco
    out, restarts = np.full((count + 1, 14), np.nan), list[tuple[int, str, bool]]()
    state, applied, pushed = out[:, :13], data.qfrc_applied, loads.pushes.mean_levers.any(axis=(1, 2))
    touched, every = _start(compiled, data, states[0]), max(1, round(EVERY / step))
    for k in range(count):
        if k and k % every == 0:
            apart = _apart(data, states[k])
            if apart:
                restarts.append((k, apart, touched))
                touched = _start(compiled, data, states[k])
        if not np.abs(data.qvel).max() < LOST:
            return out, restarts
        state[k, :7], state[k, 7:], out[k, 13] = data.qpos, data.qvel, _normal_force(data)
        data.ctrl[:] = loads.thrusts[k]
        applied[:3], applied[3:] = loads.force[k], loads.moment[k]
        if pushed[k]:
            applied[3:] += _push_moment(data, loads.pushes.mean_levers[k], step)
        if loads.air is not None:
            _blow(model, data, loads.drag, loads.air[k])
        for _ in range(model.substeps):
            mujoco.mj_step(compiled, data)
            touched = touched or bool(data.ncon)
    state[count, :7], state[count, 7:] = data.qpos, data.qvel
    return out, restarts


class Pushes(NamedTuple):
    """The mission's pushes: force [N] at the start of each step and its mean over it by Simpson's rule, each (T, 3).

    `levers` and `mean_levers` (T, 3, 3): the sum of force times point of application, from which follow moments.
    """

    force: np.ndarray
    mean: np.ndarray
    levers: np.ndarray
    mean_levers: np.ndarray


def pushes_of(mission: dict[str, Any], time: np.ndarray, step: float) -> Pushes:
    """Pushes that grow and fade as a Gaussian over time."""
    given = mission.get("pushes", [])
    each = np.zeros((3, len(time), len(given), 3))
    for i, push in enumerate(given):
        for place in range(3):
            since = (time + 0.5 * place * step - push["time"]) / push["sigma"]
            each[place, :, i] = np.exp(-0.5 * np.square(np.clip(since, -30.0, 30.0)))[:, None] * push["force"]
    each[np.abs(each) < 1e-15] = 0.0
    means = (each[0] + 4.0 * each[1] + each[2]) / 6.0
    points = np.array([push["point"] for push in given]).reshape(-1, 3)
    levers, mean_levers = (np.einsum("tpi,pj->tij", forces, points) for forces in (each[0], means))
    return Pushes(each[0].sum(axis=1), means.sum(axis=1), levers, mean_levers)


def moments(R: np.ndarray, levers: np.ndarray) -> np.ndarray:
    """Moment [N m, body axes] of forces at points: the sum of r x R^T F, of which `levers` is the sum of F r^T."""
    G = np.swapaxes(R, -1, -2) @ levers
    parts = G[..., 2, 1] - G[..., 1, 2], G[..., 0, 2] - G[..., 2, 0], G[..., 1, 0] - G[..., 0, 1]
    return np.stack(parts, axis=-1)


def rotations(q: np.ndarray) -> np.ndarray:
    """From body to world axes, of quaternions w, x, y, z (T, 4): (T, 3, 3)."""
    w, x, y, z = q.T
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.array(rows).transpose(2, 0, 1)


def rotation(quaternion: np.ndarray) -> np.ndarray:
    """From body to world axes (3 × 3)."""
    R = np.empty(9)
    mujoco.mju_quat2Mat(R, quaternion)
    return R.reshape(3, 3)


def _push_moment(data: Any, levers: np.ndarray, step: float) -> np.ndarray:
    """Mean moment [N m, body axes] of the mission's pushes over a step, at the attitude in the middle of it."""
    middle = data.qpos[3:7].copy()
    mujoco.mju_quatIntegrate(middle, data.qvel[3:], 0.5 * step)
    return moments(rotation(middle), levers)


def _start(model: Any, data: Any, state: np.ndarray) -> bool:
    """Start from a state; whether anything touches there."""
    data.qpos[:], data.qvel[:] = state[:7], state[7:]
    mujoco.mj_forward(model, data)
    return bool(data.ncon)


def _apart(data: Any, state: np.ndarray) -> str:
    """The part of the state that is too far from the record's; '' for none."""
    position, velocity = np.abs(data.qpos[:3] - state[:3]).max(), np.abs(data.qvel[:3] - state[7:10]).max()
    turn, rates = (
        2.0 * np.sqrt(max(0.0, 1.0 - float(data.qpos[3:] @ state[3:7]) ** 2)),
        np.abs(data.qvel[3:] - state[10:]).max(),
    )
    shares = np.array([position, velocity, turn, rates]) / APART
    worst = int(np.argmax(shares))
    return ("position", "velocity", "attitude", "rates")[worst] if not shares[worst] < 1.0 else ""


def _normal_force(data: Any) -> float:
    """Sum of the normal forces of all contacts [N]."""
    first = [data.contact.efc_address[i] for i in range(data.ncon)]
    return float(sum(data.efc_force[i] for i in first if i >= 0))


def drag_of(mission: dict[str, Any]) -> np.ndarray:
    """½ rho c A along the body axes [N/(m/s)2], of the payload and of every quadrotor (N + 1, 3)."""
    payload = mission["vehicle"]["payload"]
    area = payload.get("drag_area")
    if area is None:
        length, radius = payload.get("length") or 0.0, payload.get("radius") or 0.0
        area = [2.0 * radius * length, np.pi * radius**2, 2.0 * radius * length]
    parts = [np.multiply(area, payload["drag_coefficient"])]
    parts += [
        np.diag(turn_of(q) @ np.diag(q["drag_area"]) @ turn_of(q).T) * q["drag_coefficient"]
        for q in mission["vehicle"]["quadrotors"]
    ]
    return 0.5 * mission["wind"]["density"] * np.array(parts)


def _blow(model: Model, data: Any, drag: np.ndarray, air: np.ndarray) -> None:
    """Add the drag of every part in moving air, each at its centre: −½ rho c A |v| v by component, in body axes."""
    R, arms, (p, q, r) = rotation(data.qpos[3:7]), model.arms, data.qvel[3:]
    through = (data.qvel[:3] - air) @ R + arms @ np.array([[0.0, r, -q], [-r, 0.0, p], [q, -p, 0.0]])
    force = -drag * through * np.sqrt((through * through).sum(axis=1))[:, None]
    lever = arms.T @ force
    data.qfrc_applied[:3] += R @ force.sum(axis=0)
    data.qfrc_applied[3:] += lever[1, 2] - lever[2, 1], lever[2, 0] - lever[0, 2], lever[0, 1] - lever[1, 0]
