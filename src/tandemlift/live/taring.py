"""A tare of the force sensors in flight: what they read in hover, without a hand, is taken for their bias."""

from __future__ import annotations

from tandemlift.common.errors import InputError
from tandemlift.flight.channels import PHASES
from tandemlift.laws.guidance.phases import GUIDED, HOLD
from tandemlift.live.recorded import RecordedFlight

TARE = "estimator.tare_start"
NOTICE = 1.0  # s, from when a tare is asked for until it begins: for it to be made ready, and to let go


def check_hands_off(flight: RecordedFlight) -> None:
    """Refuse a hand while sensors are tared, which would take it for a bias.

    Raises:
        InputError: they are.
    """
    mission = flight.now
    start, at = mission.estimator.tare_start, flight.step * flight.dt
    if mission.pilot.push == "truth":
        return
    if mission.estimator.tare == "hover":
        if flight.number("memory", "guidance", "phase", "hovered") < mission.estimator.tare_duration:
            raise InputError("hands off until the force sensors are tared, in steady hover")
        return
    if start is None:
        return
    end = start + mission.estimator.tare_duration
    if at < end:
        raise InputError(f"hands off until {end:g} s: the force sensors are tared in hover")


def check_may_tare(flight: RecordedFlight, phase: str) -> None:
    """Refuse a tare but in hover and without a hand; `phase`: of the flight.

    Raises:
        InputError: it is no hover, somebody holds the beam, or a tare is being made.
    """
    if flight.now.estimator.tare == "clock":
        check_hands_off(flight)
    if phase not in (PHASES[int(GUIDED)], PHASES[int(HOLD)]):
        raise InputError(f"tare: only in the air, hovering; the phase is {phase}")
    if flight.hand.held or any(flight.hand.force):
        raise InputError("tare: hands off first")


def start_of_tare(flight: RecordedFlight) -> float:
    """When a tare that is asked for now may begin [s].

    Raises:
        InputError: the mission has no tare, or begins it by itself.
    """
    mission = flight.now
    if mission.pilot.push == "truth":
        raise InputError("tare: the pilot is told the true push, and reads no sensor that could be tared")
    if mission.estimator.tare == "hover":
        raise InputError("tare: the pilot tares by itself, in steady hover (estimator.tare)")
    if mission.estimator.tare_start is None:
        raise InputError(f"tare: the mission has none ({TARE})")
    return round(flight.step * flight.dt + NOTICE, 3)


def check_in_time(flight: RecordedFlight, start: float) -> None:
    """Refuse a tare whose beginning has passed while it was made ready: it would go on where the last one ended.

    Raises:
        InputError: it has.
    """
    if flight.step * flight.dt > start - 2.0 * flight.dt:
        raise InputError("tare: it took too long to make ready; ask again")
