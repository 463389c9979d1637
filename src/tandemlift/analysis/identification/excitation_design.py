"""`tl.excite`: the flight from which a vehicle can be identified best, within tilt, thrust, speed and room.

Thrust, roll, pitch and yaw get lines at frequencies of their own, whole numbers of periods within the excitation. With
the share q of a line in the limits of its axis, the information is Σ q I, and q minimizes the sum of
(deviation/target)² by the multiplicative algorithm, whose optimum is the global one. As the vehicle is not known yet,
half of the shares are spread evenly over all lines. Phases keep the peaks low. Slow motions of the reference along x
and y bring speed, for the drag of the air. Doublets of pushes follow, if a person is asked for them. Then the mission
is flown, and lowered until it keeps its limits. What it promises is what an identification from its own log finds.

Sources: Silvey, Titterington and Torsney, An algorithm for optimal designs on a finite design space, 1978; Schroeder,
Synthesis of low-peak-factor signals, 1970.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tandemlift.analysis.identification.excitation_information import (
    AXES,
    PARAMETERS,
    WEIGHED,
    ExcitedHover,
    excited_hover,
)
from tandemlift.analysis.identification.identification import Row
from tandemlift.analysis.identification.identify import identify
from tandemlift.core.errors import InputError, without_flight_warnings
from tandemlift.core.types import GRAVITY, Array
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, MissionLike, built_in, check, format_toml, load_mission, mission_of, tables_of
from tandemlift.simulation.fly import fly

LOWEST, HIGHEST, LINES = 0.2, 6.0, 10  # Hz; candidates of each axis
RAMP, PERIODS, SETTLES = 2.0, 3.0, 2.0  # s; of the lowest line, at least; s before and after the excitation
SHARE = 0.2  # of thrust, tilt, room and speed, for the peak of each axis
SPEED = 1.0  # m/s, of the vehicle
PEAK = 1.5  # times the root of the summed squares of amplitudes, until phases are chosen
ROUNDS, TRIALS = 300, 300  # of the algorithm; of phases
EVEN, SLIGHT = 0.5, 0.05  # of the shares, spread evenly; of an axis' largest amplitude, below which lines are left out
LEAST_ROOM = 0.2  # m
LOWER, TRIES = 0.8, 6  # factor of all amplitudes while a flight exceeds a limit; flights
REMOVED = ("pushes", "requests", "changes", "faults", "sensor_faults", "person")
SEEN = {"thrust": "mass, thrust constant, centre of mass; lag, delay", "yaw": "inertia about z over the yaw drag"}
PUSH_SIGMA, PUSH_EVERY = 0.4, 3.0  # s: of a push over time; from push to push
PROMISED_KEY = re.compile(
    r"mass|(inertia|center_of_mass)\.[xyz]|.*\.(thrust_constant|torque_per_thrust|lag_up|lag_down|delay)"
)


@dataclass(frozen=True)
class ExcitationDesign:
    """A mission that excites its vehicle, what it promises, and what it took of each limit when it was flown.

    Attributes:
        mission: the mission.
        promised: the numbers of the vehicle, as an identification from the log of its own flight has them, all parts
            being weighed.
        used: largest value and limit by name: tilt [rad], rotor thrust [N], speed [m/s], room along each axis [m].
        base: name of the built-in mission that it extends, or "".
    """

    mission: Mission
    promised: tuple[Row, ...]
    used: dict[str, tuple[float, float]]
    base: str

    def lines(self) -> Iterator[str]:
        """The promised intervals and the limits, in words."""
        e = self.mission.excitation
        yield f"{self.mission.mission.name}: excited from {e.begin:g} s for {e.duration:g} s by {len(e.lines)} sines"
        for p in self.mission.pushes:
            force, place = (np.round(v, 2).tolist() for v in (p.force, p.point))
            yield f"{p.time:g} s: a person pushes for a second, with about {force} N, {place} m from the centre of mass"
        yield "95 % interval, with all parts weighed to 0.1 % and the noise of the mission's sensors, in calm air:"
        for row in self.promised:
            relative = row.key != "actuators.delay" and not row.key.startswith("center_of_mass")
            factor, unit = (100.0 / row.value, "%") if relative else (1e3, f"m{row.unit}")
            yield f"  {row.key:<38} ± {factor * row.half:.2g} {unit}{'' if row.excited else ', not excited'}"
        for name, (value, limit) in self.used.items():
            unit = {"tilt": "rad", "rotor thrust": "N", "speed": "m/s"}.get(name, "m")
            yield f"  {name:<38} {value:.3g} of {limit:.3g} {unit}"

    def text(self) -> str:
        """The mission file, with what each axis excites and the promised intervals as comments."""
        tables = tables_of(self.mission)
        if self.base:
            base = tables_of(load_mission(self.base))
            tables = {"extends": self.base} | {k: v for k, v in tables.items() if v != base.get(k)}
        return "".join(f"# {line}\n" for line in [*self.lines(), *self._axes()]) + "\n" + format_toml(tables)

    def _axes(self) -> Iterator[str]:
        for axis in (*AXES, "x", "y"):
            mine = [line for line in self.mission.excitation.lines if line.axis == axis]
            if mine:
                about = SEEN.get(axis, "air drag" if axis in "xy" else f"inertia about {'xy'[axis == 'pitch']}")
                low, high = min(line.frequency for line in mine), max(line.frequency for line in mine)
                yield f"{axis}: {len(mine)} lines from {low:.2g} to {high:.2g} Hz: {about}"


def excite(
    mission: MissionLike, time: float = 60.0, *, room: Sequence[float] = (2.0, 2.0, 1.0), push: float = 0.0
) -> ExcitationDesign:
    """The excitation of a mission's vehicle that tells most of its parameters, flown once to see that limits are kept.

    Args:
        mission: from `load_mission`, or its name or path; without its pushes, requests, changes, faults and person.
        time: of the excitation [s].
        room: size for the centre of mass along each world axis [m].
        push: force [N] with which a person is asked to push to and fro along x, y and z, and beside the middle, after
            the sines; 0 for none. Logged by a force gauge, pushes tell masses and inertias without a scale.

    Returns:
        The mission, the promised intervals, and what it used of its limits.

    Raises:
        InputError: the time or the room is too short, the mission has no real rotors or no noisy sensors, or its
            excited flight fails.
    """
    mission = mission_of(mission)
    shortest = 3.0 * RAMP + PERIODS / LOWEST
    if not (math.isfinite(time) and time >= shortest):
        raise InputError(f"time = {time:g}: must be at least {shortest:g} s, {PERIODS:g} periods of {LOWEST:g} Hz")
    if len(room) != 3 or not all(math.isfinite(size) and size >= LEAST_ROOM for size in room):
        raise InputError(f"room = {list(room)}: must be three sizes of at least {LEAST_ROOM:g} m")
    if not (math.isfinite(push) and push >= 0.0):
        raise InputError(f"push = {push:g}: must be a force in N, or 0 for no pushes")
    limits, tables = limits_of(mission, room), excited_tables(mission, time, room, push)
    pushes, fine = tables["pushes"], {"log_interval": mission.mission.step}
    rows, slow = best_lines(mission, time - 3.0 * RAMP, limits)[0], reference_lines(time, limits)
    for scale in LOWER ** np.arange(TRIES):
        lowered = [row | {"amplitude": float(f"{scale * row['amplitude']:.3g}")} for row in rows]
        tables["excitation"]["lines"] = lowered + slow
        tables["pushes"] = [row | {"force": [float(f"{scale * x:.3g}") for x in row["force"]]} for row in pushes]
        with without_flight_warnings():
            made = check(tables, tables["mission"]["name"], quiet=True)
            flight = fly(check(tables | {"mission": tables["mission"] | fine}, made.mission.name, quiet=True))
        used = used_of(flight, limits)
        beyond = [f"{key} {value:.3g} of {limit:.3g}" for key, (value, limit) in used.items() if value > limit]
        beyond += [finding.kind for finding in flight.findings]
        if not beyond:
            known = mission.mission.name
            base = known if known in built_in() and load_mission(known) == mission else ""
            return ExcitationDesign(made, promised_by(flight, made), used, base)
    raise InputError(f"{made.mission.name}: no excitation keeps the limits of its flight: {', '.join(beyond)}")


def promised_by(flight: Flight, mission: Mission) -> tuple[Row, ...]:
    """The numbers that an identification from a flight of a mission finds, all parts being weighed."""
    table = mission.vehicle
    weighed = {f"vehicle.quadrotors.{i}.mass": q.mass for i, q in enumerate(table.quadrotors)}
    found = identify(flight, mission, weighed={"vehicle.payload.mass": table.payload.mass, **weighed}, held_back=0.0)
    return tuple(row for row in (*found.whole, *found.rows) if PROMISED_KEY.fullmatch(row.key))


def push_rows(quadrotors: Iterable[Sequence[float]], begin: float, force: float) -> list[dict[str, Any]]:
    """Pushes to and fro along x, y and z; and across the arm to the outermost quadrotor, amid it, which turns.

    Args:
        quadrotors: their positions [m].
        begin: of the pushes [s].
        force: of each [N].
    """
    outermost = max(quadrotors, key=lambda p: math.hypot(p[0], p[1]))
    x, y, size = 0.5 * outermost[0], 0.5 * outermost[1], 0.5 * math.hypot(outermost[0], outermost[1])
    ways = [([force * (i == axis) for i in range(3)], [0.0] * 3) for axis in range(3)]
    if size > 0.0:
        ways.append(([force * y / size, -force * x / size, 0.0], [x, y, 0.0]))
    each = [([sign * f + 0.0 for f in way], point) for way, point in ways for sign in (1.0, -1.0)]
    return [
        {"force": way, "point": point, "time": begin + PUSH_EVERY * (i + 0.5), "sigma": PUSH_SIGMA}
        for i, (way, point) in enumerate(each)
    ]


def best_lines(mission: Mission, steady: float, limits: dict[str, float]) -> tuple[list[dict[str, Any]], Array]:
    """(The lines of thrust, roll, pitch and yaw, their information (P × P) within a time [s])."""
    places, hover = line_frequencies(steady), mission.hover
    excited, mixing = excited_hover(mission, places.ravel()), hover.vehicle.allocation(hover.allocation.weights)
    most = largest_amplitudes(excited, mixing, hover.thrusts.ravel(), limits).reshape(places.shape)
    axis, whole = np.repeat(np.arange(len(AXES)), LINES), excited.information
    each = steady * whole[np.arange(len(axis)), axis].reshape(*places.shape, *whole.shape[2:])
    amplitudes = most * np.sqrt(best_shares(each * most[..., None, None] ** 2))
    amplitudes *= amplitudes > SLIGHT * amplitudes.max(axis=1, keepdims=True)
    rows = [row for name, f, A in zip(AXES, places, amplitudes, strict=True) for row in axis_lines(name, f, A)]
    return rows, np.einsum("ak,akij->ij", amplitudes**2, each)


def line_frequencies(steady: float) -> Array:
    """Frequencies (4 × LINES) [Hz]: whole numbers of periods within a time [s], each of one axis alone, interleaved."""
    numbers = list[int]()
    for wanted in np.geomspace(LOWEST, HIGHEST, len(AXES) * LINES) * steady:
        numbers.append(max(round(wanted), numbers[-1] + 1 if numbers else 1))
    return np.array(numbers).reshape(LINES, len(AXES)).T / steady


def limits_of(mission: Mission, room: Sequence[float]) -> dict[str, float]:
    """The limits of an excited flight: tilt [rad], rotor thrust [N], speed [m/s], room along each axis [m]."""
    tilt = getattr(mission.controller, "max_tilt", None) or mission.compliance.max_tilt
    strongest = min(q.thrust_limit for q in mission.hover.vehicle.quadrotors)
    return {"tilt": tilt, "rotor thrust": strongest, "speed": SPEED} | {
        f"room along {axis}": float(size) for axis, size in zip("xyz", room, strict=True)
    }


def largest_amplitudes(excited: ExcitedHover, mixing: Array, rest: Array, limits: dict[str, float]) -> Array:
    """The largest amplitudes of lines (4 · LINES) [N, N m] by their axis' share of each limit, also without control.

    `mixing`: thrusts from a wrench (4N × 4); `rest`: thrusts of the hover (4N) [N].
    """
    axis = np.repeat(np.arange(len(AXES)), LINES)
    at = np.arange(len(axis))
    motion = np.maximum(np.abs(excited.motion[at, :, axis]), np.abs(excited.free[at, :, axis]))
    thrusts = np.maximum(np.abs(excited.thrusts[at, :, axis]), np.abs(mixing[:, axis].T))
    left = np.minimum(rest, limits["rotor thrust"] - rest)
    rooms = np.array([limits[f"room along {axis}"] for axis in "xyz"])
    place, velocity, tilts = motion[:, :3], motion[:, 3:6], motion[:, 6:8]
    taken = np.hstack([thrusts / left, velocity / limits["speed"], tilts / limits["tilt"], 2.0 * place / rooms])
    return SHARE / (PEAK * taken.max(axis=1))


def best_shares(information: Array) -> Array:
    """The shares (4 × LINES), 1 in the sum of each axis, of lines whose full information is (4 × LINES × P × P)."""
    targets = np.array([p.target for p in PARAMETERS])
    scaled = information * np.outer(targets, targets)
    weighed = np.zeros_like(scaled[0, 0])
    weighed[0, 0] = (targets[0] / WEIGHED) ** 2
    q = np.full(information.shape[:2], 1.0 / LINES)
    for _ in range(ROUNDS):
        inverse = np.linalg.inv(np.einsum("ak,akij->ij", q, scaled) + weighed)
        q *= np.sqrt(np.einsum("akij,ji->ak", scaled, inverse @ inverse))
        q /= q.sum(axis=1, keepdims=True)
    return (1.0 - EVEN) * q + EVEN / LINES


def axis_lines(axis: str, frequencies: Array, amplitudes: Array) -> list[dict[str, Any]]:
    """Lines of an axis with phases of a low peak: those by Schroeder, or the best of some by chance."""
    kept = amplitudes > 0.0
    f, A = frequencies[kept], amplitudes[kept]
    power = A**2 / (A**2).sum()
    schroeder = -2.0 * math.pi * np.concatenate([[0.0], np.cumsum(np.cumsum(power))[:-1]])
    chance = np.random.default_rng(0).uniform(0.0, 2.0 * math.pi, (TRIALS, len(f)))
    t = np.arange(0.0, 1.0 / np.diff(f, prepend=0.0).min(), 1.0 / (12.0 * f.max()))
    waves = np.exp(2j * math.pi * np.outer(f, t))
    phases = np.vstack([schroeder, chance])
    peaks = np.abs(((A * np.exp(1j * phases)) @ waves).imag).max(axis=1)
    best = np.mod(phases[np.argmin(peaks)], 2.0 * math.pi)
    return [
        {"axis": axis, "frequency": round(float(x), 6), "amplitude": float(a), "phase": round(float(p), 3)}
        for x, a, p in zip(f, A, best, strict=True)
    ]


def reference_lines(time: float, limits: dict[str, float]) -> list[dict[str, Any]]:
    """A slow motion of the reference along x and y, at most half of room and speed, that falls where it began."""
    rows = list[dict[str, Any]]()
    for axis, wanted in (("x", 0.1), ("y", 0.14)):
        f = max(round(wanted * (time - 1.5 * RAMP)), 1) / (time - 1.5 * RAMP)  # so that it is 0 amid the fall
        omega = 2.0 * math.pi * f
        reach = min(
            limits[f"room along {axis}"] / 4.0, limits["speed"] / 2.0 / omega, 0.2 * limits["tilt"] * GRAVITY / omega**2
        )
        rows.append({"axis": axis, "frequency": round(f, 6), "amplitude": round(reach, 3), "phase": 0.0})
    return rows


def excited_tables(mission: Mission, time: float, room: Sequence[float], push: float = 0.0) -> dict[str, Any]:
    """The tables of the mission: lift, tare, excitation, pushes of a force [N], landing; nothing else happens."""
    t = {key: table for key, table in tables_of(mission).items() if key not in REMOVED}
    p, e = mission.phases, mission.estimator
    begin = p.lift_start + p.lift_duration
    if mission.pilot.push != "truth":
        begin += e.tare_duration if e.tare == "hover" else 0.0
        begin = max(begin, e.tare_start + e.tare_duration if e.tare == "at-time" and e.tare_start is not None else 0.0)
    begin = math.ceil(begin + SETTLES)
    t["pushes"] = push_rows([q.position for q in mission.vehicle.quadrotors], begin + time, push) if push else []
    lands = begin + time + SETTLES + PUSH_EVERY * len(t["pushes"])
    t["mission"] |= {"name": f"{mission.mission.name}-excited", "duration": lands + p.land_duration + SETTLES}
    t["phases"] |= {"land_start": lands}
    when = {"begin": float(begin), "duration": float(time), "ramp": RAMP}
    t["excitation"] = {"model": "multisine", **when, "room": [float(size) for size in room]}
    return t


def used_of(flight: Flight, limits: dict[str, float]) -> dict[str, tuple[float, float]]:
    """The largest value until the landing of each limit's quantity, and the limit."""
    begins, lands = flight.mission["excitation"]["begin"], flight.mission["phases"].get("land_start")
    within = (flight.time >= begins) & (flight.time <= (lands or math.inf))
    cosines = np.cos(flight["euler"][within, :2]).prod(axis=1)
    values = [
        float(np.arccos(cosines).max()),
        float(flight["rotor_thrusts"][within].max()),
        float(np.linalg.norm(flight["velocity"][within], axis=1).max()),
        *np.ptp(flight["position"][within], axis=0).tolist(),
    ]
    return {name: (value, limits[name]) for name, value in zip(limits, values, strict=True)}
