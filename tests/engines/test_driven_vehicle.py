"""The vehicle under logged commands, against Newton and Euler in SciPy and closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from law_values import array, random_attitude
from scipy.integrate import quad, solve_ivp
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.vector import ZERO, Vec3, set_of, vec3
from tandemlift.engines.driven_vehicle import (
    AT_REST,
    DrivenInputs,
    DrivenReadings,
    DrivenRotor,
    driven_body,
    driven_step,
    rotor_step,
    vehicle_numbers,
)
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.wind import WindTable

STEP, GRAVITY = 1e-3, 9.81  # s, m/s²
TABLE = tl.load_mission("iris").vehicle
NUMBERS = vehicle_numbers(TABLE)._replace(drag_force=ZERO, drag_moment=ZERO)
VEHICLE = Vehicle.from_settings(TABLE)
CENTER = np.array(VEHICLE.center_of_mass)  # m, from the payload's origin
SPEEDS = np.array([620.0, 640.0, 600.0, 630.0, 615.0, 625.0, 650.0, 605.0])  # rad/s


def body(air: WindTable | None = None, point: Vec3 = ZERO) -> Any:
    return driven_body(TABLE, None, air or WindTable(), NUMBERS, point, STEP)


def inputs(speeds: Any = 0.0, force: Any = ZERO, moment: Any = ZERO) -> DrivenInputs:
    return DrivenInputs(set_of(np.broadcast_to(np.square(speeds), 8).tolist()), vec3(force), vec3(moment))


def tumbling(rates: Any = (1.3, -2.1, 0.7)) -> State:
    return State(Vec3(1.0, -2.0, 3.0), Vec3(0.4, 0.3, 2.0), random_attitude(np.random.default_rng(3)), vec3(rates))


def wrench(speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force [N] and moment about the centre of mass [N m] of the rotors, body axes, summed hub by hub."""
    force, moment = np.zeros(3), np.zeros(3)
    for i, q in enumerate(TABLE.quadrotors):
        for (x, y), spin, speed in zip(q.rotors, q.spins, speeds[4 * i : 4 * i + 4], strict=True):
            thrust = np.array([0.0, 0.0, q.thrust_constant * speed**2])
            force += thrust
            hub = np.array(q.position) + np.array([x, y, 0.0])
            moment += np.cross(hub - CENTER, thrust) + spin * q.torque_per_thrust * thrust
    return force, moment


def after(s: State, u: DrivenInputs, steps: int, b: Any = None) -> tuple[State, list[DrivenReadings]]:
    """The state after some steps, and the readings at their starts."""
    b, readings = b or body(), []
    for _ in range(steps):
        s, felt = driven_step(b, s, u)
        readings.append(felt)
    return s, readings


def rotation(s: State) -> Rotation:
    return Rotation.from_quat(array(s.attitude), scalar_first=True)


