"""Eigenvalues and frequency response of a linear model, and the model in words."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.linearization.linear_model import LinearModel
from tandemlift.core.types import Array

DEADBEAT = 1e-6  # of an eigenvalue, below which its mode decays within a few steps
ROUNDING = 1e-9  # of log z
MOST_NAMES = 3
MOST_STATES = 1200  # whose eigenvalues are computed within seconds
LEAST_SHARE = 0.1
PART = re.compile(r"(\.[wxyz])?(\.r\d+)?(\[-\d+\])?$")


class Mode(NamedTuple):
    """An eigenvalue z of a discrete model, a pair of conjugates once, and s = log(z) / step.

    Attributes:
        z: the eigenvalue with nonnegative imaginary part.
        s: [1/s]; its real part is the rate of decay, its imaginary part the frequency [rad/s].
        states: participating states, without components, each with its share; the largest first.
    """

    z: complex
    s: complex
    states: tuple[tuple[str, float], ...]

    @property
    def frequency(self) -> float:
        """The frequency of the oscillation [Hz]."""
        return self.s.imag / (2.0 * np.pi)

    @property
    def damping(self) -> float:
        """The damping ratio, 1 for a mode that does not oscillate; below 0 for one that grows."""
        return -self.s.real / abs(self.s) if self.s else 0.0

    @property
    def time_constant(self) -> float:
        """The time in which the mode decays to 1/e [s]; below 0 if it grows, infinite if it is constant."""
        return -1.0 / self.s.real if self.s.real else float("inf")


class Modes(NamedTuple):
    """The modes of a model, the slowest first; and the number of further ones that decay within a few steps."""

    modes: tuple[Mode, ...]
    deadbeat: int


def modes_of(model: LinearModel) -> Modes:
    """The modes of a model; the share of a state is its participation factor, as a size."""
    z, right = np.linalg.eig(model.A)
    left = np.linalg.pinv(right)
    shares = np.abs(right * left.T)
    shares /= np.maximum(shares.sum(axis=0), 1e-300)
    kept = [i for i in np.argsort(-np.abs(z)) if abs(z[i]) > DEADBEAT and z[i].imag >= 0.0]
    fields = [PART.sub("", v.name) for v in model.states]
    found = [Mode(complex(z[i]), continuous(z[i], model.step), _largest(fields, shares[:, i])) for i in kept]
    return Modes(tuple(found), int(np.sum(np.abs(z) <= DEADBEAT)))


def continuous(z: complex, step: float) -> complex:
    """log(z) / step [1/s]; a part of it that is only rounding is 0."""
    s = np.log(complex(z))
    real, imaginary = (0.0 if abs(part) < ROUNDING else float(part) for part in (s.real, s.imag))
    return complex(real, imaginary) / step


def _largest(fields: list[str], shares: Array) -> tuple[tuple[str, float], ...]:
    sums = dict[str, float]()
    for field, share in zip(fields, shares, strict=True):
        sums[field] = sums.get(field, 0.0) + float(share)
    ordered = sorted(sums.items(), key=lambda item: -item[1])
    return tuple(item for item in ordered[:MOST_NAMES] if item[1] >= LEAST_SHARE)


def frequency_response(model: LinearModel, frequencies: Array) -> NDArray[np.complex128]:
    """C (e^{jωT} − A)⁻¹ B + D (F, p, m) at frequencies (F,) [Hz], up to half of the sample rate."""
    unit = np.eye(len(model.A))
    turns = np.exp(2j * np.pi * np.asarray(frequencies) * model.step)
    return np.array([model.C @ np.linalg.solve(turn * unit - model.A, model.B) + model.D for turn in turns])


def model_lines(model: LinearModel, connected: LinearModel, count: int) -> Iterator[str]:
    """A model in words: its size, its slowest modes, kinks and assumptions.

    Args:
        model: the whole one.
        connected: the part of it that connects inputs with outputs.
        count: of the modes.
    """
    n, m, p = len(model.states), len(model.inputs), len(model.outputs)
    yield f"{model.mission}: the {model.of} at {model.time:g} s, sample time {model.step * 1e3:g} ms"
    yield f"  {n} states, of which {len(connected.states)} connect the {m} inputs with the {p} outputs at this point"
    if count:
        yield from _mode_lines(connected, count)
    kinks = [kink.text for kink in model.kinks] or ["none within 1e-4 of the point"]
    for title, rows in (("kinks", kinks), ("assumptions", model.assumptions)):
        yield f"  {title}:"
        yield from (f"    - {row}" for row in rows)


def _mode_lines(model: LinearModel, count: int) -> Iterator[str]:
    if len(model.states) > MOST_STATES:
        yield f"  modes: not computed for more than {MOST_STATES} states; write the matrices with --out"
        return
    modes = modes_of(model)
    yield f"  modes, the slowest {min(count, len(modes.modes))} of {len(modes.modes)}:"
    yield "    time constant  frequency  damping    |z|     participating states"
    for mode in modes.modes[:count]:
        states = ", ".join(f"{name} {100.0 * share:.0f} %" for name, share in mode.states)
        frequency = f"{mode.frequency:7.3f} Hz" if mode.frequency else " " * 10
        yield f"    {mode.time_constant:11.4g} s {frequency}  {mode.damping:7.3f}  {abs(mode.z):.5f}  {states}"
    if modes.deadbeat:
        yield f"    {modes.deadbeat} more decay within a few samples"
