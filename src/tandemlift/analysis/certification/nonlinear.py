"""The tier of nonlinear bounds: thrust limits and switching as sectors of the loop, and laws over a box of states.

Thrusts within limits by `thrust_limit_solver` are a projection of the desired wrench τ: W²(τ − B f) is normal to what
the limits allow, (τ − B f)ᵀ W² (B f − B ζ) ≥ 0 for all thrusts ζ within them, which is the condition of `sector_bound`
with multipliers in the ratio W². The solver's small weight of the distance from the pseudo-inverse is left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from tandemlift.analysis.certification.claims import Claim, FlownLimit, Tier
from tandemlift.analysis.certification.cut_loop import OFFSET_NAMES, SURFACES, CutLoop, loop_of, parts_of
from tandemlift.analysis.certification.intervals import bounds
from tandemlift.analysis.certification.sector_bound import LoopPart, Sectors, Start, region_of, solvers, tolerated
from tandemlift.analysis.linearization.loop_margins import AXES, bisected, calm_mission
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import Mission, check, tables_of
from tandemlift.parts.pilot.commanded_thrusts import RotorAxes, commanded_thrusts, disturb, rotor_axes
from tandemlift.simulation.pilot_api import PilotData, pilot_at_start
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.stepping import Stepper

RESPONSE_FLOOR = 1e-3  # of the largest response to an offset, below which a part does not respond
MAX_GAIN = 4.0  # that is tried, times a response
UNITS = {"velocity": "m/s", "rates": "rad/s", "attitude": "rad"}
RECOVERY_TIME, REST_RATE = 8.0, 0.1  # s after an offset; m/s and rad/s, of a vehicle that has recovered
MAX_FACTOR = 64.0  # times the predicted offset, that is flown
ACCURACY = 0.05  # of a flown offset
BOX = {"position": 0.05, "velocity": 0.1, "angles": 0.05, "rates": 0.1}  # m, m/s, rad, rad/s: a box of scale 1
PIECE_COUNT = 3  # of each angle
MAX_BOX_SCALE, BOX_BISECTIONS = 100.0, 14
DISTURBANCE = 0.2  # size of an offset, in its unit, whose response is reduced as exactly as the loop's


def sectors_of(part: LoopPart, priorities: Sequence[float], lost: float, *, within: RotorAxes | None = None) -> Sectors:
    """The sectors of a part's cuts.

    Args:
        part: of the loop.
        priorities: of the axes, in an allocation within thrust limits; none without one.
        lost: the share of a cut's linear response that it may take away; below 0, that it may add.
        within: the rotors whose limits a region has to stay within; None for none.
    """
    k = len(part.channels)
    axes = np.array([i < len(AXES) for i in part.channels]) & bool(priorities)
    shared, rows = np.zeros(k), np.zeros((0, 2 * k))
    if axes.any():
        own = [i for i in part.channels if i < len(AXES)]
        shared[axes] = (np.array(priorities)[own] / part.scale[axes]) ** 2
        if within is not None:
            moved = within.inverse[:, own] / part.scale[axes] / within.room[:, None]
            rows = np.zeros((len(moved), 2 * k))
            rows[:, :k][:, axes] = moved * np.sign(moved[:, :1] + 1e-300)
            rows = np.unique(rows.round(12), axis=0)
    return Sectors(np.full(k, lost), shared / max(shared.max(), 1e-300), rows)


def _sector_claims(loop: CutLoop, priorities: Sequence[float]) -> Iterator[Claim]:
    texts = {
        "thrust": "share of a commanded change of thrust or moment that may be {}, at any time, known to the pilot",
        "switching": "share of the switching's slope at 0 that may be {}, at any time{}",
    }
    for what, cuts in (("thrust", AXES), ("switching", SURFACES)):
        for part, _ in parts_of(loop, cuts) if set(cuts) <= set(loop.names) else ():
            subject = ", ".join(loop.names[i] for i in part.channels)

            def stable(share: float, part: LoopPart = part) -> bool:
                return region_of(part, sectors_of(part, priorities, share)) is not None

            lost, added = tolerated(stable, 1.0), tolerated(lambda x: stable(-x), MAX_GAIN)
            text, all_of_it = texts[what], "; tanh and saturation lose less than 1" if what == "switching" else ""
            yield Claim(f"{what} loss tolerated", subject, lost or None, "1", text=text.format("lost", all_of_it))
            added = math.inf if added == MAX_GAIN else added
            yield Claim(f"{what} gain tolerated", subject, added or None, "1", text=text.format("added", ""))


class OffsetBounds:
    """Offsets of the state from which a loop comes to rest within thrust limits.

    Args:
        loop: cut at its thrust limits.
        priorities: of the axes in the allocation.
        axes: of the rotors.

    Raises:
        InputError: a rotor hovers at a limit.
    """

    def __init__(self, loop: CutLoop, priorities: Sequence[float], axes: RotorAxes) -> None:
        worst = int(axes.room.argmin())
        if axes.room[worst] <= 0.0:
            limits = f"its limits are 0 and {axes.most[worst]:.3g} N"
            raise InputError(
                f"rotor {worst + 1} hovers at {axes.hover[worst]:.3g} N, and {limits}: raise max_speed "
                "or thrust_constant of its quadrotor, or lower the mass"
            )
        # in units of the room that the limits leave
        self._parts = parts_of(loop, AXES, unit=float(axes.room.min()), disturbance=DISTURBANCE)
        self._sectors = [sectors_of(part, priorities, 1.0, within=axes) for part, _ in self._parts]

    def farthest(self, offset: Mapping[str, float]) -> float | None:
        """The largest factor of an offset, by the names of `DISTURBED`, that is recovered; None if none is found."""
        shares = np.array([offset.get(name, 0.0) for name in OFFSET_NAMES])
        moved = [
            Start(shares @ [s.state for s in starts], float(abs(shares) @ [s.left_out for s in starts]))
            for _, starts in self._parts
        ]
        most, found = max(float(np.linalg.norm(start.state)) for start in moved), math.inf
        for (part, _), sectors, start in zip(self._parts, self._sectors, moved, strict=True):
            if np.linalg.norm(start.state) > RESPONSE_FLOOR * most:
                region = region_of(part, sectors, start)
                if region is None:
                    return None
                found = min(found, region.size)
        return found


class OffsetFlights:
    """Flights of the compiled engine from a calm hover with real rotors, disturbed by an offset of the body's state."""

    def __init__(self, mission: Mission) -> None:
        calm, at = calm_mission(mission, slow=0.0)
        tables = tables_of(calm)
        for own, real in zip(tables["vehicle"]["quadrotors"], mission.vehicle.quadrotors, strict=True):
            own |= {"lag_up": real.lag_up, "lag_down": real.lag_down, "max_speed": real.max_speed}
        tables["mission"]["duration"] = at + RECOVERY_TIME
        plan = FlightPlan(check(tables, mission.mission.name, quiet=True))
        self._first, self._last = round(at / plan.dt), round((at + RECOVERY_TIME) / plan.dt)
        self._stepper = Stepper(plan)
        for k in range(self._first):
            self._stepper.step(k)
        self._hover, self._ring = self._stepper.a.copy(), self._stepper.memory.ring.copy()

    def recovers(self, offset: Mapping[str, float]) -> bool:
        """Whether a flight with an offset, by the names of `DISTURBED`, is at rest `SETTLES` seconds later."""
        s = self._stepper
        s.a[:], s.memory.ring[:] = self._hover, self._ring
        disturb(s.a[:13], offset)
        s.memory.put("fresh", 1)
        for k in range(self._first, self._last):
            s.step(k)
            if s.lost:
                return False
        return bool(np.abs([*s.a[3:6], *s.a[10:13]]).max() < REST_RATE)

    def limit(self, name: str, predicted: float) -> FlownLimit:
        """The offset of one name from which flights no longer recover, above what is predicted."""
        low, high, most = 0.0, predicted, math.pi if name.startswith("attitude") else MAX_FACTOR * predicted
        while self.recovers({name: high}):
            low, high = high, min(2.0 * high, most)
            if low == most:
                return FlownLimit(low, math.inf, math.nan, "")
        low, high = bisected(lambda size: self.recovers({name: size}), low, high, ACCURACY)
        return FlownLimit(low, high, math.nan, "not at rest")


