"""What the functions of a flight's parts read of a mission, by the names of their arguments.

A fact is a table of the mission or another of its attributes, or what `MADE` makes of other facts. So a function has
what it needs in its signature, and tests call it without a mission.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from inspect import unwrap
from types import MappingProxyType
from typing import Any

from tandemlift.core.algebra import minimum
from tandemlift.core.part import Part
from tandemlift.core.types import Number
from tandemlift.core.vector import Absent
from tandemlift.missions.acting import holds
from tandemlift.missions.mission import PARTS, Mission
from tandemlift.parts.controllers.interface import tilt_limit_of
from tandemlift.parts.guidance.compliance import push_filters
from tandemlift.parts.guidance.start_guidance import phase_settings
from tandemlift.parts.mechanics.push import SUPPORT
from tandemlift.parts.rotors.allocation import mixer_of
from tandemlift.parts.rotors.rotor_faults import known_faults
from tandemlift.parts.sensors.sensors_table import steps_of


def _least_tilt(controller: Number | None, guidance: Number) -> Number:
    return guidance if controller is None else minimum(guidance, controller)


MADE: Mapping[str, Callable[..., Any]] = {
    "step": lambda mission: mission.step,  # s: sampling time of the pilot
    "end": lambda mission: mission.duration,  # s
    "vehicle": lambda nominal: nominal,  # as the pilot assumes it
    "weight": lambda nominal: nominal.weight,  # N
    "effect": lambda nominal: mixer_of(nominal),  # the wrench of its rotors' thrusts
    "known": lambda faults, nominal: known_faults(faults, nominal),  # the rotor faults that the pilot knows of
    "hovers": lambda actuators: actuators.start == "hover",  # whether the rotors do so from the start
    "guidance": lambda pilot: pilot.guidance,
    "interactive": lambda guidance: guidance == "interactive",
    "supervised": lambda supervision: supervision.model == "on",
    "push": lambda pilot: pilot.push,
    "joints": lambda estimator: estimator.wrench in ("joints", "fused"),  # whether joint sensors measure the push
    "interval": lambda sensors, step: step * steps_of(sensors.interval, step),  # s: sampling time of the estimators
    "notches": lambda allocation: allocation.notches,
    "method": lambda allocation: allocation.method,
    "limited": lambda method: method == "constrained",  # whether the allocation knows what the rotors can give
    "threshold": lambda admittance: admittance.threshold,  # N
    "moment_threshold": lambda compliance: compliance.yaw.threshold,  # N m
    "max_lead_angle": lambda compliance: compliance.yaw.max_lead_angle,  # rad
    "max_tilt": lambda controller, compliance: tilt_limit_of(controller) or compliance.max_tilt,  # rad
    "guidance_tilt": lambda controller, compliance: _least_tilt(tilt_limit_of(controller), compliance.max_tilt),  # rad
    "push_filters": push_filters,
    "phase_settings": phase_settings,
}


class Facts(dict[str, Any]):
    """The facts of a mission by name, each made once, when it is first read.

    Args:
        mission: which they are of; `scene` is its view for an engine.
        more: what makes further facts, as `MADE` does.
    """

    def __init__(self, mission: Mission, more: Mapping[str, Callable[..., Any]] = MappingProxyType({})) -> None:
        super().__init__(scene=mission)
        self.of, self._made = mission, {**MADE, **more}

    def __missing__(self, name: str) -> Any:
        if name == "started":  # not kept: a circle would outlive the numbers that are traced
            return self.started
        self[name] = made = self.call(self._made[name]) if name in self._made else getattr(self.of, name)
        return made

    def call(self, function: Callable[..., Any], own: Mapping[str, Any] | None = None) -> Any:
        """A function of facts; `own`: other arguments by name."""
        code = unwrap(function).__code__  # of a cached function, which has its arguments by place
        names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
        given = [own[name] if own and name in own else self[name] for name in names]
        by_name = dict(zip(names[code.co_argcount :], given[code.co_argcount :], strict=True))
        return function(*given[: code.co_argcount], **by_name)

    def ask(self, part: Part, function: Callable[..., Any], **own: Any) -> Any:
        """A function that a part declares."""
        return self.call(function, {"table": reduce(getattr, part.key.split("."), self.of), **own})

    def has(self, part: Part) -> bool:
        """Whether the mission has a part."""
        return all(holds(self.of, condition) for condition in part.acts.split(" and ") if condition)

    def started(self, within: str) -> tuple[dict[str, Any], dict[str, Any]]:
        """Parameters and memory of the parts within something before the first sample, by name; of others `Absent`."""
        parameters, memory = dict[str, Any](), dict[str, Any]()
        for part in PARTS:
            if part.within == within and ((has := self.has(part)) or part.name not in parameters):
                begun: Any = self.ask(part, part.start) if has else Absent()
                k, m = begun if has and part.remembers else (begun, Absent())
                parameters[part.name] = k
                memory |= {part.name: m} if part.remembers else {}
        return parameters, memory


RESTLESS = tuple(part.key for part in PARTS if part.begins or not part.calm)
"""The tables of the parts with which a vehicle does not rest in hover, or not to the end."""


def calm_time(mission: Mission) -> float:
    """The default time [s] of a flight that is tared: the end of the first calm after the lift.

    This is before the first push, fault, excitation or landing and before a person begins; else the mission's end.
    """
    phases, facts = mission.phases, Facts(mission)
    ends = [push.time - SUPPORT * push.sigma for push in mission.pushes] + [fault.time for fault in mission.faults]
    ends += [] if phases.land_start is None else [phases.land_start]
    ends += [facts.ask(part, part.begins) for part in PARTS if part.begins and facts.has(part)]
    hovers = phases.lift_start + phases.lift_duration
    return max(min([facts["end"], *(calm for calm in ends if calm > hovers)]), 0.0)
