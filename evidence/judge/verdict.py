"""The outcome of a flight, from MuJoCo's own trajectory and from Newton's laws, by the written definitions.

The definitions are those of docs/reference/outcomes.md, implemented here from their words. The impulse of a contact is
the change of momentum beyond thrust, weight, pushes and air, so no model of contact enters it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from judge.replay import Replay, drag_of, replay, rotations

GRAVITY, FAR = 9.81, 1000.0
FADING = 0.1  # s, in which an impulse of contact fades
BEARS, LATELY = 0.5, 0.05  # of the weight, by the floor; s, within which its load may not cross that
ROUGH, ROUGH_TURN = 100.0, 500.0  # m/s², rad/s²: from such accelerations on, as medians, steps are too long
ROUGH_STEPS = 16  # of the medians: an impact is over within half of them
TOUCHING = 0.01  # of the weight: contact forces below this are rounding

BANDS = {  # width of the band on either side of each threshold, within which a disagreement does not count
    "height": 0.006,  # m
    "tilt": 0.01,  # rad
    "distance": 0.01,  # m
    "speed": 0.03,  # m/s
    "ground_load": 0.1,  # of the weight
    "impulse": 0.1,  # of the threshold
}


class Verdict(NamedTuple):
    """A judged outcome.

    `kind`: what ended it, if it crashed or diverged; `at`: when [s]; `margins`: distance of each measure from its
    threshold over the width of its band, the band itself being from −1 to 1; `close`: those measures within their
    bands; `followed`: the replay; `gained`: energy that contact added [J], beside the `work` done by all else, either
    way; `unexplained`: times of restarts without a contact [s]; `unresolved`: whether the vehicle is shaken, at the
    end of the record, so fast that values at steps do not tell what happens between them.
    """

    outcome: str
    kind: str
    at: float
    margins: dict[str, float]
    followed: Replay
    gained: float
    work: float
    unexplained: list[float]
    unresolved: bool

    @property
    def close(self) -> list[str]:
        """The measures within their bands, without that which ended the flight."""
        return [name for name, margin in self.margins.items() if abs(margin) <= 1.0 and name != self.kind]


class Ground(NamedTuple):
    """The effect of contact over every step: force [N, world axes] (T, 3), its decaying impulse [N s] (T).

    `touching` (T - 1): whether there was any; `gained` [J]: the most that it added to the vehicle's energy from one
    moment without contact to a later one; `work` [J]: that of all other loads, either way.
    """

    force: np.ndarray
    impulse: np.ndarray
    touching: np.ndarray
    gained: float
    work: float


def judge(mission: dict[str, Any], time: np.ndarray, channels: dict[str, np.ndarray]) -> Verdict:
    """Judge a record that has a sample for every step, up to its end or to where it was stopped.

    Args:
        mission: nested tables, all keys resolved.
        time: of the samples [s].
        channels: as `judge.replay.replay` takes them, until then.
    """
    flown = replay(mission, time, channels)
    ground = contact_of(mission, channels, flown)
    margins = _limits(mission, flown, ground)
    crossed = {kind: at for kind, (_, at) in margins.items() if at < math.inf}
    found = {kind: worst for kind, (worst, _) in margins.items()}
    if crossed:
        kind = min(crossed, key=lambda k: crossed[k])
        outcome, at = "diverged" if kind in ("finite", "far") else "crashed", crossed[kind]
    else:
        (outcome, more), kind, at = _end(mission, flown, ground), "", math.inf
        found |= more
    starts = [0.0, *(t for t, _, _ in flown.restarts)]
    touching = time[:-1][ground.touching]
    free = [
        t
        for (t, _, touched), since in zip(flown.restarts, starts, strict=False)
        if not touched and not np.any((touching >= since - LATELY) & (touching <= t))
    ]
    rough = is_rough(channels, mission["mission"]["step"])
    return Verdict(outcome, kind, at, found, flown, ground.gained, ground.work, free, rough)


def is_rough(channels: dict[str, np.ndarray], step: float) -> bool:
    """Whether velocity or rates jump from step to step at the end of the record."""
    last = slice(-1 - ROUGH_STEPS, None)
    jumps = (np.linalg.norm(np.diff(channels[c][last], axis=0), axis=1) / step for c in ("velocity", "rates"))
    return bool(any(np.median(j) > limit for j, limit in zip(jumps, (ROUGH, ROUGH_TURN), strict=True) if len(j)))


def _limits(mission: dict[str, Any], flown: Replay, ground: Ground) -> dict[str, tuple[float, float]]:
    """For each limit the excess of the worst value in bands, and the time of the first excess [s]."""
    crash, found, p = mission["crash"], dict[str, tuple[float, float]](), flown.position

    def beyond(kind: str, values: np.ndarray, limit: float, band: float, time: np.ndarray) -> None:
        over = np.flatnonzero(~(values <= limit))
        worst = float(np.nanmax(values - limit)) / band if len(values) else -math.inf
        found[kind] = worst, float(time[over[0]]) if len(over) else math.inf

    finite = np.isfinite(np.hstack([p, flown.velocity, flown.attitude, flown.rates])).all(axis=1)
    beyond("finite", np.where(finite, -1e9, 1e9), 0.0, 1.0, flown.time)
    beyond("far", np.linalg.norm(p, axis=1), FAR, BANDS["distance"], flown.time)
    beyond("turned over", np.arccos(np.clip(flown.up, -1.0, 1.0)), crash["tilt"], BANDS["tilt"], flown.time)
    if mission["ground"]["model"] == "floor":
        limit = crash.get("impulse") or 2.0 * flown.model.body.mass
        beyond("struck", ground.impulse, limit, BANDS["impulse"] * limit, flown.time[1:])
    if mission["supervision"]["model"] == "on":
        fence = mission["supervision"]["fence"]
        outside = np.maximum(np.maximum(fence["low"] - p, p - fence["high"]), 0.0)
        beyond("left fence", outside.max(axis=1), crash["fence_margin"], BANDS["distance"], flown.time)
    return found


def _end(mission: dict[str, Any], flown: Replay, ground: Ground) -> tuple[str, dict[str, float]]:
    """The outcome of a flight that was not stopped, and how near its measures are to their thresholds."""
    phases, limits, start = mission["phases"], mission["outcome"], flown.position[0, 2]
    margins = {}
    if asks_for_lift(mission):
        asked = min(limits["lifted_height"], 0.5 * phases["height"])
        risen = flown.position[:, 2].max() - start
        margins["lifted"] = (risen - asked) / BANDS["height"]
        if risen < asked:
            return "not-lifted", margins
    last = slice(-1 - max(1, round(LATELY / mission["mission"]["step"])), None)  # with the record's last sample
    speed = float(np.linalg.norm(flown.velocity[-2]))
    slow = (limits["landed_speed"] - speed) / BANDS["speed"]
    if mission["ground"]["model"] == "floor":
        weight = flown.model.body.mass * GRAVITY
        ground_load = (ground.force[last, 2] / weight - BEARS) / BANDS["ground_load"]
        lands = float(
            np.clip(ground_load[-1], -1.0, 1.0) if ground_load.min() < 0.0 < ground_load.max() else ground_load[-1]
        )
    else:
        land = phases.get("land_start")
        if land is None or land + phases["land_duration"] > mission["mission"]["duration"]:
            return "flying", margins
        lands = (limits["landed_height"] - abs(flown.position[-2, 2] - start)) / BANDS["height"]
    margins["landed"] = min(slow, lands)
    return ("landed" if margins["landed"] > 0.0 else "flying"), margins


def asks_for_lift(mission: dict[str, Any]) -> bool:
    """Whether the mission has a lift that should be over by its end: by its phases, or by a request."""
    phases, end = mission["phases"], mission["mission"]["duration"]
    requests = [r["time"] for r in mission.get("requests", []) if r["action"] == "lift"]
    return phases["height"] > 0.0 and min([phases["lift_start"], *requests]) + phases["lift_duration"] < end


def contact_of(mission: dict[str, Any], channels: dict[str, np.ndarray], flown: Replay) -> Ground:
    """The effect of floor and walls: the change of momentum and energy less that of all other loads."""
    body, step, drag = flown.model.body, mission["mission"]["step"], mission["vehicle"]["drag"]
    v, w = channels["velocity"], channels["rates"]
    R = rotations(channels["attitude"])
    z = R[:, :, 2]
    up = 0.5 * (z[:-1] + z[1:])
    middle_v, middle_w = 0.5 * (v[:-1] + v[1:]), 0.5 * (w[:-1] + w[1:])
    thrust = channels["rotor_thrusts"][:-1].sum(axis=1)
    outer = 0.5 * (channels["push_force"][:-1] + channels["push_force"][1:]) + np.array(mission["disturbance"]["force"])
    torque = channels["rotor_thrusts"][:-1] @ _arms(flown)
    torque += 0.5 * (channels["push_moment"][:-1] + channels["push_moment"][1:])
    torque += np.array(mission["disturbance"]["moment"])
    if "wind_velocity" in channels:
        force, moment = _air(mission, channels, flown, R)
        outer, torque = outer + force[:-1], torque + moment[:-1]
    outer = outer - np.array(drag["force"]) * middle_v
    torque = torque - np.array(drag["moment"]) * middle_w
    total = body.mass * np.diff(v, axis=0) / step
    contact = total - up * thrust[:, None] - outer + np.array([0.0, 0.0, body.mass * GRAVITY])
    power = ((up * thrust[:, None] + outer) * middle_v).sum(axis=1) + (torque * middle_w).sum(axis=1)
    height = channels["position"][:, 2]
    kinetic = 0.5 * body.mass * (v**2).sum(axis=1) + 0.5 * np.einsum("ti,ij,tj->t", w, body.inertia, w)
    touching = np.linalg.norm(contact, axis=1) > TOUCHING * body.mass * GRAVITY
    if "contact_force" in channels:  # a foot that carries less than that, yet rotates the vehicle
        touching |= channels["contact_force"][:-1].any(axis=1)
    near = touching | np.append(touching[1:], False) | np.append(False, touching[:-1])
    energy = np.cumsum(np.where(near, np.diff(kinetic + body.mass * GRAVITY * height) - power * step, 0.0))
    between = energy[~near]
    gained = float(np.max(between - np.minimum.accumulate(between))) if len(between) else 0.0
    work = float(np.abs(power).sum() * step)
    if "contact_force" in channels:  # over the last step, after which there is no sample
        contact = np.vstack([contact, channels["contact_force"][-1:]])
    beyond = contact - np.array([0.0, 0.0, body.mass * GRAVITY])
    beyond[:, 2] = np.maximum(beyond[:, 2], 0.0)
    return Ground(contact, _fading(np.linalg.norm(beyond, axis=1), step), touching, gained, work)


def _fading(force: np.ndarray, step: float) -> np.ndarray:
    """The impulse of a force [N s], older parts of which count less."""
    impulse, found, kept = 0.0, np.empty(len(force)), math.exp(-step / FADING)
    for k, f in enumerate(force):
        impulse = impulse * kept + f * step
        found[k] = impulse
    return found


def _arms(flown: Replay) -> np.ndarray:
    """Moment of each rotor's thrust about the centre of mass, over it [m, body axes] (4 N, 3)."""
    model = flown.model.mujoco
    return np.cross(model.site_pos, model.actuator_gear[:, :3]) + model.actuator_gear[:, 3:]


def _air(mission: Any, channels: Any, flown: Replay, R: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force [N, world axes] and moment [N m, body axes] of moving air."""
    arms = flown.model.arms
    through = np.einsum("tij,ti->tj", R, channels["velocity"] - channels["wind_velocity"])[:, None]
    through = through + np.cross(channels["rates"][:, None], arms)
    force = -drag_of(mission) * through * np.linalg.norm(through, axis=2)[:, :, None]
    return np.einsum("tij,tj->ti", R, force.sum(axis=1)), np.cross(arms, force).sum(axis=1)
