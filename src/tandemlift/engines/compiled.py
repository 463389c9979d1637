"""The compiled body: one rigid body, moved by a Runge-Kutta step of order four."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tandemlift.law import law
from tandemlift.laws.allocation import Mixer, wrench
from tandemlift.laws.body import Body, State, rk4
from tandemlift.laws.inertia import inertia_value
from tandemlift.laws.push import Hand
from tandemlift.laws.rotation import quaternion_from_euler
from tandemlift.pilot import mixer_value
from tandemlift.settings import Mission, VehicleTable
from tandemlift.vector import vec3
from tandemlift.vehicle import Vehicle


class Plant(NamedTuple):
    """The body as it really is: what rotor thrusts do to it, and how it moves."""

    effect: Mixer
    body: Body


@law
def advance(plant: Plant, state: State, thrusts: Any, hand: Hand, dt: Any) -> State:
    """The state [SI] after dt [s] with the rotor thrusts [N] held and the push continuous."""
    return rk4(state, wrench(plant.effect, thrusts), hand, plant.body, dt)


@lru_cache(maxsize=64)
def _effect(vehicle: VehicleTable) -> Mixer:
    return mixer_value(Vehicle.from_settings(vehicle).effect)


def start_plant(mission: Mission, vehicle: Vehicle) -> tuple[Plant, State]:
    """The body of a mission and its state at t = 0."""
    scale = np.diag(np.sqrt(mission.plant.inertia_scale))
    J = scale @ vehicle.inertia @ scale
    body = Body(
        inverse_mass=1.0 / (vehicle.mass * mission.plant.mass_scale),
        inertia=inertia_value(J),
        inverse_inertia=inertia_value(np.linalg.inv(J)),
        drag_force=vec3(vehicle.drag.force),
        drag_moment=vec3(vehicle.drag.moment),
        force=vec3(mission.disturbance.force),
        moment=vec3(mission.disturbance.moment),
    )
    initial = mission.initial
    attitude = quaternion_from_euler(vec3(initial.euler))
    state = State(vec3(initial.position), vec3(initial.velocity), attitude, vec3(initial.rates))
    return Plant(_effect(mission.vehicle), body), state
