"""The parameters that may be changed in flight with their bounds, and changes in flight.

Parameters are set and restored, rotors stopped, sensors tared. Each change is prepared beside the flight, one after the
other; the flight does not wait for it.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from tandemlift.apps.live.session import checks
from tandemlift.apps.live.session import server_messages as server
from tandemlift.apps.live.session.interactive_mission import NEVER
from tandemlift.core.errors import InputError, shown
from tandemlift.core.plugs import PLUGS
from tandemlift.missions import MISSING, Mission, Tables, built_in, place_of, tables_of, value_at
from tandemlift.missions.key_descriptions import controller_names, own_numbers
from tandemlift.simulation.recorded_flight import RecordedFlight

RAMP = 0.5  # s, within which a parameter changes to its new value
GROUP = "vehicle.quadrotors.each."  # begins the key of a parameter that all quadrotors share


class TunableParameter(NamedTuple):
    """A number or a list of numbers: its key, its label and group on the page, its unit and its bounds."""

    key: str
    label: str
    group: str
    unit: str
    low: float
    high: float


TUNABLE = (
    TunableParameter("admittance.mass", "virtual mass", "admittance", "kg", 0.3, 20.0),
    TunableParameter("admittance.damping", "damping", "admittance", "N s/m", 0.2, 30.0),
    TunableParameter("admittance.stiffness", "stiffness", "admittance", "N/m", 0.0, 20.0),
    TunableParameter(server.THRESHOLD, "threshold", "admittance", "N", 0.05, 5.0),
    TunableParameter("compliance.max_speed", "maximum speed", "admittance", "m/s", 0.1, 3.0),
    TunableParameter(server.STIFFNESS, "stiffness", "hand spring", "N/m", 1.0, 40.0),
    TunableParameter("person.damping", "damping", "hand spring", "N s/m", 0.0, 20.0),
    TunableParameter(server.MAX_FORCE, "maximum force", "hand spring", "N", 0.5, 20.0),
    TunableParameter("controller.gains.xi", "ξ", "controller", "1/s", 0.05, 20.0),
    TunableParameter("controller.gains.lambda_1", "λ₁", "controller", "1/s", 0.05, 40.0),
    TunableParameter("controller.gains.lambda_2", "λ₂", "controller", "m/s², rad/s²", 0.05, 40.0),
    TunableParameter("wind.velocity", "wind", "world", "m/s", -8.0, 8.0),
    TunableParameter("wind.turbulence", "turbulence", "world", "m/s", 1e-3, 8.0),
    TunableParameter(f"{GROUP}lag_up", "rotor lag, up", "world", "s", 0.002, 0.1),
    TunableParameter(f"{GROUP}lag_down", "rotor lag, down", "world", "s", 0.002, 0.1),
    TunableParameter("sensors.joints.force_noise", "joint force noise", "world", "N", 0.0, 1.0),
    TunableParameter("sensors.motion.position_noise", "position noise", "world", "m", 0.0, 0.05),
)
BY_KEY = {p.key: p for p in TUNABLE}
FACTOR = 10.0  # by which a number of a user's controller may be changed
CONTROLLER, GATE = "controller.name", "admittance.gate"
LABELS = {CONTROLLER: "controller", GATE: "gate"}
CHOICES = tuple(LABELS)


def keys_of(tables: Tables, key: str) -> list[str]:
    """The keys of a mission, given as tables, that a parameter's key stands for."""
    if not key.startswith(GROUP):
        return [key]
    return [f"vehicle.quadrotors.{i}.{key.removeprefix(GROUP)}" for i in range(len(tables["vehicle"]["quadrotors"]))]


