"""A flight as a table: a row for each sample, a column for each number of each channel.

A column is called `channel[unit].component`, such as `position[m].x`; a channel of one number has no component. Numbers
are written with as many digits as bring the same float64 back.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from tandemlift.flight import Flight

ROTORS = ("rotor_thrusts", "rotor_commands")
JOINTS = ("joint_force", "joint_torque", "measured_joint_force", "measured_joint_torque")


def components(name: str, frame: str, count: int) -> Sequence[str]:
    """What a channel's columns are called: axes, angles, a quaternion's w, x, y, z; quadrotor and rotor, or axis.

    Args:
        name: of the channel.
        frame: in which it is.
        count: how many columns it has.
    """
    if name in ROTORS:
        return [f"{1 + i // 4}.{1 + i % 4}" for i in range(count)]
    if name in JOINTS:
        return [f"{1 + i // 3}.{'xyz'[i % 3]}" for i in range(count)]
    if frame == "body to world" and count == 4:
        return "wxyz"
    if count == 3 and frame:
        return ("roll", "pitch", "yaw") if frame == "zxy" else "xyz"
    return [str(1 + i) for i in range(count)]


def headings(flight: Flight) -> Iterator[str]:
    """The names of all columns, time first."""
    yield "time[s]"
    for name, values in flight.channels.items():
        info = flight.info(name)
        label = f"{name}[{info.unit}]" if info.unit else name
        if values.ndim == 1:
            yield label
        else:
            yield from (f"{label}.{part}" for part in components(name, info.frame, values.shape[1]))


def write_csv(flight: Flight, path: Path) -> None:
    """Write the table: commas between, a decimal point, lines ended by a line feed, ASCII where names are."""
    columns = [flight.time, *flight.channels.values()]
    rows = np.hstack([values.reshape(len(flight.time), -1) for values in columns])
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(",".join(headings(flight)) + "\n")
        file.writelines(",".join(map(repr, row.tolist())) + "\n" for row in rows)
