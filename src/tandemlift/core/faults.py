"""The faults, checks and reactions of supervised flights, each in one record.

The keys of `[supervision.reactions]`, the alarms and their texts, the priority of faults, and the tables in
docs/reference/faults.md come from here. The laws in `parts.guidance.fault_detection` detect the faults.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

from tandemlift.core.phases import REASONS

Reaction = Literal["none", "hold", "land", "stop"]
REACTIONS: tuple[Reaction, ...] = get_args(Reaction)  # from the weakest to the strongest
REACTION_MEANINGS: dict[str, str] = {
    "none": "nothing",
    "hold": "hold the position and ignore pushes until all is well",
    "land": "land",
    "stop": "turn the rotors off",
}


class Symptom(NamedTuple):
    """A symptom of a sensor's fault: its text in an alarm, and its detection."""

    text: str
    detection: str


SYMPTOMS = (
    Symptom("frozen", "`supervision.watchdog.frozen_samples` identical samples in a row, where noise is expected"),
    Symptom("not a number", "no valid sample for `supervision.watchdog.invalid_time`"),
    Symptom("out of range", "beyond {range} for `supervision.watchdog.invalid_time`"),
)


class Fault(NamedTuple):
    """A fault.

    Attributes:
        number: in alarms; recorded flights hold it, so it stays.
        key: in `[supervision.reactions]`, and the field of `parts.guidance.fault_detection.ActiveFaults`.
        text: in alarms, events and on the live page.
        condition: when it is present, as a clause.
        reaction: the default.
        detection: how it is detected; for a sensor's samples, the largest value in range.
        symptoms: an alarm also contains the symptom's number, from 1.
    """

    number: int
    key: str
    text: str
    condition: str
    reaction: Reaction
    detection: str
    symptoms: tuple[Symptom, ...] = ()

    @property
    def alarm(self) -> int:
        """The fault's number in the channel `alarm`, to which the number of a symptom, from 1, is added."""
        return 10 * self.number


def _of_sensor(number: int, key: str, condition: str, reaction: Reaction, in_range: str) -> Fault:
    """A fault in the samples of one sensor."""
    return Fault(number, key, key, condition, reaction, in_range, SYMPTOMS)


STALE = "no fresh sample for `supervision.watchdog.stale_time`"
FAULTS = (  # by priority: if two faults have the same reaction, the first determines the alarm
    Fault(
        13,
        "orientation",
        "attitude and gyroscope lost",
        "both attitude and gyroscope are lost",
        "stop",
        "faults of both, or of their devices",
    ),
    Fault(
        12,
        "state",
        "state not a number",
        "the state has values that are not numbers",
        "stop",
        "in the state given to `tl.Pilot`, for `supervision.watchdog.invalid_time`",
    ),
    Fault(1, "imu", "imu stale", "the inertial measurement unit sends no data", "land", STALE),
    Fault(5, "motion", "motion stale", "the motion measurement sends no data", "land", STALE),
    _of_sensor(
        2,
        "joints",
        "a joint's sensor is lost",
        "hold",
        "`supervision.watchdog.max_force` or `supervision.watchdog.max_torque`",
    ),
    _of_sensor(3, "accelerometer", "the accelerometer is lost", "land", "`supervision.watchdog.max_specific_force`"),
    _of_sensor(4, "gyroscope", "the gyroscope is lost", "land", "`supervision.watchdog.max_rates`"),
    _of_sensor(6, "position", "the position is lost", "land", "`supervision.watchdog.max_position`"),
    _of_sensor(7, "velocity", "the velocity is lost", "land", "`supervision.watchdog.max_velocity`"),
    _of_sensor(8, "attitude", "the attitude is lost", "land", "5 % from unit norm"),
    Fault(
        9,
        "joints_inconsistent",
        "joints disagree",
        "the joints' sensors disagree",
        "hold",
        "by `estimator.disagreement_limit` for `supervision.watchdog.joints_time`",
    ),
    Fault(
        10,
        "attitude_inconsistent",
        "attitude disagrees with gyroscope",
        "attitude and gyroscope disagree",
        "land",
        "by `supervision.watchdog.attitude_gap` over `supervision.watchdog.window`",
    ),
    Fault(
        11,
        "velocity_inconsistent",
        "velocity disagrees with position",
        "velocity and position disagree",
        "land",
        "by `supervision.watchdog.position_gap` over `supervision.watchdog.window`",
    ),
    Fault(
        20,
        "speed_inconsistent",
        "accelerometer disagrees with velocity",
        "accelerometer and velocity disagree",
        "land",
        "by `supervision.watchdog.speed_gap` over `supervision.watchdog.window`",
    ),
    Fault(19, "rotor", "rotor failed", "a rotor has failed", "land", "the pilot's detection (`detection.model`)"),
    Fault(
        16,
        "tilt",
        "tilted too far",
        "the vehicle is tilted too far",
        "stop",
        "by `supervision.limits.tilt` for `supervision.limits.tilt_time`",
    ),
    Fault(
        17,
        "rates",
        "turning too fast",
        "the vehicle rotates too fast",
        "stop",
        "above `supervision.limits.rates` for `supervision.limits.rates_time`",
    ),
    Fault(
        14,
        "fence",
        "outside the fence",
        "the vehicle is outside the fence",
        "hold",
        "by more than `supervision.fence.margin`",
    ),
    Fault(
        15,
        "thrust",
        "too little thrust left",
        "too little thrust is left",
        "land",
        "allocated thrust above `supervision.limits.thrust_fraction` for `supervision.limits.thrust_time`",
    ),
    Fault(
        18,
        "tracking_error",
        "too far from the reference",
        "the vehicle is too far from the reference",
        "land",
        "by `supervision.limits.tracking_error` for `supervision.limits.tracking_error_time`",
    ),
    Fault(
        21,
        "limited",
        "cannot follow:",
        "the vehicle cannot follow its reference",
        "hold",
        "for `compliance.following.time`",
        tuple(Symptom(reason.text, f"{reason.detection}, for `compliance.following.time`") for reason in REASONS),
    ),
)


