"""Predictions of the sensors' readings in windows of a log, for a vehicle with certain numbers; their derivatives.

Predictions are formed in every step; their derivatives in blocks of steps, under the mean command of a block. That
changes the derivatives by less than 1 %, and an estimate from exact predictions by nothing but its efficiency.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.identification.vehicle_unknowns import DrivenNumbers, Unknowns
from tandemlift.analysis.identification.windows import FlightWindows, Places
from tandemlift.analysis.logs.log import JOINTS, conjugate, quaternion_product
from tandemlift.core.types import Array, flat
from tandemlift.engines.driven_vehicle import DrivenModels, driven_models
from tandemlift.missions import Mission

STARTS = 12  # of a window: position, velocity, a turn about body axes, rates
OUTPUTS = (  # of `driven_step`, in its order
    "measured_position",
    "measured_velocity",
    "measured_attitude",
    "measured_rates",
    "measured_specific_force",
    "measured_joint_force",
    "measured_joint_torque",
)
FORCES = OUTPUTS[4:]  # predicted as means over a block
ALWAYS = ("measured_attitude", "measured_rates")


class PredictedDerivatives(NamedTuple):
    """The derivatives of predictions in blocks, and the predictions; those of the attitude are turns about body axes.

    Attributes:
        base: predictions by stream (W, blocks + 1, width).
        streams: derivatives by stream (W, directions, blocks + 1, width).
    """

    base: dict[str, Array]
    streams: dict[str, Array]

    def changes(self, name: str) -> Array:
        """The change of predictions of a stream per block (W, blocks, width); of the attitude, the turn."""
        y = self.base[name]
        if name in FORCES:
            return np.asarray(np.gradient(y, axis=1)[:, :-1])
        if name == "measured_attitude":
            return 2.0 * quaternion_product(conjugate(y[:, :-1]), y[:, 1:])[..., 1:]
        return np.diff(y, axis=1)


@dataclass(frozen=True)
class Predictor:
    """Predictions for one log.

    Attributes:
        windows: of the log.
        unknowns: of the vehicle.
        mission: that the search starts from.
    """

    windows: FlightWindows
    unknowns: Unknowns
    mission: Mission

    @property
    def models(self) -> DrivenModels:
        """The machine code for this geometry."""
        return driven_models(self.mission.vehicle, self.windows.floor, self.mission.wind)

    @property
    def joints(self) -> int:
        """Number of joints."""
        return len(self.mission.vehicle.quadrotors)

    def starts(self) -> Array:
        """First guesses of the states (W, 13) at the start of the windows: their first samples, or no velocity."""
        w, found = self.windows, np.zeros((len(self.windows.first), 13))
        for name, place in (
            ("measured_position", slice(0, 3)),
            ("measured_velocity", slice(3, 6)),
            ("measured_attitude", slice(6, 10)),
            ("measured_rates", slice(10, 13)),
        ):
            if name in w.samples:
                s = w.samples[name]
                found[:, place] = s.values[np.searchsorted(s.window, np.arange(len(w.first)))]
        found[:, 6:10] /= np.linalg.norm(found[:, 6:10], axis=1, keepdims=True)
        return found

    def squares(self, n: DrivenNumbers, tangents: bool) -> tuple[Array, list[Array]]:
        """(Mean squares of the rotors' speeds in every step of the log (K, rotors), tangents by lag and delay).

        Tangents: by the lag up of each quadrotor, then down, then by the delay.
        """
        w, N = self.windows, self.joints
        commands, by_delay = w.commands_at(n.delay)
        u = np.ascontiguousarray(commands.T[:, :, None])
        x = np.stack([commands[0], np.repeat(n.up, 4), np.repeat(n.down, 4)], axis=1)
        p, rotors = np.array([w.step]), self.models.rotor_tangents
        if not tangents:
            return self.models.rotors(x, p, u)[0][:, :, 0].T, []
        none, still, found = np.zeros_like(x), np.zeros_like(u), list[Array]()
        y = still
        for place in (1, 2):
            for i in range(N):
                along = none.copy()
                along[4 * i : 4 * i + 4, place] = 1.0
                y, dy = rotors.tangent(x, p, u, along, np.zeros(1), still)
                found.append(dy[:, :, 0].T)
        y, dy = rotors.tangent(x, p, u, none, np.zeros(1), np.ascontiguousarray(by_delay.T[:, :, None]))
        return y[:, :, 0].T, [*found, dy[:, :, 0].T]

    def predicted(self, starts: Array, n: DrivenNumbers, squares: Array, point: Array) -> dict[str, Array]:
        """Predictions by stream (W, steps, width) in every step, one more than a window has.

        Args:
            starts: states at the start of the windows (W, 13).
            n: numbers of the vehicle.
            squares: mean squares of the rotors' speeds (K, rotors).
            point: that the motion measurement follows, from the centre of mass [m] (3).
        """
        w = self.windows
        u = _cut(np.hstack([squares, w.pushes]), w.first, w.length + 1)
        y, _ = self.models.body(starts, self._parameters(n, point, w.step), u)
        return {name: np.array(part) for name, part in self._streams(y).items()}

    def derivatives(
        self, starts: Array, q: Array, n: DrivenNumbers, squares: Array, moved: list[Array], point: Array
    ) -> PredictedDerivatives:
        """Predictions in blocks with their derivatives.

        Directions: the start of the window, the coordinates of the vehicle, the point of the motion measurement.
        """
        w, vehicle = self.windows, len(flat(n.vehicle))
        every = [np.hstack([squares, w.pushes]), *[np.hstack([m, 0.0 * w.pushes]) for m in moved]]
        u, *cut = (_in_blocks(_cut(rows, w.first, w.length + w.block), w.block) for rows in every)
        p, J = self._parameters(n, point, w.step * w.block), self.unknowns.derivatives(q)
        zero, still, streams = np.zeros_like(starts), np.zeros_like(u), dict[str, Array]()
        directions, base = STARTS + len(self.unknowns) + 3, dict[str, Array]()
        for i in range(directions):
            dx, dp, du = zero, np.zeros_like(p), still
            if i < STARTS:
                dx = _start_direction(starts, i)
            elif i < directions - 3:
                own = J[:, i - STARTS]
                dp[:vehicle] = own[:vehicle]
                for k in np.flatnonzero(own[vehicle:]):
                    du = du + cut[k] * own[vehicle + k]
            else:
                dp[vehicle + i - directions + 3] = 1.0
            y, dy = self.models.body_tangents.tangent(starts, p, u, dx, dp, du)
            if not i:
                base = {name: np.array(part) for name, part in self._streams(y).items()}
            for name, part in self._streams(dy).items():
                if name not in streams:
                    streams[name] = np.empty((len(starts), directions, *part.shape[1:]))
                streams[name][:, i] = part
        turn = quaternion_product(conjugate(base["measured_attitude"])[:, None], streams["measured_attitude"])
        return PredictedDerivatives(base, streams | {"measured_attitude": 2.0 * turn[..., 1:]})

    def _parameters(self, n: DrivenNumbers, point: Array, step: float) -> Array:
        return np.array([*flat(n.vehicle), *point, step])

    def _streams(self, y: Array) -> dict[str, Array]:
        """The outputs (W, n, outputs) by the streams of the log; those of joints, quadrotor by quadrotor."""
        N = self.joints
        widths = [4 if name == "measured_attitude" else 3 * N if name in JOINTS else 3 for name in OUTPUTS]
        parts = np.split(y, np.cumsum(widths)[:-1], axis=-1)
        return {
            name: part.reshape(*part.shape[:-1], 3, N).swapaxes(-1, -2).reshape(part.shape) if name in JOINTS else part
            for name, part in zip(OUTPUTS, parts, strict=True)
            if name in self.windows.samples or name in ALWAYS
        }


def _start_direction(starts: Array, i: int) -> Array:
    """The direction of states (W, 13) along number i of the start."""
    along = np.zeros_like(starts)
    if 6 <= i < 9:
        turn = np.zeros((len(starts), 4))
        turn[:, i - 5] = 0.5
        along[:, 6:10] = quaternion_product(starts[:, 6:10], turn)
    else:
        along[:, i if i < 6 else i + 1] = 1.0
    return along


def moved_starts(starts: Array, by: Array) -> Array:
    """The states (W, 13) after a change (W, 12)."""
    after = starts.copy()
    after[:, :6] += by[:, :6]
    after[:, 10:] += by[:, 9:]
    turn = np.concatenate([np.ones((len(by), 1)), 0.5 * by[:, 6:9]], axis=1)
    q = quaternion_product(starts[:, 6:10], turn)
    after[:, 6:10] = q / np.linalg.norm(q, axis=1, keepdims=True)
    return after


def _cut(rows: Array, first: Places, length: int) -> Array:
    """Rows from every `first` on (W, length, …)."""
    return rows[first[:, None] + np.arange(length)]


def _in_blocks(rows: Array, block: int) -> Array:
    """Means over blocks (W, blocks, …)."""
    return rows.reshape(len(rows), -1, block, rows.shape[-1]).mean(axis=2)
