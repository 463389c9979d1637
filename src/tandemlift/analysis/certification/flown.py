"""The limit of a parameter as flights show it, without a linear model: values near the predicted limit are flown.

Each flight hovers calmly with the rotors and the parameter as they are, is pushed once, weakly, and flies on. It is
stable if all rates of turn and the climb decay from the time after the push to the end.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.claims import Claim, FlownLimit, Tier
from tandemlift.analysis.certification.parameters import ARM, parameter, with_keys
from tandemlift.analysis.linearization.loop_margins import UNROUNDED, calm_mission
from tandemlift.core.errors import InputError
from tandemlift.core.phases import FAILURES
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.missions import HoverFacts, Mission, PersonTable, check, format_toml, merge, tables_of
from tandemlift.simulation.fly import fly_many

START, END, SCAN, SEARCH = 0.5, 1.6, 16, 12  # factors of the predicted limit; flights that look for the limit
PUSH, SIGMA = 0.25, 0.1  # N along each axis at the nominal mass, s of its Gaussian: below the thresholds of a push
SETTLING, WINDOW, SPACING = 4.0, 8.0, 8.0  # s after the push; of each window; between their beginnings
REST_RATIO = 0.005  # of the largest motion: below it, motion is over
DECAY = 0.8  # of the motion before: what is left of it at the end does not decay, also in a limit cycle
PULL = 0.02  # N along x and y, by which an arm begins to pull
MOTION = 0.3  # rad/s and m/s: a motion that such a push or pull does not cause by itself
THRESHOLD = 1e-4  # N: the threshold of a push while an arm holds the vehicle, which hides small oscillations else
INTERVAL = 0.005  # s
LAGS = ("lag_up", "lag_down")
ENDINGS = {*FAILURES, "landed"}  # outcomes of a hover that is lost: it lands by the alarm of its pilot only
LOST, OSCILLATES, REFUSED = "lost", "oscillation", "refused"
EXCESS = 1.05  # of a limit: the mission beside it flies beyond, where the oscillation grows


class LimitTrial(NamedTuple):
    """The flights that look for the limit of a parameter.

    Attributes:
        mission: the flight with a value of the parameter; raises InputError for a value that is not allowed.
        ended: the end of a flight's stability: "oscillation" or "lost"; "" if it is stable.
        nominal: the value in the mission.
    """

    mission: Callable[[float], Mission]
    ended: Callable[[Flight], str]
    nominal: float


def trial_of(mission: Mission, name: str) -> LimitTrial:
    """The flights that look for the limit of a parameter of a mission.

    Raises:
        InputError: no parameter has this name.
    """
    p, (hover, at) = parameter(name), hover_as_flown(mission)
    if name == ARM:
        return LimitTrial(lambda k: with_keys(hover, arm_keys(mission.person, hover, at, k)), stability_in_hand, 0.0)

    def kicked(value: float) -> Mission:
        keys = p.keys(mission, value)
        mass_scale = keys.get("plant.mass_scale", mission.plant.mass_scale)
        return with_keys(hover, kick_keys(mission.hover, at, mass_scale) | keys)

    return LimitTrial(kicked, stability, p.nominal(mission))


def flown_limit(trial: LimitTrial, predicted: float, *, threads: int | None = None) -> FlownLimit:
    """The limit of a parameter, found by flights between half the predicted value and 1.6 times it.

    They begin at the nominal value if that is nearer.

    Args:
        trial: how it is flown.
        predicted: its limit by a model, in the parameter's unit.
        threads: for the flights; by default one for each processor.
    """
    grows = predicted >= trial.nominal
    factors = np.geomspace(START, END, SCAN)
    values = np.maximum(predicted * factors, trial.nominal) if grows else np.minimum(predicted / factors, trial.nominal)
    coarse = _flown(trial, values, threads)
    bad = next((i for i, (_, ended) in enumerate(coarse) if ended), None)
    if bad is None:
        return FlownLimit(float(values[-1]), math.inf if grows else 0.0, math.nan, "")
    if bad == 0:
        return FlownLimit(trial.nominal, float(values[0]), *_end(coarse[0]))
    fine = np.geomspace(values[bad - 1], values[bad], SEARCH)[1:]
    found = [*_flown(trial, fine[:-1], threads), coarse[bad]]
    first = next(i for i, (_, ended) in enumerate(found) if ended)
    below = fine[first - 1] if first else values[bad - 1]
    return FlownLimit(float(below), float(fine[first]), *_end(found[first]))


def _end(result: tuple[Flight | None, str]) -> tuple[float, str]:
    flight, ended = result
    return (frequency_of(flight) if flight is not None and ended == OSCILLATES else math.nan), ended


def _flown(trial: LimitTrial, values: Array, threads: int | None) -> list[tuple[Flight | None, str]]:
    """A flight for each value of a parameter, and what ended its stability; "" for a stable one."""
    missions = list[Mission | None]()
    for value in values.tolist():
        try:
            missions.append(trial.mission(value))
        except InputError:
            missions.append(None)
    flights = iter(fly_many([m for m in missions if m is not None], threads=threads))
    found = [None if m is None else next(flights) for m in missions]
    return [(flight, REFUSED if flight is None else trial.ended(flight)) for flight in found]


def hover_as_flown(mission: Mission) -> tuple[Mission, float]:
    """(A calm hover of a mission with its own rotors, the time [s] at which it is calm); sensors do not round."""
    calm, at = calm_mission(mission)
    own, t = tables_of(mission), tables_of(calm)
    if mission.actuators.model == "rotors":  # ideal ones have no limit, lag or delay
        t["actuators"] = own["actuators"]
        for q, real in zip(t["vehicle"]["quadrotors"], own["vehicle"]["quadrotors"], strict=True):
            q |= {"max_speed": real["max_speed"]} | dict.fromkeys(LAGS, 0.5 * (real["lag_up"] + real["lag_down"]))
    return check(merge(t, {"sensors": UNROUNDED}), mission.mission.name, quiet=True), at


def _times(at: float) -> dict[str, Any]:
    return {"mission.duration": at + SETTLING + SPACING + WINDOW, "mission.log_interval": INTERVAL}


def kick_keys(hover: HoverFacts, at: float, mass_scale: float) -> dict[str, Any]:
    """The changes of a hover that is calm at a time [s], by dotted key, for one weak push of a vehicle of a mass."""
    # at the first quadrotor, so that the push turns the vehicle about all axes
    place = np.add(hover.vehicle.origin, hover.vehicle.quadrotors[0].position).tolist()
    # in proportion to the mass: a lighter vehicle moved more, and its pilot, who assumes the nominal mass, felt a push
    force = PUSH * mass_scale
    pushes = [{"force": [force] * 3, "time": at + 3.0 * SIGMA, "sigma": SIGMA, "point": place}]
    return {"pushes": pushes, **_times(at)}


def arm_keys(p: PersonTable, hover: Mission, at: float, stiffness: float) -> dict[str, Any]:
    """The changes of a hover that is calm at a time [s], for a massless arm that holds its grip and pulls it aside."""
    (x, y, _), yaw, aside = hover.initial.position, hover.initial.euler[2], PULL / stiffness
    along, beside, _ = np.add(hover.hover.vehicle.origin, (0.0, p.grip, 0.0)).tolist()  # the grip, body axes
    c, s = math.cos(yaw), math.sin(yaw)
    hand = x + c * along - s * beside, y + s * along + c * beside
    place = {"point": [place + aside for place in hand], "dwell": 1e4}
    arm = {"stiffness": stiffness, "damping": p.damping, "tremor": 0.0, "max_force": 1e4}
    person = {"model": "hold", "grip": p.grip, "path": [place], "start_time": at, "delay": 0.01, **arm}
    return {"person": person, "admittance.threshold": [THRESHOLD] * 3, **_times(at)}


def motions(flight: Flight) -> Array:
    """The rates of turn [rad/s] and the climb [m/s] (T, 4) of a flight."""
    return np.column_stack([flight["rates"], flight["velocity"][:, 2]])


def sizes_of_motion(flight: Flight) -> tuple[Array, Array, Array]:
    """Sizes (4,) of the motions: root mean squares about the mean after the push, and at the end; the largest value."""
    motion, end = motions(flight), flight.time[-1]
    first, last = (
        motion[(flight.time >= start) & (flight.time <= start + WINDOW)].std(axis=0)
        for start in (end - SPACING - WINDOW, end - WINDOW)
    )
    return first, last, np.abs(motion[flight.time >= end - SPACING - WINDOW - SETTLING]).max(axis=0)


def stability(flight: Flight) -> str:
    """The end of the stability of a kicked flight: "oscillation" or "lost"; "" if it is stable."""
    if flight.outcome in ENDINGS or flight.failure:
        return LOST
    first, last, most = sizes_of_motion(flight)
    return OSCILLATES if np.any((last > DECAY * first) & (last > REST_RATIO * most)) or last.max() > MOTION else ""


def stability_in_hand(flight: Flight) -> str:
    """The end of stability, as of `stability`, in an arm's hand, whose limits keep an oscillation from growing on."""
    if flight.outcome in ENDINGS or flight.failure:
        return LOST
    first, last, each = sizes_of_motion(flight)
    most = each.max()
    return OSCILLATES if np.any((last > DECAY * first) & (last > REST_RATIO * most)) or most > MOTION else ""


