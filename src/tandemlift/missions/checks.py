"""What can be flown at all, and what may fly badly: checks across the keys of a mission."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator

import numpy as np

from tandemlift.core.caching import kept
from tandemlift.core.errors import FlightWarning, InputError
from tandemlift.core.sensors import ADDITIONAL
from tandemlift.core.settings import Mission, VehicleTable
from tandemlift.core.settings.outcomes import promise_of
from tandemlift.missions.flight_checks.schedule import check_heights
from tandemlift.missions.flight_checks.table import flight_warnings
from tandemlift.missions.hardware_checks import check_hardware, hardware_warnings
from tandemlift.missions.person_checks import check_person, person_warnings
from tandemlift.missions.supervision_checks import check_supervision
from tandemlift.missions.surroundings_checks import check_surroundings, surroundings_warnings
from tandemlift.missions.values import shown
from tandemlift.parts.vehicle import Vehicle

MAX_STEPS = 1_000_000_000
MAX_LOG = 4_000_000_000  # bytes
LEAST_RATIO = 1e-12  # of the principal moments of inertia
PRECISION = 1e-6  # of the allocation
ABOVE = 0.05  # m, between rotors that turn above each other: blades bend


def check_flyable(m: Mission) -> None:
    """Refuse what no pilot could fly.

    Raises:
        InputError: with the key, its value and what is allowed.
    """
    _check_times(m)
    _check_vehicle(m.vehicle, m.allocation.weights)
    _check_admittance(m)
    check_hardware(m)
    check_surroundings(m)
    check_supervision(m)
    check_person(m)
    _check_outcomes(m)
    check_heights(m)


def sample_size(m: Mission) -> int:
    """Bytes of a logged sample: 8 for its time and for each number of the channels that the mission has."""
    count = len(m.vehicle.quadrotors)
    numbers = {
        "time, state, reference, admittance, push, wrench; rotors and joints": 51 + 10 * count,
        "commands of real rotors": (5 + 4 * count) * (m.actuators.model == "rotors"),
        "wind": 6 * (m.wind.model == "air"),
        "force of floor and walls": 3 * (m.ground.model == "floor"),
        "readings and estimates": (45 + 6 * count) * (m.sensors.model == "simulated"),
        "additional sensors": sum(ADDITIONAL[s.name].width for s in m.sensors.additional if s.name in ADDITIONAL),
        "observer": 12 * (m.observer.model != "none"),
        "guidance by hand": 10 * (m.pilot.guidance == "interactive"),
        "contact": 13 * (m.contact.model == "on"),
        "supervision": 2 * (m.supervision.model == "on"),
        "rotor-failure detection": 1 * (m.detection.model != "none"),
    }
    return 8 * sum(numbers.values())


def _check_times(m: Mission) -> None:
    """Refuse a grid of steps that is empty, endless or would not fit in memory, and a landing before the lift."""
    t, phases = m.mission, m.phases
    if t.step > t.duration:
        raise InputError(f"mission.step = {t.step}: must not be longer than mission.duration = {t.duration}")
    if t.duration / t.step > MAX_STEPS:
        count = f"makes {t.duration / t.step:.3g} steps of mission.step = {t.step}"
        raise InputError(f"mission.duration = {t.duration}: {count}; at most {MAX_STEPS:.0e} are allowed")
    size = t.steps / t.log_every * sample_size(m)
    if size > MAX_LOG:
        longer = f"must be at least {t.log_interval * size / MAX_LOG:.2g}"
        raise InputError(
            f"mission.log_interval = {t.log_interval}: {longer}, or the log exceeds {MAX_LOG / 1e9:.0f} GB"
        )
    if phases.land_start is not None and phases.land_start < phases.lift_start:
        limit = f"must not be before phases.lift_start = {phases.lift_start}"
        raise InputError(f"phases.land_start = {phases.land_start}: {limit}")


@kept
def _check_vehicle(table: VehicleTable, weights: tuple[tuple[float, ...], ...]) -> None:
    """Refuse a vehicle that cannot be computed with, or an allocation that loses the wrench."""
    vehicle = Vehicle.from_settings(table)
    try:
        with np.errstate(all="ignore"):
            moments = np.linalg.eigvalsh(vehicle.inertia)
            both = vehicle.effect @ vehicle.allocation(weights)
            sound = math.isfinite(vehicle.max_thrust) and moments[0] > LEAST_RATIO * moments[-1]
    except (OverflowError, np.linalg.LinAlgError):
        sound, both = False, np.eye(4)
    if not sound:
        raise InputError(
            "vehicle: masses, moments of inertia or positions are too large or too far apart to compute with"
        )
    if not np.all(np.abs(both - np.eye(4)) <= PRECISION):
        raise InputError(
            f"allocation.weights = {shown(weights)}: must not be so far apart, or the wrench is lost in rounding"
        )
    _check_rotors(vehicle)


def _check_rotors(vehicle: Vehicle) -> None:
    """Refuse rotors whose discs would strike each other."""
    hubs = (vehicle.lever_arms[:, None] + np.array(vehicle.rotor_hubs)).reshape(-1, 3)
    radii = np.repeat([q.rotor_radius for q in vehicle.quadrotors], 4)
    apart = np.linalg.norm(hubs[:, None, :2] - hubs[None, :, :2], axis=2)
    level = np.abs(hubs[:, None, 2] - hubs[None, :, 2]) < ABOVE
    least = radii[:, None] + radii
    strike = np.argwhere(np.triu(level & (apart < least * (1.0 - 1e-9)), 1))
    if len(strike):
        first, second = strike[0].tolist()
        names = " and ".join(f"rotor {rotor % 4 + 1} of quadrotor {rotor // 4 + 1}" for rotor in (first, second))
        i, q = second // 4, vehicle.quadrotors[second // 4]
        given = f"rotor_radius = {q.rotor_radius}" if first // 4 == i else f"position = {shown(q.position)}"
        limit = f"must be {least[first, second]:.3g} m or more, or one {ABOVE:g} m above the other"
        raise InputError(
            f"vehicle.quadrotors.{i}.{given}: {names} strike each other: from hub to hub are "
            f"{apart[first, second]:.3g} m, and it {limit}"
        )


def _check_admittance(m: Mission) -> None:
    """Refuse an admittance that grows without a push when sampled: an eigenvalue beyond the unit circle."""
    a, h = m.admittance, m.mission.step
    for axis, (M, C, K) in enumerate(zip(a.mass, a.damping, a.stiffness, strict=True)):
        # z² − (2 − c − k/2) z + 1 − c + k/2 with c = Ch/M, k = Kh²/M; Jury's conditions come to k/2 ≤ c ≤ 2
        least, most = K * h / 2.0, 2.0 * M / h
        if not least * (1.0 - 1e-12) <= C <= most * (1.0 + 1e-12):
            raise InputError(
                f"admittance.damping = {C} along {'xyz'[axis]}: must be from stiffness*step/2 = {least:.6g} to "
                f"2*mass/step = {most:.6g} N s/m with mass {M:g} kg, stiffness {K:g} N/m and step {h:g} s, "
                "or the admittance swings up by itself"
            )


def _check_outcomes(m: Mission) -> None:
    """Refuse promises and thresholds that contradict each other."""
    tilt = math.acos(math.cos(m.initial.euler[0]) * math.cos(m.initial.euler[1]))
    if tilt >= m.crash.tilt:
        given = f"initial.euler = {shown(m.initial.euler)}"
        raise InputError(
            f"{given}: must tilt by less than crash.tilt = {m.crash.tilt:.4g}, and does so by {tilt:.4g} rad"
        )
    f, promise = m.findings, promise_of(m.promise, m.pilot.guidance)
    if promise.rms_promised(m.pilot.guidance) > promise.distance:
        given = f"promise.rms_distance = {promise.rms_distance}"
        raise InputError(f"{given}: must not be above promise.distance = {promise.distance}, the largest distance")
    if promise.tilt >= m.crash.tilt:
        given = f"promise.tilt = {promise.tilt}"
        raise InputError(f"{given}: must be below crash.tilt = {m.crash.tilt}, where the flight ends")
    if f.reach_distance <= promise.distance:
        given = f"findings.reach_distance = {f.reach_distance}"
        raise InputError(f"{given}: must be above promise.distance = {promise.distance}, which is no finding yet")
    if f.fastest_oscillation <= f.slowest_oscillation:
        given = f"findings.fastest_oscillation = {f.fastest_oscillation}"
        raise InputError(f"{given}: must be above findings.slowest_oscillation = {f.slowest_oscillation}")
    most = 0.25 / m.mission.step
    if f.slowest_oscillation >= most:
        given = f"findings.slowest_oscillation = {f.slowest_oscillation}"
        raise InputError(f"{given}: must be below {most:g}, a quarter of the steps a second (mission.step)")


def _promise_warnings(m: Mission) -> Iterator[str]:
    """Promises that no vehicle can keep: below what the sensors tell, or below what a landing asks for."""
    promise, motion = promise_of(m.promise, m.pilot.guidance), m.sensors.motion
    sensed = m.sensors.model == "simulated" and m.pilot.state != "truth"
    position, attitude = math.sqrt(3.0) * motion.position_noise, motion.attitude_noise
    for name, value, least, key in (
        ("rms_distance", promise.rms_promised(m.pilot.guidance), position, "sensors.motion.position_noise"),
        ("distance", promise.distance, position, "sensors.motion.position_noise"),
        ("heading", promise.heading, attitude, "sensors.motion.attitude_noise"),
    ):
        if sensed and value < least:
            given = f"promise.{name} = {value} cannot be kept"
            yield f"{given}: a measurement alone is {least:.2g} off, root mean square ({key}); expect a finding"
    depth = m.compliance.touchdown_depth
    lands = m.ground.model == "floor" and m.phases.land_start is not None and m.phases.land_start < m.mission.duration
    if m.pilot.guidance == "interactive" and lands and promise.distance <= depth:
        given = f"promise.distance = {promise.distance} cannot be kept"
        yield f"{given}: a landing's reference ends {depth:g} m below the ground (compliance.touchdown_depth)"


def _phase_warnings(m: Mission) -> Iterator[str]:
    p = m.phases
    lifted = p.lift_start + p.lift_duration
    if p.height and p.land_start is not None and p.land_start < lifted:
        yield f"phases.land_start = {p.land_start} is before the lift ends at {lifted:g} s: it is cut short"


def setting_warnings(m: Mission) -> Iterator[str]:
    """What may fly badly by settings that do not fit each other."""
    yield from (*_phase_warnings(m), *_promise_warnings(m), *hardware_warnings(m))
    yield from (*surroundings_warnings(m), *person_warnings(m))


def warn(m: Mission, source: str) -> None:
    """Warn of what may fly badly, with the numbers."""
    for message in (*setting_warnings(m), *flight_warnings(m)):
        warnings.warn(f"{source}: {message}", FlightWarning, stacklevel=5)