def dotted_values(tables: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """The values of nested tables by their dotted keys."""
    for name, value in tables.items():
        if isinstance(value, Mapping):
            yield from dotted_values(value, f"{above}{name}.")
        else:
            yield f"{above}{name}", value


def value_of(tables: Tables, key: str) -> Any:
    """The value of a parameter in a mission's tables, or `MISSING`."""
    value = value_at(tables, place_of(key.replace(GROUP, "vehicle.quadrotors.0.")))
    return "hard" if key == GATE and value is MISSING else value


def tunables_of(first: Tables) -> dict[str, TunableParameter]:
    """The parameters by their keys; with the numbers of the first mission's controller, if it is a user's own."""
    table, own = first["controller"], dict[str, TunableParameter]()
    for key in own_numbers(table["name"]):
        name = key.name.removeprefix("controller.")
        numbers = table[name] if isinstance(table[name], list) else [table[name]]
        high, least = FACTOR * (max(map(abs, numbers)) or 1.0), min(numbers)
        low, unit = least / FACTOR if least > 0.0 else -high, key.facts.unit or ""
        low, high = max(low, key.bounds.get("ge", low)), min(high, key.bounds.get("le", high))
        own[key.name] = TunableParameter(key.name, name.replace("_", " "), "controller", unit, low, high)
    return BY_KEY | own


def bounds_of(parameter: TunableParameter, first: Tables) -> tuple[float, float]:
    """The bounds of a parameter, widened to hold the first mission's own value."""
    value = value_of(first, parameter.key)
    own = [] if value is MISSING else value if isinstance(value, list) else [value]
    return min([parameter.low, *own]), max([parameter.high, *own])


def parameters_of(tables: Tables, first: Tables) -> Iterator[server.SceneParameter]:
    """The parameters of a mission as a scene has them; `first`: tables of the mission that they can be restored to."""
    for p in tunables_of(first).values():
        value = value_of(tables, p.key)
        if value is not MISSING and _is_tunable(tables, p.key):
            low, high = bounds_of(p, first)
            shown = server.SceneParameter(
                key=p.key, label=p.label, group=p.group, unit=p.unit, value=value, min=low, max=high
            )
            restored = value_of(first, p.key)
            if restored is not MISSING:
                shown["initial"] = restored
            yield shown
    yield _choice(tables, first, CONTROLLER, "controller", controller_names())
    if tables["pilot"]["guidance"] == "scheduled":  # other pilots have a dead-band instead
        yield _choice(tables, first, GATE, "admittance", sorted(PLUGS["gate"]))


def scene_at(scene: server.FlightScene, now: Mission, first: Mission) -> server.FlightScene:
    """A scene with the present parameters, and the missions that a page may choose; `first`: as `parameters_of`."""
    hand = now.person
    return {
        **scene,
        "controller": now.controller.name,
        "threshold": list(now.admittance.threshold),
        "spring": server.SceneSpring(stiffness=hand.stiffness, damping=hand.damping, max_force=hand.max_force),
        "parameters": list(parameters_of(tables_of(now), tables_of(first))),
        "missions": [server.SceneMission(name=name, title=title) for name, title in built_in().items()],
    }


def _choice(tables: Tables, first: Tables, key: str, group: str, choices: list[str]) -> server.SceneParameter:
    label, value, initial = LABELS[key], value_of(tables, key), value_of(first, key)
    return server.SceneParameter(key=key, label=label, group=group, value=value, initial=initial, choices=choices)


def _is_tunable(tables: Tables, key: str) -> bool:
    """Whether a mission has the part of a key."""
    absent = {
        "wind": tables["wind"]["model"] == "none",
        "sensors": tables["sensors"]["model"] == "none",
        "vehicle": tables["actuators"]["model"] == "ideal",
        "compliance": tables["pilot"]["guidance"] != "interactive",
    }
    return not absent.get(key.partition(".")[0], False)


class ParameterControl:
    """Changes flights that began as one mission.

    Args:
        first: tables of the mission that parameters are restored to.
        lock: of the flight.

    Attributes:
        first: as given; other ones with another mission.
        turn: lock of who changes a flight; to be taken before that of the flight.
    """

    def __init__(self, first: Tables, lock: threading.RLock) -> None:
        self.first, self._lock = first, lock
        self.turn = threading.RLock()

    def set(self, flight: RecordedFlight, key: str, value: object) -> list[server.Answer]:
        """Set a parameter; return a message about it.

        Raises:
            InputError: there is no such parameter, or the value is out of bounds or cannot be taken in flight.
        """
        value = list(value) if isinstance(value, tuple) else value
        self._check(key, value)
        return self._set_to(flight, key, [value] * len(keys_of(self.first, key)))

    def restore(self, flight: RecordedFlight, key: str | None) -> list[server.Answer]:
        """Set a parameter, or all, back to the first mission; return messages, refusals among them."""
        answers: list[server.Answer] = []
        for one in [*CHOICES, *tunables_of(self.first)] if key is None else [key]:
            try:
                answers += self._restore(flight, one)
            except InputError as error:
                answers.append(server.RefusedMessage(type="refused", what=f"restore {one}", reason=str(error)))
        return answers

    def stop_rotor(self, flight: RecordedFlight, rotor: int) -> None:
        """Stop a rotor for good; counted over the whole vehicle, from 0.

        Raises:
            InputError: it cannot fail, or has failed already.
        """
        faults = flight.now.faults
        at = [i for i, f in enumerate(faults) if 4 * (f.quadrotor - 1) + f.rotor - 1 == rotor]
        if not at:
            raise InputError(checks.WHOLE_ROTORS.format(rotor=rotor + 1))
        if faults[at[0]].time < NEVER:
            raise InputError(checks.FAILED_ALREADY.format(rotor=rotor + 1, time=faults[at[0]].time))
        self._change(flight, f"faults.{at[0]}.time", flight.step * flight.dt, 0.0)

    def tare(self, flight: RecordedFlight) -> str:
        """Schedule a tare of the force sensors; from when to when.

        Raises:
            InputError: the mission has no tare that can be scheduled, or preparing it took too long.
        """
        with self.turn:
            start = checks.tare_start_for(flight)
            due = flight.prepare(checks.TARE, start)
            with self._lock:
                checks.check_in_time(flight, start)
                flight.change(due, checks.TARE, start)
        return f"from {start:g} s to {start + flight.now.estimator.tare_duration:g} s"

    def _check(self, key: str, value: object) -> None:
        """Refuse an unknown key, or a value out of bounds."""
        if key in CHOICES:
            return
        if key not in (known := tunables_of(self.first)):
            raise InputError(checks.UNKNOWN.format(key=key, known=", ".join([*CHOICES, *known])))
        low, high = bounds_of(known[key], self.first)
        for number in value if isinstance(value, list) else [value]:
            if isinstance(number, bool) or not isinstance(number, (int, float)):
                raise InputError(checks.NO_NUMBER.format(key=key, value=shown(value)))
            if not low <= number <= high:
                raise InputError(checks.OUT_OF_BOUNDS.format(key=key, value=shown(value), low=low, high=high))

    def _restore(self, flight: RecordedFlight, key: str) -> list[server.Answer]:
        now, keys = tables_of(flight.now), keys_of(self.first, key)
        values = [value_of(self.first, one) for one in keys]
        if MISSING in values or values == [value_of(now, one) for one in keys]:
            return []
        return self._set_to(flight, key, values)

    def _set_to(self, flight: RecordedFlight, key: str, values: list[Any]) -> list[server.Answer]:
        """Set the keys that a parameter stands for, one value each."""
        duration = 0.0 if key in CHOICES else RAMP
        for one, value in zip(keys_of(self.first, key), values, strict=True):
            self._change(flight, one, value, duration)
        now = value_of(tables_of(flight.now), key)
        return [server.ChangedMessage(type="changed", key=key, value=now, duration=duration)]

    def _change(self, flight: RecordedFlight, key: str, value: object, duration: float) -> None:
        """Prepare a change beside the flight, and let it begin."""
        with self.turn:
            if flight.over:
                raise InputError(checks.OVER.format(key=key))
            if key == CONTROLLER and value == self.first["controller"]["name"]:  # with the mission's own settings
                key, value = "controller", self.first["controller"]
            due = flight.prepare(key, value, duration)
            with self._lock:
                flight.change(due, key, value, duration)
            flight.optimise()
