"""The drag of the air on the parts, against NumPy and by what falls in it; the shadow of a beam."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from law_values import array, drag_of, paper_vehicle, quadrotor, random_state, random_vec3, seeds
from scipy.integrate import solve_ivp
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Quat, Vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.mechanics.joint_loads import resultant
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import Payload
from tandemlift.parts.mechanics.wind import AirDrag, air_drag_from, air_loads

DENSITY = 1.225


def parts_of(s: State) -> tuple[np.ndarray, np.ndarray]:
    """The parts' velocities (world), payload first, and R."""
    vehicle = paper_vehicle()
    arms = np.vstack([-vehicle.center_of_mass, vehicle.lever_arms])
    R = Rotation.from_quat(array(s.attitude), scalar_first=True).as_matrix()
    return array(s.velocity) + np.cross(array(s.rates), arms) @ R.T, R


def forces_of(drag: AirDrag, s: State, air: Vec3) -> np.ndarray:
    """Force on every part [N, world axes], payload first."""
    loads = air_loads(drag, parts_layout_from(paper_vehicle()), s, air)
    return np.vstack([array(loads.payload.force), array(loads.quadrotors.force).T])


@given(seeds)
def test_drag_is_quadratic_in_the_speed_of_each_part_through_the_air(seed):
    """Against NumPy, part by part: −k |v| v in body axes, turned to world axes."""
    rng = np.random.default_rng(seed)
    drag, s, air = drag_of(rng), random_state(rng), random_vec3(rng, 4.0)
    velocities, R = parts_of(s)
    coefficients = np.vstack([array(drag.payload), array(drag.quadrotors).T])
    through = (velocities - array(air)) @ R
    wanted = (-coefficients * np.linalg.norm(through, axis=1)[:, None] * through) @ R.T
    assert forces_of(drag, s, air) == pytest.approx(wanted, abs=1e-12)
    moments = air_loads(drag, parts_layout_from(paper_vehicle()), s, air)
    assert moments.payload.moment == ZERO
    assert not array(moments.quadrotors.moment).any()


def level(velocity: Vec3) -> State:
    return State(ZERO, velocity, Quat(1.0, 0.0, 0.0, 0.0), ZERO)


def test_a_falling_vehicle_comes_to_its_terminal_velocity():
    """v = V tanh(g t / V), V = √(m g / k): the closed form of fall with quadratic drag."""
    vehicle = paper_vehicle()
    drag, frame = air_drag_from(vehicle, DENSITY), parts_layout_from(vehicle)
    k = 0.5 * DENSITY * (2.0 * 0.05 * 2.0 + 2 * 0.05)  # the beam from below, and two quadrotors
    V = np.sqrt(vehicle.mass * GRAVITY / k)

    def fall(t: float, v: np.ndarray) -> list[float]:
        s = level(Vec3(0.0, 0.0, float(v[0])))
        return [resultant(frame, s.attitude, air_loads(drag, frame, s, ZERO)).force.z / vehicle.mass - GRAVITY]

    times = np.linspace(0.0, 8.0, 9)
    found = solve_ivp(fall, (0.0, 8.0), [0.0], t_eval=times, rtol=1e-10, atol=1e-10).y[0]
    assert found == pytest.approx(-V * np.tanh(GRAVITY * times / V), abs=1e-7)
    at_end = level(Vec3(0.0, 0.0, -float(V)))
    weight = resultant(frame, at_end.attitude, air_loads(drag, frame, at_end, ZERO)).force
    assert weight == pytest.approx((0.0, 0.0, vehicle.mass * GRAVITY), abs=1e-9)


def test_a_beam_is_seen_as_the_shadow_of_a_cylinder():
    """The areas of the payload by the convex hull of its surface's points; drag ½ ρ C_d A V²."""
    beam = Payload(mass=0.5, length=2.0, radius=0.05, drag_coefficient=1.2)
    around = np.linspace(0.0, 2.0 * np.pi, 4000)
    ends = [np.column_stack([0.05 * np.cos(around), 0.0 * around + y, 0.05 * np.sin(around)]) for y in (-1.0, 1.0)]
    surface = np.vstack(ends)
    shadows = [ConvexHull(np.delete(surface, axis, 1)).volume for axis in range(3)]
    drag = air_drag_from(Vehicle(beam, [quadrotor()]), DENSITY)
    assert array(drag.payload) == pytest.approx(0.5 * DENSITY * 1.2 * np.array(shadows), rel=1e-5)


@pytest.mark.thorough
def test_drag_at_rest_is_zero_and_has_a_derivative(jax):
    drag, frame = drag_of(np.random.default_rng(0)), parts_layout_from(paper_vehicle())

    def force(v: Any) -> Any:
        s = State(ZERO, Vec3(v[0], v[1], v[2]), Quat(1.0, 0.0, 0.0, 0.0), ZERO)
        loads = air_loads(drag, frame, s, ZERO)
        return jax.numpy.stack([*loads.payload.force, *loads.quadrotors.force.x])

    at_rest = jax.numpy.zeros(3)
    assert not np.asarray(force(at_rest)).any()
    assert np.abs(jax.jacobian(force)(at_rest)).max() < 1e-90
