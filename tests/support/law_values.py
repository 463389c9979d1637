"""Shared by the tests of laws: random values, and conversion between value types and arrays."""

from __future__ import annotations

import sys
from typing import Any, NamedTuple, TypeVar, get_args, get_origin

import numpy as np
from hypothesis import strategies as st

from tandemlift.core.vector import ZERO, Mat3, Quat, Vec3, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.mechanics.rigid_body import RigidBody, State, inertia_value
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import Payload, Quadrotor
from tandemlift.parts.mechanics.wind import AirDrag

IRIS = {
    "mass": 1.5,
    "inertia": (0.029125, 0.029125, 0.055225),
    "layout": "+",
    "arm": 0.25,
    "thrust_constant": 5.84e-6,
    "max_speed": 1100.0,
    "torque_per_thrust": 0.06,
    "lag_up": 0.0125,
    "lag_down": 0.025,
}
BEAM = Payload(mass=0.5, length=2.0, radius=0.05)
HEIGHT = 0.075
PI = float(np.pi)


def numbers(size: float = 3.0) -> Any:
    """Floats within ±size, with integers and zero."""
    return st.floats(-size, size, allow_subnormal=False)


def vectors(size: float = 3.0) -> Any:
    return st.builds(Vec3, numbers(size), numbers(size), numbers(size))


def attitudes(roll: float = np.radians(85.0)) -> Any:
    """Euler angles: roll within ±`roll`, any pitch and yaw."""
    return st.builds(Vec3, numbers(float(roll)), numbers(PI), numbers(PI))


seeds = st.integers(0, 2**32 - 1)


def flat(value: Any) -> list[Any]:
    """The numbers of a nested value, whatever their type, depth first."""
    return [x for part in value for x in flat(part)] if isinstance(value, tuple) else [value]


def rebuilt(numbers: Any, like: Any) -> Any:
    """The nested value laid out like `like` whose numbers, of any type, are `numbers`."""
    source = iter(numbers)

    def build(part: Any) -> Any:
        return type(part)(*map(build, part)) if isinstance(part, tuple) else next(source)

    return build(like)


def zeros(kind: Any, **given: Any) -> Any:
    """A value of a law's type, zero in all fields but those that are given.

    A field with a default keeps it. One that may be of several types must be given, or its name is told.
    """
    (*_, of), kind = (None, *get_args(kind)), get_origin(kind) or kind  # such as LowPassState[Vec3]
    assert set(given) <= set(kind._fields), set(given) - set(kind._fields)
    for name in kind._fields:
        if name in given or name in kind._field_defaults:
            continue
        hint = kind.__annotations__[name]
        hint = of if isinstance(hint, TypeVar) else getattr(hint, "__forward_arg__", hint)
        if isinstance(hint, str):
            hint = eval(hint, {"Number": float, **vars(sys.modules[kind.__module__])})
        plain = hint in (float, Any)
        assert plain or hasattr(get_origin(hint) or hint, "_fields"), f"give {name} of {kind.__name__}"
        given[name] = 0.0 if plain else zeros(hint)
    return kind(**given)


def record(name: str, values: Any) -> Any:
    """Any number of values as one nested value."""
    return NamedTuple(name, [(f"x{i}", Any) for i in range(len(values))])(*values)  # type: ignore[misc]


def array(value: Any) -> np.ndarray:
    """A vector, quaternion or matrix as an array."""
    return np.array(value, dtype=float)


def tensor(J: Any) -> np.ndarray:
    """The 3 × 3 array of an inertia value."""
    return array(J) if isinstance(J, Mat3) else np.diag(J)


def random_vec3(rng: np.random.Generator, size: float = 1.0) -> Vec3:
    return vec3(size * rng.standard_normal(3))


def random_attitude(rng: np.random.Generator) -> Quat:
    q = rng.standard_normal(4)
    return Quat(*map(float, q / np.linalg.norm(q)))


def random_state(rng: np.random.Generator, rates: float = 3.0) -> State:
    return State(random_vec3(rng), random_vec3(rng), random_attitude(rng), random_vec3(rng, rates))


def quadrotor(position: Any = (0.0, 1.0, HEIGHT), **changes: Any) -> Quadrotor:
    return Quadrotor(position=tuple(map(float, position)), **{**IRIS, **changes})


def random_moments(rng: np.random.Generator, size: float) -> tuple[float, float, float]:
    """Principal moments that a rigid body can have."""
    a, b, c = map(float, size * rng.uniform(0.1, 1.0, 3))
    return (b + c, a + c, a + b)


def random_vehicle(rng: np.random.Generator, count: int) -> Vehicle:
    """N different quadrotors at any places on any payload: a full inertia tensor."""
    payload = Payload(mass=float(rng.uniform(0.2, 2.0)), inertia=random_moments(rng, 0.2))
    made = [
        quadrotor(
            rng.uniform(-1.0, 1.0, 3),
            mass=float(rng.uniform(0.5, 2.0)),
            inertia=random_moments(rng, 0.05),
            layout=str(rng.choice(["+", "x"])),
            arm=float(rng.uniform(0.1, 0.4)),
            torque_per_thrust=float(rng.uniform(0.01, 0.1)),
        )
        for _ in range(count)
    ]
    return Vehicle(payload, made)


def paper_vehicle() -> Vehicle:
    """Two IRIS quadrotors at ±1 m of the beam's centre, 0.075 m above its axis."""
    return Vehicle(BEAM, [quadrotor((0.0, 1.0, HEIGHT)), quadrotor((0.0, -1.0, HEIGHT))])


def free_body(mass: float, J: np.ndarray) -> RigidBody:
    """A body without drag or disturbance."""
    return RigidBody(1.0 / mass, inertia_value(J), inertia_value(np.linalg.inv(J)), ZERO, ZERO, ZERO, ZERO)


def order_of(steps: Any, errors: Any) -> float:
    """The order of convergence: slope of log error over log step."""
    slope, _ = np.polyfit(np.log(steps), np.log(errors), 1)
    return float(slope)


def drag_of(rng: np.random.Generator, count: int = 2) -> AirDrag:
    payload, quadrotors = rng.uniform(0.0, 0.3, 3), rng.uniform(0.0, 0.1, (3, count))
    return AirDrag(
        vec3(payload), rebuilt(map(float, quadrotors.ravel()), parts_layout_from(paper_vehicle()).quadrotors)
    )
