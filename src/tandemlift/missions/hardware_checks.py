"""What a mission asks of rotors, sensors and estimators: what no vehicle could do, and what may fly badly."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.algebra.constants import GRAVITY
from tandemlift.core.errors import InputError, suggestion
from tandemlift.core.sensors import ADDITIONAL
from tandemlift.core.settings import Mission
from tandemlift.missions.flight_checks.weight import lift_of, weight_of
from tandemlift.missions.values import shown
from tandemlift.parts.vehicle import Vehicle

MAX_DELAY = 10_000  # steps
WIDTH = 3.0  # of a push, in standard deviations


def check_hardware(m: Mission) -> None:
    """Refuse rotors that cannot lift the vehicle, and settings of faults, sensors and estimators that cannot be met.

    Raises:
        InputError: with the key, its value and what is allowed.
    """
    _check_faults(m)
    _check_lift(m)
    _check_delays(m)
    _check_additional(m)
    _check_readings(m)
    _check_tare(m)
    _check_windage(m)
    _check_observer(m)
    _check_detection(m)


def _check_faults(m: Mission) -> None:
    count, seen = len(m.vehicle.quadrotors), dict[tuple[int, int], int]()
    for i, f in enumerate(m.faults):
        if f.quadrotor > count:
            raise InputError(f"faults.{i}.quadrotor = {f.quadrotor}: must be from 1 to {count}, as many as there are")
        first = seen.setdefault((f.quadrotor, f.rotor), i)
        if first != i:
            where = f"rotor {f.rotor} of quadrotor {f.quadrotor}"
            raise InputError(f"faults.{i}.rotor = {f.rotor}: {where} must fail once, and does so in faults.{first}")
    if m.faults and m.actuators.model != "rotors":
        raise InputError('actuators.model = "ideal": must be "rotors" where there are faults, or nothing can fail')


def _check_lift(m: Mission) -> None:
    weight, lift = weight_of(m), lift_of(m)
    if m.actuators.model == "rotors" and weight > lift:
        raise InputError(
            f'actuators.model = "rotors": the vehicle weighs {weight:.4g} N'
            f"{f' (plant.mass_scale = {m.plant.mass_scale:g})' if m.plant.mass_scale != 1.0 else ''} "
            f'and its rotors lift {lift:.4g} N at most; it must be lighter, or the model "ideal"'
        )


def _check_additional(m: Mission) -> None:
    """Refuse additional sensors that are not registered, that there are twice, or that cannot be simulated."""
    for i, s in enumerate(m.sensors.additional):
        key = f"sensors.additional.{i}.name = {shown(s.name)}"
        if s.name not in ADDITIONAL:
            known = sorted(ADDITIONAL)
            raise InputError(f"{key}: must be one of {', '.join(known)}.{suggestion(s.name, known)}")
        if s.name in [other.name for other in m.sensors.additional[:i]]:
            raise InputError(f"{key}: must be different from the sensors above it")
    if m.sensors.additional and m.sensors.model == "none":
        raise InputError('sensors.model = "none": must be "simulated" where there are additional sensors')


def _check_delays(m: Mission) -> None:
    delays = {
        "actuators.delay": m.actuators.delay,
        "sensors.delay": m.sensors.delay,
        "sensors.motion.delay": m.sensors.motion.delay,
        "person.delay": m.person.delay,
    }
    delays |= {f"sensors.additional.{i}.delay": s.delay for i, s in enumerate(m.sensors.additional)}
    for key, delay in delays.items():
        if delay / m.mission.step > MAX_DELAY:
            raise InputError(f"{key} = {delay}: must be at most {MAX_DELAY} steps of mission.step = {m.mission.step}")


def _check_readings(m: Mission) -> None:
    if m.sensors.model == "simulated":
        return
    for key, reading in (("pilot.state", m.pilot.state), ("pilot.push", m.pilot.push)):
        if reading != "truth":
            raise InputError(
                f'{key} = "{reading}": must be "truth" without sensors, or sensors.model must be "simulated"'
            )


def _check_tare(m: Mission) -> None:
    e, step = m.estimator, m.mission.step
    if e.identify_mass and e.tare_start is None and e.tare == "at-time":
        raise InputError(
            "estimator.identify_mass = true: the payload's mass is identified during the tare: "
            "give estimator.tare_start, or do not identify"
        )
    interval = step * max(1, round(m.sensors.interval / step))
    if (e.tare_start is not None or e.tare == "hover") and e.tare_duration < interval:
        raise InputError(
            f"estimator.tare_duration = {e.tare_duration}: a tare must hold a sample: they come every {interval:g} s"
        )


def _check_windage(m: Mission) -> None:
    if m.estimator.wind_compensation == "none":
        return
    for axis, name in enumerate("xy"):
        if not any(q.drag_area[axis] * q.drag_coefficient > 0.0 for q in m.vehicle.quadrotors):
            raise InputError(
                'estimator.wind_compensation = "quadrotors": must be "none" where no quadrotor has drag along body '
                f"{name}: there its wind tells nothing"
            )


def _check_observer(m: Mission) -> None:
    if m.observer.model != "none" and m.allocation.method != "constrained":
        raise InputError(
            f'observer.model = "{m.observer.model}": must be "none" unless allocation.method is "constrained", '
            "which tells it what the rotors could give"
        )


def _check_detection(m: Mission) -> None:
    if m.detection.model != "none" and m.allocation.method != "constrained":
        raise InputError(
            f'detection.model = "{m.detection.model}": must be "none" unless allocation.method is "constrained", '
            "which alone can do without a rotor"
        )


def hardware_warnings(m: Mission) -> Iterator[str]:
    """What may fly badly, with the numbers."""
    if m.actuators.model == "rotors":
        yield from _of_hover(m)
        yield from _of_faults(m)
    elif weight_of(m) > lift_of(m):
        yield (
            f"the vehicle weighs {weight_of(m):.4g} N and its rotors lift {lift_of(m):.4g} N; it flies only because "
            "actuators.model is ideal"
        )
    if m.sensors.model == "simulated":
        yield from _of_ranges(m)
        yield from _of_mass(m)
        yield from _of_tare(m)


def _hover(m: Mission) -> NDArray[np.float64]:
    """Thrusts [N] of all rotors in hover as the allocation shares them out, (N × 4)."""
    inverse = Vehicle.from_settings(m.vehicle).allocation(m.allocation.weights)
    return inverse[:, 0].reshape(-1, 4) * weight_of(m)


def _of_hover(m: Mission) -> Iterator[str]:
    for i, (q, thrusts) in enumerate(zip(m.vehicle.quadrotors, _hover(m), strict=True), 1):
        worst = max(thrusts, key=lambda f: max(-f, f - q.max_thrust))
        if not 0.0 <= worst <= q.max_thrust:
            yield f"in hover a rotor of quadrotor {i} would give {worst:.4g} N and can give 0 to {q.max_thrust:.4g} N"


def _of_faults(m: Mission) -> Iterator[str]:
    weight, lift = weight_of(m), lift_of(m, faulty=True)
    if weight > lift:
        yield f"once all faults are there, the vehicle weighs {weight:.4g} N and its rotors lift {lift:.4g} N"
    known = [i for i, f in enumerate(m.faults) if f.known_after is not None]
    if known and m.allocation.method != "constrained":
        yield f'faults.{known[0]}.known_after is of use only where allocation.method is "constrained"'


def _of_ranges(m: Mission) -> Iterator[str]:
    s = m.sensors
    for i, (q, thrusts) in enumerate(zip(m.vehicle.quadrotors, _hover(m), strict=True), 1):
        force = thrusts.sum() - q.mass * GRAVITY
        if abs(force) > s.joints.force_range:
            yield f"sensors.joints.force_range = {s.joints.force_range}: joint {i} bears {force:.4g} N in hover"
    if s.accelerometer.range < GRAVITY:
        yield f"sensors.accelerometer.range = {s.accelerometer.range}: it reads {GRAVITY} m/s2 in hover"


def _of_mass(m: Mission) -> Iterator[str]:
    believed, vehicle = m.vehicle.payload.mass, Vehicle.from_settings(m.vehicle)
    real = believed + (m.plant.mass_scale - 1.0) * vehicle.mass
    if real <= 0.0:
        yield (
            f"plant.mass_scale = {m.plant.mass_scale}: what joints feel puts all of the difference to the payload, "
            f"which would weigh {real:.4g} kg"
        )


def _of_tare(m: Mission) -> Iterator[str]:
    e, p, joints = m.estimator, m.phases, m.sensors.joints
    if e.tare == "hover":
        return
    if e.tare_start is None:
        if m.pilot.push != "truth" and joints.force_bias > 0.0:
            bias = f"sensors.joints.force_bias = {joints.force_bias}"
            yield f"{bias} N is read as a push, as estimator.tare_start is left out"
        return
    end, lifted = e.tare_start + e.tare_duration, p.lift_start + p.lift_duration
    window = f"the tare, from {e.tare_start:g} s to {end:g} s,"
    if end > m.mission.duration:
        yield f"{window} is not over before the flight is, at {m.mission.duration:g} s: no push is ever estimated"
    if p.height and e.tare_start < lifted:
        yield f"{window} begins before the lift ends at {lifted:g} s"
    if p.land_start is not None and end > p.land_start:
        yield f"{window} ends after the landing begins at {p.land_start:g} s"
    for i, push in enumerate(m.pushes):
        if e.tare_start - WIDTH * push.sigma < push.time < end + WIDTH * push.sigma:
            yield f"{window} takes a part of pushes.{i} at {push.time:g} s for a bias"
