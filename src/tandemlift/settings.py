"""The tables of a mission: what each key is, in which unit, and what it may be.

Every table is strict: unknown keys, wrong types and non-finite numbers are refused. A leaf that is given per axis
takes one number for all axes or one number each. The built-in missions in `data/missions` hold the numbers.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, SerializeAsAny, model_validator
from pydantic_core import PydanticCustomError

Positive = Annotated[float, Field(gt=0.0)]
NonNegative = Annotated[float, Field(ge=0.0)]


class Table(BaseModel):
    """A strict, frozen table of a mission."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _spread(*counts: int, single: bool = True) -> BeforeValidator:
    """Accept one number for all axes (if `single`), or a list of exactly one of `counts` numbers."""
    lists = " or ".join(str(n) for n in counts)
    allowed = f"one number or a list of {lists} numbers" if single else f"a list of {lists} numbers"

    def spread(value: Any) -> Any:
        if single and _is_number(value):
            return (value,) * counts[0]
        if isinstance(value, (list, tuple)) and len(value) in counts and all(map(_is_number, value)):
            return tuple(value)
        raise PydanticCustomError("axes", "{allowed}", {"allowed": allowed})

    return BeforeValidator(spread)


Triple = tuple[float, float, float]
Axes3 = Annotated[Triple, _spread(3)]
Positive3 = Annotated[tuple[Positive, Positive, Positive], _spread(3)]
NonNegative3 = Annotated[tuple[NonNegative, NonNegative, NonNegative], _spread(3)]
Exactly3 = Annotated[Triple, _spread(3, single=False)]
Sextuple = tuple[float, float, float, float, float, float]
Positive6 = Annotated[tuple[Positive, Positive, Positive, Positive, Positive, Positive], _spread(6)]
NonNegative6 = Annotated[
    tuple[NonNegative, NonNegative, NonNegative, NonNegative, NonNegative, NonNegative], _spread(6)
]


class MissionTable(Table):
    """`[mission]`: name, duration and times of the run."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$")]
    duration: Positive  # s
    step: Annotated[float, Field(gt=0.0, le=0.02)] = 0.001  # s, of the pilot and of the body
    log_interval: Positive = 0.01  # s, rounded to whole steps
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 0

    @property
    def steps(self) -> int:
        """Number of steps of the run, at least one."""
        return max(1, round(self.duration / self.step))

    @property
    def log_every(self) -> int:
        """Steps from one logged sample to the next, at least one."""
        return max(1, round(self.log_interval / self.step))


def _check_inertia(name: str, inertia: Triple) -> None:
    x, y, z = sorted(inertia)
    if z > (x + y) * (1.0 + 1e-9):
        raise PydanticCustomError(
            "inertia",
            "principal moments with none above the sum of the other two (no rigid body has {name} = {given})",
            {"name": name, "given": str(list(inertia))},
        )


class Payload(Table):
    """`[vehicle.payload]`: a beam along body y, or any body with a mass and principal moments of inertia."""

    mass: Positive  # kg
    length: Positive | None = None  # m, along body y
    radius: Positive | None = None  # m
    inertia: Positive3 | None = None  # kg m², about its centre of mass; a beam's if not given

    @model_validator(mode="after")
    def _complete(self) -> Payload:
        if self.inertia is None and (self.length is None or self.radius is None):
            raise PydanticCustomError("payload", "either `inertia`, or `length` and `radius` of a beam", {})
        if self.inertia is not None:
            _check_inertia("inertia", self.inertia)
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
    inertia: Positive3  # kg m², about its centre of mass
    position: Exactly3  # m, of its centre of mass from the payload's, body axes
    layout: Literal["+", "x"]
    arm: Positive  # m, from the centre of mass to each rotor
    thrust_constant: Positive  # N/(rad/s)²
    max_speed: Positive  # rad/s
    torque_per_thrust: Positive  # m
    lag_up: NonNegative  # s, time constant of spinning up
    lag_down: NonNegative  # s

    @model_validator(mode="after")
    def _physical(self) -> Quadrotor:
        _check_inertia("inertia", self.inertia)
        return self

    @property
    def max_thrust(self) -> float:
        """Largest thrust of one rotor [N]."""
        return self.thrust_constant * self.max_speed**2


class Drag(Table):
    """`[vehicle.drag]`: linear drag, force on world velocity and moment on body rates."""

    force: NonNegative3 = (0.0, 0.0, 0.0)  # N s/m
    moment: NonNegative3 = (0.0, 0.0, 0.0)  # N m s


class VehicleTable(Table):
    """`[vehicle]`: the parts."""

    payload: Payload
    quadrotors: Annotated[tuple[Quadrotor, ...], BeforeValidator(lambda v: tuple(v) if isinstance(v, list) else v)]
    drag: Drag = Drag()

    @model_validator(mode="after")
    def _distinct(self) -> VehicleTable:
        if not 1 <= len(self.quadrotors) <= 64:
            raise PydanticCustomError("quadrotors", "1 to 64 quadrotors", {})
        positions = [q.position for q in self.quadrotors]
        if len(set(positions)) < len(positions):
            raise PydanticCustomError("quadrotors", "quadrotors at different positions (two are at the same)", {})
        return self


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


def _weights(value: Any) -> Any:
    allowed = PydanticCustomError("weights", "one number > 0, four numbers > 0, or four for each quadrotor", {})
    if _is_number(value):
        value = [value] * 4
    if not isinstance(value, (list, tuple)) or not value:
        raise allowed
    rows = value if all(isinstance(row, (list, tuple)) for row in value) else [value]
    if any(len(row) != 4 or not all(_is_number(c) and c > 0 for c in row) for row in rows):
        raise allowed
    return tuple(tuple(float(c) for c in row) for row in rows)


class AllocationTable(Table):
    """`[allocation]`: how the wrench is split over the quadrotors."""

    method: Literal["pseudo-inverse"] = "pseudo-inverse"
    weights: Annotated[tuple[tuple[Positive, ...], ...], BeforeValidator(_weights)] = ((1.0, 1.0, 1.0, 1.0),)


class Initial(Table):
    """`[initial]`: the state at t = 0."""

    position: Axes3 = (0.0, 0.0, 0.0)  # m, of the system's centre of mass, world axes
    velocity: Axes3 = (0.0, 0.0, 0.0)  # m/s, world axes
    euler: Axes3 = (0.0, 0.0, 0.0)  # rad: roll, pitch, yaw (Z-X-Y)
    rates: Axes3 = (0.0, 0.0, 0.0)  # rad/s, body axes

    @model_validator(mode="after")
    def _upright(self) -> Initial:
        if abs(self.euler[0]) >= 1.4835298641951802:  # 85°
            raise PydanticCustomError("roll", "a roll within ±85° (±1.4835 rad), where Z-X-Y angles are regular", {})
        return self


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

    mass_scale: Positive = 1.0
    inertia_scale: Positive3 = (1.0, 1.0, 1.0)


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
    pushes: Annotated[tuple[PushTable, ...], BeforeValidator(lambda v: tuple(v) if isinstance(v, list) else v)] = ()
    disturbance: Disturbance = Disturbance()
    plant: Plant = Plant()
    actuators: Actuators = Actuators()
