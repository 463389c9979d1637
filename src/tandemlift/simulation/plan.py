"""The plan of a flight: a mission prepared for the compiled loop, which is cached by its types."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import numpy as np

from tandemlift.core.caching import LastUsed
from tandemlift.core.law import replaced
from tandemlift.core.plugs import explained, listed, plugin_of
from tandemlift.core.types import layout_and_numbers
from tandemlift.core.vector import ZERO, each, layout
from tandemlift.engines.registry import engine_named
from tandemlift.flight.record import LATE
from tandemlift.missions import Mission, check_double
from tandemlift.parts.controllers import NoMemory, control
from tandemlift.parts.guidance.requests import ReferenceVelocity
from tandemlift.simulation.loop.caller_inputs import CallerInput, OutsidePush
from tandemlift.simulation.loop.log_sample import Sample
from tandemlift.simulation.preparation import (
    LANES,
    FlightStart,
    LeafSpan,
    LoopCode,
    PythonController,
    TimeGrid,
    leaf_offset,
)
from tandemlift.simulation.preparation.assemble import assemble
from tandemlift.simulation.preparation.memory import in_floats
from tandemlift.simulation.preparation.traced_assembly import assembled_by_graph

LONG_RUN, LONG_STEPWISE = 5_000_000, 10_000  # steps that take about a second

LOOP_CODE = LastUsed[LoopCode](32)  # of some megabytes each


class FlightPlan:
    """A mission ready to fly: the assembled flight at t = 0, its inputs from outside, and its time grid.

    Args:
        mission: from `load_mission`.
        engine: name of the body's engine.
        interactive: whether the caller of a step has inputs (`simulation.loop.caller_inputs`).
        in_block: whether it is flown in a block, which alone may be in single precision.

    Raises:
        InputError: the engine is unknown, or the mission cannot be built, or needs double precision.
    """

    def __init__(
        self, mission: Mission, engine: str = "compiled", *, interactive: bool = False, in_block: bool = False
    ) -> None:
        if not in_block:
            check_double(mission, "only fly, fly_many, Block, environments and studies compute in single precision")
        chosen, brought = engine_named(engine), plugin_of("engine", engine)
        mission = mission.with_plugins([brought.said]) if brought else mission
        for plugin in mission.plugins:
            listed(plugin._asdict())  # as it was loaded for the mission
        self.mission, self.engine, self.interactive = mission, engine, interactive
        self.steps = mission.mission.steps
        self.every = mission.mission.log_every
        self.dt = mission.mission.step
        self.single = mission.mission.precision == "single"
        try:
            self.model, self.given, self.tables, self.delays, self.seeds = assembled_by_graph(mission, assemble)
        except Exception as error:
            if (told := explained(error)) is error:
                raise
            raise told from error
        if interactive:
            rotors = 4 * len(mission.vehicle.quadrotors)
            none = each(rotors)(*[0.0] * rotors)
            nothing = CallerInput(ZERO, ZERO, none, 0.0, ReferenceVelocity(ZERO, 0.0))
            self.given = self.given._replace(external=nothing)
        if chosen.pushable:
            self.given = self.given._replace(outside=OutsidePush(ZERO, ZERO))
        self.interpreted: tuple[Any, Any] | None = None
        if type(self.model.pilot.controller) in control.interpreted:
            self._detach_python_controller()
        if engine != "compiled":
            check_double(mission, f"the engine {engine!r} computes in doubles")
        if self.interpreted is not None:
            check_double(
                mission, f"the controller {mission.controller.name!r} is plain Python, which computes in doubles"
            )
        if mission.changes_in_flight:
            what = (
                "person.recording is flown again, bit by bit,"
                if mission.person.recording
                else "changes in flight are flown"
            )
            check_double(mission, f"{what} in doubles")

    def _detach_python_controller(self) -> None:
        flight_state, pilot = self.model.flight_state, self.model.pilot
        self.interpreted = pilot.controller, flight_state.memory.controller
        memory = flight_state.memory._replace(controller=NoMemory())
        self.model = self.model._replace(
            flight_state=flight_state._replace(memory=memory), pilot=pilot._replace(controller=PythonController())
        )

    @cached_property
    def variant(self) -> Any:
        """The key of the compiled loop: the types, not the values, of its members and inputs; and its rounding."""
        return self._parts[0], layout(self.given), self.mission.mission.fma, self.single

    @cached_property
    def _parts(self) -> tuple[Any, list[float]]:
        """The classes of the flight at t = 0, and its numbers."""
        return layout_and_numbers(self.model)

    @property
    def sample(self) -> Sample:
        """The layout of a row of the log."""
        return self.loop_code.templates.sample

    def place(self, *path: str) -> LeafSpan:
        """The place of a part of the flight among its numbers, by its path from `FlightModel`."""
        return leaf_offset(self.model, *path)

    @property
    def stepwise(self) -> bool:
        """Whether it is flown step by step, because Python is part of its loop."""
        return self.interpreted is not None or self.mission.changes_in_flight

    @property
    def takes_long(self) -> bool:
        """Whether flying it, once compiled, takes more than a second or so."""
        return self.steps >= (LONG_STEPWISE if self.stepwise else LONG_RUN)

    @property
    def late_step(self) -> int:
        """The first step that starts at `LATE` or later."""
        return math.ceil(LATE / self.dt - 1e-9)

    @property
    def lanes(self) -> int:
        """Flights of a block: as many as a vector of the processor has numbers."""
        return LANES * (1 + self.single)

    @cached_property
    def regime(self) -> tuple[float, ...]:
        """What happens in the flight that takes code of its own: the number of walls, and when rotors fail [s]."""
        times = sorted(min(fault.time, self.mission.mission.duration) for fault in self.mission.faults)
        return len(self.tables.walls), *times

    @cached_property
    def loop_code(self) -> LoopCode:
        """The compiled loops of this variant."""
        key = self.variant, replaced()
        return LOOP_CODE.of(
            key, lambda: LoopCode(self.model, self.given, fuses=self.mission.mission.fma, single=self.single)
        )

    def start(self) -> FlightStart:
        """The flight at its first step, as input of a compiled loop."""
        numbers = in_floats(self._parts[1]) if self.single else np.array(self._parts[1], dtype=float)
        return FlightStart(numbers, self.tables, self._delay_lines(numbers), self.seeds)

    def grid(self, rows: int, every: int) -> TimeGrid:
        """The time grid of the flight, with a log of `rows` rows, one every `every` steps."""
        return TimeGrid(self.steps, every, rows, self.dt, self.delays)

    def _delay_lines(self, numbers: np.ndarray) -> np.ndarray:
        """The delay lines of this flight, filled with the values at t = 0: `numbers`, those of its model."""
        if not self.delays.any():
            return np.zeros((1, 0))
        row = np.concatenate([numbers[span.at : span.at + span.size] for span in self.loop_code.delayed])
        return np.tile(row, (1 << int(self.delays.max()).bit_length(), 1))
