"""The flight under the quadrotors: in real time beside the live page, or a step at a time for scripts and tests."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tandemlift import Mission, Simulation, Vehicle
from tandemlift.apps.clients.quadrotors import CRAZYFLIE, Control, FailSafe, Quadrotors
from tandemlift.apps.clients.setpoints import EstimateError
from tandemlift.apps.live.session.frames import channel_columns
from tandemlift.apps.live.session.session import Session

BODY = ("position", "velocity", "attitude", "rates")  # channels of a state (13,)
BEFORE_THRUSTS, AFTER_OVERRIDE = 6, 4  # numbers of a `CallerInput`: force and point; a velocity and whether it counts


def rotor_lag(mission: Mission) -> float:
    """The time after which rotors follow a command [s]: delay and the slower lag; 0 for ideal ones."""
    if mission.actuators.model == "ideal":
        return 0.0
    return mission.actuators.delay + max(max(q.lag_up, q.lag_down) for q in mission.vehicle.quadrotors)


def quadrotors_of(
    mission: Mission,
    control: Control = "shared",
    fail_safe: FailSafe = CRAZYFLIE,
    errors: Sequence[EstimateError] = (),
) -> Quadrotors:
    """The quadrotors of a mission's vehicle."""
    vehicle = Vehicle.from_settings(mission.vehicle)
    return Quadrotors(vehicle, rotor_lag(mission), mission.mission.step, control, fail_safe, errors)


class SteppedFlight:
    """A flight without a clock: who calls `step` keeps the time.

    Args:
        mission: without its pushes and its landing, which are left out.
        quadrotors: those of the mission.
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


def real_time_session(mission: Mission, quadrotors: Quadrotors, engine: str, out: Path) -> Session:
    """The session of a flight in real time, of which pages show and push the vehicle."""
    thrusts = slice(BEFORE_THRUSTS, BEFORE_THRUSTS + 4 * quadrotors.count)
    inputs = np.zeros(thrusts.stop + 1 + AFTER_OVERRIDE)
    inputs[thrusts.stop] = 1.0  # the thrusts count
    columns: Any = None

    def commanded(flight: Any) -> np.ndarray:
        nonlocal columns
        if columns is None:
            places = channel_columns(flight.layout)
            columns = np.concatenate([places[name] for name in BODY])
        inputs[thrusts] = quadrotors.update(flight.step * flight.dt, flight.sample[columns].tolist())
        return inputs

    return Session(mission, engine, out, commanded)
