"""Solution of exercise 5."""

import numpy as np

GRAVITY = np.array([0.0, 0.0, -9.81])


def rotor_force(attitude, thrust):
    w, x, y, z = attitude
    return thrust * np.array([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])


def start(mass, velocity):
    return mass * velocity


def observer(memory, velocity, rotors, mass, gain, dt):
    estimate = gain * (mass * velocity - memory)
    known = rotors + mass * GRAVITY
    return estimate, memory + dt * (known + estimate)


def without_wind(estimates, samples):
    return estimates - estimates[:samples].mean(axis=0)
