"""The tables of a mission: what each key is, in which unit, and what it may be.

Every table is strict: unknown keys, wrong types and non-finite numbers are refused. A leaf that is given per axis
takes one number for all axes or one number each. The built-in missions in `data/missions` hold the numbers.
"""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import AfterValidator, Field, SerializeAsAny

from tandemlift.settings.changes import ChangeTable
from tandemlift.settings.corridor import CorridorTable, WallTable, wall_tables
from tandemlift.settings.guided import ComplianceTable, DetectionTable, ObserverTable
from tandemlift.settings.leaves import (
    AtLeastOne,
    AtLeastOne6,
    Axes,
    Axes3,
    Exactly3,
    NonNegative,
    NonNegative3,
    NonNegative6,
    Positive,
    Positive3,
    Positive6,
    Scale,
    Table,
    Tilt,
    Triple,
    divisor,
    must,
)
from tandemlift.settings.partner import PartnerTable
from tandemlift.settings.parts import Drag, Payload, Quadrotor, VehicleTable
from tandemlift.settings.pilot import (
    AdmittanceTable,
    AllocationTable,
    ControllerTable,
    Estimator,
    PhasesTable,
    PilotTable,
)
from tandemlift.settings.supervision import RequestTable, SensorFaultTable, SupervisionTable
from tandemlift.settings.world import (
    Actuators,
    Disturbance,
    Fault,
    Ground,
    InertialSensor,
    Initial,
    Plant,
    PushTable,
    Sensors,
    WindTable,
)

__all__ = [
    "AdmittanceTable",
    "AtLeastOne",
    "AtLeastOne6",
    "Axes",
    "Axes3",
    "ChangeTable",
    "ComplianceTable",
    "ControllerTable",
    "CorridorTable",
    "DetectionTable",
    "Drag",
    "Exactly3",
    "InertialSensor",
    "Mission",
    "MissionTable",
    "NonNegative",
    "NonNegative3",
    "NonNegative6",
    "PartnerTable",
    "Payload",
    "PhasesTable",
    "Positive",
    "Positive3",
    "Positive6",
    "Quadrotor",
    "Scale",
    "SensorFaultTable",
    "SupervisionTable",
    "Table",
    "Tilt",
    "Triple",
    "VehicleTable",
    "WallTable",
    "wall_tables",
]


def _name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}", name):
        raise must("name", "be 1 to 64 letters, digits, '.', '_' or '-', the first a letter or a digit")
    return name


class MissionTable(Table):
    """`[mission]`: name, duration and times of the run."""

    name: Annotated[str, AfterValidator(_name)]
    duration: Positive  # s, rounded to whole steps
    step: Annotated[float, Field(gt=0.0, le=0.02), AfterValidator(divisor)] = 0.001  # s, of the pilot and of the body
    log_interval: Positive = 0.01  # s, rounded to whole steps
    seed: Annotated[int, Field(ge=0, le=10**18)] = 0

    @property
    def steps(self) -> int:
        """Number of steps of the run, at least one."""
        return max(1, round(self.duration / self.step))

    @property
    def log_every(self) -> int:
        """Steps from one logged sample to the next, at least one and at most one more than there are."""
        return max(1, round(min(self.log_interval / self.step, self.steps + 1)))


class Mission(Table):
    """Everything that a flight depends on; see `tandemlift.missions` for loading one."""

    mission: MissionTable
    vehicle: VehicleTable
    controller: SerializeAsAny[ControllerTable]
    admittance: AdmittanceTable
    allocation: AllocationTable = AllocationTable()
    initial: Initial = Initial()
    phases: PhasesTable = PhasesTable()
    pushes: tuple[PushTable, ...] = ()
    disturbance: Disturbance = Disturbance()
    plant: Plant = Plant()
    pilot: PilotTable = PilotTable()
    estimator: Estimator = Estimator()
    compliance: ComplianceTable = ComplianceTable()
    observer: ObserverTable = ObserverTable()
    supervision: SupervisionTable = SupervisionTable()
    requests: tuple[RequestTable, ...] = ()
    detection: DetectionTable = DetectionTable()
    actuators: Actuators = Actuators()
    faults: tuple[Fault, ...] = ()
    sensors: Sensors = Sensors()
    sensor_faults: tuple[SensorFaultTable, ...] = ()
    wind: WindTable = WindTable()
    ground: Ground = Ground()
    walls: tuple[WallTable, ...] = ()
    corridor: CorridorTable = CorridorTable()
    partner: PartnerTable = PartnerTable()
    changes: tuple[ChangeTable, ...] = ()

    @property
    def all_walls(self) -> tuple[WallTable, ...]:
        """Every wall that there is: those of `walls`, then the corridor's."""
        return (*self.walls, *self.corridor.walls)
