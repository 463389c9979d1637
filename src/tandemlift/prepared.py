"""A mission made ready for the compiled loop, which is chosen by the types of its members and kept for the next."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import numpy as np

from tandemlift.assembly import assemble
from tandemlift.jit import flat
from tandemlift.kernels import Aside, Kernels
from tandemlift.laws.controllers import NoMemory, control
from tandemlift.settings import Mission
from tandemlift.tally import LATE
from tandemlift.vector import layout

STRETCH = 2_000_000  # steps between looks at the keyboard and at the progress bar
LONG_RUN, LONG_STEPWISE = 5_000_000, 10_000  # steps that take more than a second

KERNELS: dict[Any, Kernels] = {}


class Prepared:
    """A mission ready to fly: its loop at t = 0, what it is given from outside, and its grid of steps."""

    def __init__(self, mission: Mission) -> None:
        self.mission = mission
        self.steps = mission.mission.steps
        self.every = mission.mission.log_every
        self.dt = mission.mission.step
        self.flying, self.given, self.tables, self.delays, self.seeds = assemble(mission)
        self.interpreted: tuple[Any, Any] | None = None
        if type(self.flying.pilot.controller) in control.interpreted:
            self._set_controller_aside()

    def _set_controller_aside(self) -> None:
        moving, pilot = self.flying.moving, self.flying.pilot
        self.interpreted = pilot.controller, moving.memory.controller
        memory = moving.memory._replace(controller=NoMemory())
        self.flying = self.flying._replace(
            moving=moving._replace(memory=memory), pilot=pilot._replace(controller=Aside())
        )

    @cached_property
    def variant(self) -> Any:
        """What decides the compiled loop: the types, not the values, of the flight's members and inputs."""
        return layout(self.flying), layout(self.given)

    @property
    def sample(self) -> Any:
        """The layout of a row of the log."""
        return self.kernels.likes.sample

    @property
    def late_step(self) -> int:
        """The first step that starts at `LATE` or after."""
        return math.ceil(LATE / self.dt - 1e-9)

    @property
    def stops(self) -> list[int]:
        """Where the stretches that the flight is flown in end; the last one with the closing sample."""
        inner = {*range(STRETCH, self.steps, STRETCH), self.late_step}
        return sorted({s for s in inner if s < self.steps} | {self.steps + 1})

    @property
    def kernels(self) -> Kernels:
        """The compiled loops of this variant."""
        if self.variant not in KERNELS:
            KERNELS[self.variant] = Kernels(self.flying, self.given)
        return KERNELS[self.variant]

    def ring(self) -> np.ndarray:
        """A delay line for this flight, filled with what it holds at t = 0."""
        lines, numbers = self.kernels.lines, np.array(flat(self.flying))
        if not self.delays.any():
            return np.zeros((1, 0))
        row = np.concatenate([numbers[span.at : span.at + span.size] for span in lines])
        return np.tile(row, (1 << int(self.delays.max()).bit_length(), 1))


def needs_compiling(mission: Mission) -> bool:
    """Whether flying this mission alone will first compile its loop, which takes seconds."""
    p = Prepared(mission)
    return p.variant not in KERNELS and not p.kernels.folder.exists()


def takes_long(mission: Mission) -> bool:
    """Whether flying this mission, once compiled, takes more than a second or so."""
    stepwise = Prepared(mission).interpreted is not None or mission.changes or mission.partner.recording
    return mission.mission.steps >= (LONG_STEPWISE if stepwise else LONG_RUN)
