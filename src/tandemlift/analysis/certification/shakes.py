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

from tandemlift.analysis.certification.claims import Claim
from tandemlift.analysis.certification.flown import EXCESS, hover_as_flown
from tandemlift.analysis.certification.parameters import with_keys
from tandemlift.core.errors import CLOSE, FAILS, CheckResult, judged
from tandemlift.core.phases import FAILURES
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, format_toml, tables_of
from tandemlift.simulation.fly import fly_many

AXES = "xyz"
FREQUENCIES = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0)  # Hz
SECONDS, REST = 8.0, 2.0
BEYOND = {"touched", "out-of-reach", "landed-by-fault"}
NEAR_END = 0.9  # of half the payload's length: where a hand holds an end
PEAK, MASS = 3.0, 3.5  # N and kg of the check, as of the check `push`: all forces are in proportion to the mass
MIN_PEAK, MAX_PEAK, LEVELS = 0.25, 8.0, 33  # N: peaks that are tried, and how many
WIDTH, POINTS, GAP = 0.8, 4, 0.025  # σ of the Gaussians whose sum is a sine, in gaps; of a half wave; s, of a gap
INTERVAL, BATCH = 0.02, 128  # s; flights in memory


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
    return with_keys(hover, keys | {"mission.duration": at + SECONDS + REST, "mission.log_interval": INTERVAL}), at


def shaken(hover: Mission, at: float, hand: Shake) -> Mission:
    """A hover with a shake from a time [s] on: Gaussians h apart, of σ = WIDTH · h, as high as a sine times 1/g there.

    By Poisson's sum they are that sine with g = WIDTH √(2π) e^(−(ω σ)²/2), and no image of it has 1e-4 of its peak. It
    begins as suddenly as a sine does, within h: how a hand begins decides on how far the first waves move a vehicle.
    """
    half = max(POINTS, math.ceil(0.5 / hand.frequency / GAP))
    apart = 0.5 / hand.frequency / half
    gain = WIDTH * math.sqrt(2.0 * math.pi) * math.exp(-0.5 * (math.pi * WIDTH / half) ** 2)
    bell = hover.pushes[0].model_copy(update={"sigma": WIDTH * apart, "point": hand.point})
    sine = hand.peak / gain * np.sin(math.pi / half * np.arange(half * max(1, round(2.0 * SECONDS * hand.frequency))))
    forces = sine[:, None] * np.eye(3)[hand.axis]
    times = (at + apart * np.arange(len(sine))).tolist()
    each = ({"time": t, "force": tuple(F)} for t, F in zip(times, forces.tolist(), strict=True))
    return hover.model_copy(update={"pushes": tuple(bell.model_copy(update=one) for one in each)})


def flown_shakes(mission: Mission, hands: Sequence[Shake]) -> Iterator[tuple[bool, ShakenMotion]]:
    """Whether a mission's vehicle answers each shake, and how far it deviates."""
    hover, at = hover_to_shake(mission)
    for i in range(0, len(hands), BATCH):
        for flight in fly_many([shaken(hover, at, hand) for hand in hands[i : i + BATCH]]):
            yield is_answered(flight, at), deviations(flight, at)


def largest_shakes(mission: Mission, hands: Sequence[Shake]) -> list[float]:
    """The largest peak [N] that is answered of each hand, whatever its own; infinite beyond all that are tried."""
    levels = np.geomspace(MIN_PEAK, MAX_PEAK, LEVELS) * (mission.hover.mass / MASS)
    flown = flown_shakes(mission, [hand._replace(peak=peak) for hand in hands for peak in levels.tolist()])
    return [end_of_answers(levels, [next(flown)[0] for _ in levels]) for _ in hands]


def end_of_answers(peaks: Array, answered: Sequence[bool]) -> float:
    """The geometric mean of the first of rising peaks that is not answered, as its next one, and the one before it.

    A single one is a coincidence of the hand's phase and of noise. The first peak, if that is such a one; infinite if
    there is none. The last alone counts as two.
    """
    steps = zip(peaks, peaks[:1].tolist() + peaks[:-1].tolist(), answered, [*answered[1:], False], strict=True)
    return next((math.sqrt(peak * before) for peak, before, one, after in steps if not (one or after)), math.inf)


def shake_checks(mission: Mission) -> Iterator[CheckResult]:
    """Check the worst answers to shakes with the peak of a push that is not gentle; all but sinking advise a hand."""
    hands = [hand._replace(peak=PEAK * mission.hover.mass / MASS) for hand in shaken_hands(mission)]
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
    hands, most, count = shaken_hands(mission), MAX_PEAK * mission.hover.mass / MASS, len(FREQUENCIES)
    peaks, claims, files = largest_shakes(mission, hands), list[Claim](), dict[str, str]()
    for axis, name in enumerate(AXES):
        peak, hand = min((one for one in zip(peaks, hands, strict=True) if one[1].axis == axis), key=lambda one: one[0])
        text, command = "all that were flown are answered", ""
        if peak < math.inf:
            beyond = shaken(*hover_to_shake(mission), hand._replace(peak=EXCESS * peak))
            files[f"limits/shake-{name}.toml"] = format_toml(tables_of(beyond))
            text, command = (
                f"{hand.where}: beyond it, it sinks, strays or turns",
                f"tandemlift run limits/shake-{name}.toml",
            )
        claims.append(Claim("largest shake", f"along {name}", peak, "N", None, text, command=command, tried=most))
    rows = {f"{hands[i].place}, {AXES[hands[i].axis]}": peaks[i : i + count] for i in range(0, len(hands), count)}
    return claims, {"frequency": list(FREQUENCIES), "most": most, "peaks": rows}, files
