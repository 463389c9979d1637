"""The tables of a mission: what each key is, in which unit, and what it may be.

Every table is strict: unknown keys, wrong types and non-finite numbers are refused. A leaf that is given per axis
takes one number for all axes or one number each. The built-in missions in `data/missions` hold the numbers.
"""

from __future__ import annotations

import math
import re
from typing import Annotated, Any, Literal, get_origin

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, SerializeAsAny, model_validator
from pydantic_core import PydanticCustomError, core_schema

COINCIDING = 1e-3  # m
SMALLEST = 1e-300  # of a divisor: its inverse is finite


def _must(kind: str, words: str) -> PydanticCustomError:
    return PydanticCustomError(kind, "must {words}", {"words": words})


def _divisor(value: float) -> float:
    if value < SMALLEST:
        raise _must("size", f"be at least {SMALLEST}")
    return value


Positive = Annotated[float, Field(gt=0.0), AfterValidator(_divisor)]
NonNegative = Annotated[float, Field(ge=0.0)]
AtLeastOne = Annotated[float, Field(ge=1.0)]
Scale = Annotated[float, Field(ge=1e-6, le=1e6)]


class Table(BaseModel):
    """A strict, frozen table of a mission."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False, validate_default=True)

    @model_validator(mode="before")
    @classmethod
    def _lists_as_tuples(cls, data: Any) -> Any:
        tuples = {name for name, field in cls.model_fields.items() if get_origin(field.annotation) is tuple}
        items = data.items() if isinstance(data, dict) else ()
        return {k: tuple(v) if k in tuples and isinstance(v, list) else v for k, v in items} or data


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


class Axes:
    """Mark of a leaf given per axis: one number for all `count` axes (unless `single` is False), or one number each."""

    def __init__(self, count: int, *, single: bool = True) -> None:
        self.count, self.single = count, single

    def describe(self, limits: str) -> str:
        """What is allowed, in words; `limits` is what each number must keep to."""
        return f"{'one number or ' if self.single else ''}a list of {self.count} numbers{limits and ', each ' + limits}"

    def spread(self, value: Any) -> Any:
        """The numbers of all axes."""
        if self.single and _is_number(value):
            return (value,) * self.count
        if isinstance(value, (list, tuple)) and len(value) == self.count and all(map(_is_number, value)):
            return tuple(value)
        raise _must("axes", f"be {self.describe('')}")

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return core_schema.no_info_before_validator_function(self.spread, handler(source))


Triple = tuple[float, float, float]
Axes3 = Annotated[Triple, Axes(3)]
Positive3 = Annotated[tuple[Positive, Positive, Positive], Axes(3)]
NonNegative3 = Annotated[tuple[NonNegative, NonNegative, NonNegative], Axes(3)]
Exactly3 = Annotated[Triple, Axes(3, single=False)]
Positive6 = Annotated[tuple[Positive, Positive, Positive, Positive, Positive, Positive], Axes(6)]
NonNegative6 = Annotated[tuple[NonNegative, NonNegative, NonNegative, NonNegative, NonNegative, NonNegative], Axes(6)]
AtLeastOne6 = Annotated[tuple[AtLeastOne, AtLeastOne, AtLeastOne, AtLeastOne, AtLeastOne, AtLeastOne], Axes(6)]


def _name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}", name):
        raise _must("name", "be 1 to 64 letters, digits, '.', '_' or '-', the first a letter or a digit")
    return name


class MissionTable(Table):
    """`[mission]`: name, duration and times of the run."""

    name: Annotated[str, AfterValidator(_name)]
    duration: Positive  # s, rounded to whole steps
    step: Annotated[float, Field(gt=0.0, le=0.02), AfterValidator(_divisor)] = 0.001  # s, of the pilot and of the body
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


def _principal(inertia: Triple) -> Triple:
    x, y, z = sorted(inertia)
    if z > (x + y) * (1.0 + 1e-9):
        raise _must("inertia", "be principal moments of a body, none greater than the sum of the other two")
    return inertia


Inertia = Annotated[Positive3, AfterValidator(_principal)]


class Payload(Table):
    """`[vehicle.payload]`: a beam along body y, or any body with a mass and principal moments of inertia."""

    mass: Positive  # kg
    length: Positive | None = None  # m, along body y
    radius: Positive | None = None  # m
    inertia: Inertia | None = None  # kg m², about its centre of mass; a beam's if not given

    @model_validator(mode="after")
    def _complete(self) -> Payload:
        if self.inertia is None and (self.length is None or self.radius is None):
            raise _must("payload", "have either inertia, or length and radius (of a beam)")
        return self

    @property
    def moments(self) -> Triple:
        """Principal moments [kg m²]: as given, or of a thin rod along y (m L²/12) with a solid section (m r²/2)."""
        if self.inertia is not None:
            return self.inertia
        length, radius = self.length or 0.0, self.radius or 0.0
        across = self.mass * length**2 / 12.0
        return (across, self.mass * radius**2 / 2.0, across)


class Quadrotor(Table):
    """One of `[[vehicle.quadrotors]]`: axes parallel to the vehicle's, rigidly fixed to the payload."""

    mass: Positive  # kg
    inertia: Inertia  # kg m², about its centre of mass
    position: Exactly3  # m, of its centre of mass from the payload's, body axes
    layout: Literal["+", "x"]
    arm: Positive  # m, from the centre of mass to each rotor
    thrust_constant: Positive  # N/(rad/s)²
    max_speed: Positive  # rad/s
    torque_per_thrust: Positive  # m
    lag_up: NonNegative  # s, time constant of spinning up
    lag_down: NonNegative  # s

    @property
    def max_thrust(self) -> float:
        """Largest thrust of one rotor [N]."""
        return self.thrust_constant * self.max_speed**2


