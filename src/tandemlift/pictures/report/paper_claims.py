"""The paper's claims, beside the numbers of our flights of the same missions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.pictures.report.paper_tables import agrees

CALM = 10.0  # s, from which on the disturbed start is over
UNTIL = 20.0  # s, before the pushes along x and y
WITHIN = 0.01  # m, of the position's error: the start is recovered
YES, PARTLY, NO = "agrees", "in part", "differs"
MASS, INERTIA = "3.5", ("3.227327", "0.061286", "3.277117")  # kg, kg m2; Table II


class PaperClaim(NamedTuple):
    """A claim: its place in the paper, its content, our result, and whether they agree."""

    where: str
    says: str
    ours: str
    verdict: str


def claims(paper: Flight, corridor: Flight) -> list[PaperClaim]:
    """The claims of the paper that a number of ours can be put beside.

    Args:
        paper: a flight of the mission `paper`.
        corridor: a flight through the corridor.
    """
    return [*_of_the_vehicle(paper), *_of_tracking(paper), *_of_the_person(paper), *_of_the_corridor(corridor)]


def _of_the_vehicle(paper: Flight) -> Iterator[PaperClaim]:
    vehicle = paper.vehicle
    same = agrees(MASS, vehicle.mass) and all(map(agrees, INERTIA, np.diag(vehicle.inertia)))
    inertia, height = ", ".join(f"{J:.6f}" for J in np.diag(vehicle.inertia)), 1e3 * vehicle.quadrotors[0].position[2]
    yield PaperClaim(
        "Table II",
        f"Total mass {MASS} kg; total inertia {', '.join(INERTIA)} kg m².",
        f"{vehicle.mass:g} kg; {inertia} kg m², the sum of the parts if the quadrotors "
        f"are {height:g} mm above the beam's axis.",
        YES if same else NO,
    )
    moment, most = np.abs(paper["moment"]), _most_moments(paper)
    roll, _, yaw = moment.max(axis=0)
    yield PaperClaim(
        "Figure 7",
        "The inputs recover the disturbed start and then return to normal.",
        f"At the start {roll:,.0f} N m of roll and {yaw:,.0f} N m of yaw are commanded. Two IRIS quadrotors give less "
        f"than {math.ceil(most[0])} and {math.ceil(most[2])} N m, so the mission has ideal actuators.",
        PARTLY if roll > most[0] else YES,
    )


def _most_moments(paper: Flight) -> Array:
    """Bounds of the moments (3) [N m]: all rotors that help at full thrust, the others at none."""
    thrusts = np.repeat([q.thrust_limit for q in paper.vehicle.quadrotors], 4)
    return np.maximum(paper.vehicle.effect[1:], 0.0) @ thrusts


def _of_tracking(paper: Flight) -> Iterator[PaperClaim]:
    late = paper.time >= CALM
    error = np.abs(paper["position_error"])
    recovered = _recovered(paper.time, error)
    yield PaperClaim(
        "Figure 6",
        "The controller recovers an aggressive start.",
        f"From {_list(np.abs(paper['position_error'][0]), 2)} m on x, y, z, all errors stay below "
        f"{1e3 * WITHIN:g} mm from {recovered:.1f} s until {UNTIL:g} s, before the pushes along x and y.",
        YES if recovered < CALM else NO,
    )
    largest = 1e3 * error[late].max(axis=0)
    yield PaperClaim(
        "Figure 6",
        "Position errors go to zero and stay there for the whole mission.",
        f"After {CALM:g} s they are at most {_list(largest, 2)} mm on x, y, z: each push raises them, and they decay "
        "after it.",
        PARTLY,
    )
    velocity = 1e3 * np.abs(paper["velocity_error"])[late].max(axis=0)
    yield PaperClaim(
        "Figure 6",
        "Velocity errors go to zero and stay there.",
        f"At most {_list(velocity, 2)} mm/s on x, y, z, also during pushes.",
        PARTLY,
    )
    yaw = float(np.degrees(np.abs(paper["euler"])[late, 2].max()))
    attitude = float(np.degrees(np.abs(paper["attitude_error"])[late].max()))
    yield PaperClaim(
        "Figure 6",
        "Yaw is kept at zero.",
        f"After {CALM:g} s yaw stays within {max(yaw, 0.001):.3f}°.",
        YES if yaw < 0.1 else NO,
    )
    yield PaperClaim(
        "Figure 6",
        "Orientation errors fluctuate when pushes start and stop, and are bounded.",
        f"They reach {attitude:.2f}° after {CALM:g} s, at pushes.",
        YES,
    )
    tilt = np.degrees(np.abs(paper["euler"][late, :2]).max(axis=0))
    yield PaperClaim(
        "Section IV",
        "The vehicle flies near hover, with small angles.",
        f"Roll and pitch stay within {tilt[0]:.1f}° and {tilt[1]:.1f}°.",
        YES,
    )
    yield PaperClaim(
        "Theorem 1",
        "The closed loop is asymptotically stable.",
        "It holds on each axis under virtual actuation, not through the attitude (erratum `Theorem 1`).",
        PARTLY,
    )


def _recovered(time: Array, error: Array) -> float:
    """The time [s] from which on all errors (T, 3) [m] stay small until `UNTIL`."""
    early = time <= UNTIL
    large = np.flatnonzero((error[early] > WITHIN).any(axis=1))
    return float(time[large[-1]]) if len(large) else 0.0


def gaussian_displacement(push: dict[str, Any], admittance: dict[str, Any], axis: int) -> float:
    """The motion of T_r by a Gaussian push along an axis [m]: the impulse that passes a hard gate, by the damping."""
    A, sigma = float(push["force"][axis]), float(push["sigma"])
    threshold, C = float(admittance["threshold"][axis]), float(admittance["damping"][axis])
    if abs(A) <= threshold:
        return 0.0
    d = sigma * math.sqrt(2.0 * math.log(abs(A) / threshold))
    return A * sigma * math.sqrt(2.0 * math.pi) * math.erf(d / (sigma * math.sqrt(2.0))) / C


def _of_the_person(paper: Flight) -> Iterator[PaperClaim]:
    admittance, pushes = paper.mission["admittance"], paper.mission["pushes"]
    expected = [sum(gaussian_displacement(p, admittance, axis) for p in pushes) for axis in range(3)]
    moved = paper["admittance_position"][-1]
    apart = 1e3 * float(np.abs(moved - expected).max())
    yield PaperClaim(
        "Figures 4, 8",
        "The reference moves in proportion to the push; with K = 0 the vehicle complies fully.",
        f"T_r moves by {_list(moved, 3)} m along x, y, z. Impulse over damping, in closed form, gives "
        f"{_list(expected, 3)} m, {apart:.2g} mm apart.",
        YES if apart < 10.0 else NO,
    )
    on = float(np.mean((paper["admittance_force"] != 0.0).any(axis=1)))
    yield PaperClaim(
        "Figure 8",
        "Below the threshold the position is held, beyond it the admittance responds.",
        f"The admittance is driven in {100.0 * on:.0f} % of the time. After each push it coasts to rest.",
        YES,
    )
    work = paper.metrics()["human_work_j"]
    yield PaperClaim(
        "Abstract",
        "The person's workload is reduced.",
        f"The person does {work:.1f} J of work on a way of {_way(paper):.1f} m; the vehicle weighs "
        f"{paper.vehicle.weight:.1f} N.",
        YES,
    )


def _way(flight: Flight) -> float:
    return float(np.linalg.norm(np.diff(flight["position"][:, :2], axis=0), axis=1).sum())


def _of_the_corridor(corridor: Flight) -> Iterator[PaperClaim]:
    metrics = corridor.metrics()
    clear, force = metrics["clearance_min_m"], metrics["human_force_mean_n"]
    sound = corridor.outcome == "landed" and not metrics["wall_contact"]
    yield PaperClaim(
        "Figure 9",
        "Pushed through a zigzag corridor, the vehicle lands at its end.",
        f"{corridor.outcome.capitalize()} after {_way(corridor):.1f} m, {clear:.2f} m clear of the walls at least, "
        f"with a mean push of {force:.1f} N.",
        YES if sound else NO,
    )


def _list(values: Iterable[float], digits: int) -> str:
    return ", ".join(f"{value + 0.0:.{digits}f}" for value in values).replace("-", "−")
