"""Excitation of a flight that is flown to identify the vehicle: sines added to the commanded wrench and the reference.

Each line is one sine of one axis. Along thrust, roll, pitch and yaw, w(t) Σ A sin(2π f s + φ) with s = t − begin is
added to the wrench that the controller commands, after its lead and before the allocation, so that the observer and
the detection of rotor failures know of it. Along x, y and z the reference moves by the same sum, in m: it is given the
velocity of that motion, so that limits of speed and acceleration hold, and pushes are not followed meanwhile. The
window w rises from 0 to 1 and falls to 0 by quintic smooth steps, a ramp before the end, so that no load jumps, and
the reference returns and comes to rest.

Sources: Schroeder, Synthesis of low-peak-factor signals, 1970 (phases); Morelli, Multiple input design for real-time
parameter estimation, 2003 (one set of lines for each axis, so that all are excited at once).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

import numpy as np

from tandemlift.core.algebra import chosen, cos, maximum, sin, where
from tandemlift.core.errors import CheckResult, judged, refused
from tandemlift.core.keys import NonNegative, Positive, Positive3, Table, key
from tandemlift.core.law import elementwise, law
from tandemlift.core.part import FlightCheck, Part
from tandemlift.core.trajectories import PhasesTable, smoothstep
from tandemlift.core.types import GRAVITY, Array, Number, NumberSet
from tandemlift.core.vector import Absent, Vec3, total
from tandemlift.parts.guidance.requests import ReferenceVelocity, padded_set
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.rotors.hover import HoverFacts

WRENCH, MOTION = ("thrust", "roll", "pitch", "yaw"), ("x", "y", "z")
AXES = {
    "thrust": "force along body z",
    "roll": "moment about body x",
    "pitch": "moment about body y",
    "yaw": "moment about body z",
    "x": "position along world x",
    "y": "position along world y",
    "z": "position along world z",
}


class LineTable(Table):
    """`[[excitation.lines]]`: a sine along one axis each: amplitude · sin(2π frequency (t − begin) + phase)."""

    axis: Literal["thrust", "roll", "pitch", "yaw", "x", "y", "z"] = key(
        ..., None, "the quantity to which the sine is added", choices=AXES, example="yaw"
    )
    frequency: Positive = key(..., "Hz", "frequency", rule="one period within the duration", example=0.5)
    amplitude: NonNegative = key(
        ..., "N, N m or m", "amplitude: of thrust in N, of a moment in N m, of the reference in m", example=0.2
    )
    phase: float = key(0.0, "rad", "phase at the beginning", source="a sine that begins at 0")


class ExcitationTable(Table, acts='excitation.model = "multisine"'):
    """`[excitation]`: sines on top of what the pilot commands, from which the vehicle can be identified.

    `tandemlift excite` chooses them. The floor and the rotors' start are no part of it: it acts in flight only.
    """

    model: Literal["none", "multisine"] = key(
        "none",
        None,
        "excitation of the flight",
        choices={"none": "none", "multisine": "the sum of the sines of `excitation.lines`"},
    )
    begin: NonNegative = key(0.0, "s", "begin", rule="not before the end of the lift", example=13.0)
    duration: Positive = key(
        30.0, "s", "duration", rule="within the flight, and until the landing", source="chosen: hundreds of turns"
    )
    ramp: Positive = key(
        1.0, "s", "time of rise, of fall and of rest after it", rule="at most a third of the duration", source="chosen"
    )
    room: Positive3 = key(
        (2.0, 2.0, 1.0), "m", "size of the room for the centre of mass along each world axis", source="chosen"
    )
    lines: tuple[LineTable, ...] = ()


class Sines(NamedTuple):
    """Σ A sin(ω s + φ): amplitudes, angular frequencies [rad/s], phases [rad]; sets with a value for each line."""

    amplitude: NumberSet
    omega: NumberSet
    phase: NumberSet


class ReferenceSines(NamedTuple):
    """The sines of the reference along each world axis."""

    x: Sines | Absent
    y: Sines | Absent
    z: Sines | Absent


class Excitation(NamedTuple):
    """The window: begin and end [s], 1/ramp [1/s], begin of the fall [s]; the sines of thrust, moments, reference."""

    begin: Number
    end: Number
    ramp_rate: Number
    fall: Number
    thrust: Sines | Absent
    roll: Sines | Absent
    pitch: Sines | Absent
    yaw: Sines | Absent
    motion: ReferenceSines | Absent


@elementwise
def sine(amplitude: Number, omega: Number, phase: Number, s: Number) -> Number:
    """A sin(ω s + φ)."""
    return amplitude * sin(omega * s + phase)


@elementwise
def sine_rate(amplitude: Number, omega: Number, phase: Number, s: Number) -> Number:
    """Its derivative A ω cos(ω s + φ)."""
    return amplitude * omega * cos(omega * s + phase)


@law(absent=0.0)
def sum_of(k: Sines, s: Number) -> Number:
    """The sum of sines at a time s [s] after the begin."""
    return total(sine(k.amplitude, k.omega, k.phase, s))


@law(absent=0.0)
def windowed_rate(k: Sines, s: Number, window: Number, rate: Number) -> Number:
    """d/dt (w Σ A sin) = w Σ A ω cos + ẇ Σ A sin."""
    return window * total(sine_rate(k.amplitude, k.omega, k.phase, s)) + rate * sum_of(k, s)


@law
def window(k: Excitation, t: Number) -> tuple[Number, Number]:
    """(w, ẇ [1/s]) at time t [s]."""
    rise, fall = smoothstep(t, k.begin, k.ramp_rate), smoothstep(t, k.fall, k.ramp_rate)
    return rise.value - fall.value, rise.rate - fall.rate


@law(absent="u")
def excited(k: Excitation, u: Wrench, flying: Number, t: Number) -> Wrench:
    """The wrench u with the excitation at time t [s], as far as the vehicle is `flying` (1, or 0 on the ground)."""
    w, s = window(k, t)[0] * flying, t - k.begin
    moment = Vec3(sum_of(k.roll, s), sum_of(k.pitch, s), sum_of(k.yaw, s))
    return Wrench(u.thrust + sum_of(k.thrust, s) * w, u.moment + moment * w)


@law(absent="own")
def combined(lead: ReferenceVelocity, own: ReferenceVelocity) -> ReferenceVelocity:
    """The velocity of the excitation, or outside its window that of a caller, `lead`."""
    return ReferenceVelocity(chosen(own.given, own.velocity, lead.velocity), maximum(own.given, lead.given))


@law(absent="lead")
def sines_velocity(
    motion: ReferenceSines, k: Excitation, lead: ReferenceVelocity | Absent, t: Number
) -> ReferenceVelocity:
    """The velocity of the reference [m/s, world axes] at time t [s]; `lead`: a caller's, or `Absent`."""
    (w, rate), s = window(k, t), t - k.begin
    velocity = Vec3(*[windowed_rate(axis, s, w, rate) for axis in motion])
    within = where(t < k.begin, 0.0, where(t < k.end, 1.0, 0.0))
    return combined(lead, ReferenceVelocity(velocity, within))


