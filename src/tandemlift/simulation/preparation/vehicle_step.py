"""The step of a vehicle without its pilot: a caller gives the thrusts. The pilot's numbers stay as they are."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tandemlift.compiler.tracer import Symbol
from tandemlift.core.algebra import where
from tandemlift.core.law import law
from tandemlift.core.types import Number, leaves
from tandemlift.simulation.loop.ending import ending_number, impulse_after, with_aftermath
from tandemlift.simulation.loop.log_sample import Sample, log_sample
from tandemlift.simulation.loop.step import Actuation, FlightModel, FlightState, PilotOutput, StepInputs, sensed
from tandemlift.simulation.preparation.templates import Templates
from tandemlift.simulation.preparation.traced_step import TracedStep

TRUE = ("position", "velocity", "attitude", "euler", "rates", "rotor_thrusts", "joint_force", "joint_torque")
LOADS = ("push_force", "push_moment", "wind_velocity", "wind_force", "contact_force")
READ = "measured_"


def is_of_vehicle(channel: str) -> bool:
    """Whether a channel is one of the vehicle, and not of its pilot."""
    return channel in TRUE + LOADS or channel.startswith(READ)


@law
def finish_vehicle(
    model: FlightModel, output: PilotOutput, acting: Actuation, moved: Any, inputs: StepInputs, t: Number, dt: Number
) -> tuple[FlightState, Sample]:
    """As `finish_sample` without a pilot: (the state after a step, the sample at its start).

    No estimate of the attitude comes with the readings of the IMU: the true attitude is in its place.
    """
    before, noise, limits = model.flight_state, inputs.noise.sensors, model.limits
    attitude = before.state.attitude
    readings, sensing = sensed(model, moved, attitude, noise)
    impulse = impulse_after(limits.strike, before.impulse, moved.readings.contact_force, dt)
    number = ending_number(limits, moved.state, impulse)
    crash, ended = with_aftermath(limits.aftermath, before.crash, number, moved.state, impulse, t, dt)
    after = before._replace(
        state=moved.state,
        wind=acting.wind.memory,
        shape=moved.shape,
        grip=moved.grip,
        touches=moved.touches,
        sensing=sensing,
        rotors=acting.rotors,
        readings=readings,
        person=inputs.person,
        impulse=impulse,
        crash=crash,
        ended=where(before.ended > 0.0, before.ended, ended),
    )
    return after, log_sample(model, output, acting, moved, inputs)


class VehicleStep(TracedStep):
    """A traced step whose thrusts a caller gives. Channels of the pilot are zero.

    Args:
        templates: of the flight, with inputs of a caller.
        fuses: see `TracedStep`.
        rolls: see `TracedStep`.
    """

    end = staticmethod(finish_vehicle)

    def __init__(self, templates: Templates, *, fuses: bool = True, rolls: bool = True) -> None:
        self.pilot: Any = lambda *_: templates.output
        super().__init__(templates, fuses=fuses, rolls=rolls)

    def input_of(self, kind: str, like: Any) -> Any:
        """As of a `TracedStep`, but thrusts always count, and a velocity of the reference never does."""
        value = super().input_of(kind, like)
        return value._replace(override=1.0, lead=like.lead) if kind == "external" else value

    def _limit_thrusts(self, output: PilotOutput) -> PilotOutput:
        return output

    def used(self) -> set[int]:
        """The places, among a flight's numbers, of those that its samples depend on, now or in a later step."""
        size = leaves(self.templates.model.flight_state)
        found = self._read_by([*self.sample, *self.may_touch_walls, *self.may_touch_hull])
        while more := self._read_by(self.next_state[i] for i in found if i < size) - found:
            found |= more
        return found

    def _read_by(self, numbers: Iterable[Symbol]) -> set[int]:
        """The places of the numbers of the flight that symbols depend on, also by the motion of the body."""
        graph = self.graph
        nodes = graph.needed([s.node for s in numbers])
        moved = [graph.args[n][1] for n in nodes if graph.ops[n] == "in" and graph.args[n][0] == "moved"]
        bodies = [body for body in (self.body_in_contact, self.body_on_feet, self.body_in_free_air) if body]
        nodes += graph.needed([body[i].node for body in bodies for i in moved])
        return {graph.args[n][1] for n in nodes if graph.ops[n] == "in" and graph.args[n][0] == "fly"}
