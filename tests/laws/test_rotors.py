"""Rotors: the answer to a step of command, its impulse, delay, limits, faults, and thrust near the floor."""

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from tandemlift.jit import flat, install, load, store, zeroed
from tandemlift.laws.body import State
from tandemlift.laws.rotors import Faults, FreeAir, Sound, Spinning, drive, ground_effect, near_ground, rotors_of
from tandemlift.vector import ZERO, Quat, Vec3, each
from tandemlift.vehicle import Vehicle

from .helpers import BEAM, quadrotor

K, UP, DOWN, FASTEST = 5.84e-6, 0.0125, 0.025, 1100.0  # N/(rad/s)², s, s, rad/s
MOST = K * FASTEST**2
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
ABOVE = State(Vec3(0.0, 0.0, 9.0), ZERO, LEVEL, ZERO)
ROTORS = each(4)
RADIUS = 0.128  # m


class Driven(NamedTuple):
    """What a step of the rotors depends on."""

    rotors: Any
    memory: Any
    state: State


def lone(**changes: Any) -> Vehicle:
    return Vehicle(BEAM, [quadrotor((0.0, 0.0, 0.075), rotor_radius=RADIUS, **changes)])


def rotors(step: float, vehicle: Vehicle | None = None, **changes: Any) -> Any:
    plain = {"late": False, "faults": Sound(), "surface": FreeAir(), "per_reach": None}
    return rotors_of(vehicle or lone(), step, **{**plain, **changes})._replace(per_reach=0.0)


