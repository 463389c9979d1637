"""Windows of a flight and their samples, made up for the pieces of an identification."""

import numpy as np

from tandemlift.analysis.identification.windows import FlightWindows, Samples
from tandemlift.analysis.logs.log import Stream
from tandemlift.missions import load_mission


def iris():
    return load_mission("iris")


def cut(first=(100, 200, 300), length=100, block=10, samples=None, commands=None, count=450, step=0.002):
    """Windows of a grid that begins at 5 s."""
    commands = commands or Stream(np.array([4.0, 9.0]), np.zeros((2, 8)))
    pushes = np.zeros((count, 6))
    return FlightWindows("log", step, 5.0, count, np.array(first), length, block, commands, pushes, samples or {})


def sampled(windows, width=3, per=20, values=None, *, rng):
    """Samples of each window, evenly."""
    window = np.repeat(np.arange(windows), per)
    step = np.tile(np.arange(per) * 5, windows)
    values = rng.normal(size=(len(window), width)) if values is None else values
    return Samples(window, step, np.zeros(len(window)), values)