@law(absent="lead")
def excited_lead(k: Excitation, lead: ReferenceVelocity | Absent, t: Number) -> ReferenceVelocity | Absent:
    """The velocity that the reference is given at time t [s]: the excitation's, a caller's, or `Absent`."""
    return sines_velocity(k.motion, k, lead, t)


def start_excitation(table: ExcitationTable) -> Excitation:
    """The excitation."""
    # the fall ends a ramp before the end, in which the reference comes to rest
    end, along = table.begin + table.duration, {axis: sines_from(table.lines, axis) for axis in AXES}
    moves = any(not isinstance(along[axis], Absent) for axis in MOTION)
    motion = ReferenceSines(*[along[axis] for axis in MOTION]) if moves else Absent()
    return Excitation(
        begin=table.begin,
        end=end,
        ramp_rate=1.0 / table.ramp,
        fall=end - 2.0 * table.ramp,
        thrust=along["thrust"],
        roll=along["roll"],
        pitch=along["pitch"],
        yaw=along["yaw"],
        motion=motion,
    )


def sines_from(lines: Sequence[LineTable], axis: str) -> Sines | Absent:
    """The sines along an axis, or `Absent` without any."""
    mine = [line for line in lines if line.axis == axis]
    if not mine:
        return Absent()
    return Sines(
        amplitude=padded_set([line.amplitude for line in mine]),
        omega=padded_set([2.0 * math.pi * line.frequency for line in mine]),
        phase=padded_set([line.phase for line in mine]),
    )


