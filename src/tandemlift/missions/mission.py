"""The `Mission`, which collects the tables of `parts/`; the tables `[mission]` and `[[changes]]`.

Every table is strict: unknown keys, wrong types and non-finite numbers are refused. A key that is given per axis
takes one number for all axes or one number each. The built-in missions in `data/missions` hold the numbers.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from html import escape
from typing import Annotated, Any, Literal, get_args, get_type_hints

from pydantic import AfterValidator, Field, PrivateAttr, SerializeAsAny, ValidationError, model_validator

from tandemlift.core.errors import InputError, shown
from tandemlift.core.keys import NonNegative, Positive, Table, divisor, key, must
from tandemlift.core.plugs import PluginText
from tandemlift.core.trajectories import PhasesTable
from tandemlift.missions.acting import holds
from tandemlift.missions.outcomes import CrashTable, FindingsTable, OutcomeTable, PromiseTable
from tandemlift.parts.contact.corridor import CorridorTable, WallTable, nearest_wall
from tandemlift.parts.contact.standing import GroundTable
from tandemlift.parts.controllers import ControllerTable
from tandemlift.parts.estimation.contact_detection import CONTACT, ContactTable
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.estimation.push_confirmation import CONFIRMATION
from tandemlift.parts.flight_checks.loop_checks import ControlLoop, push_feedback, reading_delays
from tandemlift.parts.guidance.above_ground import CLEARANCE
from tandemlift.parts.guidance.admittance import AdmittanceTable, with_feel
from tandemlift.parts.guidance.compliance import ComplianceTable
from tandemlift.parts.guidance.contact_hold import CONTACT_HOLD
from tandemlift.parts.guidance.disturbance_observer import OBSERVER, ObserverTable
from tandemlift.parts.guidance.energy_tank import TANK
from tandemlift.parts.guidance.following import FOLLOWING
from tandemlift.parts.guidance.guidance import PilotTable
from tandemlift.parts.guidance.policy import POLICY
from tandemlift.parts.guidance.requests import RequestTable
from tandemlift.parts.guidance.start_guidance import BY_HAND, BY_SCHEDULE
from tandemlift.parts.guidance.supervision import SUPERVISION, SupervisionTable
from tandemlift.parts.guidance.yaw_compliance import HEADING
from tandemlift.parts.mechanics.push import PushTable
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.mechanics.structure import STRUCTURE, StructureMode, is_elastic, structure_modes
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import DisturbanceTable, PlantTable, VehicleTable
from tandemlift.parts.mechanics.wind import WIND, WindTable
from tandemlift.parts.person.person_table import PERSON, PersonTable
from tandemlift.parts.pilot.excitation import EXCITATION, ExcitationTable
from tandemlift.parts.pilot.rotor_lead import LEAD
from tandemlift.parts.rotor_loss.detection import DETECTION, DetectionTable
from tandemlift.parts.rotors.allocation import AllocationTable
from tandemlift.parts.rotors.hover import HoverFacts
from tandemlift.parts.rotors.notch import NOTCHES
from tandemlift.parts.rotors.rotor_faults import FaultTable
from tandemlift.parts.rotors.rotors import ActuatorsTable
from tandemlift.parts.sensors.sensors_table import SensorFaultTable, SensorsTable
from tandemlift.parts.sensors.vehicle_sensors import ADDITIONAL


def _name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}", name):
        raise must("name", "be 1 to 64 letters, digits, '.', '_' or '-', the first a letter or a digit")
    return name


class MissionTable(Table):
    """`[mission]`: name, duration and sampling of the flight."""

    name: Annotated[str, AfterValidator(_name)] = key(
        ...,
        None,
        "name of the flight; results are written to out/NAME",
        rule="1 to 64 letters, digits, '.', '_' or '-', the first a letter or a digit",
        example="my-mission",
    )
    duration: Positive = key(
        ..., "s", "duration of the flight, rounded to whole steps", rule="at most 1e9 steps", example=30.0
    )
    step: Annotated[float, Field(gt=0.0, le=0.02), AfterValidator(divisor)] = key(
        0.001,
        "s",
        "sampling time of the pilot, and time step of the simulated body",
        rule="at most the duration",
        source="chosen: 1 kHz",
    )
    log_interval: Positive = key(
        0.01,
        "s",
        "time between logged samples, rounded to whole steps; metrics are computed from every step regardless",
        rule="the log must not exceed 4 GB",
        source="chosen: 100 Hz",
    )
    seed: Annotated[int, Field(ge=0, le=10**18)] = key(0, "1", "seed of every random number of the flight")
    fma: bool = key(
        True,
        None,
        "whether a·b + c is rounded once, which is fastest; false gives the same bits on every machine, as in C",
    )
    precision: Literal["double", "single"] = key(
        "double",
        None,
        "precision of the numbers in flight",
        choices={"double": "64 bits, everywhere", "single": "32 bits, 16 flights at once, in blocks and studies"},
    )

    @property
    def steps(self) -> int:
        """Number of steps of the run, at least one."""
        return max(1, round(self.duration / self.step))

    @property
    def log_every(self) -> int:
        """Steps from one logged sample to the next, at least one and at most one more than the flight has."""
        return max(1, round(min(self.log_interval / self.step, self.steps + 1)))


describe_key = key  # `[[changes]]` has a key of that name


def _hashable(value: Any) -> Any:
    """A value whose lists are tuples."""
    return tuple(map(_hashable, value)) if isinstance(value, list) else value


class ChangeTable(Table):
    """`[[changes]]`: a key that takes another value in flight; one table for each change, in the order of their times.

    Numbers (gains, admittance, wind, lags, noise, an efficiency) change linearly within `duration`. A choice, such as
    `admittance.gate` or the controller, switches from one step to the next; a new controller starts with an initial
    memory. A change that needs another layout of any other memory is refused: another `wind.model`, a delay, another
    body or other channels. A flight with changes is flown step by step, at about 20 µs a step.
    """

    time: NonNegative = describe_key(
        ..., "s", "start of the change, rounded to a whole step", rule="not before the change above it", example=10.0
    )
    key: str = describe_key(..., None, "dotted key that changes, as for --set", example="admittance.damping")
    value: Annotated[Any, AfterValidator(_hashable)] = describe_key(
        ..., None, "new value of the key", rule="as the key takes it", example=[4.0, 4.0, 4.0]
    )
    duration: NonNegative = describe_key(0.0, "s", "time within which numbers change linearly to the new value")


@cache
def _width(channels: type) -> int:
    """How many numbers channels have, without the groups in them."""
    return sum(len(getattr(kind, "_fields", "1")) for kind in get_type_hints(channels).values() if not get_args(kind))


class Mission(Table):
    """All data that a flight depends on; see `tandemlift.missions` for loading one.

    `plugins`, before its tables, bring parts that it names, or metrics and figures.
    """

    _plugins: tuple[PluginText, ...] = PrivateAttr(())
    mission: MissionTable
    vehicle: VehicleTable
    controller: SerializeAsAny[ControllerTable]
    admittance: AdmittanceTable
    allocation: AllocationTable = AllocationTable()
    initial: InitialTable = InitialTable()
    phases: PhasesTable = PhasesTable()
    pushes: tuple[PushTable, ...] = ()
    disturbance: DisturbanceTable = DisturbanceTable()
    plant: PlantTable = PlantTable()
    pilot: PilotTable = PilotTable()
    estimator: EstimatorTable = EstimatorTable()
    compliance: ComplianceTable = ComplianceTable()
    observer: ObserverTable = ObserverTable()
    supervision: SupervisionTable = SupervisionTable()
    contact: ContactTable = ContactTable()
    requests: tuple[RequestTable, ...] = ()
    excitation: ExcitationTable = ExcitationTable()
    detection: DetectionTable = DetectionTable()
    actuators: ActuatorsTable = ActuatorsTable()
    faults: tuple[FaultTable, ...] = ()
    sensors: SensorsTable = SensorsTable()
    sensor_faults: tuple[SensorFaultTable, ...] = ()
    wind: WindTable = WindTable()
    ground: GroundTable = GroundTable()
    walls: tuple[WallTable, ...] = ()
    corridor: CorridorTable = CorridorTable()
    person: PersonTable = PersonTable()
    changes: tuple[ChangeTable, ...] = ()
    crash: CrashTable = CrashTable()
    outcome: OutcomeTable = OutcomeTable()
    promise: PromiseTable = PromiseTable()
    findings: FindingsTable = FindingsTable()

    @model_validator(mode="before")
    @classmethod
    def _by_feel(cls, data: Any) -> Any:
        return with_feel(data) if isinstance(data, dict) else data

    @property
    def plugins(self) -> tuple[PluginText, ...]:
        """Its plugins."""
        return self._plugins

    def with_plugins(self, plugins: Iterable[PluginText]) -> Mission:
        """It with more plugins."""
        made, listed = self.model_copy(), dict.fromkeys((*self._plugins, *plugins))
        made._plugins = tuple(listed)
        return made

    @property
    def all_walls(self) -> tuple[WallTable, ...]:
        """All walls: those of `walls`, then the corridor's."""
        return (*self.walls, *self.corridor.walls)

    def wall_at(self, place: Sequence[float]) -> str:
        """The name of the wall nearest to a place [m]."""
        number = nearest_wall(self.all_walls, place)
        return f"walls.{number}" if number < len(self.walls) else "a wall of the corridor"

    @property
    def changes_in_flight(self) -> bool:
        """Whether parameters, or the virtual hand of a recording, change in flight."""
        return bool(self.changes or self.person.recording)

    @property
    def by_hand(self) -> ComplianceTable | None:
        """The limits of interactive guidance; None with scheduled guidance."""
        return self.compliance if self.pilot.guidance == "interactive" else None

    @property
    def nominal(self) -> Vehicle:
        """The vehicle that the pilot assumes."""
        return Vehicle.from_settings(self.vehicle)

    @property
    def hover(self) -> HoverFacts:
        """The vehicle in hover, with all faults of rotors that the flight has."""
        faults = tuple(f for f in self.faults if f.time < self.mission.duration)
        return HoverFacts(self.nominal, self.plant, self.actuators, self.allocation, faults)

    @property
    def control_loop(self) -> ControlLoop:
        """The control loop about hover."""
        step, hover = self.mission.step, self.hover
        readings = reading_delays(self.sensors, self.pilot.state, step)
        push = push_feedback(self.pilot, self.compliance, self.estimator, hover, self.disturbance)
        return ControlLoop(hover, self.controller, self.observer, readings, push, step)

    @property
    def is_elastic(self) -> bool:
        """Whether the beam bends or a mount gives."""
        return is_elastic(self.nominal)

    @property
    def structure_modes(self) -> tuple[StructureMode, ...]:
        """The modes of the structure that are flown, the slowest first; none of a rigid vehicle."""
        return structure_modes(self.nominal, self.mission.step)

    @property
    def sample_size(self) -> int:
        """Size of a logged sample [bytes]: 8 for its time and for each number of its channels."""
        count, more = len(self.vehicle.quadrotors), self.sensors.additional
        numbers = {
            "time, state, reference, admittance, push, wrench; rotors and joints": 51 + 10 * count,
            "commands of real rotors": (5 + 4 * count) * (self.actuators.model == "rotors"),
            "deflection of elastic vehicles": 6 * count * self.is_elastic,
            "force of floor and walls": 3 * (self.ground.model == "floor"),
            "readings and estimates": (45 + 6 * count) * (self.sensors.model == "simulated"),
            "additional sensors": sum(ADDITIONAL[s.name].width for s in more if s.name in ADDITIONAL),
        }
        return 8 * (
            sum(numbers.values()) + sum(_width(p.channels) for p in PARTS if p.channels and holds(self, p.acts))
        )

    def _repr_html_(self) -> str:
        """HTML for a notebook: the main choices of the mission."""
        payload, quadrotors = self.vehicle.payload, self.vehicle.quadrotors
        mass = payload.mass + sum(q.mass for q in quadrotors)
        rows = {
            "mission": f"{self.mission.name}, {self.mission.duration:g} s in steps of {1e3 * self.mission.step:g} ms",
            "vehicle": f"{len(quadrotors)} quadrotors on a payload of {payload.mass:g} kg; {mass:g} kg in all",
            "controller": self.controller.name,
            "guidance": self.pilot.guidance,
            "rotors": f"{self.actuators.model}, {self.allocation.method}",
            "sensors": self.sensors.model,
            "pushes": f"{len(self.pushes)}; simulated person: {self.person.model}",
            "around": f"wind: {self.wind.model}; ground: {self.ground.model}; walls: {len(self.all_walls)}",
        }
        cells = (f"<tr><th style='text-align:left'>{k}</th><td>{escape(v)}</td></tr>" for k, v in rows.items())
        return f"<table>{''.join(cells)}</table>"


