"""The velocity of the air: steady wind, discrete gusts and turbulence; its drag on payload and quadrotors.

Gusts have the 1 − cosine shape of MIL-F-8785C, section 3.7. Velocities are in world axes [m/s]. The drag is quadratic
in the velocity through the air; the linear drag of the whole vehicle, `vehicle.drag`, is in `rigid_body`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple, cast

import numpy as np
from pydantic import Field

from tandemlift.core.algebra import clip, cos, maximum, sqrt
from tandemlift.core.arrays import distance
from tandemlift.core.errors import CheckResult, warned
from tandemlift.core.keys import NonNegative, PerAxis, Positive, Table, key
from tandemlift.core.law import elementwise, law
from tandemlift.core.part import Part
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Absent, Vec3, apply, apply_transposed, cross, dot, spread, vec3
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartLoads, PartsLayout, sum_over_set, translated
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import PI, rotation_from_quaternion
from tandemlift.parts.mechanics.turbulence import (
    FOOT,
    HIGHEST_ALTITUDE,
    LOWEST_ALTITUDE,
    Dryden,
    TurbulenceState,
    WindNoise,
    dryden,
    start_turbulence,
    turbulence_step,
    turbulence_velocity,
)
from tandemlift.parts.mechanics.vehicle import Vehicle

Speed = Annotated[float, Field(ge=-1e3, le=1e3)]  # m/s, along an axis
Speeds = tuple[Speed, Speed, Speed]
Turbulence = Annotated[float, Field(ge=0.0, le=1e3)]  # m/s
Airspeed = Annotated[float, Field(ge=0.01, le=1e3)]  # m/s


class GustTable(Table):
    """`[[wind.gusts]]`: gusts on top of the mean wind, one table each, as in MIL-F-8785C, 3.7.3."""

    velocity: Annotated[Speeds, PerAxis(3, single=False)] = key(
        ..., "m/s", "peak velocity of the gust, world axes", example=[2.0, 0.0, 0.0]
    )
    start: float = key(..., "s", "time at which the gust begins to rise", example=12.0)
    rise: Positive = key(..., "s", "time in which the gust rises as 1 − cos, and in which it falls again", example=1.0)
    hold: NonNegative | None = key(None, "s", "time for which the gust holds its peak", unset="it stays", example=2.0)


class WindTable(Table, acts='wind.model = "air"', keys_act={"height airspeed": "wind.turbulence > 0"}):
    """`[wind]`: moving air with quadratic drag on payload and quadrotors, unknown to the pilot.

    Gusts and Dryden turbulence are those of MIL-F-8785C.
    """

    model: Literal["none", "air"] = key(
        "none", None, "model of the wind", choices={"none": "no moving air", "air": "moving air with drag"}
    )
    velocity: Annotated[Speeds, PerAxis(3, single=False)] = key((0.0, 0.0, 0.0), "m/s", "mean velocity, world axes")
    turbulence: Turbulence = key(
        0.0, "m/s", "mean wind at 20 ft that scales the turbulence: 7.7 is light, 15.4 moderate, 0 none"
    )
    height: Positive = key(
        3.048,
        "m",
        "height above ground for the turbulence's scales; clipped to the standard's range of 3.048 to 304.8",
        source="10 ft, where the standard begins",
    )
    airspeed: Airspeed | None = key(
        None,
        "m/s",
        "speed at which the turbulence passes the vehicle",
        unset="that of the mean wind, at least 0.5",
        example=3.0,
    )
    density: Annotated[Positive, Field(le=1e4)] = key(
        1.225, "kg/m³", "density of the air", source="standard atmosphere at sea level"
    )
    gusts: tuple[GustTable, ...] = ()


class Gust(NamedTuple):
    """One gust: peak [m/s, world axes], start [s], 1/(rise time) [1/s], and how long it holds [s] (it may be inf)."""

    velocity: Vec3
    start: Number
    per_rise: Number
    hold: Number


@law
def gust_velocity(g: Gust, t: Number) -> Vec3:
    """Velocity of one gust at time t [s]: ½ V (1 − cos) while it rises, V while it holds, and down as it rose."""
    since = (t - g.start) * g.per_rise
    rising, falling = clip(since, 0.0, 1.0), clip(since - 1.0 - g.hold * g.per_rise, 0.0, 1.0)
    return g.velocity * (0.5 * (cos(PI * falling) - cos(PI * rising)))


TINY = 1e-200  # m²/s², lost in the square of any speed; keeps the derivative of its root finite


class AirDrag(NamedTuple):
    """½ ρ C_d A along each body axis [N/(m/s)²], of the payload and of every quadrotor (a vector of sets)."""

    payload: Vec3
    quadrotors: Vec3


@elementwise
def zero_like(x: Number) -> Number:
    """0, for a number or for every value of a set."""
    return 0.0


@law
def quadratic_drag(k: Vec3, v: Vec3) -> Vec3:
    """−k |v| v by component [N], v [m/s] through the air; vectors of numbers or of sets."""
    speed = sqrt(maximum(dot(v, v), TINY))
    return Vec3(-(k.x * v.x * speed), -(k.y * v.y * speed), -(k.z * v.z * speed))


@law
def air_loads(drag: AirDrag, frame: PartsLayout, s: State, air: Vec3) -> PartLoads:
    """Drag of every part, quadratic in the velocity of its centre of mass through the air; no moments about it."""
    # sets are the left factors of products: a CasADi number on the left does not know them
    R = rotation_from_quaternion(s.attitude)
    v, turn = apply_transposed(R, s.velocity - air), -cross(frame.quadrotors, s.rates)
    payload = apply(R, quadratic_drag(drag.payload, v + cross(s.rates, frame.payload)))
    each = quadratic_drag(drag.quadrotors, translated(v, turn))
    moments = Vec3(zero_like(each.x), zero_like(each.y), zero_like(each.z))
    return PartLoads(PartLoad(payload, ZERO), PartLoad(Vec3(dot(each, R.x), dot(each, R.y), dot(each, R.z)), moments))


def air_drag_from(vehicle: Vehicle, density: float) -> AirDrag:
    """The drag of a vehicle's parts in air of a density [kg/m³]."""
    payload, quadrotors = vehicle.payload, vehicle.quadrotors
    return AirDrag(
        vec3(payload.areas) * (0.5 * density * payload.drag_coefficient),
        spread([[a * (0.5 * density * q.drag_coefficient) for a in q.areas] for q in quadrotors]),
    )


