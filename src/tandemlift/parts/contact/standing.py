"""The floor of a mission, `[ground]`: the vehicle's equilibrium on it at start and landing, and the checks of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Field

from tandemlift.core.caching import cached
from tandemlift.core.errors import CheckResult, refused, shown, warned
from tandemlift.core.keys import Positive, Table, key
from tandemlift.core.trajectories import PhasesTable
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import vec3
from tandemlift.parts.contact.feet import Floor, floor, sinkage_of, standing_height
from tandemlift.parts.contact.hull import Hull, hull, lowest_of_hull
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.mechanics.rotation import rotation_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import VehicleTable

FOOT_DEPTH = 0.02  # m, of feet in the floor at the start
SOLE_OFFSET = 0.005  # m, between the soles of two quadrotors
DISTANCE_BELOW = 0.02  # m, of the landed reference below the height of the standing vehicle
DISTANCE_ABOVE = 0.3  # m, and above it
THROW_FACTOR = 5.0  # times its sinkage
IMPULSE_SHARE = 0.75  # of the impulse that ends a flight, as a contact returns some of it
SINKAGE_FACTOR = 2.0  # times the specified sinkage


class GroundTable(Table, acts='ground.model = "floor"'):
    """`[ground]`: a level floor with friction. Feet stand on it; rotors, guards and beam touch it in all attitudes.

    A rotor that touches floor or wall stops for the rest of the flight.
    """

    model: Literal["none", "floor"] = key(
        "none", None, "model of the ground", choices={"none": "no ground", "floor": "a level floor"}
    )
    height: float | None = key(
        None,
        "m",
        "height z of the floor",
        rule="the vehicle starts at most 0.02 m deep in it",
        unset="such that the level vehicle stands on it at the start",
        example=-0.1688,
    )
    sinkage: Annotated[Positive, Field(le=0.1)] = key(
        5e-4,
        "m",
        "depth of the feet in the floor under the vehicle's weight; a long step makes the floor softer",
        source="chosen",
    )
    friction: Annotated[float, Field(ge=0.0, le=100.0)] = key(
        0.8, "1", "coefficient of friction of floor and walls", source="chosen: rubber on a dry floor"
    )
    effect: bool = key(
        False,
        None,
        'true: more thrust near the floor (Cheeseman and Bennett, 1955); needs `actuators.model = "rotors"`',
    )


class Standing(NamedTuple):
    """The floor; for the real vehicle standing on it, z [m] of its centre of mass, and its sinkage [m].

    `depth`: of its lowest point in the floor at t = 0, beyond that sinkage [m].
    """

    floor: Floor
    rests: float
    sinkage: float
    depth: float


@cached
def floor_under(vehicle: Vehicle, g: GroundTable, mass_scale: float, step: float, start: float) -> Floor:
    """The floor under a vehicle; unless its height is given, the vehicle stands on it with its centre at `start`."""
    mass = vehicle.mass * mass_scale
    at_zero = floor(vehicle, mass, step, friction=g.friction, sinkage=g.sinkage, hull=hull(vehicle, mass, step))
    height = start - standing_height(at_zero, mass * GRAVITY) if g.height is None else g.height
    return at_zero._replace(height=height)


@cached
def standing_on(g: GroundTable, table: VehicleTable, mass_scale: float, step: float, start: InitialTable) -> Standing:
    """The equilibrium on the floor of a vehicle with this start, which is on the floor by default; `step` in s."""
    vehicle, z = Vehicle.from_settings(table), start.position[2]
    ground, weight = floor_under(vehicle, g, mass_scale, step, z), vehicle.mass * mass_scale * GRAVITY
    stands, sinkage = standing_height(ground, weight), sinkage_of(ground, weight)
    R = rotation_from_euler(vec3(start.euler))
    assert isinstance(ground.hull, Hull)
    lowest = z + min(float((vehicle.soles @ np.array(R.z)).min()), lowest_of_hull(ground.hull, R))
    return Standing(ground, ground.height + stands, sinkage, ground.height - lowest - sinkage)


def floor_checks(g: GroundTable, rotors: str, phases: PhasesTable, *, walls: bool) -> Iterator[CheckResult]:
    """Check for keys that need a missing floor, and for ground effect on ideal rotors; `rotors`: `actuators.model`."""
    if g.model != "none":
        if g.effect and rotors != "rotors":
            yield refused('ground.effect = true: must be false where actuators.model is "ideal"')
        return
    if g.effect:
        yield refused('ground.effect = true: must be false without a floor, or ground.model must be "floor"')
    if walls:
        yield refused('ground.model = "none": must be "floor" where there are walls or a corridor')
    if phases.rotors == "flight":
        yield refused(
            'phases.rotors = "flight": must be "always" without a floor, or the vehicle falls while its rotors are '
            'stopped; or ground.model must be "floor"'
        )


def lift_height_checks(g: GroundTable, phases: PhasesTable) -> Iterator[CheckResult]:
    """Check for a lift that leads down into the floor."""
    if g.model == "floor" and phases.height < 0.0:
        given = f"phases.height = {phases.height}"
        yield refused(f"{given}: must be 0 or above over a floor, or the reference leads into it")


def depth_checks(g: GroundTable, initial: InitialTable, standing: Standing) -> Iterator[CheckResult]:
    """Check for a start deep in the floor."""
    if standing.depth > FOOT_DEPTH:
        key, value, hint = "ground.height", g.height, "must be lower, or initial.position higher"
        if value is None:
            key, hint = "initial.euler", "must be level, or ground.height lower"
        given = shown(initial.euler if value is None else value)
        yield refused(f"{key} = {given}: the vehicle starts {standing.depth:.3g} m deep in the floor; {hint}")


def floor_warnings(
    g: GroundTable, vehicle: VehicleTable, rotors: str, step: float, standing: Standing
) -> Iterator[CheckResult]:
    """Check for a soft floor, ideal rotors on a floor, soles that are not level, and a payload lower than the feet."""
    if standing.sinkage > SINKAGE_FACTOR * g.sinkage:
        yield warned(
            f"ground.sinkage = {g.sinkage} m: with mission.step = {step} s the floor must be softer, "
            f"and the standing vehicle sinks by {standing.sinkage:.2g} m"
        )
    if rotors == "ideal":
        yield warned(
            'actuators.model = "ideal": thrusts have no limits and may pull down, so the pilot may press the vehicle '
            'on the floor with the force of an impact; "rotors" cannot'
        )
    soles = [q.position[2] - q.feet_depth for q in vehicle.quadrotors]
    high, low = (pick(range(len(soles)), key=soles.__getitem__) for pick in (max, min))
    if soles[high] - soles[low] > SOLE_OFFSET:
        yield warned(
            f"the soles of quadrotor {high + 1} are {soles[high] - soles[low]:.3g} m above those of quadrotor "
            f"{low + 1}: the vehicle does not stand level; change position or feet_depth of one"
        )
    lower = soles[low] - float(vehicle.payload.box[0][2])
    if lower > 0.0:
        yield warned(f"the payload hangs {lower:.3g} m lower than the feet: the vehicle stands on it, and may roll")


def start_warnings(p: PhasesTable, standing: Standing) -> Iterator[CheckResult]:
    """Check for a start deep in the floor, or above it with stopped rotors."""
    depth = standing.depth
    if depth > THROW_FACTOR * standing.sinkage:
        thrown = f"{depth**2 / (2.0 * standing.sinkage):.2g} m"  # of springs, undamped
        yield warned(
            f"the vehicle starts {depth:.2g} m deep in the floor, which throws the vehicle up by as much as {thrown}"
        )
    if p.rotors == "flight" and p.lift_start > 0.0 and -depth > DISTANCE_BELOW:
        until = f"with its rotors stopped until {p.lift_start:g} s"
        yield warned(f"the vehicle starts {-depth:.3g} m above the floor, {until}")


def blow_warnings(
    p: PhasesTable, initial: InitialTable, mass: float, limit: float, standing: Standing
) -> Iterator[CheckResult]:
    """Check for an impact on the floor at the start that may end the flight; a contact returns some of the speed.

    With stopped rotors, a vehicle that starts upwards falls back as fast. `mass` [kg] is the real one; an impulse of
    `limit` [N s] ends a flight.
    """
    stopped = p.rotors == "flight" and p.lift_start > 0.0
    down = max(-initial.velocity[2], 0.0)
    speed = math.hypot(*initial.velocity) if stopped or down else 0.0
    if -standing.depth < DISTANCE_BELOW and mass * speed > IMPULSE_SHARE * limit:
        straight = mass * down > IMPULSE_SHARE * limit
        speed = down if straight else speed
        what = f"[2] = {-down:g}" if straight else f" = {shown(initial.velocity)}"
        yield warned(
            f"initial.velocity{what} m/s drives the vehicle into the floor with "
            f"{mass * speed:.3g} N s, and an impact of {limit:.3g} N s (crash.impulse) ends the flight"
        )


def reference_warnings(p: PhasesTable, duration: float, standing: Standing) -> Iterator[CheckResult]:
    """Check for a reference that differs from the height of the standing vehicle, in a flight of `duration` [s]."""
    rests = standing.rests
    stops = math.inf if p.land_start is None else p.land_start + p.land_duration
    if p.rotors == "flight" and rests < -DISTANCE_BELOW and stops < duration:
        yield warned(f"the landing ends at z = 0, {-rests:.3g} m above where the vehicle stands: then its rotors stop")
    if rests > DISTANCE_ABOVE:
        where = f"the vehicle stands at z = {rests:.3g} m while its reference, not lifted, is at z = 0"
        yield warned(f"{where}: it presses down")
