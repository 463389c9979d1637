"""The largest shake that a hovering vehicle answers, over frequency, axis and place, by flights.

A shake is a sine of force for `SECONDS`. It is answered if until `RESTS` after it no deviation from the reference
exceeds `LIMITS`, and there is no finding of the kinds `BEYOND`: others tell what the hand does, such as to oscillate.
Where rotors reach limits no linear model holds: what lacks of a moment winds up integrators. So flights find it.
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
from tandemlift.missions import Mission, format_toml, tables_of
from tandemlift.simulation.fly import Flight, fly_many

AXES = "xyz"
FREQUENCIES = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0)  # Hz
SECONDS, RESTS = 8.0, 2.0
BEYOND = {"touched", "out-of-reach", "landed-by-fault"}
NEAR_END = 0.9  # of half the payload's length: where a hand holds an end
PEAK, PUSHED = 3.0, 3.5  # N and kg of the check, as of the check `push`: all forces are in proportion to the mass
LEAST, MOST, LEVELS = 0.25, 8.0, 8  # N: peaks that are tried, and how many
WIDTH = 0.2  # of a period: σ of the Gaussians whose sum is a sine
LOGGED, AT_ONCE = 0.02, 128  # s; flights in memory


class ShakenMotion(NamedTuple):
    """How far a vehicle sinks below its reference [m], strays beside it [m], and turns off its heading [deg]."""

    sinks: float
    strays: float
    turns: float


LIMITS = ShakenMotion(0.1, 0.25, 5.0)


class Shake(NamedTuple):
    """A sine of force: its peak [N], frequency [Hz], axis (0 to 2, world), place and point [m, body axes]."""

    peak: float
    frequency: float
    axis: int
    place: str
    point: tuple[float, float, float]

    @property
    def where(self) -> str:
        """Axis, place and frequency in words."""
        return f"along {AXES[self.axis]}, {self.place}, {self.frequency:g} Hz"


def shaken_hands(mission: Mission) -> list[Shake]:
    """Shakes without a peak along each axis, in the payload's middle and near its ends: one, if the vehicle is even."""
    vehicle = mission.hover.vehicle
    end = 0.5 * NEAR_END * (vehicle.payload.span or 2.0 * float(np.abs(vehicle.lever_arms[:, 1]).max()))
    x, y, z = vehicle.origin.tolist()
    places = [("middle", (x, y, z)), ("+y end", (x, y + end, z)), ("-y end", (x, y - end, z))][
        : 2 if abs(y) < 1e-6 else 3
    ]
    return [Shake(0.0, f, axis, name, point) for name, point in places for axis in range(3) for f in FREQUENCIES]


def deviations(flight: Flight, since: float) -> ShakenMotion:
    """The largest deviations of a flight from a time [s] on, by its samples."""
    on = flight.time >= since
    off = (flight["reference_position"] - flight["position"])[on]
    turned = np.exp(1j * (flight["euler"] - flight["reference_euler"])[on, 2])
    strays, turns = np.linalg.norm(off[:, :2], axis=1).max(), np.abs(np.angle(turned)).max()
    return ShakenMotion(float(off[:, 2].max()), float(strays), math.degrees(float(turns)))


def is_answered(flight: Flight, since: float) -> bool:
    """Whether a flight answers a shake from a time [s] on."""
    bad = flight.outcome in FAILURES or any(f.kind in BEYOND and f.time >= since for f in flight.findings)
    return not bad and all(x <= most for x, most in zip(deviations(flight, since), LIMITS, strict=True))


def hover_to_shake(mission: Mission) -> tuple[Mission, float]:
    """(A hover of a mission in calm air, with its own rotors and sensors, the time [s] at which it is calm)."""
    (hover, at), own = hover_as_flown(mission), tables_of(mission)
    keys: dict[str, Any] = {name: own[name] for name in ("vehicle", "sensors", "ground")}
    keys["pushes"] = [{"force": [0.0] * 3, "time": at, "sigma": 1.0}]
    return with_keys(hover, keys | {"mission.duration": at + SECONDS + RESTS, "mission.log_interval": LOGGED}), at


