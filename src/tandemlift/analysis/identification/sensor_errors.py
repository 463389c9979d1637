"""The errors of sensors as unknowns beside the vehicle, and the residuals of their samples.

Biases of IMU and joints are constant over a few windows and walk from one group of windows to the next, as the drift of
the mission's sensors allows. So do the offsets of the clocks of motion measurement and joints against the gyroscope's,
which `clocks` finds to about a millisecond only, and that of the accelerometer. The axes of each joint's sensor are
turned by a small rotation, and the motion measurement follows a point near the centre of mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tandemlift.analysis.identification.prediction import FORCES
from tandemlift.analysis.identification.windows import Samples
from tandemlift.analysis.logs.clocks import GROUPS
from tandemlift.analysis.logs.log import JOINTS, conjugate, quaternion_product, swept
from tandemlift.core.types import Array
from tandemlift.missions import SensorsTable

STREAMS = {  # with a bias; the least standard deviations of the priors of bias and of its walk over a second
    "measured_specific_force": ("accelerometer", "", 0.1, 2e-4),
    "measured_rates": ("gyroscope", "", 0.02, 2e-5),
    "measured_joint_force": ("joints", "force_", 0.5, 1e-3),
    "measured_joint_torque": ("joints", "torque_", 0.05, 1e-4),
}
CLOCKS = {  # streams with a clock of their own; standard deviations of its offset [s] and of its walk [s/√s]
    **{group: (names, 3e-3, 3e-5) for group, names in GROUPS.items()},
    "accelerometer": (("measured_specific_force",), 5e-4, 1e-7),
}
POINT = 0.03  # m, standard deviation of the place of the point that the motion measurement follows
TURN = 0.02  # rad, of a joint's sensor about each axis
PLACE = 0.1  # m, of an accelerometer that is elsewhere


@dataclass(frozen=True)
class SensorPriors:
    """Priors of the errors of the sensors that a log has.

    Attributes:
        places: of the bias of each stream that has one among all biases.
        clocks: the place of the offset of each stream's clock against the gyroscope's [s]; the last of the biases.
        bias: standard deviations of the biases (B,).
        walk: of their change over a second (B,).
        joints: number of joints whose sensors' axes are unknown.
        place: of the accelerometer, from the payload's origin [m] (3), where the search starts; None if it is there.
    """

    places: dict[str, slice]
    clocks: dict[str, int]
    bias: Array
    walk: Array
    joints: int
    place: Array | None = None

    @property
    def placed(self) -> bool:
        """Whether the accelerometer's place is searched for."""
        return self.place is not None

    @property
    def count(self) -> int:
        """Number of errors that do not change: places of point and accelerometer, a rotation at each joint."""
        return 3 + 3 * self.joints + 3 * self.placed

    @property
    def sd(self) -> Array:
        """Standard deviations of these."""
        return np.array([POINT] * 3 + [TURN] * 3 * self.joints + [PLACE] * 3 * self.placed)

    @property
    def start(self) -> Array:
        """Where the search for them starts."""
        return np.concatenate([np.zeros(3 + 3 * self.joints), self.place if self.place is not None else []])


def sensor_priors(
    sensors: SensorsTable, joints: int, streams: frozenset[str], place: Array | None = None
) -> SensorPriors:
    """The priors of the sensors that a log has, none narrower than a careful builder could promise.

    Args:
        sensors: of the mission.
        joints: number of joints.
        streams: of the log.
        place: about where the accelerometer is, from the payload's origin [m]; None if it is there.
    """
    places, bias, walk = dict[str, slice](), list[float](), list[float]()
    for name, (table, prefix, least, drift) in STREAMS.items():
        if name in streams:
            width = 3 * joints if name in JOINTS else 3
            own = getattr(sensors, table)
            places[name] = slice(len(bias), len(bias) + width)
            bias += [max(getattr(own, f"{prefix}bias"), least)] * width
            walk += [max(getattr(own, f"{prefix}drift"), drift)] * width
    clocks = {name: len(bias) + i for i, (names, *_) in enumerate(CLOCKS.values()) for name in names}
    bias += [sd for _, sd, _ in CLOCKS.values()]
    walk += [sd for _, _, sd in CLOCKS.values()]
    return SensorPriors(places, clocks, np.array(bias), np.array(walk), joints if JOINTS[0] in streams else 0, place)