class Check(NamedTuple):
    """A check: its key in the law, its text when it fails, the request it precedes, its condition, and its keys."""

    key: str
    text: str
    before: Literal["lift", "guided"]
    passes: str
    keys: tuple[str, ...] = ()

    @property
    def number(self) -> int:
        """The check's number in the channel of failed checks."""
        return CHECKS.index(self) + 1


CHECKS = (  # by priority: the first that fails is reported
    Check(
        "imu", "no inertial measurements", "lift", "fresh inertial measurements", ("supervision.watchdog.stale_time",)
    ),
    Check(
        "motion", "no motion measurements", "lift", "fresh motion measurements", ("supervision.watchdog.stale_time",)
    ),
    Check(
        "sensors",
        "a sensor has failed",
        "lift",
        "samples of all sensors finite, in range, not frozen; joints agree; no fault for `supervision.recovery_time`",
        ("supervision.watchdog",),
    ),
    Check(
        "hover",
        "hover not feasible",
        "lift",
        "weight, with the estimated payload, below a fraction of the thrust that the rotors have with all known faults",
        ("supervision.checks.thrust_fraction",),
    ),
    Check("level", "not level", "lift", "level", ("supervision.checks.tilt",)),
    Check("rest", "not at rest", "lift", "at rest", ("supervision.checks.speed", "supervision.checks.rates")),
    Check("rotors", "a rotor has failed", "lift", "no failed rotor"),
    Check("tare", "no tare yet", "guided", "tare done", ("estimator.tare", "estimator.tare_start")),
    Check(
        "payload",
        "payload mass not plausible",
        "guided",
        "payload mass plausible",
        ("supervision.checks.min_payload_ratio", "supervision.checks.max_payload_ratio"),
    ),
    Check("joints", "joints disagree", "guided", "joints agree", ("estimator.disagreement_limit",)),
)


def _alarm_texts() -> tuple[str, ...]:
    texts = [""] * (10 * max(fault.number for fault in FAULTS) + 10)
    for fault in FAULTS:
        texts[fault.alarm] = fault.text
        for i, symptom in enumerate(fault.symptoms, start=1):
            texts[fault.alarm + i] = f"{fault.text} {symptom.text}"
    return tuple(texts)


ALARM_TEXTS = _alarm_texts()
"""The text of each alarm, indexed by its number, such as "gyroscope frozen" at 41; "" for unused numbers."""
