"""The values of a frame's fields, from the channels of a flight or of one sample."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tandemlift.algebra.layout import leaves
from tandemlift.common.phases import GUIDED, LAND, LIFT
from tandemlift.common.types import Array
from tandemlift.simulation.results import channels_of

MIN_PUSH = 1e-9  # N, below which a push has no point of action
CHANNELS = {  # of each field: the channels that it may come from, the best first
    "position": ("position",),
    "attitude": ("attitude",),
    "velocity": ("velocity",),
    "reference": ("reference_position",),
    "push": ("push_force",),
    "pilot_push": ("push_filtered", "push_estimate", "push_force"),
    "disturbance": ("disturbance_force",),
    "wind": ("wind_velocity",),
    "alarm": ("alarm",),
    "thrusts": ("rotor_thrusts",),
}
USED = {"reference_euler", "push_moment", "phase"}.union(*CHANNELS.values())


def channel_columns(layout: Any) -> dict[str, NDArray[np.intp]]:
    """The columns of a sample that hold each channel which `field_values` reads; `layout`: of the sample."""
    row = np.arange(leaves(layout), dtype=np.float64)[None, :]
    return {name: at.astype(np.intp) for name, at in channels_of(layout, row) if name in USED}


def field_values(channels: Mapping[str, Array], time: Array, phases: Mapping[str, Any]) -> dict[str, Array]:
    """The values of the fields from channels (T, …) at times (T,) [s]; `phases`: that table of the mission."""
    found = {field: next((channels[n] for n in names if n in channels), None) for field, names in CHANNELS.items()}
    values = {field: channel for field, channel in found.items() if channel is not None}
    values["time"] = time
    values["reference_yaw"] = channels["reference_euler"][:, 2]
    values["push_point"] = points_of(values["push"], channels["push_moment"], channels["attitude"])
    values["phase"] = channels["phase"] if "phase" in channels else _phases_by_clock(time, phases)
    return {field: np.nan_to_num(v) for field, v in values.items()}


def points_of(forces: Array, moments: Array, attitudes: Array) -> Array:
    """Points of action (T, 3) [m, body] nearest to the centre of mass.

    Args:
        forces: (T, 3) [N, world].
        moments: about the centre of mass (T, 3) [N m, body].
        attitudes: quaternions w, x, y, z, body to world (T, 4).
    """
    w, axis = attitudes[:, :1], -attitudes[:, 1:]
    turned = 2.0 * np.cross(axis, forces)
    body = forces + w * turned + np.cross(axis, turned)
    square = np.sum(body * body, axis=1, keepdims=True)
    return np.where(square > MIN_PUSH**2, np.cross(body, moments) / np.maximum(square, MIN_PUSH**2), 0.0)


def _phases_by_clock(time: Array, phases: Mapping[str, Any]) -> Array:
    """The phases of a flight that is guided by the clock."""
    lifting = (time >= phases["lift_start"]) & (time < phases["lift_start"] + phases["lift_duration"])
    landing = np.full(len(time), False) if phases.get("land_start") is None else time >= phases["land_start"]
    return np.where(landing, LAND, np.where(lifting & (phases["height"] != 0.0), LIFT, GUIDED))
