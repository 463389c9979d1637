"""The layouts of the values that pass through a step: nested values without meaningful numbers."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.trajectories import Trajectory
from tandemlift.core.types import zeroed
from tandemlift.core.vector import ZERO, Absent, Quat
from tandemlift.engines.compiled import BodyStep
from tandemlift.parts.contact.walls import NearWalls
from tandemlift.parts.controllers import Command, Measured, Reference, control
from tandemlift.parts.mechanics.rigid_body import State, Wrench
from tandemlift.parts.person.person import Person
from tandemlift.parts.rotors.allocation import ConstrainedAllocation
from tandemlift.simulation.loop import step
from tandemlift.simulation.loop.log_sample import Sample

COMMAND = Command(Wrench(0.0, ZERO), ZERO)
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)


class ControllerInput(NamedTuple):
    """The inputs of a controller at a sample."""

    measured: Measured
    reference: Reference


GIVEN = ControllerInput(Measured(State(ZERO, ZERO, LEVEL, ZERO), ZERO), Reference(Trajectory(ZERO, ZERO, ZERO), 0.0))


class PythonController(NamedTuple):
    """Stands in the loops for a controller in plain Python, which is called between the parts of a step."""


@control.register(PythonController)
def _layout_of_command(gains: PythonController, memory: Any, measured: Measured, reference: Reference) -> Any:
    return COMMAND, memory


class Templates(NamedTuple):
    """Layouts of the values that pass through a step.

    Attributes:
        model: the flight, a `FlightModel`.
        given: the `StepInputs`.
        output: the `PilotOutput`.
        acting: the `Actuation`.
        moved: the `BodyStep`.
        sample: a row of the log.
        nowhere: the nearest walls before the first search; its numbers are used, not only its layout.
    """

    model: step.FlightModel
    given: step.StepInputs
    output: step.PilotOutput
    acting: step.Actuation
    moved: BodyStep
    sample: Sample
    nowhere: NearWalls | Absent

    @property
    def calls_python(self) -> bool:
        """Whether a controller in plain Python is called in the middle of a step."""
        return isinstance(self.model.pilot.controller, PythonController)

    @property
    def has_thrust_limits(self) -> bool:
        """Whether the allocation keeps thrusts within limits."""
        return isinstance(self.model.pilot.allocation, ConstrainedAllocation)

    @property
    def has_walls(self) -> bool:
        """Whether the mission has walls."""
        return not isinstance(self.nowhere, Absent)

    @property
    def has_person(self) -> bool:
        """Whether a person leads the vehicle along a path."""
        return isinstance(self.model.person, Person)

    @property
    def has_floor(self) -> bool:
        """Whether the mission has a floor."""
        return not isinstance(self.model.plant.floor, Absent)

    @property
    def has_delays(self) -> bool:
        """Whether anything is delayed."""
        return not isinstance(self.model.delays, Absent)


def templates_from(model: step.FlightModel, given: step.StepInputs) -> Templates:
    """The layouts of a flight's steps, from its first."""
    before, outer = model.flight_state, given
    given = step.with_person(model, given, 0.0, 0.001)
    output = step.run_pilot(model, given, 0.0, 0.001)
    acting = step.actuate(model, output.decision.thrusts, given, 0.0)
    moved = step.step_body(model.plant, before, acting, given.hand, 0.0, 0.001)
    _, sample = step.finish_sample(model, output, acting, moved, given, 0.0, 0.0)
    layouts = [zeroed(x) for x in (model, outer, output, acting, moved, sample)]
    return Templates._make([*layouts, before.near])
