"""The paper's claims: what our flights give, what that is compared with, and a verdict for each."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.types import GRAVITY, Array
from tandemlift.flight.record import LATE, Flight
from tandemlift.missions import check
from tandemlift.pictures.drawing.panels import Mask
from tandemlift.pictures.report.paper_tables import agrees

UNTIL = 20.0  # s, before the pushes along x and y
WITHIN, LEVEL = 0.01, 0.1  # m or m/s, degrees: a smaller error counts as zero
SMALL_ANGLE = 14.0  # degrees: up to it, the sine of an angle is the angle within 1 %
REST = 5.0  # s without a push that is followed, after which errors should be zero
HOLDS, NOT, UNTESTED = "holds", "does not", "not tested"
MASS, INERTIA = "3.5", ("3.227327", "0.061286", "3.277117")  # kg, kg m2; Table II


class PaperClaim(NamedTuple):
    """A claim.

    Attributes:
        where: its place in the paper.
        says: its content, in our words.
        ours: our result.
        against: what our result is compared with, or what a test would need.
        verdict: `holds`, `does not` or `not tested`.
    """

    where: str
    says: str
    ours: str
    against: str
    verdict: str


def _judged(where: str, says: str, ours: str, against: str, holds: bool) -> PaperClaim:
    return PaperClaim(where, says, ours, against, HOLDS if holds else NOT)


def claims(paper: Flight, corridor: Flight) -> list[PaperClaim]:
    """The paper's claims beside the numbers of flights.

    Args:
        paper: a flight of the mission `paper`, or of the reader's.
        corridor: a flight through the corridor.
    """
    sections = [_of_the_vehicle, _of_tracking, _of_attitude, _of_the_law, _of_the_person]
    if paper.failure or paper.time[-1:].sum() < LATE:
        sections = [_of_the_vehicle, _of_the_end]
    return [*(claim for section in sections for claim in section(paper)), *_of_the_corridor(corridor)]


def _of_the_end(paper: Flight) -> Iterator[PaperClaim]:
    failed, ended = paper.failure[:1].upper() + paper.failure[1:], f"It ends at {paper.time[-1:].sum():g} s"
    against = f"A flight of {LATE:g} s or more that does not fail."
    verdict = NOT if failed else UNTESTED
    yield PaperClaim("Section IV", "The vehicle flies the whole task.", f"{failed or ended}.", against, verdict)


def _of_the_vehicle(paper: Flight) -> Iterator[PaperClaim]:
    vehicle = paper.vehicle
    same = agrees(MASS, vehicle.mass) and all(map(agrees, INERTIA, np.diag(vehicle.inertia)))
    inertia, height = ", ".join(f"{J:.6f}" for J in np.diag(vehicle.inertia)), 1e3 * vehicle.quadrotors[0].position[2]
    yield _judged(
        "Table II",
        f"Total mass {MASS} kg; total inertia {', '.join(INERTIA)} kg m².",
        f"{vehicle.mass:g} kg; {inertia} kg m², the sum of the parts with the quadrotors {height:g} mm above the "
        "beam's axis.",
        "The printed digits.",
        same,
    )
    metrics, most = paper.metrics(), check(dict(paper.mission), quiet=True).hover.largest_moments
    start, later = np.abs(metrics["command_at_start"] or [math.nan] * 4)[1:], metrics["moment_max_abs_after_10s_n_m"]
    yield _of_a_disturbed_start(
        paper,
        "Figure 7",
        "The inputs act on the disturbed start and then return to normal.",
        f"|U₂|, |U₃|, |U₄| are {_list(start, 1)} N m in the first step.",
        f"{_list(later or [], 1) or 'Nothing is known'} N m at most after {LATE:g} s, at pushes.",
        later is not None and bool(start.max() > max(later)),
    )
    largest = np.abs(paper["moment"]).max(axis=0, initial=0.0)
    when = "in the first step" if (largest <= start).all() else "at most"
    yield _judged(
        "Section IV",
        "A vehicle of two IRIS quadrotors makes these inputs.",
        f"{largest[0]:,.0f} N m of roll and {largest[2]:,.0f} N m of yaw are commanded, {when}. This flight has "
        f"{'ideal actuators' if paper.mission['actuators']['model'] == 'ideal' else 'rotors with limits'}.",
        f"{most[0]:.1f} N m of roll and {most[2]:.2f} N m of yaw: the most that the rotors can exert in hover, by any "
        "division of their thrusts.",
        bool((largest <= most).all()),
    )


def _of_a_disturbed_start(paper: Flight, where: str, says: str, ours: str, against: str, holds: bool) -> PaperClaim:
    """A claim of the disturbed start, which a flight without one does not test."""
    far = (np.abs(paper["position_error"][0]) > WITHIN).any() or (np.abs(paper["euler"][0]) > np.radians(1.0)).any()
    if far:
        return _judged(where, says, ours, against, holds)
    return PaperClaim(where, says, "This flight starts undisturbed.", f"A disturbed start. {against}", UNTESTED)


def _recovered(time: Array, error: Array) -> float:
    """The time [s] from which on all errors (T, 3) [m] stay small until `UNTIL`."""
    early = time <= UNTIL
    large = np.flatnonzero((error[early] > WITHIN).any(axis=1))
    return float(time[large[-1]]) if len(large) else 0.0


def _of_tracking(paper: Flight) -> Iterator[PaperClaim]:
    late = paper.time >= LATE
    error, speed = np.abs(paper["position_error"]), np.abs(paper["velocity_error"])
    recovered = _recovered(paper.time, error)
    yield _of_a_disturbed_start(
        paper,
        "Figure 6",
        "The controller recovers an aggressive start.",
        f"From {_list(error[0], 2)} m on x, y, z, all errors are small from {recovered:.1f} s until {UNTIL:g} s, "
        "before the pushes along x and y.",
        f"{1e3 * WITHIN:g} mm, from {LATE:g} s on.",
        recovered < LATE,
    )
    for what, unit, values in (("Position", "mm", error), ("Velocity", "mm/s", speed)):
        yield _judged(
            "Figure 6",
            f"{what} errors go to zero and stay there for the whole mission.",
            f"On x, y, z at most {_list(1e3 * _most(values, late), 2)} {unit} after {LATE:g} s, at pushes, and "
            f"{_list(1e3 * _most(values), 0)} {unit} over the flight.",
            f"{1e3 * WITHIN:g} {unit}, after {LATE:g} s.",
            bool((_most(values, late) < WITHIN).all()),
        )


def _most(values: Array, where: Any = slice(None)) -> Array:
    """The largest of some samples (T, n) along each axis (n); zeros where there is none."""
    return np.max(values[where], axis=0, initial=0.0)


def _quiet(paper: Flight) -> Mask:
    """Whether the admittance has not been driven for `REST` seconds (T,), after the disturbed start."""
    driven = paper.time[(paper["admittance_force"] != 0.0).any(axis=1)]
    last = np.searchsorted(driven, paper.time, side="right") - 1
    since = paper.time - driven[last] if len(driven) else np.full(len(paper.time), np.inf)
    return (paper.time >= LATE) & ((last < 0) | (since > REST))


def _of_attitude(paper: Flight) -> Iterator[PaperClaim]:
    late = paper.time >= LATE
    angles, errors = (np.degrees(np.abs(paper[name])) for name in ("euler", "attitude_error"))
    yaw, tilt, small = _most(angles, late)[2], _most(angles, late)[:2], _most(angles)[:2]
    yield _judged(
        "Figure 6",
        "Yaw is kept at zero.",
        f"It stays within {max(yaw, 0.001):.3f}° after {LATE:g} s; it starts at {angles[0, 2]:.1f}°.",
        f"{LEVEL:g}°, after {LATE:g} s.",
        bool(yaw < LEVEL),
    )
    calm = float(_most(errors, _quiet(paper)).max())
    yield _judged(
        "Figure 6",
        "Orientation errors fluctuate at pushes, are bounded, and go to zero after each.",
        f"They reach {_most(errors, late).max():.2f}° after {LATE:g} s and {_most(errors).max():.1f}° over the flight; "
        f"{REST:g} s after a push they are {max(calm, 0.001):.3f}° at most.",
        f"{LEVEL:g}°, {REST:g} s after a push.",
        calm < LEVEL,
    )
    yield _judged(
        "Section IV",
        "The vehicle flies near hover, with small angles.",
        f"Roll and pitch stay within {_list(small, 1, '°')} over the flight, within {_list(tilt, 1, '°')} after "
        f"{LATE:g} s.",
        f"{SMALL_ANGLE:g}°, up to which a sine is its angle within 1 %.",
        bool((small < SMALL_ANGLE).all()),
    )


def _of_the_law(paper: Flight) -> Iterator[PaperClaim]:
    theorem = "The closed loop is asymptotically stable: V falls whenever it is not zero."
    if paper.mission["controller"]["name"] == "nftsmc":
        gains = paper.mission["controller"]["gains"]
        e, early = paper["position_error"][:, :2], paper.time <= 1.0
        xi, eta, a = (np.array(gains[name][:2]) for name in ("xi", "eta", "a"))
        S = (paper["velocity_error"][:, :2] + xi * e + eta * np.sign(e) * np.abs(e) ** a)[early]
        rising = 100.0 * np.mean(np.diff(S**2, axis=0) > 0.0, axis=0) if len(S) > 1 else np.zeros(2)
        yield _of_a_disturbed_start(
            paper,
            "Theorem 1",
            theorem,
            f"In the first second V rises in {_list(rising, 0, ' %')} of the samples on x, y, which are commanded "
            "through the attitude. On an axis that is commanded directly, it falls (erratum `Theorem 1`).",
            "0 % of the samples.",
            not rising.any(),
        )
    else:
        yield PaperClaim("Theorem 1", theorem, "This mission has another controller.", "The paper's.", UNTESTED)
    yield PaperClaim(
        "Abstract",
        "The controller is robust, and its response is fast.",
        "Not flown here: `tandemlift study` flies disturbances and uncertainties.",
        "A disturbance, an uncertainty or a time; the paper gives none.",
        UNTESTED,
    )


def gaussian_displacement(push: dict[str, Any], admittance: dict[str, Any], axis: int) -> float:
    """The motion of T_r by a Gaussian push along an axis [m]: the impulse that passes the gate, by the damping."""
    A, sigma = float(push["force"][axis]), float(push["sigma"])
    threshold, C = float(admittance["threshold"][axis]), float(admittance["damping"][axis])
    if abs(A) <= threshold or threshold == 0.0:
        return 0.0 if threshold else A * sigma * math.sqrt(2.0 * math.pi) / C
    d = sigma * math.sqrt(2.0 * math.log(abs(A) / threshold))
    taken = 2.0 * d * math.copysign(threshold, A) if admittance.get("gate") == "soft" else 0.0
    return (A * sigma * math.sqrt(2.0 * math.pi) * math.erf(d / (sigma * math.sqrt(2.0))) - taken) / C


def _of_the_person(paper: Flight) -> Iterator[PaperClaim]:
    admittance, pushes = paper.mission["admittance"], paper.mission.get("pushes", [])
    moved, pilot = paper["admittance_position"][-1], paper.mission["pilot"]
    says, over = "The reference moves in proportion to the push, with full compliance.", paper.time[-1] - REST
    closed_form = pilot["guidance"] == "scheduled" and pilot["push"] == "truth" and not any(admittance["stiffness"])
    if closed_form and all(push["time"] + 5.0 * push["sigma"] < over for push in pushes):
        expected = [sum(gaussian_displacement(p, admittance, axis) for p in pushes) for axis in range(3)]
        apart = float(np.abs(moved - expected).max())
        closed = f"{_list(expected, 3)} m, impulse over damping in closed form, within {1e3 * WITHIN:g} mm."
        ours = f"T_r moves by {_list(moved, 3)} m along x, y, z, {1e3 * apart:.2g} mm apart."
        yield _judged("Figures 4, 8", says, ours, closed, apart < WITHIN)
    else:
        against = "A closed form, which other guidance, a spring or a push that still acts does not have."
        yield PaperClaim("Figures 4, 8", says, f"T_r moves by {_list(moved, 3)} m along x, y, z.", against, UNTESTED)
    off = (paper["admittance_force"][1:] == 0.0).all(axis=1)
    coasted = float(np.linalg.norm(np.diff(paper["admittance_position"], axis=0)[off], axis=1).sum())
    yield _judged(
        "Figure 8",
        "Below the threshold the position is held, beyond it the admittance responds.",
        f"The admittance is driven in {100.0 * (1.0 - off.mean()):.0f} % of the time. While it is not, T_r coasts to "
        f"rest: {coasted:.2f} m in all.",
        f"{1e3 * WITHIN:g} mm.",
        coasted < WITHIN,
    )
    yield from _of_workload(paper)


def _of_workload(paper: Flight) -> Iterator[PaperClaim]:
    weight, z = paper.vehicle.payload.mass * GRAVITY, paper["position"][:, 2]
    work, step = paper.metrics()["human_work_j"], float(np.diff(paper.time[:2]).sum())
    held = float(np.linalg.norm(paper["push_force"], axis=1).sum()) * step
    largest = float(np.linalg.norm(paper["push_force"], axis=1).max())
    up = float(np.mean(z > z[0] + WITHIN)) * paper.time[-1]
    yield _judged(
        "Abstract",
        "The person's workload is reduced, as work.",
        f"The person does {work or math.nan:.1f} J by pushing, on a way of {_way(paper):.1f} m.",
        f"{weight * (z.max() - z[0]):.1f} J: the {weight:.1f} N of the payload alone, lifted by hand to "
        f"{z.max() - z[0]:.2f} m. The vehicle's {paper.vehicle.weight:.1f} N would not be carried.",
        work is not None and bool(work < weight * (z.max() - z[0])),
    )
    yield _judged(
        "Abstract",
        "The person's workload is reduced, as force over time.",
        f"The person pushes with {held:.0f} N s in all, {largest:.1f} N at most.",
        f"{weight * up:.0f} N s: the payload held by hand for the {up:.0f} s that it is up.",
        held < weight * up,
    )
    says = "Interaction is intuitive, seamless and safe."
    yield PaperClaim("Abstract", says, "No person takes part.", "A study with people.", UNTESTED)


def _way(flight: Flight) -> float:
    return float(np.linalg.norm(np.diff(flight["position"][:, :2], axis=0), axis=1).sum())


def _of_the_corridor(corridor: Flight) -> Iterator[PaperClaim]:
    metrics = corridor.metrics()
    clear, force = metrics["clearance_min_m"], metrics["human_force_mean_n"]
    yield _judged(
        "Figure 9",
        "Pushed through a zigzag corridor, the vehicle lands at its end.",
        f"{corridor.outcome.capitalize()} after {_way(corridor):.1f} m, {clear:.2f} m clear of the walls at least, "
        f"with a mean push of {force:.1f} N.",
        "Landed, and no wall is touched.",
        corridor.outcome == "landed" and not metrics["wall_contact"],
    )
    yield PaperClaim(
        "Figure 9",
        "It does so in ROS and Gazebo.",
        f"This report's engine is {corridor.version.get('engine', 'unknown')}.",
        "`tandemlift gazebo zigzag`, which needs Gazebo 11.",
        UNTESTED,
    )


def _list(values: Iterable[float], digits: int, unit: str = "") -> str:
    return ", ".join(f"{value + 0.0:,.{digits}f}{unit}" for value in values).replace("-", "−")
