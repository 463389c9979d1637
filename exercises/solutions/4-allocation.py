"""Solution of exercise 4."""

import numpy as np


def effectiveness(arms, spins, torque_per_thrust):
    return np.array([np.ones(len(arms)), arms[:, 1], -arms[:, 0], torque_per_thrust * np.asarray(spins)])


def allocate(effectiveness, wrench):
    return np.linalg.pinv(effectiveness) @ wrench


def allocate_without(effectiveness, wrench, rotor):
    left = effectiveness.copy()
    left[:, rotor] = 0.0
    return np.linalg.pinv(left) @ wrench


def can_hover(effectiveness, wrench, largest, rotor):
    thrusts = allocate_without(effectiveness, wrench, rotor)
    makes_it = np.allclose(effectiveness @ thrusts, wrench)
    within = np.all(thrusts >= -1e-9) and np.all(thrusts <= largest)
    return bool(makes_it and within)
