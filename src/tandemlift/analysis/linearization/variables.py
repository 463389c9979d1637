"""The outputs of a linear model: columns of a sample, with their names and units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.core.errors import unknown
from tandemlift.core.types import leaves
from tandemlift.flight.channels import channel_of
from tandemlift.flight.data_frames import column_names
from tandemlift.flight.state_variables import Variable
from tandemlift.simulation.results import channels_of


class Outputs(NamedTuple):
    """The chosen columns of a sample, and their variables."""

    columns: tuple[int, ...]
    variables: tuple[Variable, ...]


def outputs_from(sample: object, chosen: Sequence[str] | None, default: Sequence[str]) -> Outputs:
    """The columns of channels.

    Args:
        sample: the layout of a sample.
        chosen: names of channels; None for those of `default` that the flight has.
        default: names of channels.

    Raises:
        InputError: there is no such channel.
    """
    row = np.arange(leaves(sample), dtype=np.float64)[None, :]
    places = {name: at[0] for name, at in channels_of(sample, row)}
    for name in chosen or ():
        if name not in places:
            raise unknown("output", name, places)
    columns, variables = list[int](), list[Variable]()
    for name in [name for name in default if name in places] if chosen is None else chosen:
        channel, at = channel_of(name), places[name]
        columns += np.atleast_1d(at).astype(int).tolist()
        variables += [Variable(column, channel.unit) for column in column_names(name, channel, at.shape)]
    return Outputs(tuple(columns), tuple(variables))