PARTS = [
    *(CONTACT, CONFIRMATION, OBSERVER, BY_SCHEDULE, BY_HAND, FOLLOWING, CONTACT_HOLD, SUPERVISION, EXCITATION),
    *(HEADING, TANK, POLICY, CLEARANCE, NOTCHES, LEAD, DETECTION, STRUCTURE, WIND, PERSON),
]
"""The optional parts of a flight, in the order of their checks and channels."""


def check_keys(tables: Mapping[str, Any]) -> None:
    """Reject a flown mission's nested tables that have an unknown key; keys of controllers are not checked.

    Raises:
        InputError: with the dotted key.
    """
    try:
        Mission.model_validate({name: table for name, table in tables.items() if name != "plugins"})
    except ValidationError as error:
        for problem in error.errors(include_url=False, include_input=False):
            if problem["type"] == "extra_forbidden" and problem["loc"][0] != "controller":
                key = ".".join(map(str, problem["loc"]))
                raise InputError(f"{key}: unknown key of a mission; `tandemlift explain` lists all") from None


def check_double(mission: Mission, reason: str) -> None:
    """Refuse single precision for a reason.

    Raises:
        InputError: the mission asks for it.
    """
    if mission.mission.precision == "single":
        raise InputError(f"mission.precision = 'single': must be 'double' here, because {reason}")


def with_precision(mission: Mission, precision: str | None) -> Mission:
    """A mission in the precision that a caller asks for; in its own if None.

    Raises:
        InputError: there is no such precision.
    """
    if precision is None or precision == mission.mission.precision:
        return mission
    if precision not in ("double", "single"):
        raise InputError(f"precision = {shown(precision)}: must be 'double' or 'single'")
    return mission.model_copy(update={"mission": mission.mission.model_copy(update={"precision": precision})})