def frequency_of(flight: Flight) -> float:
    """The frequency [rad/s] of the largest motion of the last window, by its crossings of its mean."""
    motion = motions(flight)[flight.time >= flight.time[-1] - WINDOW]
    values = motion[:, int(np.argmax(motion.std(axis=0)))]
    values = values - values.mean()
    crossings = np.flatnonzero((values[:-1] < 0.0) != (values[1:] < 0.0))
    if len(crossings) < 3:
        return math.nan
    return float(math.pi * (len(crossings) - 1) / (INTERVAL * (crossings[-1] - crossings[0])))


def with_limits(tier: Tier, mission: Mission, fly: bool) -> Tier:
    """A tier with a mission that flies beyond each limit of a parameter, and the flown limits if asked for."""
    files, claims = dict(tier.files), list[Claim]()
    for claim in tier.claims:
        if claim.limit is not None:
            trial, name = trial_of(mission, claim.parameter), f"limits/{claim.slug}.toml"
            with suppress(InputError):  # a value beyond that no mission may have, such as a delay above 1 s
                files[name] = format_toml(tables_of(_mission_beyond(trial, claim.limit)))
            flown = flown_limit(trial, claim.limit) if fly else None
            nominal = parameter(claim.parameter).nominal(mission)
            claim = claim._replace(
                command=f"tandemlift run {name}" if name in files else "", nominal=nominal, flown=flown
            )
        claims.append(claim)
    return replace(tier, claims=tuple(claims), files=files)


def _mission_beyond(trial: LimitTrial, limit: float) -> Mission:
    """The mission that flies beyond a limit."""
    return trial.mission(limit * EXCESS if limit >= trial.nominal else limit / EXCESS)