class Drag(Table):
    """`[vehicle.drag]`: linear drag, force on world velocity and moment on body rates."""

    force: NonNegative3 = (0.0, 0.0, 0.0)  # N s/m
    moment: NonNegative3 = (0.0, 0.0, 0.0)  # N m s


def _fleet(quadrotors: tuple[Quadrotor, ...]) -> tuple[Quadrotor, ...]:
    if not 1 <= len(quadrotors) <= 64:
        raise _must("count", f"be 1 to 64 tables, here are {len(quadrotors)}")
    for i, q in enumerate(quadrotors):
        for j in range(i):
            if math.dist(q.position, quadrotors[j].position) < COINCIDING:
                raise _must("count", f"differ in position, but numbers {j} and {i} are both at {list(q.position)}")
    return quadrotors


class VehicleTable(Table):
    """`[vehicle]`: the parts."""

    payload: Payload
    quadrotors: Annotated[tuple[Quadrotor, ...], AfterValidator(_fleet)]
    drag: Drag = Drag()


class ControllerTable(Table):
    """`[controller]`: a controller's own settings; each controller adds its keys."""

    name: str


class AdmittanceTable(Table):
    """`[admittance]`: virtual mass, damping, stiffness and the gate, per world axis."""

    mass: Positive3  # kg
    damping: NonNegative3  # N s/m
    stiffness: NonNegative3 = (0.0, 0.0, 0.0)  # N/m
    threshold: NonNegative3  # N
    gate: Literal["hard", "soft"] = "hard"
    reanchor: bool = False


class Weights:
    """Mark of the allocation weights: one number, four, or four for each quadrotor."""

    def describe(self, limits: str) -> str:
        """What is allowed, in words; `limits` is what each number must keep to."""
        return f"one number {limits}, four numbers {limits}, or a list of four for each quadrotor"

    def rows(self, value: Any) -> Any:
        """Rows of four: one for all quadrotors, or one each."""
        if _is_number(value):
            value = [value] * 4
        if isinstance(value, (list, tuple)) and value:
            rows = value if all(isinstance(row, (list, tuple)) for row in value) else [value]
            if all(len(row) == 4 and all(map(_is_number, row)) for row in rows):
                return tuple(map(tuple, rows))
        raise _must("axes", f"be {self.describe('> 0')}")

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return core_schema.no_info_before_validator_function(self.rows, handler(source))


class AllocationTable(Table):
    """`[allocation]`: how the wrench is split over the quadrotors."""

    method: Literal["pseudo-inverse"] = "pseudo-inverse"
    weights: Annotated[tuple[tuple[Positive, Positive, Positive, Positive], ...], Weights()] = ((1.0, 1.0, 1.0, 1.0),)


def _upright(euler: Triple) -> Triple:
    if abs(euler[0]) >= math.radians(85.0):
        raise _must("roll", "have a roll (the first angle) within ±85° (±1.4835 rad), where the angles are regular")
    return euler


class Initial(Table):
    """`[initial]`: the state at t = 0."""

    position: Axes3 = (0.0, 0.0, 0.0)  # m, of the system's centre of mass, world axes
    velocity: Axes3 = (0.0, 0.0, 0.0)  # m/s, world axes
    euler: Annotated[Axes3, AfterValidator(_upright)] = (0.0, 0.0, 0.0)  # rad: roll, pitch, yaw (Z-X-Y)
    rates: Axes3 = (0.0, 0.0, 0.0)  # rad/s, body axes


class PhasesTable(Table):
    """`[phases]`: lift to a height, and land; leave `land_start` out never to land."""

    lift_start: NonNegative = 0.0  # s
    lift_duration: Positive = 1.0  # s
    height: float = 0.0  # m
    land_start: NonNegative | None = None  # s
    land_duration: Positive = 1.0  # s


class PushTable(Table):
    """One of `[[pushes]]`: a person's push A exp(−(t − t₀)²/2σ²)."""

    force: Exactly3  # N, peak, world axes
    time: float  # s, of the peak
    sigma: Positive  # s
    point: Exactly3 = (0.0, 0.0, 0.0)  # m, body axes, from the system's centre of mass


class Disturbance(Table):
    """`[disturbance]`: a constant force and moment that the pilot does not know of."""

    force: Axes3 = (0.0, 0.0, 0.0)  # N, world axes, at the centre of mass
    moment: Axes3 = (0.0, 0.0, 0.0)  # N m, body axes


class Plant(Table):
    """`[plant]`: how the body differs from what the pilot believes."""

    mass_scale: Scale = 1.0
    inertia_scale: Annotated[tuple[Scale, Scale, Scale], Axes(3)] = (1.0, 1.0, 1.0)


class Actuators(Table):
    """`[actuators]`: what the rotors do with a command."""

    model: Literal["ideal"] = "ideal"


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
    actuators: Actuators = Actuators()