def time_checks(table: ExcitationTable, phases: PhasesTable, step: float, end: float) -> Iterator[CheckResult]:
    """Check for an excitation without lines, outside the flight until its `end` [s], or too short for a line."""
    e, lifted = table, phases.lift_start + phases.lift_duration
    if e.model == "none":
        return
    if not e.lines:
        yield refused('excitation.model = "multisine": needs one of excitation.lines or more, or must be "none"')
    if e.begin < lifted:
        yield refused(f"excitation.begin = {e.begin:g}: must be at least {lifted:g} s, the end of the lift")
    until = min(end, math.inf if phases.land_start is None else phases.land_start)
    if e.begin + e.duration > until:
        yield refused(
            f"excitation.duration = {e.duration:g}: must be at most {until - e.begin:g} s, from excitation.begin until "
            "the landing or the end of the flight"
        )
    if 3.0 * e.ramp > e.duration:
        yield refused(f"excitation.ramp = {e.ramp:g}: must be at most {e.duration / 3.0:g} s, a third of the duration")
    slowest, fastest = 1.0 / e.duration, 0.5 / step
    for i, line in enumerate(e.lines):
        if not slowest <= line.frequency < fastest:
            yield refused(
                f"excitation.lines.{i}.frequency = {line.frequency:g}: must be at least {slowest:.3g} Hz, one period "
                f"within excitation.duration, and below {fastest:g} Hz, half of the sample rate"
            )


def excitation_checks(table: ExcitationTable, hover: HoverFacts, max_tilt: float) -> Iterator[CheckResult]:
    """Check thrusts, tilt (limit [rad]) and room of an excitation, without the controller, which resists it."""
    wrench = np.array([over_time(table, axis) for axis in WRENCH])
    change = hover.vehicle.allocation(hover.allocation.weights) @ wrench
    most = np.repeat([q.thrust_limit for q in hover.vehicle.quadrotors], 4)
    rest = hover.thrusts.ravel()
    share = max(float((change.max(axis=1) / (most - rest)).max()), float((-change.min(axis=1) / rest).max()))
    text = (
        f"the excitation takes {100.0 * share:.3g} % of the thrust that a rotor has left in hover: lower "
        "excitation.lines.*.amplitude along thrust, roll, pitch and yaw"
    )
    yield judged("excitation", share, 1.0, "1", text, subject="thrust")
    J = np.diag(hover.vehicle.real_inertia(hover.plant))
    tilts = [
        np.abs(over_time(table, a, 2)) / J[i] + np.abs(over_time(table, b, -2)) / GRAVITY
        for i, (a, b) in enumerate(TILTING)
    ]
    tilt = float(np.hypot(*tilts).max())
    text = (
        f"the excitation tilts the vehicle by {tilt:.3g} rad, and {max_tilt:g} rad is allowed: lower "
        "excitation.lines.*.amplitude along roll, pitch, x and y, or raise the frequencies along roll and pitch"
    )
    yield judged("excitation", tilt, max_tilt, "rad", text, subject="tilt")
    moved = [GRAVITY / J[1] * over_time(table, "pitch", 4), GRAVITY / J[0] * over_time(table, "roll", 4)]
    moved.append(over_time(table, "thrust", 2) / hover.mass)
    for axis, size, way in zip(MOTION, table.room, moved, strict=True):
        reach = 2.0 * float((np.abs(over_time(table, axis)) + np.abs(way)).max())
        text = (
            f"the excitation takes a room of {reach:.3g} m along {axis}, and excitation.room has {size:g} m: lower "
            f"excitation.lines.*.amplitude along {axis}, or excite at higher frequencies"
        )
        yield judged("excitation", reach, size, "m", text, subject=f"room along {axis}")


TILTING = (("roll", "y"), ("pitch", "x"))  # axes that tilt about body x and about body y
SAMPLES_OF_A_PERIOD = 12  # samples of a period of the fastest line


def over_time(table: ExcitationTable, axis: str, integrals: int = 0) -> Array:
    """The excitation along an axis over its duration, integrated so many times over time (below 0: differentiated)."""
    fastest = max(line.frequency for line in table.lines)
    s = np.linspace(0.0, table.duration, int(SAMPLES_OF_A_PERIOD * fastest * table.duration) + 2)
    total_of = np.zeros(len(s))
    for line in table.lines:
        if line.axis == axis:
            omega = 2.0 * math.pi * line.frequency
            phase = line.phase - 0.5 * math.pi * integrals
            total_of += line.amplitude * omega**-integrals * np.sin(omega * s + phase)
    return total_of


EXCITATION = Part(
    *("excitation", "pilot", "excitation", ExcitationTable.acts, start_excitation),
    remembers=False,
    refusals=time_checks,
    checks=excitation_checks,
    rows=(
        FlightCheck(
            "excitation",
            "change of a rotor's thrust; tilt; way of the centre of mass, by the excitation without the controller",
            "what the rotor has left in hover; the largest tilt that the controller or the guidance commands; the room",
            "1, rad, m",
            f"`{ExcitationTable.acts}`",
            "`excitation.lines`, `excitation.room`",
        ),
    ),
    begins=lambda table: table.begin,
)
