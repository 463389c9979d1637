"""A flight as a table: a row for each sample, a column for each number of each channel.

A column is called `channel[unit].component`, such as `position[m].x`; a channel of one number has no component. Numbers
are written with enough digits to restore the same float64; one that is missing is `NaN`, which pandas, polars, DuckDB
and pyarrow all read as a number.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from tandemlift.flight.channels import Channel, dimensions
from tandemlift.flight.record import Flight


def components(channel: Channel, count: int) -> Sequence[str]:
    """The names of a channel's columns: axes, angles, a quaternion's w, x, y, z; quadrotor and rotor, or axis.

    Args:
        channel: its description.
        count: its number of columns.
    """
    if channel.per == "rotor" and channel.width == 1:
        return [f"{1 + i // 4}.{1 + i % 4}" for i in range(count)]
    labels = [d.labels for d in dimensions(channel, count)]
    return [".".join(map(str, parts)) for parts in itertools.product(*labels)]


def headings(flight: Flight) -> Iterator[str]:
    """The names of all columns, time first."""
    yield "time[s]"
    for name, values in flight.channels.items():
        info = flight.info(name)
        label = f"{name}[{info.unit}]" if info.unit else name
        if values.ndim == 1:
            yield label
        else:
            yield from (f"{label}.{part}" for part in components(info, values.shape[1]))


def write_csv(flight: Flight, path: Path) -> None:
    """Write the table: commas between, a decimal point, lines ended by a line feed, ASCII where names are."""
    columns = [flight.time, *flight.channels.values()]
    rows = np.hstack([values.reshape(len(flight.time), -1) for values in columns])
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(",".join(headings(flight)) + "\n")
        file.writelines(",".join(map(repr, row.tolist())).replace("nan", "NaN") + "\n" for row in rows)