def test_with_its_rotors_off_it_falls_freely_and_tumbles_as_euler_says():
    """The centre of mass follows a parabola, the body Euler's equations without a moment, by SciPy's DOP853."""
    start, J = tumbling(), VEHICLE.inertia

    def rates(_, y):
        q, w = y[:4], y[4:]
        turn = np.array([-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))]) / 2.0
        return np.append(turn, np.linalg.solve(J, -np.cross(w, J @ w)))

    end, _ = after(start, inputs(), 400)
    t = 400 * STEP
    y0 = np.append(array(start.attitude), array(start.rates))
    exact = solve_ivp(rates, (0.0, t), y0, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    fallen = array(start.position) + array(start.velocity) * t + np.array([0.0, 0.0, -0.5 * GRAVITY * t * t])
    assert array(end.position) == pytest.approx(fallen, abs=1e-12)
    assert (rotation(end) * Rotation.from_quat(exact[:4], scalar_first=True).inv()).magnitude() < 1e-9
    assert array(end.rates) == pytest.approx(exact[4:], abs=1e-9)


def test_a_tumble_keeps_energy_and_angular_momentum():
    start, J = tumbling(), VEHICLE.inertia
    end, _ = after(start, inputs(), 400)
    turned = [rotation(s).apply(J @ array(s.rates)) for s in (start, end)]
    energy = [array(s.rates) @ J @ array(s.rates) for s in (start, end)]
    assert turned[1] == pytest.approx(turned[0], rel=1e-10)
    assert energy[1] == pytest.approx(energy[0], rel=1e-10)


def test_the_accelerometer_reads_thrust_over_mass_at_the_payload_s_origin():
    """f = F/m + α × r + ω × (ω × r): no weight, and the turning of a place beside the centre of mass."""
    s, (force, moment), w = tumbling(), wrench(SPEEDS), np.array([1.3, -2.1, 0.7])
    _, felt = driven_step(body(), s, inputs(SPEEDS))
    turn = np.linalg.solve(VEHICLE.inertia, moment - np.cross(w, VEHICLE.inertia @ w))
    expected = force / VEHICLE.mass + np.cross(turn, -CENTER) + np.cross(w, np.cross(w, -CENTER))
    assert array(felt.specific_force) == pytest.approx(expected, abs=1e-11)


def test_the_joints_carry_the_payload():
    """Newton and Euler of the payload alone: nothing but its weight and the joints' forces and torques moves it."""
    s, (force, moment), w = tumbling(), wrench(SPEEDS), np.array([1.3, -2.1, 0.7])
    _, felt = driven_step(body(), s, inputs(SPEEDS))
    turn = np.linalg.solve(VEHICLE.inertia, moment - np.cross(w, VEHICLE.inertia @ w))
    at_center = force / VEHICLE.mass + np.cross(turn, -CENTER) + np.cross(w, np.cross(w, -CENTER))
    forces, torques = (np.array(list(zip(*axes, strict=True))) for axes in (felt.joint_force, felt.joint_torque))
    J = np.diag(TABLE.payload.moments)
    arms = [np.array(q.joint_position) for q in TABLE.quadrotors]
    about = sum(np.cross(arm, one) for arm, one in zip(arms, forces, strict=True)) + torques.sum(axis=0)
    assert forces.sum(axis=0) == pytest.approx(TABLE.payload.mass * at_center, abs=1e-10)
    assert about == pytest.approx(J @ turn + np.cross(w, J @ w), abs=1e-10)


def test_a_push_at_the_payload_s_origin_turns_the_vehicle_about_its_centre_of_mass():
    push = np.array([2.0, -1.0, 0.5])
    rest, u = AT_REST, inputs(force=push)
    moved, _ = driven_step(body(), rest, u)
    turn = np.linalg.solve(VEHICLE.inertia, np.cross(-CENTER, push))
    assert array(moved.velocity) / STEP == pytest.approx(push / VEHICLE.mass - (0.0, 0.0, GRAVITY), abs=1e-5)
    assert array(moved.rates) / STEP == pytest.approx(turn, abs=1e-5)


def test_wind_drags_by_half_its_density_times_coefficient_times_area_times_speed_squared():
    wind, density = 3.0, 1.2
    air = WindTable(model="air", velocity=(wind, 0.0, 0.0), density=density)
    moved, _ = driven_step(body(air), AT_REST, inputs())
    area = sum(part.drag_coefficient * part.areas[0] for part in (TABLE.payload, *TABLE.quadrotors))
    assert moved.velocity.x / STEP == pytest.approx(0.5 * density * area * wind**2 / VEHICLE.mass, rel=1e-4)


def test_motion_capture_follows_a_point_of_the_body():
    """Its velocity is the derivative of its position, by central differences of the flown positions."""
    _, felt = after(tumbling(), inputs(SPEEDS), 3, body(point=Vec3(0.2, -0.4, 0.1)))
    slope = (array(felt[2].position) - array(felt[0].position)) / (2.0 * STEP)
    assert array(felt[1].velocity) == pytest.approx(slope, abs=1e-5)


@pytest.mark.parametrize(("begin", "command"), [(500.0, 700.0), (700.0, 500.0), (0.0, 1100.0)])
def test_a_rotor_s_thrust_over_a_step_is_the_integral_of_its_squared_speed(begin, command):
    """It approaches the command exponentially, by its time constant up or down."""
    up, down, step = 0.0125, 0.025, 4e-3
    lag = up if command > begin else down

    def speed(t: float) -> float:
        return command + (begin - command) * np.exp(-t / lag)

    rotor, square = rotor_step(step, DrivenRotor(begin, up, down), command)
    assert square == pytest.approx(quad(lambda t: speed(t) ** 2, 0.0, step, epsabs=1e-10)[0] / step, rel=1e-12)
    assert rotor.speed == pytest.approx(speed(step), rel=1e-14)
