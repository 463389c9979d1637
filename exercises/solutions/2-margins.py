"""Solution of exercise 2."""

import numpy as np


def crossovers(frequency, response):
    size = np.log(np.abs(response))
    i = np.flatnonzero(np.diff(np.sign(size)))
    share = size[i] / (size[i] - size[i + 1])
    return frequency[i] * (frequency[i + 1] / frequency[i]) ** share


def with_delay(frequency, response, delay):
    return response * np.exp(-1j * frequency * delay)


def margins(frequency, response):
    at = crossovers(frequency, response)
    phase = np.interp(at, frequency, np.unwrap(np.angle(response)))
    return at, phase + np.pi


def phase_margin(frequency, response):
    _, margin = margins(frequency, response)
    margin = (margin + np.pi) % (2.0 * np.pi) - np.pi
    return np.degrees(margin[np.argmin(abs(margin))])


def longest_delay(frequency, response):
    at, margin = margins(frequency, response)
    return np.min(margin % (2.0 * np.pi) / at)
