"""Fisher information of a hover that is excited by sines: what its sensors tell of the vehicle.

The log has the commands u and the readings y = G(θ) u + noise. About hover, G is that of the linear body behind the
rotors' lag and delay, and a line of amplitude A at frequency f gives, within a time T, the information
I_ij = T/2 Re Σ_c (∂y_c/∂θ_i)* (∂y_c/∂θ_j) (samples per second)/σ_c², ∂y/∂θ = (∂G/∂θ) u, with the commands u of the
closed loop. Only the frequencies of the lines count: slow disturbances and biases then matter little.

Sources: Mehra, Optimal input signals for parameter estimation, IEEE TAC 19, 1974; Ljung, System Identification, 1999,
chapter 13.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.linearization.frequency_response import frequency_response
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import NO_KINK, calm_mission, rotors_response
from tandemlift.core.errors import InputError
from tandemlift.core.types import GRAVITY, Array
from tandemlift.missions import Mission, SensorsTable, check, tables_of

Responses = NDArray[np.complexfloating]  # with the shapes of their docstrings
Frequencies = NDArray[np.complexfloating]
AXES = ("thrust", "roll", "pitch", "yaw")
MOTION = ("position", "velocity", "euler", "rates")
STEP = 1e-3  # of a difference: relative, or m


class VehicleParameter(NamedTuple):
    """A number of the vehicle that a flight identifies.

    Attributes:
        name: in words.
        target: half width of a 95 % interval that identification aims at: relative, of a centre of mass in m, or in s.
        key: of `[plant]`, from which it deviates; "" if the rotors alone have it.
        axis: of that key; None for a number.
    """

    name: str
    target: float
    key: str = ""
    axis: int | None = None


PARAMETERS = (
    VehicleParameter("mass", 0.003, "mass_scale"),
    VehicleParameter("inertia about x", 0.02, "inertia_scale", 0),
    VehicleParameter("inertia about y", 0.02, "inertia_scale", 1),
    VehicleParameter("inertia about z over yaw drag", 0.02, "inertia_scale", 2),  # only the ratio acts in hover
    VehicleParameter("centre of mass x", 0.002, "center_of_mass_offset", 0),
    VehicleParameter("centre of mass y", 0.002, "center_of_mass_offset", 1),
    VehicleParameter("centre of mass z", 0.002, "center_of_mass_offset", 2),
    VehicleParameter("thrust constant", 0.01),
    VehicleParameter("lag of rotors", 0.05),
    VehicleParameter("delay of rotors", 0.001),
)
WEIGHED = 0.0005  # standard deviation of the mass, weighed beforehand to 0.1 %: else only ratios to it are known


class ExcitedHover(NamedTuple):
    """The responses of a hover to a unit of commanded thrust, roll, pitch and yaw at frequencies (F) [Hz].

    Attributes:
        frequencies: (F).
        motion: position [m], velocity [m/s], Euler angles [rad], rates [rad/s] (F × 12 × 4).
        free: the same motion without the controller.
        thrusts: of the rotors [N] (F × 4N × 4).
        information: per second, of each line alone (F × 4 × P × P).
    """

    frequencies: Array
    motion: Responses
    free: Responses
    thrusts: Responses
    information: Array


def excited_hover(mission: Mission, frequencies: Array) -> ExcitedHover:
    """The responses and the information of a mission's hover.

    Raises:
        InputError: the mission has no real rotors or no noisy sensors, or its hover has no linear model.
    """
    if mission.actuators.model != "rotors":
        raise InputError(f'actuators.model = "{mission.actuators.model}": must be "rotors", which are identified')
    weights, hover = densities(mission.sensors, mission.mission.step), mission.hover
    calm, at = calm_mission(mission, slow=1.0)
    mixing = hover.vehicle.allocation(hover.allocation.weights)
    s = 2j * math.pi * frequencies
    # a command is held over a step, and read after it
    lags, late = np.repeat(hover.lags, 4), mission.actuators.delay + mission.mission.step
    rotors = rotors_response(2.0 * math.pi * frequencies[:, None], late, lags)[:, :, None] * mixing
    loop = linearize(calm, at, inputs=["thrust_offsets"], outputs=MOTION, kink_tolerance=NO_KINK).connected()
    motion = frequency_response(loop, frequencies) @ rotors
    body = body_response(calm, at, frequencies)
    # the thrusts that turn and lift the body as the loop does; those of the loop's model are of a later time
    moved = [5, 9, 10, 11]  # velocity z, rates
    thrusts = mixing @ np.linalg.solve(body[:, moved] @ mixing, motion[:, moved])
    lever = np.array(hover.vehicle.payload_center)
    gain = readings(body, s, lever) @ thrusts  # of the readings by the logarithm of the thrust constant
    slopes = [
        readings((body_response(deviating(calm, p, STEP), at, frequencies) - body) / STEP, s, lever) @ thrusts
        for p in PARAMETERS
        if p.key
    ]
    slopes += [gain, gain * (-s * hover.lag / (1.0 + s * hover.lag))[:, None, None], gain * -s[:, None, None]]
    dy = np.array(slopes)
    information = 0.5 * np.einsum("ifca,jfca,c->faij", dy.conj(), dy, weights).real
    return ExcitedHover(frequencies, motion, body @ mixing, thrusts, information)


def body_response(calm: Mission, at: float, frequencies: Array) -> Responses:
    """The responses of `MOTION` of the body alone to the thrust of each rotor (F × 12 × 4N)."""
    model = linearize(calm, at, of="body", inputs=["rotor_thrusts"], outputs=MOTION, kink_tolerance=NO_KINK)
    return frequency_response(model, frequencies)


def readings(motion: Responses, s: Frequencies, lever: Array) -> Responses:
    """Rates, specific force at a lever from the centre of mass, position, Euler angles (F × 12 × …) of a motion."""
    position, velocity, euler, rates = np.split(motion, 4, axis=1)
    turning = s[:, None, None] * rates
    tilted = GRAVITY * np.stack([-euler[:, 1], euler[:, 0], 0.0 * euler[:, 2]], axis=1)
    force = s[:, None, None] * velocity + tilted + np.cross(turning, lever[None, :, None], axis=1)
    return np.concatenate([rates, force, position, euler], axis=1)


def deviating(mission: Mission, parameter: VehicleParameter, by: float) -> Mission:
    """A mission whose real body has a parameter of `[plant]` that is larger by so much."""
    tables: Any = tables_of(mission)
    plant, key, axis = tables["plant"], parameter.key, parameter.axis
    plant[key] = plant[key] + by if axis is None else [x + by * (i == axis) for i, x in enumerate(plant[key])]
    return check(tables, mission.mission.name, quiet=True)


def densities(s: SensorsTable, step: float) -> Array:
    """Samples per second over σ² of the readings: rates, specific force, position, Euler angles (12).

    Raises:
        InputError: there is no noise.
    """
    if s.model != "simulated":
        raise InputError(f'sensors.model = "{s.model}": must be "simulated": their noise bounds what can be identified')
    inertial, seen = max(s.interval, step), max(s.motion.interval, step)
    factor = 1.0 if s.noise_interval is None else s.noise_interval / inertial
    found = []
    for name, noise, interval, scale in (
        ("gyroscope.noise", s.gyroscope.noise, inertial, factor),
        ("accelerometer.noise", s.accelerometer.noise, inertial, factor),
        ("motion.position_noise", s.motion.position_noise, seen, 1.0),
        ("motion.attitude_noise", s.motion.attitude_noise, seen, 1.0),
    ):
        sigma = np.broadcast_to(np.asarray(noise, dtype=float), 3)
        if not (sigma > 0.0).all():
            raise InputError(f"sensors.{name} = {noise}: must be above 0: only noise bounds an identification")
        found.append(1.0 / (interval * sigma**2 * scale))
    return np.concatenate(found)