def flown(made: Any, start: Any, commands: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """(thrusts, speeds after each step) of four rotors in a compiled loop; one row of commands [N] a step."""
    install()
    like = zeroed(Driven(made, start, ABOVE))

    @numba.njit(error_model="numpy")
    def loop(a, commands, thrusts, speeds, dt):
        x = load(a, like)
        memory = x.memory
        for k in range(len(commands)):
            thrust, memory = drive(x.rotors, memory, load(commands[k], memory.speed), x.state, k * dt)
            store(thrusts[k], thrust)
            store(speeds[k], memory.speed)

    thrusts, speeds = np.zeros((len(commands), 4)), np.zeros((len(commands), 4))
    loop(np.array(flat(Driven(made, start, ABOVE))), commands, thrusts, speeds, step)
    return thrusts, speeds


def spinning(speed: float, command: float = 0.0) -> Spinning:
    return Spinning(ROTORS(*[speed] * 4), ROTORS(*[command] * 4))


@pytest.mark.parametrize("step", [0.001, 0.004])
@pytest.mark.parametrize(("start", "end", "tau"), [(0.0, 800.0, UP), (500.0, 800.0, UP), (900.0, 300.0, DOWN)])
def test_a_step_of_command_is_answered_by_an_exponential_of_the_speed_and_its_exact_impulse(start, end, tau, step):
    commands = np.full((60, 4), K * end**2)
    thrusts, speeds = flown(rotors(step), spinning(start), commands, step)
    times = step * np.arange(1, 61)

    def speed(t):
        return end + (start - end) * np.exp(-t / tau)

    np.testing.assert_allclose(speeds, speed(times)[:, None] * np.ones(4), rtol=1e-12)
    for thrust, t in zip(thrusts[:20], times, strict=False):
        impulse, _ = quad(lambda s: K * speed(s) ** 2, t - step, t, epsabs=1e-14)
        np.testing.assert_allclose(thrust * step, impulse, rtol=1e-11)


def test_a_rotor_without_lag_gives_its_command_at_once():
    commands = np.array([[1.0, 2.0, 3.0, 4.0], [4.0, 0.0, 2.0, 1.0]])
    thrusts, _ = flown(rotors(0.001, lone(lag_up=0.0, lag_down=0.0)), spinning(300.0), commands, 0.001)
    np.testing.assert_allclose(thrusts, commands, rtol=1e-14, atol=1e-14)


def test_no_command_drives_a_rotor_beyond_its_limits():
    commands = np.array([[1e9, -1e9, MOST, 0.0]] * 2000)
    thrusts, speeds = flown(rotors(0.001), spinning(600.0), commands, 0.001)
    assert thrusts.min() >= 0.0
    assert thrusts.max() <= MOST * (1.0 + 1e-15)
    np.testing.assert_allclose(thrusts[-1], [MOST, 0.0, MOST, 0.0], atol=1e-12)
    np.testing.assert_allclose(speeds[-1], [FASTEST, 0.0, FASTEST, 0.0], atol=1e-12)


def test_a_late_command_acts_when_it_arrives():
    commands = np.full((3, 4), 5.0)
    made = rotors(0.001, lone(lag_up=0.0, lag_down=0.0), late=True)
    thrusts, memory = drive(made, spinning(0.0, 2.0), ROTORS(*commands[0]), ABOVE, 0.0)
    np.testing.assert_allclose(thrusts, 2.0, rtol=1e-14)  # what was on its way
    np.testing.assert_allclose(memory.arriving, 5.0)  # and what is now


def test_a_failing_rotor_keeps_its_share_of_thrust_from_its_time_on():
    faults = Faults(ROTORS(0.01, 1e18, 0.02, 0.0), ROTORS(0.0, 0.5, 0.4, 0.9))
    thrusts, _ = flown(
        rotors(0.001, lone(lag_up=0.0, lag_down=0.0), faults=faults), spinning(0.0), np.full((30, 4), 3.0), 0.001
    )
    for rotor, (first, share) in enumerate([(10, 0.0), (31, 0.5), (20, 0.4), (0, 0.9)]):
        np.testing.assert_allclose(thrusts[:first, rotor], 3.0, rtol=1e-13)
        np.testing.assert_allclose(thrusts[first:, rotor], 3.0 * share, rtol=1e-13)


@pytest.mark.parametrize(
    ("heights", "ratio"),  # z/R and T/T∞ by Cheeseman and Bennett, to the digits of a hand calculation
    [(0.5, 4.0 / 3.0), (1.0, 16.0 / 15.0), (1.5, 36.0 / 35.0), (2.0, 64.0 / 63.0), (4.0, 256.0 / 255.0)],
)
def test_thrust_near_the_floor_is_that_of_cheeseman_and_bennett(heights, ratio):
    vehicle, floor = lone(), -0.7
    surface = ground_effect(vehicle, floor)
    above = heights * RADIUS - vehicle.lever_arms[0, 2]
    state = State(Vec3(3.0, -2.0, floor + above), ZERO, LEVEL, ZERO)
    np.testing.assert_allclose(near_ground(surface, state), ratio, rtol=1e-12)


def test_the_theory_is_not_followed_nearer_than_half_a_radius():
    surface = ground_effect(lone(), 0.0)
    for z in (0.03, 0.0, -1.0):
        state = State(Vec3(0.0, 0.0, z), ZERO, LEVEL, ZERO)
        np.testing.assert_allclose(near_ground(surface, state), 4.0 / 3.0, rtol=1e-12)


def test_of_a_tilted_vehicle_every_rotor_has_its_own_height():
    vehicle = lone()
    turn = Rotation.from_euler("zxy", [0.4, 0.3, -0.2])
    q = np.roll(turn.as_quat(), 1)
    state = State(Vec3(0.0, 0.0, 0.3), ZERO, Quat(*map(float, q)), ZERO)
    ratios = np.array(near_ground(ground_effect(vehicle, 0.0), state))
    hubs = np.array([[x, y, vehicle.lever_arms[0, 2]] for x, y in vehicle.quadrotors[0].rotors])
    heights = 0.3 + turn.apply(hubs)[:, 2]
    np.testing.assert_allclose(1.0 - 1.0 / ratios, (RADIUS / (4.0 * heights)) ** 2, rtol=1e-12)
    assert np.ptp(ratios) > 0.01