def shaken(hover: Mission, at: float, hand: Shake) -> Mission:
    """A hover with a shake from a time [s] on: Gaussians of alternating sign, half a period T apart, of σ = T/5.

    The odd harmonics n of their sum have 4 σ √(2π)/T e^(−(n ω σ)²/2), so the third has 0.0018 of the first.
    """
    force = hand.peak * np.eye(3)[hand.axis] / (4.0 * WIDTH * math.sqrt(2.0 * math.pi))
    force *= math.exp(0.5 * (2.0 * math.pi * WIDTH) ** 2)
    ways = [{"force": tuple((way * force).tolist())} for way in (1.0, -1.0)]
    bell = hover.pushes[0].model_copy(update={"sigma": WIDTH / hand.frequency, "point": hand.point})
    times = (at + (0.5 * k + 0.25) / hand.frequency for k in range(max(1, round(2.0 * SECONDS * hand.frequency))))
    pushes = tuple(bell.model_copy(update={"time": t, **ways[k % 2]}) for k, t in enumerate(times))
    return hover.model_copy(update={"pushes": pushes})


def flown_shakes(mission: Mission, hands: Sequence[Shake]) -> Iterator[tuple[bool, ShakenMotion]]:
    """Whether a mission's vehicle answers each shake, and how far it deviates."""
    hover, at = hover_to_shake(mission)
    for i in range(0, len(hands), AT_ONCE):
        for flight in fly_many([shaken(hover, at, hand) for hand in hands[i : i + AT_ONCE]]):
            yield is_answered(flight, at), deviations(flight, at)


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
    flown = flown_shakes(mission, [hand._replace(peak=peak) for hand, peaks in ladders for peak in peaks.tolist()])
    each = [[peak for peak in peaks.tolist() if not next(flown)[0]] for _, peaks in ladders]
    return [min(peaks, default=math.inf) for peaks in each]


def shake_checks(mission: Mission) -> Iterator[CheckResult]:
    """Check the worst answers to shakes with the peak of a push that is not gentle; all but sinking advise a hand."""
    hands = [hand._replace(peak=PEAK * mission.hover.mass / PUSHED) for hand in shaken_hands(mission)]
    found = [(hand, off) for hand, (_, off) in zip(hands, flown_shakes(mission, hands), strict=True)]
    for i, (what, unit) in enumerate((("sinking", "m"), ("straying", "m"), ("turning", "deg"))):
        hand, off = max(found, key=lambda one: one[1][i])
        text = (
            f"{hand.where}: a shake of {hand.peak:.3g} N leaves it {off[i]:.3g} {unit} off by {what}; shake less there"
        )
        result = judged("shake", off[i], LIMITS[i], unit, text, subject=f"{what} {hand.where}", near=0.0)
        yield result._replace(verdict=CLOSE) if result.verdict == FAILS and what != "sinking" else result


def shake_claims(mission: Mission) -> tuple[list[Claim], dict[str, Any], dict[str, str]]:
    """(The least of the largest shakes along each axis, all of them by place and axis, missions just beyond)."""
    hands, most, count = shaken_hands(mission), MOST * mission.hover.mass / PUSHED, len(FREQUENCIES)
    peaks, claims, files = largest_shakes(mission, hands), list[Claim](), dict[str, str]()
    for axis, name in enumerate(AXES):
        peak, hand = min((one for one in zip(peaks, hands, strict=True) if one[1].axis == axis), key=lambda one: one[0])
        text, command = "all that were flown are answered", ""
        if peak < math.inf:
            beyond = shaken(*hover_to_shake(mission), hand._replace(peak=PAST * peak))
            files[f"limits/shake-{name}.toml"] = format_toml(tables_of(beyond))
            text, command = (
                f"{hand.where}: beyond it, it sinks, strays or turns",
                f"tandemlift run limits/shake-{name}.toml",
            )
        claims.append(Claim("largest shake", f"along {name}", peak, "N", None, text, command=command, tried=most))
    rows = {f"{hands[i].place}, {AXES[hands[i].axis]}": peaks[i : i + count] for i in range(0, len(hands), count)}
    return claims, {"frequency": list(FREQUENCIES), "most": most, "peaks": rows}, files
