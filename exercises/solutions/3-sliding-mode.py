"""Solution of exercise 3."""

import numpy as np


def surface(error, rate, slope):
    return rate + slope * error


def switching(s, boundary):
    if boundary == 0.0:
        return np.sign(s)
    return np.clip(s / boundary, -1.0, 1.0)


def command(error, rate, slope, gain, boundary):
    s = surface(error, rate, slope)
    return -slope * rate - gain * switching(s, boundary)


def least_gain(disturbance, fall):
    return disturbance + fall


def changes_per_second(signal, dt):
    signs = np.sign(signal)
    return np.count_nonzero(signs[1:] * signs[:-1] < 0.0) / (len(signal) * dt)