def residuals(
    s: Samples, name: str, predicted: dict[str, Array], biases: Array, turns: Array, late: Array | None = None
) -> Array:
    """Samples less predictions (n, width); of the attitude, turns about body axes (n, 3).

    Args:
        s: the samples, each at its instant.
        name: of the stream.
        predicted: in every step: motion at its start, loads under the mean thrust of the step, that is amid it.
        biases: of every window (W, width), or of none (W, 0).
        turns: of the axes of each joint's sensor (joints, 3).
        late: steps by which the stamps of every window are too early (W,).
    """
    p, width = predicted[name], s.values.shape[1]
    beyond = s.beyond - (0.5 if name in FORCES else 0.0) + (0.0 if late is None else late[s.window])
    step = np.clip(s.step + np.floor(beyond).astype(np.intp), 0, p.shape[1] - 2)
    seen = p[s.window, step]
    if beyond.any():
        seen = seen + (s.step + beyond - step)[:, None] * (p[s.window, step + 1] - seen)
    if name == "measured_attitude":
        turned = quaternion_product(conjugate(seen), s.values)
        length = np.linalg.norm(s.values, axis=1, keepdims=True) * np.linalg.norm(seen, axis=1, keepdims=True)
        sign = np.where(turned[:, :1] < 0.0, -2.0, 2.0)
        found: Array = turned[:, 1:] * sign / length
        return found
    if name in JOINTS and len(turns):
        seen = turned_axes(seen, turns)
    shift = biases[s.window] if biases.shape[1] == width else 0.0
    return np.asarray(s.values - seen - shift)


def at_place(force: Array, rates: Array, place: Array, step: float) -> Array:
    """The specific force (…, n, 3) at a place (3) from where it is given, by rates (…, n, 3) every step [s]."""
    turning = np.diff(rates, axis=-2, append=2.0 * rates[..., -1:, :] - rates[..., -2:-1, :]) / step
    return force + swept(turning, rates, place)


def turned_axes(v: Array, turns: Array) -> Array:
    """Vectors of joints (…, 3 N) along axes that are turned by small rotation vectors (N, 3)."""
    own = v.reshape(*v.shape[:-1], len(turns), 3)
    size = np.linalg.norm(turns, axis=1)[:, None]
    first = np.where(size > 1e-12, np.sin(size) / np.maximum(size, 1e-12), 1.0)
    second = np.where(size > 1e-12, (1.0 - np.cos(size)) / np.maximum(size, 1e-12) ** 2, 0.5)
    back = np.cross(turns, own)
    result: Array = own - first * back + second * np.cross(turns, back)
    return result.reshape(v.shape)


def by_turns(v: Array) -> Array:
    """The derivatives (W, 3 N, n, 3 N) of vectors of joints (W, n, 3 N) by small turns of the axes."""
    found = np.zeros((len(v), v.shape[-1], *v.shape[1:]))
    for i in range(0, v.shape[-1], 3):
        x, y, z = (v[..., i + a] for a in range(3))
        for row, by, value in ((0, 1, -z), (0, 2, y), (1, 0, z), (1, 2, -x), (2, 0, -y), (2, 1, x)):
            found[:, i + by, :, i + row] = value
    return found


def noise_of(values: Array, name: str) -> float:
    """The standard deviation of the white noise of samples, from their second differences, robustly."""
    sd = 1.4826 * np.median(np.abs(np.diff(values, 2, axis=0)), axis=0) / np.sqrt(6.0)
    if name == "measured_attitude":  # half of a turn about three axes, in four numbers
        return float(2.0 * np.sqrt(np.sum(sd**2) / 3.0))
    return float(np.median(sd))


def robust_sd(r: Array) -> float:
    """The standard deviation of residuals, from their median absolute value."""
    return float(1.4826 * np.median(np.abs(r)))
