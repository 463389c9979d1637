"""The flight under the quadrotors: in real time beside the live page, or a step at a time for scripts and tests."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tandemlift import InputError, Mission, Simulation
from tandemlift.apps.clients.quadrotors import Control, Quadrotors
from tandemlift.apps.clients.setpoints import EstimateError
from tandemlift.apps.live.session.frames import channel_columns
from tandemlift.apps.live.session.session import Session

# settings of a mission whose own pilot, which decides nothing, needs no sensors, no tare and no hands off
PILOT_ASIDE = ("pilot.push=truth", "pilot.state=truth", "contact.model=none")
BODY = ("position", "velocity", "attitude", "rates")  # channels of a state (13,)
MAX_START_HEIGHT = 0.02  # m, of the feet above the floor at the start
BEFORE_THRUSTS, AFTER_OVERRIDE = 6, 4  # numbers of a `CallerInput`: force and point; a velocity and whether it counts


def quadrotors_of(mission: Mission, control: Control = "shared", errors: Sequence[EstimateError] = ()) -> Quadrotors:
    """The quadrotors of a mission's vehicle."""
    hover = mission.hover
    return Quadrotors(hover.vehicle, hover.response_time, mission.mission.step, control, errors)


def check_stands(mission: Mission) -> None:
    """Check that the vehicle stands on a floor: rotors stand until a client arms them.

    Raises:
        InputError: it would fall.
    """
    given, feet = mission.ground, mission.initial.position[2] + float(mission.hover.vehicle.soles[..., 2].min())
    if given.model != "floor":
        wrong = f'ground.model = "{given.model}": must be "floor"'
    elif given.height is not None and feet > given.height + MAX_START_HEIGHT:
        wrong = f"ground.height = {given.height}: must be unset, or at the feet"
    else:
        return
    raise InputError(f"{mission.mission.name}: {wrong}, as the vehicle stands until a client arms its rotors")


class SteppedFlight:
    """A flight without a clock: who calls `step` keeps the time.

    Args:
        mission: without its pushes and its landing, which are left out.
        quadrotors: those of the mission.

    Attributes:
        simulation: the flight.
    """

    def __init__(self, mission: Mission, quadrotors: Quadrotors) -> None:
        self.simulation, self._quadrotors = Simulation(mission), quadrotors

    def step(self, steps: int = 1) -> None:
        """Take steps, at most to the end of the flight."""
        flight = self.simulation
        for _ in range(steps):
            if flight.over:
                return
            flight.step(thrusts=self._quadrotors.update(flight.time, flight.state))


class RealTimeFlight:
    """A flight in real time, of which pages show and push the vehicle.

    Args:
        mission: what is flown; its pushes and its person are left out.
        quadrotors: those of the mission.
        engine: name of the body's engine.
        out: folder of the session's files.

    Attributes:
        session: for `apps.live.server`; prepared.

    Raises:
        InputError: the vehicle does not stand on a floor.
    """

    def __init__(self, mission: Mission, quadrotors: Quadrotors, engine: str, out: Path) -> None:
        check_stands(mission)
        self._quadrotors, self._thrusts = quadrotors, slice(BEFORE_THRUSTS, BEFORE_THRUSTS + 4 * quadrotors.count)
        self._inputs = np.zeros(self._thrusts.stop + 1 + AFTER_OVERRIDE)
        self._inputs[self._thrusts.stop] = 1.0  # the thrusts count
        self.session = Session(mission, engine, out, self._commanded)
        self.session.prepare()
        self._places = channel_columns(self.session.flight.layout, None)
        self._state = np.concatenate([self._places[name] for name in BODY])

    def _commanded(self, flight: Any) -> np.ndarray:
        """The inputs of the step that comes."""
        state = flight.sample[self._state].tolist()
        self._inputs[self._thrusts] = self._quadrotors.update(flight.step * flight.dt, state)
        return self._inputs

    def channels(self) -> Iterator[tuple[str, str, Callable[[], float]]]:
        """All columns of the record: channel, name of the column, and its last value."""
        for channel, places in self._places.items():
            names = ["value"] if len(places) == 1 else "xyz" if len(places) == 3 else range(1, len(places) + 1)
            for name, place in zip(names, places.tolist(), strict=True):
                yield channel, str(name), self._reader(place)

    def _reader(self, place: int) -> Callable[[], float]:
        return lambda: float(self.session.flight.sample[place])
