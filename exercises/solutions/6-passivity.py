"""Solution of exercise 6."""

import numpy as np


def energy(force, velocity, dt):
    power = np.sum(force * velocity, axis=1)
    return np.sum(power) * dt


def felt(frequency, mass, damping, delay):
    return np.exp(-1j * frequency * delay) / (mass * 1j * frequency + damping)


def is_passive(frequency, admittance):
    return bool(np.all(admittance.real >= -1e-12))


def stiffest_arm(mass, damping, delay):
    low, high = 0.0, np.pi / (2.0 * delay)
    for _ in range(80):
        middle = 0.5 * (low + high)
        if np.arctan(middle * mass / damping) + middle * delay < np.pi / 2.0:
            low = middle
        else:
            high = middle
    return low * np.hypot(mass * low, damping)


def least_damping(mass, delay, stiffness):
    low, high = 1e-6, 1e3
    for _ in range(80):
        middle = 0.5 * (low + high)
        if stiffest_arm(mass, middle, delay) < stiffness:
            low = middle
        else:
            high = middle
    return high
