"""The pilot as an object for the user's own loop: measurement in, rotor thrusts out."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import cached_property
from typing import Any

import numpy as np

from tandemlift.core.errors import InputError, shown
from tandemlift.core.refusals import Refusals
from tandemlift.core.types import Array, flat, leaves, unflat
from tandemlift.core.vector import ZERO, Absent, Quat
from tandemlift.missions import Mission, MissionLike, check_double, mission_of
from tandemlift.missions.facts import Facts
from tandemlift.parts.controllers import control
from tandemlift.parts.guidance.requests import NO_REQUEST, UNKNOWN_STATUS
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.pilot.pilot import PilotInput
from tandemlift.simulation.preparation.assemble import start_pilot
from tandemlift.simulation.preparation.memory import aligned
from tandemlift.simulation.preparation.pilot_sampling import MEASURED, PilotData, pilot_code
from tandemlift.simulation.preparation.traced_assembly import assembled_by_graph
from tandemlift.simulation.refusals import refusals_of

INPUT = PilotInput(
    State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO), ZERO, ZERO, 0.0, Absent(), NO_REQUEST, UNKNOWN_STATUS
)


def pilot_at_start(mission: Mission) -> PilotData:
    """The pilot of a mission before its first sample."""
    parameters, memory = start_pilot(Facts(mission))
    return PilotData(0.0, memory, parameters)


class Pilot:
    """A mission's pilot, to be sampled every `mission.step` seconds.

    Args:
        mission: from `load_mission`, or its name or path.

    Attributes:
        thrusts: thrust of every rotor [N] (4N,), the answer to the last measurement; overwritten by the next.

    Raises:
        InputError: the mission's controller is plain Python; the pilot needs a law, which can be compiled.
    """

    def __init__(self, mission: MissionLike) -> None:
        mission = mission_of(mission)
        check_double(mission, "a pilot alone computes in doubles")
        self._start = assembled_by_graph(mission, pilot_at_start)
        if type(self._start.parameters.controller) in control.interpreted:
            raise InputError(f"controller {mission.controller.name!r} is plain Python; write it as a law to use Pilot")
        self._dt, self._fuses = mission.mission.step, mission.mission.fma
        self._numbers = np.array(flat(self._start))
        self.thrusts: Array = np.zeros(4 * len(mission.vehicle.quadrotors))
        self._input = np.zeros(leaves(INPUT))
        self._measurement: Any = self._input[:16].data  # takes such an array only, and faster than an array does
        self._moment, self._requests = self._input[16:19], self._input[19:23]
        self._has_moment, self._last_requests = False, (False, False, False, False)

    @cached_property
    def _sample(self) -> Callable[[], int]:
        code = pilot_code(self._start, INPUT, len(self.thrusts) // 4, fuses=self._fuses)
        self._work = aligned(code.about["size"])
        arrays = (self._numbers, self._input, self.thrusts, self._work)
        self._context = np.array([a.ctypes.data for a in arrays] + [0], dtype=np.int64)
        self._context.view(np.float64)[-1] = self._dt
        self._code = code
        code.optimise()
        return code.bound("sample", self._context.ctypes.data)

    def step(
        self,
        measurement: Array,
        moment: Array | None = None,
        *,
        lift: bool = False,
        land: bool = False,
        stop: bool = False,
        enabled: bool = True,
    ) -> Array:
        """Take one sample.

        Args:
            measurement: float64 (16,): position [m] and velocity [m/s] of the centre of mass in world axes, attitude
                quaternion w, x, y, z (body to world), rates [rad/s] in body axes, force of the person [N] in world
                axes.
            moment: of the person [N·m] (3,) about the centre of mass, body axes; zero if not given.
            lift: whether to lift, in addition to `phases.lift_start`.
            land: whether to land.
            stop: whether to stop the rotors at once; they stay stopped until `reset`.
            enabled: whether the pilot may follow the person; otherwise it holds its position.

        The requests affect only interactive guidance. `refusals` has the reason if one of them is refused.

        Returns:
            Thrust of every rotor [N] (4N,), the same array each time.

        Raises:
            InputError: the measurement is not a float64 array of 16 numbers, or the moment not 3 numbers; or, without
                supervision, a number of them is not finite. No sample is taken then.
        """
        try:
            self._measurement[:] = measurement
        except (TypeError, ValueError, NotImplementedError) as error:
            given = f"{getattr(measurement, 'dtype', type(measurement).__name__)} {np.shape(measurement)}"
            raise InputError(f"measurement is {given}: must be a float64 array of shape (16,)") from error
        if moment is not None or self._has_moment:
            self._moment[:] = 0.0 if moment is None else _three(moment)
            self._has_moment = moment is not None
        requests = land, lift, stop, enabled
        if requests != self._last_requests:
            self._requests[:] = self._last_requests = requests
        if self._sample():
            at = int(np.flatnonzero(~np.isfinite(self._input[:MEASURED]))[0])
            name = f"measurement[{at}]" if at < 16 else f"moment[{at - 16}]"
            raise InputError(f"{name} = {self._input[at]}: must be a finite number without supervision")
        return self.thrusts

    @property
    def refusals(self) -> Refusals:
        """The refusals of a lift, of a landing and of following a push as of the last sample, with reasons."""
        data: PilotData = unflat(self._numbers, self._start)
        return refusals_of(data.parameters.guidance, data.memory.guidance, data.samples * self._dt)

    @property
    def memory(self) -> Array:
        """The changing numbers: the count of samples taken so far, then those of the pilot's memory."""
        return self._numbers[: 1 + leaves(self._start.memory)].copy()

    def reset(self) -> None:
        """Start anew at t = 0."""
        self._numbers[:] = flat(self._start)


def _three(moment: Any) -> Array:
    """A caller's moment as an array."""
    with suppress(TypeError, ValueError):
        numbers = np.asarray(moment, dtype=float)
        if numbers.shape == (3,):
            return numbers
    raise InputError(f"moment = {shown(moment)}: must be 3 numbers [N m], about the axes of the body")
