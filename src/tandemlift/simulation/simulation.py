"""Pilot and body together, a step at a time: `Simulation`."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.errors import InputError, accepted, shown
from tandemlift.core.refusals import Refusals
from tandemlift.core.types import Array, leaves
from tandemlift.flight.channels import DERIVED, Channel, channel_of
from tandemlift.flight.record import Ending, Flight, interruption
from tandemlift.missions import MissionLike, mission_of
from tandemlift.missions.recording import engine_of
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_checks import on_vehicle_checks
from tandemlift.simulation.caller_values import checked_seed, count_of, held_inputs, numbers
from tandemlift.simulation.loop.running_metrics import EMPTY
from tandemlift.simulation.outcome import ending_of
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import leaf_offset
from tandemlift.simulation.results import RawResult, SampleChannels, flight_of, take_metrics
from tandemlift.simulation.stepping import Stepper, body_of

__all__ = [
    "Simulation",
    "checked_seed",
    "count_of",
    "held_inputs",
]

REPORT_EVERY = 1000  # steps between reports of computing time, which decides when optimised code is made


class Simulation:
    """A mission's flight, a step at a time: the pilot, sensors, rotors, wind and body that `tl.fly` flies.

    A step goes from `time` to `time` + `dt`. The pilot is sampled at its start; its decision and the inputs of the
    caller act until its end. Then `state` is the state at the new `time`, and `sim["rotor_thrusts"]` and the other
    channels are the sample of the step just taken: the pilot's readings and decision at its start, `sample_time`, and
    the loads during it. A `Flight` holds the same samples.

    Args:
        mission: from `load_mission`, or its name or path.
        engine: name of the engine; if None, that of the mission's recording, or "compiled".

    Attributes:
        mission: the mission that is flown.
        engine: name of the engine.
        k: steps taken since the start.
        dt: length of a step [s].
        channels: names of the channels, the same as the flight's.

    Raises:
        InputError: the engine is unknown, or the mission cannot be loaded or built.
    """

    def __init__(self, mission: MissionLike, engine: str | None = None) -> None:
        self.mission = mission_of(mission)
        self.engine = engine_of(self.mission.person.recording) if engine is None else engine
        self._prepare()
        self._begin()

    def _prepare(self) -> None:
        p = self._p = FlightPlan(self.mission, self.engine, interactive=True)
        self.dt = p.dt
        self._sample = SampleChannels(p.sample)
        self.channels = self._sample.names
        self._external, self._held = np.zeros(leaves(p.given.external)), held_inputs(p.given.external)
        self._state = leaf_offset(p.model, "flight_state", "state")

    def _begin(self) -> None:
        vars(self).pop("_stepper", None)  # first release an engine that only one pilot can drive
        self._stepper = Stepper(self._p, body_of(self._p))
        self.k, self._early, self._rows, self._end = 0, EMPTY, list[Array](), None
        self._wall = self._reported = 0.0
        self._interruption: Ending | None = None

    def reset(self, seed: int | None = None) -> Array:
        """Begin anew at t = 0.

        Args:
            seed: of all random numbers, instead of `mission.seed`, from now on; if None, the seed stays and the same
                flight begins again.

        Returns:
            The state (13,) at t = 0.

        Raises:
            InputError: the seed is not a whole number from 0 to 10¹⁸.
        """
        if seed is not None:
            table = self.mission.mission.model_copy(update={"seed": checked_seed(seed)})
            self.mission = self.mission.model_copy(update={"mission": table})
        if seed is not None or self._p.interpreted is not None:  # plain Python may have changed its memory in place
            self._prepare()
        self._begin()
        return self.state

    def step(
        self,
        push: ArrayLike | None = None,
        thrusts: ArrayLike | None = None,
        *,
        point: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        steps: int = 1,
    ) -> Array:
        """Take one step of `dt`, or several; the inputs act for these steps only.

        Args:
            push: force (3,) [N] on the vehicle in world axes, in addition to the mission's pushes.
            thrusts: of every rotor (4N,) [N], quadrotor by quadrotor, commanded instead of the pilot's decision.
                Delay, lag, limits and faults of real rotors apply to them; ideal rotors produce them exactly. The pilot
                continues to decide without receiving them.
            point: point of application of the push (3,) [m], body axes, from the centre of mass; that centre if None.
            velocity: of the reference (3,) [m/s], world axes, in place of the admittance's response to pushes. With
                interactive guidance its limits apply, and it counts only while pushes may be followed.
            steps: number of steps; fewer are taken if the flight ends before.

        Returns:
            The state (13,) at the new `time`.

        Raises:
            InputError: the flight is over, an input is not an array of that many finite numbers, the point is not on
                the vehicle, or `steps` is not a whole number of at least 1.
            OSError: the engine in another process is lost; the flight is over. It is also over if Ctrl-C or an error
                stops a step in another engine or in a controller in plain Python.
        """
        if self.over:
            reason = self.ending or f"the flight is over: mission.duration = {self.mission.mission.duration:g} s"
            raise InputError(f"{reason}; reset() begins anew")
        self._set_inputs(push, thrusts, point, velocity)
        began, left = time.perf_counter(), steps if steps == 1 else count_of("steps", steps)
        try:
            while True:
                self._stepper.step(self.k, external=self._external)
                self._log_and_advance()
                left -= 1
                if not left or self.over:
                    break
        except BaseException as error:  # the engine is lost, or Ctrl-C
            self._keep_whole(error)
            raise
        self._wall += time.perf_counter() - began
        return self.state

    def _keep_whole(self, error: BaseException) -> None:
        """Count an interrupted step that is complete; one that is not, in Python or another engine, ends the flight."""
        if self._stepper.flight_state.metrics.steps + self._early.steps > self.k:
            self._log_and_advance()
        elif self._stepper.by_parts:
            self._interruption = interruption(self.time, str(error) or type(error).__name__)

    def _set_inputs(self, push: Any, thrusts: Any, point: Any, velocity: Any) -> None:
        """Write the caller's inputs of a step."""
        x = self._external
        x.fill(0.0)
        if push is not None:
            self._hold("push", push)
        if thrusts is not None:
            self._hold("thrusts", thrusts)
        if velocity is not None:
            self._hold("velocity", velocity)
        if point is not None:
            self._hold("point", point)
            if push is None:
                raise InputError(f"point = {shown(point)}: must come with a push")
            given = x[self._held["point"].place].tolist()
            accepted(on_vehicle_checks("point", given, Vehicle.from_settings(self.mission.vehicle)))

    def _hold(self, name: str, value: Any) -> None:
        place, meaning, flag = self._held[name]
        self._external[place] = numbers(name, value, place.stop - place.start, meaning)
        if flag is not None:
            self._external[flag] = 1.0

    def _log_and_advance(self) -> None:
        """Log the sample of the step just taken, if it is due, and count the step."""
        p, stepper = self._p, self._stepper
        if self.k % p.every == 0:
            self._rows[self.k // p.every :] = [stepper.row.copy()]
        self.k, self._end = self.k + 1, None
        if self.k == p.late_step < p.steps:
            (self._early,) = take_metrics(stepper.a, stepper.p.model, 1)
        if self.k % REPORT_EVERY == 0:
            stepper.code.add_time(self._wall - self._reported)
            self._reported = self._wall

    # state and channels

    @property
    def time(self) -> float:
        """Time that the flight has reached [s]: that of `state`, and of the start of the next step."""
        return self.k * self.dt

    @property
    def sample_time(self) -> float:
        """Time of the channels' sample [s]: the start of the step taken last; nan before the first."""
        return (self.k - 1) * self.dt if self.k else math.nan

    @property
    def state(self) -> Array:
        """The true state (13,) at `time`.

        Position [m] and velocity [m/s] of the centre of mass in world axes, attitude quaternion w, x, y, z (body to
        world), rates [rad/s] in body axes: the first 13 numbers that `Pilot.step` takes.
        """
        at, size = self._state
        return self._stepper.a[at : at + size].copy()

    @property
    def lost(self) -> bool:
        """Whether the flight has crashed or diverged, or its engine is lost."""
        return self._stepper.lost or self._interruption is not None

    @property
    def over(self) -> bool:
        """Whether no further step can be taken: the duration is over, or the flight is lost."""
        return self.k >= self._p.steps or self.lost

    @property
    def ending(self) -> Ending | None:
        """The end of a lost flight: quantity, time, value and limit, or a reason; None if it is not lost."""
        return ending_of(self._stepper.p, self._stepper.flight_state, self.k, self._interruption)

    @property
    def refusals(self) -> Refusals:
        """The refusals of a lift, a landing and following a push that would apply now, with reasons and remedies."""
        return self._stepper.refusals(self.time)

    def __getitem__(self, name: str) -> Any:
        """A channel of the last sample: an array (n,), or a number where the channel has one column.

        Raises:
            InputError: no step has been taken yet.
            KeyError: there is no such channel.
        """
        if name == "time":
            return self.sample_time
        if self.k == 0 and name in self._sample:
            raise InputError(f"channel {name!r}: no step has been taken yet, and a sample is of a step; see `state`")
        return self._sample.of(self._stepper.row, name).copy()

    def __contains__(self, name: object) -> bool:
        return name in self._sample

    def __iter__(self) -> Iterator[str]:
        return iter(self.channels)

    def __repr__(self) -> str:
        return f"<Simulation {self.mission.mission.name} in {self.engine}: {self.time:g} s, {self.k} steps>"

    def info(self, name: str) -> Channel:
        """Unit, frame and meaning of a channel."""
        if name not in self and name != "time":
            self[name]
        return DERIVED[name][2] if name in DERIVED else channel_of(name)

    # the record

    def flight(self) -> Flight:
        """The record of the flight so far, logged every `mission.log_interval`; the simulation can continue.

        It equals that of a flight whose mission ends at `time`: its last sample is that of the pilot at `time`, if one
        is due, without inputs. With a body in another engine, or a controller in plain Python, this sample exists only
        at the mission's end, because taking it would advance the flight. The caller's inputs are in the channels, but
        not in the record's mission.

        Raises:
            InputError: nothing is logged yet, with such a body or controller.
        """
        end = self._sample_here()
        rows = [*self._rows, end] if end is not None and self.k % self._p.every == 0 else self._rows
        if not rows:
            raise InputError("nothing is logged yet: take a step first")
        last = np.full(leaves(self._p.sample), math.nan) if self.lost else self._stepper.row if end is None else end
        return flight_of(self._p, self._result(np.array(rows), last), self.engine)

    def _result(self, log: Array, last: Array) -> RawResult:
        return RawResult(
            flight_state=self._stepper.flight_state,
            early=self._early,
            step=self.k,
            log=log,
            last=last,
            wall=self._wall,
            interruption=self._interruption,
            now=self._stepper.p,
        )

    def _sample_here(self) -> Array | None:
        """The sample at `time`, taken without advancing; None if that is impossible."""
        stepper = self._stepper
        returns = stepper.body is None and stepper.interpreted is None
        if self._end is None and not self.lost and (returns or self.k == self._p.steps):
            row = stepper.row.copy()
            self._external.fill(0.0)
            stepper.step(self.k, final=True, external=self._external)
            self._end = stepper.row.copy()
            stepper.row[:] = row
        return self._end
