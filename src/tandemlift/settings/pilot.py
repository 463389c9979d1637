"""What the pilot is told to do: controller, admittance, allocation, phases, and which signals it reads."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, ValidationError, model_validator
from pydantic_core import core_schema

from tandemlift.settings.leaves import (
    Axes,
    NonNegative,
    NonNegative3,
    Positive,
    Positive3,
    Scale,
    Table,
    divisor,
    is_number,
    must,
)

LN_20 = 2.995732273553991  # time constants until 95 %

Priorities = Annotated[tuple[Scale, Scale, Scale, Scale], Axes(4)]
Bandwidth = Annotated[float, Field(gt=0.0, le=1e4), AfterValidator(divisor)]  # rad/s
Reading = Literal["truth", "measurement", "estimate"]


class ControllerTable(Table):
    """`[controller]`: a controller's own settings; each controller adds its keys."""

    name: str


class FeelTable(Table):
    """`[admittance.feel]`: what a push does, in place of mass and damping: so much force, so much speed, so soon."""

    force: Positive = 1.0  # N
    speed: Positive = 0.6  # m/s, that it comes to
    time: Positive = 0.5  # s, until 95 % of that


class AdmittanceTable(Table):
    """`[admittance]`: virtual mass, damping, stiffness and the gate, per world axis."""

    feel: FeelTable | None = None

    mass: Positive3  # kg
    damping: NonNegative3  # N s/m
    stiffness: NonNegative3 = (0.0, 0.0, 0.0)  # N/m
    threshold: NonNegative3  # N
    gate: Literal["hard", "soft"] = "hard"
    reanchor: bool = False

    @model_validator(mode="before")
    @classmethod
    def _by_feel(cls, data: Any) -> Any:
        """Mass and damping from the feel: v(t) = v (1 − exp(−C t/M)) under the force beyond the threshold."""
        if not isinstance(data, dict) or not isinstance(data.get("feel"), dict):
            return data
        try:
            feel, threshold = FeelTable(**data["feel"]), data["threshold"]
            axes = [threshold] * 3 if is_number(threshold) else list(threshold)
            less = [0.0 if data.get("gate", "hard") == "hard" else float(x) for x in axes]
        except (ValidationError, KeyError, TypeError, ValueError):
            return data  # which the keys' own rules explain
        damping = tuple((feel.force - x) / feel.speed for x in less)
        return {**data, "damping": damping, "mass": tuple(c * feel.time / LN_20 for c in damping)}


class Weights:
    """Mark of the allocation weights: one number, four, or four for each quadrotor."""

    def describe(self, limits: str) -> str:
        """What is allowed, in words; `limits` is what each number must keep to."""
        return f"one number {limits}, four numbers {limits}, or a list of four for each quadrotor"

    def rows(self, value: Any) -> Any:
        """Rows of four: one for all quadrotors, or one each."""
        if is_number(value):
            value = [value] * 4
        if isinstance(value, (list, tuple)) and value:
            rows = value if all(isinstance(row, (list, tuple)) for row in value) else [value]
            if all(len(row) == 4 and all(map(is_number, row)) for row in rows):
                return tuple(map(tuple, rows))
        raise must("axes", f"be {self.describe('> 0')}")

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return core_schema.no_info_before_validator_function(self.rows, handler(source))


class AllocationTable(Table):
    """`[allocation]`: how the wrench is split over the quadrotors."""

    method: Literal["pseudo-inverse", "constrained"] = "pseudo-inverse"
    weights: Annotated[tuple[tuple[Positive, Positive, Positive, Positive], ...], Weights()] = ((1.0, 1.0, 1.0, 1.0),)
    priorities: Priorities = (30.0, 900.0, 900.0, 1.0)  # thrust, roll, pitch, yaw: of the constrained method


class PhasesTable(Table):
    """`[phases]`: lift to a height, and land; leave `land_start` out never to land."""

    lift_start: NonNegative = 0.0  # s
    lift_duration: Positive = 1.0  # s
    height: float = 0.0  # m
    land_start: NonNegative | None = None  # s
    land_duration: Positive = 1.0  # s
    rotors: Literal["always", "flight"] = "always"  # or stopped before the lift starts and after the landing ends


class PilotTable(Table):
    """`[pilot]`: what guides it; whether it reads the truth, what sensors measure, or what is estimated from them."""

    guidance: Literal["clock", "hand"] = "clock"
    state: Reading = "truth"
    push: Reading = "truth"


class Estimator(Table):
    """`[estimator]`: the push from the joint sensors, and the state from inertial and motion sensors."""

    push_bandwidth: Bandwidth = 36.0  # rad/s, of the second-order low-pass on the push
    tare: Literal["clock", "hover"] = "clock"  # at `tare_start`, or once it hovers steadily
    tare_start: NonNegative | None = None  # s, in hover; no tare if not given
    tare_duration: Positive = 2.0  # s
    identify_mass: bool = False  # of the payload, while taring
    disagreement_limit: Scale = 2.0  # N, between the joint sensors, beyond which the push is not trusted
    least_force: Scale = 0.5  # N, below which no point of application is given
    position_bandwidth: Bandwidth = 6.0  # rad/s, of the state estimate
    attitude_bandwidth: Bandwidth = 4.0  # rad/s
    wind_compensation: Literal["none", "quadrotors"] = "none"  # wind on the payload, from that on the quadrotors
    wind_bandwidth: Bandwidth = 25.0  # rad/s, of the low-pass on it
