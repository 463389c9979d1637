"""Settings of the pilot: controller, allocation, phases, and the sources of its signals."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field
from pydantic_core import core_schema

from tandemlift.core.settings.key_description import key
from tandemlift.core.settings.value_types import (
    NonNegative,
    PerAxis,
    Positive,
    Scale,
    Table,
    divisor,
    is_number,
    must,
)

Priorities = Annotated[tuple[Scale, Scale, Scale, Scale], PerAxis(4)]
Bandwidth = Annotated[float, Field(gt=0.0, le=1e4), AfterValidator(divisor)]  # rad/s
Reading = Literal["truth", "measurement", "estimate"]


class ControllerTable(Table):
    """`[controller]`: the controller and its settings; each controller adds its own keys."""

    name: str = key(..., None, "name of the controller, one of `tandemlift controllers`", example="nftsmc")


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
    """`[allocation]`: how the wrench is distributed over the quadrotors."""

    method: Literal["pseudo-inverse", "constrained"] = key(
        "pseudo-inverse",
        None,
        "how the wrench is distributed over the rotors",
        choices={
            "pseudo-inverse": "the paper's weighted pseudo-inverse",
            "constrained": "beyond a rotor's limits, the thrusts within them that come closest to the wrench",
        },
    )
    weights: Annotated[tuple[tuple[Positive, Positive, Positive, Positive], ...], Weights()] = key(
        ((1.0, 1.0, 1.0, 1.0),),
        "1",
        "cost c of a quadrotor's thrust, roll, pitch and yaw moment",
        source="all alike; open in the paper",
    )
    priorities: Priorities = key(
        (30.0, 900.0, 900.0, 1.0),
        "1",
        "for 'constrained': weights of the errors in thrust, roll, pitch and yaw when the rotors cannot give all four",
        source="chosen: roll and pitch first, then thrust, then yaw",
    )


class PhasesTable(Table):
    """`[phases]`: the reference is lifted by a height and landed, with smooth steps.

    A landing that starts before the lift is refused; one that starts before the lift ends cuts it short, with a
    warning.
    """

    lift_start: NonNegative = key(0.0, "s", "start of the lift", example=2.0)
    lift_duration: Positive = key(1.0, "s", "duration of the lift", source="chosen", example=6.0)
    height: float = key(0.0, "m", "height of the lift", example=1.0)
    land_start: NonNegative | None = key(
        None,
        "s",
        "start of the landing; a time after the end of the flight cancels an inherited landing",
        rule="not before lift_start",
        unset="it never lands",
        example=20.0,
    )
    land_duration: Positive = key(1.0, "s", "duration of the landing", source="chosen", example=8.0)
    rotors: Literal["always", "flight"] = key(
        "always",
        None,
        "when the rotors turn",
        choices={
            "always": "all the time",
            "flight": "from the start of the lift to the end of the landing (needs a floor)",
        },
    )


class PilotTable(Table):
    """`[pilot]`: what guides the vehicle, and what the pilot reads."""

    guidance: Literal["scheduled", "interactive"] = key(
        "scheduled",
        None,
        "what guides the vehicle",
        choices={
            "scheduled": "lift and landing at set times, and the admittance between them",
            "interactive": "phases and requests, and `[compliance]` around the admittance",
        },
    )
    state: Reading = key(
        "truth",
        None,
        "where position, velocity, attitude and rates come from",
        rule='"truth" without sensors',
        choices={
            "truth": "the simulation",
            "measurement": "the last samples of motion measurement and gyroscope",
            "estimate": "an estimator that also uses the accelerometer",
        },
    )
    push: Reading = key(
        "truth",
        None,
        "where the person's force comes from",
        rule='"truth" without sensors',
        choices={
            "truth": "the simulation",
            "measurement": "the last sample of the joints' force sensors",
            "estimate": "that sample after a low-pass filter, zero before the tare ends and while the joints disagree",
        },
    )
    map: Literal["none", "walls"] = key(
        "none",
        None,
        "what the pilot knows of its surroundings",
        choices={
            "none": "nothing",
            "walls": 'the walls, so that a contact is told from a hand more surely (with `contact.model = "on"`)',
        },
    )


class EstimatorTable(Table):
    """`[estimator]`: the push from the joints' force sensors, and the state from inertial and motion sensors.

    The push is the force that accelerates the payload and does not come through a joint: wind on the payload is part of
    it. During the tare, in hover, it is assumed to be zero; what the joints then read is their bias.
    """

    push_bandwidth: Bandwidth = key(
        36.0,
        "rad/s",
        "bandwidth of the second-order low-pass filter on the push",
        source="as compliance.input_bandwidth",
    )
    tare: Literal["at-time", "hover"] = key(
        "at-time",
        None,
        "when the force sensors are tared",
        choices={
            "at-time": "at tare_start",
            "hover": "once the vehicle has hovered steadily for a second (needs guidance by hand)",
        },
    )
    tare_start: NonNegative | None = key(
        None,
        "s",
        "start of the tare, in hover and without a push (or a warning says so)",
        unset="there is no tare",
        example=9.0,
    )
    tare_duration: Positive = key(2.0, "s", "duration of the tare", rule="at least one sample", source="chosen")
    identify_mass: bool = key(
        False,
        None,
        "true identifies the payload's mass during the tare; false takes the excess for a bias of the joints",
        rule="true needs a tare",
    )
    disagreement_limit: Scale = key(
        2.0,
        "N",
        "the push is not trusted once one joint's sensor alone would have to be wrong by this horizontal force",
        source="chosen",
    )
    min_force: Scale = key(
        0.5,
        "N",
        "smallest force for which a point of application is estimated",
        source="chosen: ten times the noise of mission iris's sensors",
    )
    position_bandwidth: Bandwidth = key(
        6.0, "rad/s", "bandwidth with which the motion measurement corrects position and velocity", source="chosen"
    )
    attitude_bandwidth: Bandwidth = key(
        4.0, "rad/s", "bandwidth with which the motion measurement corrects the attitude", source="chosen"
    )
    confirmation: Literal["none", "motion"] = key(
        "motion",
        None,
        "what a push must agree with to be followed",
        choices={
            "none": "nothing",
            "motion": "how the vehicle moves under the thrust that the pilot knows: of a push that the motion "
            "contradicts, or that came with wind on the quadrotors, less than the threshold is left",
        },
    )
    wind_compensation: Literal["none", "quadrotors"] = key(
        "none",
        None,
        "what the push is freed of",
        choices={
            "none": "nothing",
            "quadrotors": "the wind on the payload along body x and y, estimated from the outside forces on the "
            "quadrotors by the ratio of drag areas (needs quadrotors with drag along both)",
        },
    )
    wind_bandwidth: Bandwidth = key(
        25.0,
        "rad/s",
        "bandwidth of the low-pass filter on the estimated wind force; lower for noisy joints, higher for gusts",
        source="chosen",
    )