class WindModel(NamedTuple):
    """Steady velocity [m/s, world axes], turbulence, and the drag of the parts."""

    velocity: Vec3
    turbulence: Dryden | Absent
    drag: AirDrag


class WindOutput(NamedTuple):
    """The wind over a step: its velocity [m/s, world axes], its loads on the parts, and its memory after the step."""

    velocity: Vec3 | Absent
    loads: PartLoads | Absent
    memory: TurbulenceState | Absent


@law
def wind_step(
    wind: WindModel, memory: TurbulenceState | Absent, gust: Vec3, noise: WindNoise | Absent
) -> tuple[Vec3, TurbulenceState | Absent]:
    """(Velocity of the air now [m/s, world axes], the turbulence one step later); `gust`: the gusts' velocity now."""
    air = wind.velocity + gust + turbulence_velocity(wind.turbulence, memory)
    return air, turbulence_step(wind.turbulence, memory, noise)


@law(absent=WindOutput(Absent(), Absent(), Absent()))
def wind_loads(
    wind: WindModel,
    memory: TurbulenceState | Absent,
    frame: PartsLayout,
    state: State,
    gust: Vec3,
    noise: WindNoise | Absent,
) -> WindOutput:
    """`WindOutput` over a step that starts in `state`; `gust`: velocity of all gusts together [m/s, world axes]."""
    velocity, after = wind_step(wind, memory, gust, noise)
    return WindOutput(velocity, air_loads(wind.drag, frame, state, velocity), after)


LEAST_AIRSPEED = 0.5  # m/s, at which turbulence passes in still air
NO_NOISE = WindNoise(0.0, 0.0, 0.0, 0.0, 0.0)


def start_wind(
    table: WindTable, vehicle: Vehicle, step: float, chance: np.random.Generator
) -> tuple[WindModel, TurbulenceState | Absent]:
    """The wind and its turbulence at t = 0; `chance` draws the turbulence."""
    w, turbulence = table, cast("Dryden | Absent", Absent())
    if w.turbulence > 0.0:
        airspeed = w.airspeed
        if airspeed is None:
            airspeed = maximum(distance(w.velocity, ZERO), LEAST_AIRSPEED)
        turbulence = dryden(w.turbulence, w.height, airspeed, w.velocity, step)
    eddies = start_turbulence(turbulence, chance.standard_normal(5).tolist())
    return WindModel(vec3(w.velocity), turbulence, air_drag_from(vehicle, w.density)), eddies


def wind_noise_of(model: WindModel | Absent) -> WindNoise | Absent:
    """The layout of the wind's standard normals."""
    still = isinstance(model, Absent) or isinstance(model.turbulence, Absent)
    return Absent() if still else NO_NOISE


def gusts_from(w: WindTable) -> list[Gust]:
    """The gusts on top of the mean wind."""
    gusts = w.gusts if w.model == "air" else ()
    return [Gust(vec3(g.velocity), g.start, 1.0 / g.rise, math.inf if g.hold is None else g.hold) for g in gusts]


def wind_checks(table: WindTable) -> Iterator[CheckResult]:
    """Check for turbulence at a height outside the standard."""
    lowest, highest = LOWEST_ALTITUDE * FOOT, HIGHEST_ALTITUDE * FOOT
    held = min(max(table.height, lowest), highest)
    if table.turbulence and abs(held - table.height) > 1e-6 * held:
        yield warned(
            f"wind.height = {table.height}: MIL-F-8785C gives the turbulence from {lowest:g} m to {highest:g} m; "
            f"that of {held:g} m blows"
        )


class WindChannels(NamedTuple):
    """The velocity of the air, and its force on all parts together."""

    wind_velocity: Vec3
    wind_force: Vec3


@law(absent="loads")
def wind_channels(loads: PartLoads, velocity: Vec3) -> WindChannels:
    """The channels of moving air."""
    return WindChannels(wind_velocity=velocity, wind_force=loads.payload.force + sum_over_set(loads.quadrotors.force))


WIND = Part(
    *("wind", "body", "wind", WindTable.acts, start_wind), checks=wind_checks, channels=WindChannels, calm=False
)
