"""The tables of a mission: what each key is, in which unit, and what it may be.

Every table is strict: unknown keys, wrong types and non-finite numbers are refused. A leaf that is given per axis
takes one number for all axes or one number each. The built-in missions in `data/missions` hold the numbers.
"""

from tandemlift.core.settings.admittance import AdmittanceTable
from tandemlift.core.settings.corridor import CorridorTable, WallTable, wall_tables
from tandemlift.core.settings.guided import ComplianceTable, DetectionTable, ObserverTable
from tandemlift.core.settings.key_description import KeyDescription, description_of, key
from tandemlift.core.settings.mission import ChangeTable, Mission, MissionTable
from tandemlift.core.settings.parts import Drag, Payload, Quadrotor, VehicleTable
from tandemlift.core.settings.person import PersonTable
from tandemlift.core.settings.pilot import ControllerTable, PhasesTable
from tandemlift.core.settings.sensors import AdditionalSensorTable, InertialSensor, JointSensors, SensorFaultTable
from tandemlift.core.settings.supervision import SupervisionTable
from tandemlift.core.settings.value_types import (
    AtLeastOne,
    AtLeastOne6,
    Axes3,
    Exactly3,
    NonNegative,
    NonNegative3,
    NonNegative6,
    PerAxis,
    Positive,
    Positive3,
    Positive6,
    Scale,
    Table,
    Tilt,
    Triple,
)

__all__ = [
    "AdditionalSensorTable",
    "AdmittanceTable",
    "AtLeastOne",
    "AtLeastOne6",
    "Axes3",
    "ChangeTable",
    "ComplianceTable",
    "ControllerTable",
    "CorridorTable",
    "DetectionTable",
    "Drag",
    "Exactly3",
    "InertialSensor",
    "JointSensors",
    "KeyDescription",
    "Mission",
    "MissionTable",
    "NonNegative",
    "NonNegative3",
    "NonNegative6",
    "ObserverTable",
    "Payload",
    "PerAxis",
    "PersonTable",
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
    "description_of",
    "key",
    "wall_tables",
]
