"""The tables of a mission: what each key is, in which unit, and what it may be.

Every table is strict: unknown keys, wrong types and non-finite numbers are refused. A leaf that is given per axis
takes one number for all axes or one number each. The built-in missions in `data/missions` hold the numbers.
"""

from tandemlift.settings.admittance import AdmittanceTable
from tandemlift.settings.corridor import CorridorTable, WallTable, wall_tables
from tandemlift.settings.guided import ComplianceTable, DetectionTable, ObserverTable
from tandemlift.settings.key_description import KeyDescription, description_of, key
from tandemlift.settings.mission import ChangeTable, Mission, MissionTable
from tandemlift.settings.parts import Drag, Payload, Quadrotor, VehicleTable
from tandemlift.settings.person import PersonTable
from tandemlift.settings.pilot import ControllerTable, PhasesTable
from tandemlift.settings.sensors import AdditionalSensorTable, InertialSensor, JointSensors, SensorFaultTable
from tandemlift.settings.supervision import SupervisionTable
from tandemlift.settings.value_types import (
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
