"""Checks of exercise 5. A failed assertion says what to look at."""

import functools

import numpy as np

import tandemlift as tl

MASS, GRAVITY, DT = 3.5, np.array([0.0, 0.0, -9.81]), 5e-3  # kg, m/s2, s


def observe(start, observer, push, gain=8.0, seconds=3.0, speed=(0.0, 0.0, 0.0), lift=None):
    """The estimates along a flight of a body that rotors hold up and a hand pushes by `push` [N]."""
    rotors = -MASS * GRAVITY if lift is None else np.asarray(lift)
    v, rows = np.array(speed), []
    memory = start(MASS, v)
    for _ in range(round(seconds / DT)):
        estimate, memory = observer(memory, v, rotors, MASS, gain, DT)
        rows.append(np.array(estimate, float))
        v = v + DT * ((rotors + np.asarray(push)) / MASS + GRAVITY)
    return np.array(rows)


def check_thrust_direction(rotor_force, points=1):
    """The force of the rotors in world axes."""
    level = rotor_force(np.array([1.0, 0.0, 0.0, 0.0]), 30.0)
    assert np.allclose(level, [0.0, 0.0, 30.0]), f"Level, 30 N point up: not {np.round(level, 2).tolist()}."
    half = 0.1  # rad: half the angle
    pitched = rotor_force(np.array([np.cos(half), 0.0, np.sin(half), 0.0]), 30.0)
    true = 30.0 * np.array([np.sin(0.2), 0.0, np.cos(0.2)])
    assert np.allclose(pitched, true), (
        f"Pitched by 0.2 rad the thrust points forwards, {np.round(true, 2).tolist()} N: not "
        f"{np.round(pitched, 2).tolist()}. The quaternion (w, x, y, z) turns body into world axes."
    )


def check_hover(start, observer, points=1):
    """In hover, without a hand, the estimate is zero."""
    r = observe(start, observer, [0.0, 0.0, 0.0])
    assert np.abs(r).max() < 1e-6, (
        f"It says {np.round(r[-1], 2).tolist()} N. The rotors carry the weight: gravity belongs to the known forces."
    )


def check_steady_push(start, observer, points=2):
    """A steady push is found, on each axis."""
    push = np.array([1.0, -2.0, 0.5])
    r = observe(start, observer, push)
    assert np.all(np.isfinite(r)) and np.abs(r).max() < 100.0, (
        "The estimate grows without end: which sign closes the loop?"
    )
    assert np.allclose(r[-1], push, atol=0.02), (
        f"After 3 s it says {np.round(r[-1], 2).tolist()} N, the hand pushes by {push.tolist()} N."
    )


def check_time_constant(start, observer, points=2):
    """It gets there with the time constant 1/gain."""
    for gain in (4.0, 8.0):
        r = observe(start, observer, [1.0, 0.0, 0.0], gain)
        share = np.interp(1.0 / gain, np.arange(len(r)) * DT, r[:, 0])
        assert abs(share - 0.632) < 0.04, (
            f"With a gain of {gain:g}/s it has found {100 * share:.0f} % after {1 / gain:g} s; it must be 63 %. "
            "Is the estimate within its own integral?"
        )


def check_already_moving(start, observer, points=1):
    """A body that already moves when it begins is no push."""
    r = observe(start, observer, [0.0, 0.0, 0.0], speed=(1.5, 0.0, 0.0))
    assert np.abs(r).max() < 1e-6, (
        f"At 1.5 m/s it begins with {r[0, 0]:.1f} N: the integral must begin at the momentum."
    )


@functools.cache
def flight_of_iris():
    """40 s of mission iris, and the vehicle's mass [kg]."""
    mission = tl.load_mission("iris", {"mission.duration": 40.0})
    return tl.fly(mission), tl.Vehicle.from_settings(mission.vehicle).mass


def check_flight(rotor_force, start, observer, without_wind, points=3):
    """Without force sensors, the pushes of mission iris are found."""
    flight, mass = flight_of_iris()
    t, v, push = flight.time, flight["velocity"], flight["push_force"]
    first, dt = np.searchsorted(t, 8.0), t[1] - t[0]
    thrust = flight["rotor_thrusts"].sum(axis=1)
    memory, rows = start(mass, v[first]), []
    for i in range(first, len(t)):
        known = rotor_force(flight["attitude"][i], thrust[i])
        estimate, memory = observer(memory, v[i], known, mass, 8.0, dt)
        rows.append(np.array(estimate, float))
    found = without_wind(np.array(rows), round(2.0 / dt))
    rmse = np.sqrt(np.mean((found - push[first:]) ** 2, axis=0))
    assert np.all(rmse < 0.3), (
        f"The estimate differs from the hand by {np.round(rmse, 2).tolist()} N (RMSE along x, y, z); 0.3 N is reached."
    )
    calm = without_wind(np.array(rows) + np.array([0.6, 0.0, 0.0]), round(2.0 / dt))
    assert np.allclose(calm, found, atol=1e-9), (
        "A steady wind of 0.6 N from the start is in the estimate: take off its mean over the first samples."
    )
