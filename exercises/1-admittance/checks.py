"""Checks of exercise 1. A failed assertion says what to look at."""

import numpy as np

import tandemlift as tl

X = np.array([1.0, 0.0, 0.0])


def check_rest_within_threshold(dead_band, points=1):
    """A force within the threshold counts as none."""
    for force in (0.0 * X, 0.49 * X, np.array([0.3, -0.3, 0.2])):
        assert np.allclose(dead_band(force, 0.5), 0.0), (
            f"dead_band({force.tolist()}, 0.5) must be zero: the length of this force, {np.linalg.norm(force):.2f} N, "
            "is within the threshold."
        )


def check_what_is_left_of_a_force(dead_band, points=2):
    """Beyond the threshold, what exceeds it is left, along the same direction."""
    just = np.linalg.norm(dead_band(0.501 * X, 0.5))
    assert just < 0.01, (
        f"At 0.501 N the result jumps to {just:.3f} N. Subtract the threshold from the length of the force, so that "
        "the result begins at zero."
    )
    assert np.allclose(dead_band(2.0 * X, 0.5), 1.5 * X), "2 N beyond a threshold of 0.5 N leave 1.5 N."
    assert np.allclose(dead_band(-2.0 * X, 0.5), -1.5 * X), "A push backwards must be as strong as one forwards."
    oblique = dead_band(np.array([3.0, 4.0, 0.0]), 0.5)
    assert np.allclose(oblique, [2.7, 3.6, 0.0]), (
        "The direction must not change: take the threshold off the length of the vector, not off each axis."
    )


def check_steady_speed(step, points=1):
    """Under a steady force, the speed goes to F/D."""
    v = 0.0 * X
    for _ in range(2000):
        v = step(v, 2.0 * X, 1.0, 1.6, 0.01)
    assert np.all(np.isfinite(v)) and abs(v[0]) < 100.0, (
        "The speed grows without end. Which sign has the force of the damping?"
    )
    assert np.allclose(v, 1.25 * X, atol=1e-3), (
        f"After 20 s under 2 N, with D = 1.6 N s/m: {v[0]:.3f} instead of 1.25 m/s."
    )


def check_time_constant(step, points=1):
    """It gets there with the time constant M/D."""
    v = 0.0 * X
    for _ in range(200):
        v = step(v, 2.0 * X, 3.2, 1.6, 0.01)
    share = v[0] / 1.25
    assert abs(share - 0.632) < 0.01, (
        f"After M/D = 2 s the speed is {100 * share:.0f} % of its last value; it must be 63 %. "
        "Does the step depend on M, D and dt as the equation does?"
    )


def check_any_step(step, points=1):
    """One step of any length is exact."""
    many = v = 0.4 * X
    for _ in range(4000):
        many = step(many, X, 0.5, 8.0, 5e-5)
    once = step(v, X, 0.5, 8.0, 0.2)
    assert np.allclose(once, many, atol=2e-3), (
        f"One step of 0.2 s leads to {once[0]:.3f} m/s, and 4,000 short ones to {many[0]:.3f} m/s. "
        "Over a step the force is constant: solve the equation, which leads to exp(-D dt / M)."
    )


def check_design(design, points=2):
    """A beam designed for 0.5 m/s under 2 N, 63 % of it after 0.6 s."""
    mass, damping = design(0.5, 2.0, 0.6)
    assert damping > 0.0 and abs(2.0 / damping - 0.5) < 1e-6, (
        f"With D = {damping:.3g} N s/m the steady speed under 2 N is {2.0 / damping:.3g} m/s."
    )
    assert abs(mass / damping - 0.6) < 1e-6, f"With M = {mass:.3g} kg the time constant is {mass / damping:.3g} s."


def check_flight(step, design, points=2):
    """The beam in flight moves as your law says."""
    mass, damping = design(0.5, 2.0, 0.6)
    keys = {"admittance.mass": [mass] * 3, "admittance.damping": [damping] * 3, "mission.duration": 8.0}
    flight = tl.fly(tl.load_mission("one-push", keys))
    dt = flight.time[1] - flight.time[0]
    mine = np.zeros_like(flight["admittance_velocity"])
    for i in range(1, len(mine)):
        force = 0.5 * (flight["admittance_force"][i - 1] + flight["admittance_force"][i])
        mine[i] = step(mine[i - 1], force, mass, damping, dt)
    error = np.abs(mine - flight["admittance_velocity"]).max()
    assert error < 0.02, f"In mission one-push your law and the flight differ by {error:.2f} m/s."
