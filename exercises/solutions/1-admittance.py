"""Solution of exercise 1."""

import numpy as np


def dead_band(force, threshold):
    length = np.linalg.norm(force)
    if length <= threshold:
        return np.zeros(3)
    return force * (1.0 - threshold / length)


def step(velocity, force, mass, damping, dt):
    kept = np.exp(-damping * dt / mass)
    return velocity * kept + force / damping * (1.0 - kept)


def design(speed, force, time_constant):
    damping = force / speed
    mass = damping * time_constant
    return mass, damping
