"""The linear tier: classical and disk margins, and the delay, lag and inertia at which the loops oscillate.

The loop is that of a calm hover, cut at the rotors, sampled and delayed as flown: `linearization.loop_margins`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.certification.changed_models import linear_limit
from tandemlift.analysis.certification.claims import Claim, Tier
from tandemlift.analysis.certification.disk_margins import disk_margin, disk_sizes
from tandemlift.analysis.linearization.loop_margins import (
    AXES,
    MAX_LAG,
    OpenLoop,
    axis_margins,
    is_stable,
    largest,
    open_loop,
    rotor_delay_and_lag,
    single_loop,
)
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import Mission

TITLE = "Linear: margins of the loops"
GAIN_BAR, PHASE_BAR = 6.0, 45.0  # dB, deg: usual bars of classical margins
DISK_GAIN_BAR, DISK_PHASE_BAR = 5.5, 35.0  # dB, deg: of one axis
CHANGED = ("mass", "roll inertia", "pitch inertia", "yaw inertia")
NO_LIMIT = 60.0  # dB: a gain that may change by more has no limit
ASSUMPTIONS = (
    "The vehicle hovers: no wind, ground effect, push or person; sensors without errors; small deviations.",
    "The loop is cut at the rotors. Sampling, delays of sensors and estimators, and the hold are as flown.",
    "Rotors are a delay and a lag of first order, of each its own mean of up and down, and reach no limit.",
    "Margins of an axis: the other three loops are closed. Disk margins of all rotors: each changes by itself.",
)


class LoopAsFlown(NamedTuple):
    """The loop of a mission with the delay and the lag [s] of its rotors.

    Attributes:
        open: without them, in thrust, roll, pitch, yaw.
        delay: of the rotors [s].
        lag: of the rotors, the mean of all, up and down [s]: each rotor's own is in proportion.
    """

    open: OpenLoop
    delay: float
    lag: float

    @property
    def L(self) -> NDArray[np.complexfloating]:
        """The response (F, 4, 4) in thrust, roll, pitch, yaw."""
        return np.asarray(self.open.L @ self.open.rotors.wrench(self.open.w, self.delay, self.lag), complex)

    @property
    def at_rotors(self) -> NDArray[np.complexfloating]:
        """The response (F, 4N, 4N) at each rotor."""
        rotors = self.open.rotors
        each = rotors.each(self.open.w, self.delay, self.lag)
        return np.asarray((rotors.allocation @ self.open.L @ rotors.effect) * each[:, None], complex)

    @property
    def stable(self) -> bool:
        """Whether the loop is stable as flown."""
        return is_stable(self.open, self.delay, self.lag)


def loop_as_flown(mission: Mission) -> LoopAsFlown:
    """The loop of a mission.

    Raises:
        InputError: the controller is plain Python, or the calm flight is lost.
    """
    return LoopAsFlown(open_loop(mission), *rotor_delay_and_lag(mission.hover))


def linear_tier(mission: Mission) -> Tier:
    """The linear tier of a mission; without claims, and with the reason, where its loop has no linear model."""
    try:
        loop = loop_as_flown(mission)
    except InputError as error:
        return Tier("linear", TITLE, ASSUMPTIONS, reason=f"there is no linear model: {error}")
    if not loop.stable:
        what = "with the delay and lag of its rotors" if loop.open.stable else "even without delay and lag"
        return Tier("linear", TITLE, ASSUMPTIONS, reason=f"the hover is unstable {what}: lower the gains")
    claims = (*_margins(loop), *rotor_limits(loop), *changed_limits(mission))
    return Tier("linear", TITLE, ASSUMPTIONS, claims, _curves(loop))


def _margins(loop: LoopAsFlown) -> Iterator[Claim]:
    """Margins of each axis, and of all rotors at once."""
    w, L = loop.open.w, loop.L
    for i, m in enumerate(axis_margins(w, L)):
        gain = min(abs(20.0 * math.log10(x)) if 0.0 < x < math.inf else NO_LIMIT for x in (m.gain, m.least_gain))
        text = f"the gain may grow {_times(m.gain)} and fall {_times(m.least_gain)}"
        yield Claim("gain margin", m.axis, gain, "dB", GAIN_BAR, text, tried=NO_LIMIT)
        phase, text = abs(m.phase), f"at {m.crossover:.3g} rad/s, where the gain is 1"
        if math.isnan(phase):
            phase, text = math.inf, "the gain is 1 nowhere"
        yield Claim("phase margin", m.axis, phase, "deg", PHASE_BAR, text, m.crossover)
        yield from _disk(w, single_loop(L, i)[:, None, None], m.axis, DISK_GAIN_BAR, DISK_PHASE_BAR)
    yield from _disk(w, L, "all axes")
    yield from _disk(w, loop.at_rotors, "all rotors")


def _times(factor: float) -> str:
    return f"to {factor:.3g} times" if 0.0 < factor < math.inf else "without limit"


def _disk(
    w: Array, L: NDArray[np.complexfloating], subject: str, gain: float | None = None, phase: float | None = None
) -> Iterator[Claim]:
    d = disk_margin(w, L)
    text = f"smallest at {d.frequency:.3g} rad/s; gain and phase change together"
    yield Claim("disk gain margin", subject, min(d.gain_db, NO_LIMIT), "dB", gain, text, d.frequency, tried=NO_LIMIT)
    yield Claim("disk phase margin", subject, d.phase, "deg", phase, text, d.frequency)


def rotor_limits(loop: LoopAsFlown) -> Iterator[Claim]:
    """Delay and lag of the rotors at which a loop oscillates."""
    for name, nominal, at in (
        ("delay", loop.delay, largest(lambda x: is_stable(loop.open, x, loop.lag))),
        ("lag", loop.lag, largest(lambda x: is_stable(loop.open, loop.delay, x))),
    ):
        if at == math.inf:
            text = f"no {name} up to {MAX_LAG:g} s makes the loops oscillate"
            yield Claim(f"{name} limit", "", at, "ms", text=text, tried=1e3 * MAX_LAG)
            continue
        limit = loop._replace(delay=at) if name == "delay" else loop._replace(lag=at)
        axis, frequency = oscillation(limit.open.w, limit.L)
        mean = "mean " if name == "lag" and np.ptp(loop.open.rotors.shares) else ""
        text = f"{axis} oscillates at {frequency:.3g} rad/s; the rotors' {mean}{name} is {1e3 * nominal:.3g} ms"
        yield Claim(f"{name} limit", "", 1e3 * at, "ms", None, text, frequency, parameter=name, limit=at)


def changed_limits(mission: Mission) -> Iterator[Claim]:
    """Mass and inertias at which a mission's hover is no longer stable, by a linear model of each value.

    The limit of the largest mass may be the thrust of real rotors; ideal ones have no limit.
    """
    limited = mission.actuators.model == "rotors"
    lifted = mission.hover.level_lift / mission.hover.vehicle.weight if limited else math.inf
    for name, growing in itertools.product(CHANGED, (False, True)):
        axis, _, kind = name.rpartition(" ")
        quantity = f"{'largest' if growing else 'least'} {kind}"
        at, frequency = linear_limit(mission, name, growing=growing)
        end = f"it oscillates at {frequency:.3g} rad/s" if frequency else "there is no calm hover beyond it"
        text = f"times the pilot's value; {end}"
        if name == "mass" and at > lifted:
            at, frequency, text = (
                lifted,
                math.nan,
                "times the pilot's value: the most that the rotors lift without turning",
            )
        if not 0.0 < at < math.inf:
            yield Claim(quantity, axis, math.inf, "1", text="no limit within a factor of 50")
            continue
        if name == "mass" and at < 1.0 and mission.pilot.guidance == "interactive":
            push = f"a push of more than {min(mission.admittance.threshold):g} N, the threshold"
            text += f"; {push}, may make the admittance oscillate earlier"
        yield Claim(quantity, axis, at, "1", None, text, frequency, parameter=name, limit=at)


def oscillation(w: Array, L: NDArray[np.complexfloating]) -> tuple[str, float]:
    """(axis, frequency [rad/s]) at which a loop (F, 4, 4) is nearest to an oscillation."""
    found = [nearest_to_oscillation(w, single_loop(L, i)) for i in range(len(AXES))]
    best = min(range(len(AXES)), key=lambda i: found[i][1])
    return AXES[best], found[best][0]


def nearest_to_oscillation(w: Array, L: NDArray[np.complexfloating]) -> tuple[float, float]:
    """(frequency [rad/s], distance) at which log L (F) of one loop, straight in between, is nearest to log −1."""
    log = np.log(np.abs(L)) + 1j * np.unwrap(np.angle(L))
    turn = 2.0 * math.pi * np.round((log.imag[:-1] - math.pi) / (2.0 * math.pi))
    start, step = log[:-1] - 1j * (math.pi + turn), np.diff(log)
    part = np.clip(-np.real(start * np.conj(step)) / np.maximum(np.abs(step) ** 2, 1e-300), 0.0, 1.0)
    distance = np.abs(start + part * step)
    at = int(np.argmin(distance))
    return float(w[at] * (w[at + 1] / w[at]) ** part[at]), float(distance[at])


def _curves(loop: LoopAsFlown) -> dict[str, list[float]]:
    """Disk sizes of each axis and of all rotors over the frequency."""
    w, L = loop.open.w, loop.L
    sizes = {axis: disk_sizes(single_loop(L, i)[:, None, None]) for i, axis in enumerate(AXES)}
    found = {"frequency": w, **sizes, "all rotors": disk_sizes(loop.at_rotors)}
    return {name: values.tolist() for name, values in found.items()}