def _offset_claims(bounds: OffsetBounds, flights: OffsetFlights | None, command: str) -> Iterator[Claim]:
    for name in OFFSET_NAMES:
        what, axis = name.split(".")
        size = bounds.farthest({name: 1.0})
        shown = "" if size is None or what != "attitude" else f" ({math.degrees(size):.3g} deg)"
        text = f"with {what} off by less than this{shown} along {axis}, thrust limits do not prevent a return to hover"
        flown = flights.limit(name, size) if flights is not None and size is not None else None
        yield Claim("offset recovered", name, size, UNITS[what], text=text, command=command, flown=flown)


def box_of(half: Array) -> tuple[Array, Array]:
    """The ends (12, N) of the pieces of a box of states (12) about rest: its angles are cut in `PIECES`."""
    cuts = [np.linspace(-h, h, (PIECE_COUNT if 6 <= i < 9 else 1) + 1) for i, h in enumerate(half)]
    low, high = (np.meshgrid(*[c[part] for c in cuts], indexing="ij") for part in (slice(None, -1), slice(1, None)))
    return np.array([x.ravel() for x in low]), np.array([x.ravel() for x in high])


def _box_claims(pilot: PilotData, most: Sequence[float]) -> Iterator[Claim]:
    """Claims on the thrusts of a pilot in boxes of states; `most`: the largest of each rotor [N], none if ideal."""
    thrusts, sizes = commanded_thrusts(pilot.parameters, pilot.memory), np.repeat([*BOX.values()], 3)

    def within(half: Array) -> bool:
        low, high = bounds(thrusts, *box_of(half))
        return bool((low >= 0.0).all() and (high <= most).all())

    def finite(half: Array) -> bool:
        return bool(np.isfinite(bounds(thrusts, *box_of(half))).all())

    whole, most_angle = (
        tolerated(lambda scale: finite(scale * sizes), MAX_BOX_SCALE, BOX_BISECTIONS),
        MAX_BOX_SCALE * BOX["angles"],
    )
    text = f"within {_box_text(whole)}, no NaN"
    yield Claim("finite thrusts", "all", whole * BOX["angles"], "rad", text=text, tried=most_angle)
    if not most:
        return
    whole = tolerated(lambda scale: within(scale * sizes), MAX_BOX_SCALE, BOX_BISECTIONS)
    text = f"within {_box_text(whole)}"
    yield Claim("thrusts within limits", "all", whole * BOX["angles"], "rad", text=text, tried=most_angle)
    for i, (name, unit) in enumerate(zip(BOX, ("m", "m/s", "rad", "rad/s"), strict=True)):
        alone = sizes * (np.arange(12) // 3 == i)
        size = BOX[name] * tolerated(lambda scale: within(scale * alone), MAX_BOX_SCALE, BOX_BISECTIONS)  # noqa: B023
        text = f"with any {name} of up to this on each axis at once"
        yield Claim("thrusts within limits", name, size, unit, text=text, tried=MAX_BOX_SCALE * BOX[name])


def _box_text(scale: float) -> str:
    half = {name: scale * size for name, size in BOX.items()}
    return (
        f"±{half['position']:.3g} m, ±{half['velocity']:.3g} m/s, ±{math.degrees(half['angles']):.3g} deg and "
        f"±{half['rates']:.3g} rad/s of a hover at rest on each axis at once"
    )


ASSUMED = (
    "Sectors: the loop is linear about a calm hover but for the cut that is named: small angles, no wind, push, person "
    "or noise, no limit of tilt or slope; delay as flown, lag the mean of up and down.",
    "Sectors: what limits take away is known to the pilot's observer, as in flight; a rotor that fails is not.",
    "Sectors: what a cut takes away acts for a whole sample of the sensors' common period.",
    "Sectors: losses of one part reach the others only through the allocation, which gives up axes in the order of its "
    "priorities; each part is bounded as if the others kept theirs.",
    "Sectors: responses of one part to another below 2 % of the parts' own, or without a way back, are left out.",
    "Sectors: inequalities are checked in double precision, not by intervals.",
    "Sectors: what reduction left out is a further block of the loop with a proven bound of its gain.",
    "Offsets: the pilot knows of the offset by its sensors only, and all else is at rest. Flights that confirm it have "
    "every nonlinearity.",
    "Boxes: controller and allocation alone, without allocation.lead; estimates anywhere in the box, the reference at "
    "rest, memories as at the start; rounding of every operation is covered, in machine code too.",
)


def nonlinear_tier(mission: Mission, *, fly: bool = False) -> Tier:
    """Bounds on thrust limits, switching and laws; what cannot be bounded is left out, with the reason.

    Args:
        mission: to certify.
        fly: whether flights look for the offset at which each bound on offsets ends.

    Raises:
        InputError: cvxpy or SciPy is not installed.
    """
    claims, reasons = list[Claim](), list[str]()
    try:
        real = mission.actuators.model == "rotors"
        most = [q.thrust_limit for q in mission.vehicle.quadrotors for _ in range(4 * real)]
        claims += _box_claims(pilot_at_start(mission), most)
    except InputError as error:
        reasons.append(str(error))
    except (TypeError, AttributeError) as error:
        reasons.append(f"controller {mission.controller.name!r} does not run on intervals: {error}")
    solvers()
    try:
        loop = loop_of(mission)
        if AXES[0] not in loop.names:
            reasons.append(
                'thrust limits: only those of actuators.model = "rotors" with allocation.method = '
                '"constrained" are bounded'
            )
        if SURFACES[0] not in loop.names:
            reasons.append("switching: only that of nftsmc with tanh or saturation has a slope")
        allocation = mission.allocation
        priorities = allocation.priorities if allocation.method == "constrained" else ()
        claims += _sector_claims(loop, priorities)
        if AXES[0] in loop.names:
            axes = rotor_axes(mission.vehicle, allocation.weights)
            offsets, flights = OffsetBounds(loop, priorities, axes), OffsetFlights(mission) if fly else None
            claims += _offset_claims(offsets, flights, f"tandemlift certify {mission.mission.name} --fly")
    except InputError as error:
        reasons.append(str(error))
    return Tier("nonlinear", "Nonlinear, local", ASSUMED, tuple(claims), reason="; ".join(reasons))
