"""The delay of rotors that are later than believed, from what the thrust's noise does to the accelerometer."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.estimation.wrench.delay import late_wrench, rotor_delay
from tandemlift.parts.estimation.wrench_push import start_wrench_push
from tandemlift.parts.mechanics.rigid_body import Wrench

MASS, NOISE, T, KNOWN = 3.5, 0.03, 1e-3, 0.01  # kg, m/s², s, s
SECONDS, SETTLED = 5, 4000  # s, samples
FREQUENCIES = np.geomspace(5.0, 80.0, 40)  # rad/s, of the noise in the thrust


def estimated(later, scale=1.0, noise=NOISE):
    """(errors of the delay [s], of the thrust [N]) for rotors that are `later` [s] than known, with a scaled thrust."""
    rng, ends = np.random.default_rng(3), np.arange(1, 1000 * SECONDS + 1) * T
    phases = rng.uniform(0.0, 2.0 * np.pi, FREQUENCIES.size)

    def thrust(t):
        noisy = 0.05 * np.cos(np.multiply.outer(t, FREQUENCIES) + phases).sum(axis=-1)
        return MASS * 9.81 + noisy + 1.5 * np.sin(2.0 * t)  # a hand lifts slowly

    made, true = thrust(ends - 0.5 * T), thrust(ends - KNOWN - later)
    k, memory = rotor_delay(KNOWN, MASS, NOISE, T)
    delays, thrusts = [], []
    for i, t in enumerate(ends):
        vertical = float(scale * true[i] + 0.1 * t) / MASS + noise * rng.normal()  # beside a push that grows
        wrench, memory = late_wrench(k, memory, Wrench(float(made[i]), ZERO), vertical, float(t > 1.0), T)
        delays.append(memory.product / (memory.square + k.prior))
        thrusts.append(wrench.thrust)
    return np.array(delays)[SETTLED:] - later, (np.array(thrusts) - true)[SETTLED:]


@pytest.mark.parametrize("later", [-0.004, 0.005])
def test_a_delay_is_found_within_a_fraction_of_a_millisecond_and_the_thrust_is_right(later):
    delay, thrust = estimated(later)
    assert abs(delay[-1]) < 4e-4  # s, after four seconds in flight
    assert thrust.std() < 0.03  # N; of the thrust as believed 0.05 N per 5 ms at 40 rad/s


def test_a_thrust_that_is_wrong_by_a_factor_is_no_delay():
    assert abs(estimated(0.0, scale=0.95)[0][-1]) < 4e-4


@pytest.mark.parametrize("noise", [NOISE, 0.0])
def test_on_the_floor_nothing_is_learned_and_the_model_stays(noise):
    k, memory = rotor_delay(KNOWN, MASS, noise, T)
    for i in range(300):
        _, memory = late_wrench(k, memory, Wrench(float(np.sin(0.05 * i)), ZERO), float(np.cos(0.05 * i)), 0.0, T)
    assert (memory.product, memory.square) == (0.0, 0.0)


def test_a_moment_and_a_thrust_that_grow_steadily_are_late_by_the_known_delay_and_its_error():
    """A ramp is as far behind as it grows in that time, up to half a sample of a held input; a moment as a thrust."""
    later, slope, turns = 0.003, 2.0, Vec3(0.5, -0.25, 0.125)  # s, N/s, N m/s
    k, memory = rotor_delay(KNOWN, MASS, NOISE, T)
    memory = memory._replace(product=later * 1e9, square=1e9)  # the error is known well
    k = k._replace(keep=1.0, prior=0.0)
    for i in range(1, 401):
        middle = (i - 0.5) * T
        made = Wrench(slope * middle, Vec3(*(x * middle for x in turns)))
        wrench, memory = late_wrench(k, memory, made, 0.0, 0.0, T)
    then = 400 * T - KNOWN - later
    assert wrench.thrust == pytest.approx(slope * then, abs=slope * 0.5 * T)
    assert tuple(wrench.moment) == pytest.approx([x * wrench.thrust / slope for x in turns], rel=1e-9)


def test_an_observer_models_the_rotors_that_identification_writes():
    """`tandemlift identify` writes constants and lags of each quadrotor's rotors into the mission's vehicle."""
    changes = {"vehicle.quadrotors.1.thrust_constant": 5.1e-6, "vehicle.quadrotors.0.lag_up": 0.02}
    mission = tl.load_mission("iris", {"estimator.wrench": "kalman", **changes})
    vehicle = tl.Vehicle.from_settings(mission.vehicle)
    push, _ = start_wrench_push(mission.estimator, mission.sensors, vehicle, T, KNOWN, None)
    constants, decay = push.thrust.rotors.constant, push.thrust.rotors.up.decay
    assert list(constants) == pytest.approx([5.84e-6] * 4 + [5.1e-6] * 4)
    assert list(decay) == pytest.approx([np.exp(-T / 0.02)] * 4 + [np.exp(-T / 0.0125)] * 4)
