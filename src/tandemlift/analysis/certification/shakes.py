"""The largest shake that a hovering vehicle answers, over frequency, axis and place, by flights.

A shake is a sine of force for `SECONDS`. It is answered if until `RESTS` after it the vehicle sinks by at most `SINKS`,
strays by at most `STRAYS` and turns by at most `TURNS` from its reference, and has no finding of the kinds `BEYOND`;
others tell what the hand does, such as an oscillation at its frequency. Where rotors reach limits the answer is
anything but linear: what lacks of a moment turns the vehicle and winds up integrators. So flights with rising peaks
find the limit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.flown import PAST, hover_as_flown
from tandemlift.analysis.certification.parameters import with_keys
from tandemlift.analysis.linearization.claims import Claim
from tandemlift.core.errors import CLOSE, FAILS, CheckResult, judged
from tandemlift.core.phases import FAILURES
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, format_toml, tables_of
from tandemlift.parts.mechanics.push import sine_pushes
from tandemlift.parts.rotors.authority import PUSH, PUSHED
from tandemlift.simulation.fly import fly_many

AXES = "xyz"
FREQUENCIES = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0)  # Hz
SECONDS, RESTS = 8.0, 2.0
SINKS, STRAYS, TURNS = 0.1, 0.25, 5.0  # m, m, deg
BEYOND = {"touched", "out-of-reach", "landed-by-fault"}
NEAR_END = 0.9  # of half the payload's length: where a hand holds an end
LEAST, MOST, LEVELS = 0.25, 8.0, 8  # N for `PUSHED` kg, in proportion to the mass: peaks that are tried, and how many
LOGGED, AT_ONCE = 0.02, 128  # s; flights in memory


class Shake(NamedTuple):
    """A sine of force: its peak [N], frequency [Hz], axis (0 to 2, world), place and point [m, body axes]."""

    peak: float
    frequency: float
    axis: int
    place: str
    point: tuple[float, float, float]


class Answer(NamedTuple):
    """How far a shaken vehicle sinks, strays [m] and turns [deg], and its findings and failure beyond the hand's."""

    sinks: float
    strays: float
    turns: float
    beyond: frozenset[str]

    @property
    def is_calm(self) -> bool:
        """Whether the shake is answered."""
        return self.sinks <= SINKS and self.strays <= STRAYS and self.turns <= TURNS and not self.beyond


def shaken_hands(mission: Mission) -> list[Shake]:
    """Shakes without a peak: in the payload's middle and near its ends, along each axis, with all `FREQUENCIES`.

    One end stands for both if the centre of mass is in the middle.
    """
    vehicle = mission.hover.vehicle
    end = 0.5 * NEAR_END * (vehicle.payload.span or 2.0 * float(np.abs(vehicle.lever_arms[:, 1]).max()))
    x, y, z = vehicle.origin.tolist()
    places = [("middle", (x, y, z)), ("+y end", (x, y + end, z)), ("-y end", (x, y - end, z))][
        : 2 if abs(y) < 1e-6 else 3
    ]
    return [Shake(0.0, f, axis, name, point) for name, point in places for axis in range(3) for f in FREQUENCIES]


def answer_of(flight: Flight, since: float) -> Answer:
    """The answer of a flight to a shake from a time [s] on."""
    on, kinds = flight.time >= since, {f.kind for f in flight.findings if f.time >= since}
    off = (flight["reference_position"] - flight["position"])[on]
    turned = np.exp(1j * (flight["euler"] - flight["reference_euler"])[on, 2])
    beyond = (BEYOND & kinds) | ({flight.outcome} & set(FAILURES))
    strays, turns = np.linalg.norm(off[:, :2], axis=1).max(), np.abs(np.angle(turned)).max()
    return Answer(float(off[:, 2].max()), float(strays), math.degrees(float(turns)), frozenset(beyond))


def hover_to_shake(mission: Mission) -> tuple[Mission, float]:
    """(A hover of a mission in calm air, with its own rotors and sensors, the time [s] at which it is calm)."""
    (hover, at), own = hover_as_flown(mission), tables_of(mission)
    keys = {"vehicle": own["vehicle"], "sensors": own["sensors"], "ground": own["ground"]}
    return with_keys(hover, keys | {"mission.duration": at + SECONDS + RESTS, "mission.log_interval": LOGGED}), at


