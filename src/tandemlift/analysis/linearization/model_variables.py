"""Inputs and outputs of a linear model: numbers of a step's inputs and columns of its sample, with names and units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.linearization.state_variables import Variable
from tandemlift.analysis.linearization.step_graph import no_push
from tandemlift.core.errors import InputError, unknown
from tandemlift.core.types import flat, leaves, unflat
from tandemlift.core.vector import Absent, Quat
from tandemlift.flight.channels import channel_of, column_names
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.simulation.graphs import PushSamples, gust_velocity, push_at
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import GAUSSIAN, GUST, leaf_offset
from tandemlift.simulation.results import channels_of

LOOP = ("push_force", "push_moment", "disturbance_force", "disturbance_moment", "wind_velocity")
BODY = ("rotor_thrusts", *LOOP)
ON_REQUEST = ("thrust_offsets",)  # inputs of the loop that are not taken by default
UNITS = {"push_moment": "N m", "disturbance_moment": "N m", "wind_velocity": "m/s"}  # the others: N
SPREAD = 3  # where Σ F rᵀ begins in a push


class InputColumn(NamedTuple):
    """An input: its description, and the derivatives of the step's numbers by it, as (kind, index, derivative)."""

    variable: Variable
    seeds: tuple[tuple[str, int, float], ...]


def input_columns(p: FlightPlan, chosen: Sequence[str] | None, of: str, attitude: Quat) -> list[InputColumn]:
    """The inputs of a model.

    Args:
        p: the plan of the flight.
        chosen: names of groups; None for all.
        of: "loop" or "body".
        attitude: of the body at the point.

    Raises:
        InputError: there is no such input, or the mission has none.
    """
    known = BODY if of == "body" else LOOP
    allowed = known if of == "body" else (*known, *ON_REQUEST)
    windless = isinstance(p.model.wind, Absent)
    for name in chosen or ():
        if name not in allowed:
            raise unknown(f"input of the {of}", name, allowed)
        if name == "wind_velocity" and windless:
            raise InputError('input wind_velocity: the mission has no wind; wind.model = "air" gives it one')
        if name == "thrust_offsets" and p.mission.actuators.model != "rotors":
            raise InputError(
                'input thrust_offsets: actuators.model must be "rotors", whose thrusts differ from commands'
            )
    names = [name for name in known if not (windless and name == "wind_velocity")] if chosen is None else chosen
    return [column for name in names for column in _columns(p, name, attitude)]


def _columns(p: FlightPlan, name: str, attitude: Quat) -> list[InputColumn]:
    unit = UNITS.get(name, "N")
    if name in ("rotor_thrusts", *ON_REQUEST):
        rotors, kind = 4 * len(p.mission.vehicle.quadrotors), "thrust" if name == "rotor_thrusts" else "offset"
        return [InputColumn(Variable(f"{name}_rotor_{i + 1}", unit), ((kind, i, 1.0),)) for i in range(rotors)]
    return [
        InputColumn(Variable(f"{name}_{axis}", unit), tuple(_seeds(p, name, i, attitude)))
        for i, axis in enumerate("xyz")
    ]


def _seeds(p: FlightPlan, name: str, i: int, attitude: Quat) -> list[tuple[str, int, float]]:
    size = len(flat(no_push(p)))
    if name == "push_force":
        return [("hand", size * part + i, 1.0) for part in range(3)]
    if name == "push_moment":
        return [
            ("hand", size * part + SPREAD + j, weight)
            for part in range(3)
            for j, weight in enumerate(_spread_of_moment(i, attitude))
        ]
    if name == "wind_velocity":
        return [("gust", i, 1.0)]
    at = leaf_offset(p.model, "plant", "body", name.removeprefix("disturbance_")).at
    return [("fly", at + i, 1.0)]


def _spread_of_moment(i: int, attitude: Quat) -> list[float]:
    """Σ F rᵀ of a unit moment about body axis i without a force: R G, where G is half its cross-product matrix."""
    R = np.array([list(row) for row in rotation_from_quaternion(attitude)])
    half = 0.5 * np.eye(3)[i]
    cross = np.array([[0.0, -half[2], half[1]], [half[2], 0.0, -half[0]], [-half[1], half[0], 0.0]])
    return (R @ cross).ravel().tolist()


def given_at(p: FlightPlan, t: float) -> dict[str, list[float]]:
    """The mission's pushes and gusts over the step from time t [s], and its time."""
    times = (t, t + 0.5 * p.dt, t + p.dt)
    gust = sum((np.array(flat(gust_velocity(unflat(row, GUST), t))) for row in p.tables.gusts), np.zeros(3))
    hand = PushSamples(*[push_sum(p, when) for when in times])
    return {"hand": flat(hand), "gust": gust.tolist(), "t": [t], "dt": [p.dt]}


def push_sum(p: FlightPlan, t: float) -> Any:
    """The sum of the mission's pushes at a time [s]."""
    kind = no_push(p)
    return sum((push_at(kind, unflat(row, GAUSSIAN), t) for row in p.tables.pushes), start=kind)


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
