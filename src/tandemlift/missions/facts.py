"""What the functions of a flight's parts read of a mission, by the names of their arguments.

A fact is a table of the mission, or another of its attributes, or what one of the functions below makes of other facts:
such as the `step` in the table `[mission]`. A function that asks for facts has what it
needs in its signature, and is called without a mission in tests.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import reduce
from typing import Any

from tandemlift.core.part import Part
from tandemlift.core.vector import Absent
from tandemlift.missions.keys.acting import holds
from tandemlift.missions.mission import PARTS, Mission, MissionTable
from tandemlift.parts.controllers import ControllerTable
from tandemlift.parts.controllers.interface import tilt_limit_of
from tandemlift.parts.guidance.compliance_table import ComplianceTable
from tandemlift.parts.guidance.guidance import PilotTable
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import AllocationTable, Mixer, mixer_of
from tandemlift.parts.rotors.rotors import ActuatorsTable


def step(mission: MissionTable) -> float:
    """Sampling time of the pilot [s]."""
    return mission.step


def end(mission: MissionTable) -> float:
    """Duration of the flight [s]."""
    return mission.duration


def guidance(pilot: PilotTable) -> str:
    """`pilot.guidance`."""
    return pilot.guidance


def method(allocation: AllocationTable) -> str:
    """`allocation.method`."""
    return allocation.method


def vehicle(nominal: Vehicle) -> Vehicle:
    """The nominal vehicle."""
    return nominal


def effect(vehicle: Vehicle) -> Mixer:
    """The wrench that the thrusts of its rotors make."""
    return mixer_of(vehicle)


def hovers(actuators: ActuatorsTable) -> bool:
    """Whether the rotors have their hover speed at the start."""
    return actuators.start == "hover"


def max_tilt(controller: ControllerTable, compliance: ComplianceTable) -> float:
    """The largest tilt [rad] that the controller commands, or the guidance."""
    return tilt_limit_of(controller) or compliance.max_tilt


MADE = {made.__name__: made for made in (step, end, guidance, method, vehicle, effect, hovers, max_tilt)}


class Facts(dict[str, Any]):
    """The facts of a mission by name, each made once, when it is first read."""

    def __init__(self, mission: Mission) -> None:
        super().__init__()
        self.of = mission

    def __missing__(self, name: str) -> Any:
        self[name] = made = self.call(MADE[name]) if name in MADE else getattr(self.of, name)
        return made

    def call(self, function: Callable[..., Any], own: Mapping[str, Any] | None = None) -> Any:
        """A function of facts; `own`: other arguments by name."""
        code = function.__code__
        names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
        return function(**{name: own[name] if own and name in own else self[name] for name in names})

    def ask(self, part: Part, function: Callable[..., Any], **own: Any) -> Any:
        """A function that a part declares."""
        return self.call(function, {"table": reduce(getattr, part.key.split("."), self.of), **own})

    def acting(self) -> Iterator[Part]:
        """The parts that the mission has."""
        return (part for part in PARTS if not part.acts or holds(self.of, part.acts))

    def started(self, within: str) -> tuple[dict[str, Any], dict[str, Any]]:
        """Parameters and memory of the parts within something before the first sample, by name; of others `Absent`."""
        acting = set(map(id, self.acting()))
        parameters, memory = dict[str, Any](), dict[str, Any]()
        for part in PARTS:
            if part.within == within:
                begun = self.ask(part, part.start) if id(part) in acting else (Absent(), Absent())
                parameters[part.name], memory[part.name] = begun
        return parameters, memory
