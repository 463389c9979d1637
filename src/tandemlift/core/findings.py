"""The kinds of findings, each in one record.

A finding is an undesired event during a flight, with time, place and number; the flight's outcome may still be good.
The choices of the key `findings.ignore` and the table of docs/reference/outcomes.md come from here. The laws in
`simulation.loop.detectors` examine every step; `simulation.findings` forms the findings from their states.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal, NamedTuple


class FindingKind(NamedTuple):
    """A kind of finding: its name, meaning and remedy, and the keys of its thresholds."""

    name: str
    meaning: str
    remedy: str
    keys: tuple[str, ...] = ()


KINDS = (
    FindingKind(
        "touched",
        "a rotor, a guard or the beam touched the floor or a wall",
        "leave more room, lift higher, or lower `compliance.max_speed`",
    ),
    FindingKind(
        "oscillating",
        "a body rate, or the error of the vertical speed, oscillated with half periods of similar length "
        "whose amplitude did not decay",
        "lower the controller's gains, or fly rotors with less delay and lag",
        (
            "findings.oscillation_rate",
            "findings.oscillation_speed",
            "findings.slowest_oscillation",
            "findings.fastest_oscillation",
            "findings.oscillation_periods",
        ),
    ),
    FindingKind(
        "structure-oscillates",
        "the thrusts of a vehicle whose beam bends or whose mounts give went on swinging: a loop of the pilot drives a "
        "mode of the structure",
        "add notches (`allocation.notches`) at the modes that `tandemlift check` finds driven, or stiffen the beam",
        ("findings.structure_thrust", "findings.structure_time"),
    ),
    FindingKind(
        "saturated",
        "a rotor that still works was at its limit for long, or for a large fraction of the flight",
        "use stronger rotors or a lighter payload, or lower the controller's gains",
        ("findings.saturated_time", "findings.saturated_fraction"),
    ),
    FindingKind(
        "no-response-to-push",
        "a push was above its threshold, and the vehicle did not move along with it",
        "see that rotors have thrust left beside the weight (`compliance.thrust_fraction`), and that nothing is in the "
        "way",
        ("findings.push_time", "findings.push_response"),
    ),
    FindingKind(
        "response-without-push",
        "the reference moved although nobody pushed: it followed an error of the sensors, or wind",
        "see that `estimator.confirmation` is on, raise `admittance.threshold`, or repair the sensor",
        ("findings.unpushed_distance",),
    ),
    FindingKind(
        "push-refuted",
        "the joint sensors measured a push, but the vehicle did not move along it; the push was not followed",
        "repair or tare the joint sensors; see channel `push_withheld`",
        ("findings.refuted_time",),
    ),
    FindingKind(
        "off-track",
        "the vehicle was farther from its reference than the mission promises: in distance, RMS distance, "
        "height, heading or tilt",
        "change what disturbs it or the controller's gains; if the deviation is acceptable, change the promise",
        tuple(
            f"promise.{name}" for name in ("distance", "rms_distance", "sinking", "heading", "tilt", "settling_time")
        ),
    ),
    FindingKind(
        "out-of-reach",
        "the reference needed more thrust than the rotors have, or moved away from the vehicle",
        "make the reference slower: a longer `phases.lift_duration`, more `admittance.damping`, less "
        "`compliance.max_acceleration`",
        ("findings.reach_time", "findings.reach_distance"),
    ),
    FindingKind(
        "cannot-follow",
        'the pilot ignored pushes because the vehicle could not follow them, phase "limited"; '
        "docs/reference/faults.md has the reasons",
        "remove the cause that it names: use stronger rotors or a lighter payload, or fly in less wind",
        ("compliance.following.time", "compliance.following.max_error", "compliance.following.recovery_time"),
    ),
    FindingKind(
        "not-landed",
        "a landing of the mission should be over, but the vehicle is in the air",
        "make `mission.duration` longer, or see in the other findings and in the events what kept it in the air",
    ),
    FindingKind(
        "landed-by-fault",
        "the vehicle landed, or stopped its rotors, because of a fault and without a request",
        "remove the cause that it names; `supervision.reactions` has the reaction to each fault",
    ),
    FindingKind(
        "lift-refused",
        "a lift was requested, and a check before the flight refused it",
        "see the failed check in docs/reference/faults.md, and its keys in `supervision.checks`",
    ),
)
KIND_OF = {kind.name: kind for kind in KINDS}
FINDING_NAMES = tuple(KIND_OF)
if TYPE_CHECKING:
    FindingName = str
else:
    FindingName = Literal[FINDING_NAMES]


class Finding(NamedTuple):
    """An undesired event during a flight.

    Attributes:
        kind: one of `FINDING_NAMES`.
        time: when it began [s].
        duration: how long it lasted in all [s].
        place: of the vehicle's centre of mass, or of a touch [m, world axes]; None where there is none.
        quantity: name of the measured quantity.
        value: its worst value; None where there is no number.
        unit: of value and limit.
        limit: the largest or smallest allowed value; None where there is no number.
        text: a sentence with all of this.
    """

    kind: FindingName
    time: float
    duration: float
    place: tuple[float, float, float] | None
    quantity: str
    value: float | None
    unit: str
    limit: float | None
    text: str

    def __str__(self) -> str:
        return f"{self.kind} at {self.time:.6g} s: {self.text}"

    @property
    def remedy(self) -> str:
        """The remedy."""
        return KIND_OF[self.kind].remedy

    def as_table(self) -> dict[str, Any]:
        """The fields by name, as in findings.json, and the remedy."""
        return {**self._asdict(), "place": self.place and list(self.place), "remedy": self.remedy}


def finding(
    kind: FindingName,
    text: str,
    *,
    time: float,
    duration: float = 0.0,
    place: Iterable[float] | None = None,
    quantity: str = "",
    value: float | None = None,
    unit: str = "",
    limit: float | None = None,
) -> Finding:
    """A finding with plain numbers; one that is not finite, of a flight that diverged, is left out."""
    at = None if place is None else tuple(map(float, place))
    return Finding(
        kind=KIND_OF[kind].name,
        time=round(float(time), 9),
        duration=round(float(duration), 9),
        place=at if at and all(map(math.isfinite, at)) else None,  # type: ignore[arg-type]
        quantity=quantity,
        value=value if value is not None and math.isfinite(value) else None,
        unit=unit,
        limit=limit,
        text=text,
    )


def finding_from(table: dict[str, Any]) -> Finding:
    """A finding from its table (`Finding.as_table`)."""
    place = table["place"]
    fields = {name: table[name] for name in Finding._fields}
    return Finding(**{**fields, "place": place and tuple(place)})