def answers(mission: Mission, shakes: Sequence[Shake]) -> Iterator[Answer]:
    """The answers of a mission's vehicle to shakes."""
    hover, at = hover_to_shake(mission)
    for i in range(0, len(shakes), AT_ONCE):
        some = [_shaken(hover, at, shake) for shake in shakes[i : i + AT_ONCE]]
        yield from (answer_of(flight, at) for flight in fly_many(some))


def _shaken(hover: Mission, at: float, hand: Shake) -> Mission:
    force = tuple((hand.peak * np.eye(3)[hand.axis]).tolist())
    return hover.model_copy(update={"pushes": sine_pushes(force, hand.frequency, at, SECONDS, hand.point)})


def largest_shakes(mission: Mission, hands: Sequence[Shake]) -> list[float]:
    """The largest peak [N] that is answered of each hand, whatever its own; infinite beyond all that are tried.

    It is the geometric mean of the lowest peak that is not answered and the one before it.
    """
    levels = np.geomspace(LEAST, MOST, LEVELS) * (mission.hover.mass / PUSHED)
    step = float(levels[1] / levels[0])
    coarse = _first_unanswered(mission, [(hand, levels) for hand in hands])
    finer = step ** (np.arange(1, LEVELS + 1) / LEVELS - 1.0)
    ladders = [(hand, x * finer) for hand, x in zip(hands, coarse, strict=True) if x < math.inf]
    fine = iter(_first_unanswered(mission, ladders))
    return [x if x == math.inf else next(fine) * step ** (-0.5 / LEVELS) for x in coarse]


def _first_unanswered(mission: Mission, ladders: Sequence[tuple[Shake, Array]]) -> list[float]:
    """The lowest of some rising peaks that is not answered, of each hand; infinite if all are."""
    flown = answers(mission, [hand._replace(peak=peak) for hand, peaks in ladders for peak in peaks.tolist()])
    each = [[peak for peak in peaks.tolist() if not next(flown).is_calm] for _, peaks in ladders]
    return [min(peaks, default=math.inf) for peaks in each]


def shake_checks(mission: Mission) -> Iterator[CheckResult]:
    """Check the worst answers to shakes with the peak of a push that is not gentle; all but sinking advise a hand."""
    hands = [hand._replace(peak=PUSH * mission.hover.mass / PUSHED) for hand in shaken_hands(mission)]
    found = list(zip(hands, answers(mission, hands), strict=True))
    far = promise_of(mission.promise, mission.pilot.guidance).distance
    for i, (what, limit, unit) in enumerate(
        (("sinking", SINKS, "m"), ("straying", far, "m"), ("turning", TURNS, "deg"))
    ):
        hand, answer = max(found, key=lambda one: one[1][i])
        where = f"along {AXES[hand.axis]}, {hand.place}, {hand.frequency:g} Hz"
        text = f"{where}: a shake of {hand.peak:.3g} N leaves it {answer[i]:.3g} {unit} off by {what}; shake less there"
        result = judged("shake", answer[i], limit, unit, text, subject=f"{what} {where}", near=0.0)
        yield result._replace(verdict=CLOSE) if result.verdict == FAILS and what != "sinking" else result


def shake_claims(mission: Mission) -> tuple[list[Claim], dict[str, Any], dict[str, str]]:
    """(The least of the largest shakes along each axis, all of them by place and axis, missions just beyond)."""
    hands, count = shaken_hands(mission), len(FREQUENCIES)
    peaks, most = largest_shakes(mission, hands), MOST * mission.hover.mass / PUSHED
    claims, files = list[Claim](), dict[str, str]()
    for axis, name in enumerate(AXES):
        peak, hand = min((one for one in zip(peaks, hands, strict=True) if one[1].axis == axis), key=lambda one: one[0])
        text, file = "all that were flown are answered", f"limits/shake-{name}.toml"
        if peak < math.inf:
            text = (
                f"{hand.place}, {hand.frequency:g} Hz: a larger one sinks it by {SINKS:g} m or turns it by {TURNS:g}°"
            )
            beyond = _shaken(*hover_to_shake(mission), hand._replace(peak=PAST * peak))
            files[file] = format_toml(tables_of(beyond))
        command = f"tandemlift run {file}" if files.get(file) else ""
        claims.append(Claim("largest shake", f"along {name}", peak, "N", None, text, command=command, tried=most))
    rows = {f"{hands[i].place}, {AXES[hands[i].axis]}": peaks[i : i + count] for i in range(0, len(hands), count)}
    return claims, {"frequency": list(FREQUENCIES), "most": most, "peaks": rows}, files
