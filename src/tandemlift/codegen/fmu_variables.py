"""The variables of an FMU: parameters by the keys of its mission, inputs, and outputs by the channels of a flight.

Each has a place among the numbers of the C code (`data/c/fmu.h`): parameters, then inputs, then outputs. Its value
reference is 1 more.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from tandemlift.codegen.number_facts import CALLER, FIELDS, PUSH, REQUESTS, STATE, STATUS
from tandemlift.flight.channels import Channel, channel_of, column_names
from tandemlift.simulation.graphs import TracedAssembly
from tandemlift.simulation.results import channel_columns
from tandemlift.simulation.simulation import held_inputs

ENTRY = re.compile(r"(.+?)((?:\.\d+)+)")  # a key of a number in a list


class FmuVariable(NamedTuple):
    """A variable of an FMU.

    Attributes:
        name: in FMI 3.
        causality: "parameter", "input" or "output".
        channel: unit, frame, meaning.
        at: place of its first number.
        labels: names of its numbers in FMI 2; one for a single number.
        is_array: whether it has a dimension.
        start: its numbers before the first step; none for outputs.
        bounds: of its numbers, by their names in JSON Schema.
        is_truth: whether it is true or false.
        is_tunable: whether a parameter may be set between steps, as `[[changes]]` do.
    """

    name: str
    causality: str
    channel: Channel
    at: int
    labels: tuple[str, ...]
    is_array: bool
    start: tuple[float, ...] = ()
    bounds: Mapping[str, float] = MappingProxyType({})
    is_truth: bool = False
    is_tunable: bool = False

    @property
    def description(self) -> str:
        """The meaning, and the frame if there is one."""
        frame = self.channel.frame
        return f"{self.channel.meaning} ({frame} frame)" if frame and " " not in frame else self.channel.meaning


def parameters(
    traced: TracedAssembly, facts: Mapping[str, dict[str, Any]], effective: set[int], tunable: set[int]
) -> Iterator[FmuVariable]:
    """A parameter for each key whose numbers have an effect; a list of numbers is an array.

    Args:
        traced: the assembly, whose inputs are the numbers.
        facts: of `number_facts`, by key.
        effective: which of these have an effect.
        tunable: which of these may change between steps.
    """
    places = [i for i in range(len(traced.keys)) if i in effective]
    for name, group in itertools.groupby(places, lambda i: _list_of(traced.keys[i])):
        own = list(group)
        keys = tuple(traced.keys[i] for i in own)
        is_list = keys == tuple([f"{name}.{i}" for i in range(len(keys))])
        is_whole = is_list and own == list(range(own[0], own[0] + len(own)))
        for members in [own] if is_whole else [[i] for i in own]:
            labels = tuple(traced.keys[i] for i in members)
            bounds = dict(facts[labels[0]])
            channel = Channel(bounds.pop("unit"), "", bounds.pop("meaning"), len(members))
            start = tuple(traced.values[i] for i in members)
            at = members[0]
            own_name, is_tunable = name if is_whole else labels[0], tunable.issuperset(members)
            yield FmuVariable(
                own_name, "parameter", channel, at, labels, is_whole, start, bounds, is_tunable=is_tunable
            )


def _list_of(key: str) -> str:
    match = ENTRY.fullmatch(key)
    return match[1] if match else key


def _labelled(name: str, channel: Channel, size: int, shape: tuple[int, ...]) -> tuple[str, ...]:
    return tuple(column_names(name, channel, shape)) if size > 1 or shape else (name,)


def outputs(sample: Any, first: int, names: Iterable[str]) -> tuple[list[FmuVariable], list[int]]:
    """Outputs for the channels of these names, and the places of their numbers in a sample laid out like `sample`."""
    found, places = list[FmuVariable](), list[int]()
    for name, columns in channel_columns(sample).items():
        if name in names:
            channel, shape = channel_of(name), columns.shape
            labels = _labelled(name, channel, columns.size, shape)
            found.append(FmuVariable(name, "output", channel, first + len(places), labels, bool(shape)))
            places += columns.ravel().tolist()
    return found, places


def thrust_output(first: int, rotors: int) -> FmuVariable:
    """The output of a pilot."""
    meaning = "thrust of each rotor that the pilot decided at the start of the last step, quadrotor by quadrotor"
    channel = Channel("N", "body z", meaning, 1, "rotor")
    return FmuVariable("thrusts", "output", channel, first, _labelled("thrusts", channel, rotors, (rotors,)), True)


def caller_inputs(external: Any, first: int, *, has_pilot: bool) -> Iterator[FmuVariable]:
    """The inputs of a flight, or of a vehicle without pilot, which are held over a step."""
    places, rotors = held_inputs(external), len(external.thrusts)
    channels = {"push": CALLER["force"], "point": CALLER["point"], "thrusts": CALLER["thrusts"]}
    channels["velocity"] = FIELDS["ReferenceVelocity"]["velocity"]
    counts = {
        "thrusts": "whether the thrusts count, in place of the pilot's",
        "velocity": "whether that velocity counts",
    }
    for name, channel in channels.items():
        held = places[name]
        size = held.place.stop - held.place.start
        if name == "velocity" and not has_pilot:
            continue
        own = {"velocity": "desired_velocity"}.get(name, name)  # there is an output of that name
        labels = _labelled(own, channel, rotors if channel.per else size, (size,))
        yield FmuVariable(own, "input", channel, first + held.place.start, labels, True, (0.0,) * size)
        if held.flag is not None and has_pilot:
            yield _truth(f"{own}_given", counts[name], first + held.flag, 0.0)


def pilot_inputs(first: int, start: list[float]) -> Iterator[FmuVariable]:
    """The inputs of a pilot, in the order of a `PilotInput`; `start`: its numbers at rest."""
    at = 0
    for name, channel in {**STATE, **PUSH}.items():
        values = tuple(start[at : at + channel.width])
        labels = _labelled(name, channel, channel.width, (channel.width,))
        yield FmuVariable(name, "input", channel, first + at, labels, True, values)
        at += channel.width
    for name, channel in REQUESTS.items():
        yield _truth(name, channel.meaning.replace("1 to", "whether to"), first + at, start[at])
        at += 1
    for name, channel in STATUS.items():
        name = {"thrust": "allocated_thrust", "limited": "limited_reason"}.get(name, name)
        yield FmuVariable(name, "input", channel, first + at, (name,), False, (start[at],))
        at += 1


def _truth(name: str, meaning: str, at: int, start: float) -> FmuVariable:
    return FmuVariable(name, "input", Channel("1", "", meaning, 1), at, (name,), False, (start,), is_truth=True)
