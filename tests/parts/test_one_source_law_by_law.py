"""One source everywhere, law by law: those that the steps of `test_one_source.py` do not need, or need in part."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from law_values import flat, rebuilt, record
from machine_code import answers

from tandemlift.core.vector import (
    Absent,
    Mat3,
    Quarters,
    Quat,
    Vec3,
    each,
    outer,
)
from tandemlift.parts.contact import feet as contact
from tandemlift.parts.contact import hull, impulses, spheres, touches, walls
from tandemlift.parts.controllers import attitude_reference, equations_of_motion, sliding_surface
from tandemlift.parts.estimation import wind_compensation
from tandemlift.parts.guidance import guidance
from tandemlift.parts.interaction import policy
from tandemlift.parts.mechanics import loads, low_pass, parts, rotation
from tandemlift.parts.mechanics.push import PointPush
from tandemlift.parts.mechanics.rigid_body import RigidBody, State, Wrench, motion
from tandemlift.parts.mechanics.wall_geometry import Wall
from tandemlift.parts.rotors import allocation, ground_effect, rotor_faults, rotor_lag, rotor_lead, rotors
from tandemlift.parts.rotors import decision as rotor_loss_decision
from tandemlift.parts.rotors import detection as rotor_loss_detection

V = Vec3(0.0, 0.0, 0.0)
M = Mat3(V, V, V)
Q = Quat(0.0, 0.0, 0.0, 0.0)
EULER = rotation.Euler(V, *[0.0] * 7)
BODY = RigidBody(0.0, V, V, V, V, V, V)
JOINT = parts.Joint(V, V)
SURFACE = sliding_surface.Surface(V, V, sliding_surface.Power(V), V, V, sliding_surface.Tanh(V))
AXES = equations_of_motion.GeneralizedVector(V, V)
STATE = State(V, V, Q, V)
TWO, EIGHT = each(2)(0.0, 0.0), each(8)(*[0.0] * 8)  # a value of every quadrotor, and of every rotor
VV, FOUR = Vec3(TWO, TWO, TWO), Quarters(TWO, TWO, TWO, TWO)
FRAME = loads.PartsLayout(V, VV, VV, TWO, VV, FOUR, FOUR, FOUR)
LOADS = loads.PartLoads(loads.PartLoad(V, V), loads.PartLoad(VV, VV))
FELT = loads.PerfectReadings(V, VV, VV, V)
FLOOR = contact.Floor(*[0.0] * 7, Quarters(VV, VV, VV, VV), V, 0.0, Absent())
ROUND = hull.Ellipsoids(VV, TWO, TWO)
HULL = hull.Hull(*[0.0] * 3, hull.Ellipsoids(Vec3(EIGHT, EIGHT, EIGHT), EIGHT, EIGHT), ROUND, ROUND, V, V, 0.0)
PRESSED = hull.FloorContact(VV, TWO, VV)
LYING = hull.HullContact(
    hull.FloorContact(Vec3(EIGHT, EIGHT, EIGHT), EIGHT, Vec3(EIGHT, EIGHT, EIGHT)), PRESSED, PRESSED
)
SPHERES = spheres.RotorSpheres(Vec3(EIGHT, EIGHT, EIGHT), EIGHT)
GRIP = Quarters(*[contact.FootGrip(TWO, TWO, TWO)] * 4)
WALLS = walls.Walls(*[0.0] * 4, TWO, SPHERES, walls.Beam(0.0, TWO), 0.0)
UPRIGHT, UPRIGHTS = Wall(*[0.0] * 6), Wall(*[TWO] * 6)
NEAR_ROTORS = spheres.NearRotors(Wall(*[EIGHT] * 6), Wall(*[EIGHT] * 6))
NEAR = walls.NearWalls(UPRIGHTS, UPRIGHTS, NEAR_ROTORS, walls.NearBeam(UPRIGHTS, UPRIGHT, UPRIGHT, UPRIGHT))
ON_WALL = spheres.WallContact(0.0, V, V, loads.PartLoad(V, V))
ON_WALLS = spheres.WallContact(TWO, VV, VV, loads.PartLoad(VV, VV))
ROTOR_ON_WALL = spheres.WallContact(
    EIGHT, *[Vec3(EIGHT, EIGHT, EIGHT)] * 2, loads.PartLoad(*[Vec3(EIGHT, EIGHT, EIGHT)] * 2)
)
TOUCHING = walls.NearWallContact(
    spheres.ContactPair(ON_WALLS, ON_WALLS),
    spheres.ContactPair(ROTOR_ON_WALL, ROTOR_ON_WALL),
    walls.BeamContact(ON_WALLS, *[ON_WALL] * 3),
)
LAG, MIXER = rotor_lag.Lag(EIGHT, EIGHT, EIGHT), allocation.Mixer(EIGHT, EIGHT, EIGHT, EIGHT)
SURFACES = ground_effect.GroundEffect(Vec3(EIGHT, EIGHT, EIGHT), EIGHT, 0.0)
ROTORS = rotors.Rotors(
    EIGHT, EIGHT, EIGHT, LAG, LAG, rotor_faults.RotorFaults(EIGHT, EIGHT), SURFACES, 0.0, Wrench(0.0, V)
)
FOURS, LOW = each(4)(*[0.0] * 4), low_pass.LowPass(*[0.0] * 4)
SMOOTH, SMOOTHS = low_pass.LowPassState(FOURS, FOURS), low_pass.LowPassState(EIGHT, EIGHT)
DETECTION = rotor_loss_detection.RotorLossDetection(
    0.0, V, MIXER, LOW, LOW, LOW, LOW, FOURS, FOURS, EIGHT, EIGHT, rotor_loss_decision.DecisionRules(*[0.0] * 6)
)
WATCHING = rotor_loss_detection.DetectionState(
    *[SMOOTHS] * 2, *[SMOOTH] * 4, rotor_loss_decision.DecisionState(EIGHT, 0.0, 0.0, EIGHT, 0.0)
)
HEARD = guidance.PilotInput(STATE, V, V, 0.0, Absent())
SLOPE = low_pass.LowPassState(V, V)
BLOWN = wind_compensation.PayloadDragState(V, 0.0, SLOPE)
CONSTRAINED = allocation.ConstrainedAllocation(
    MIXER, MIXER, Wrench(0.0, V), EIGHT, rotor_faults.RotorFaults(EIGHT, EIGHT)
)

LAWS: dict[str, tuple[Callable[..., Any], tuple[Any, ...]]] = {
    "outer": (outer, (V, V)),
    "rates from Euler rates": (rotation.rates_from_euler_rates, (EULER, V)),
    "point on body": (parts.point_on_body, (parts.Point(V, V, V), M, V, V, V)),
    "quadrotor acceleration": (parts.quadrotor_acceleration, (0.0, V, V, 0.0, V, V, JOINT)),
    "joint wrench, full": (parts.joint_wrench, (0.0, M, V, 0.0, V, V, parts.Acceleration(V, V))),
    "joint on payload": (parts.joint_on_payload, (M, V, JOINT)),
    "payload acceleration": (parts.payload_acceleration, (0.0, V, V, JOINT)),
    "virtual inputs": (rotation.virtual_inputs, (EULER, 0.0)),
    "surface rate": (sliding_surface.surface_rate, (SURFACE, V, V, V)),
    "Lyapunov": (sliding_surface.lyapunov, (V,)),
    "Lyapunov rate": (sliding_surface.lyapunov_rate, (V, V)),
    "bound of the Lyapunov rate": (sliding_surface.lyapunov_rate_bound, (V, V, V, V)),
    "reaching time": (sliding_surface.reaching_time, (V, V, V, V)),
    "expanded dynamics": (equations_of_motion.expanded_dynamics, (BODY, V, V, AXES)),
    "Euler dynamics": (equations_of_motion.euler_dynamics, (BODY, EULER, V, V, Wrench(0.0, V))),
    "thrusts of rotors": (rotors.rotors_step, (ROTORS, rotors.RotorState(EIGHT, EIGHT), EIGHT, STATE, 0.0)),
    "commands to weak rotors": (allocation.rotor_commands, (CONSTRAINED, EIGHT, 0.0)),
    "watching for a lost rotor": (
        rotor_loss_detection.detection_step,
        (DETECTION, WATCHING, HEARD, EIGHT, 0.0, 0.0, 0.0),
    ),
    "wind on the payload": (
        wind_compensation.wind_on_payload,
        (wind_compensation.PayloadDrag(0.0, 0.0, LOW), BLOWN, TWO, TWO, 1.0, 0.0, 0.0),
    ),
    "a wrench with lead": (
        rotor_lead.lead_step,
        (
            rotor_lead.RotorLead(LOW, 0.0, V),
            rotor_lead.RotorLeadState(low_pass.LowPassState(0.0, 0.0), SLOPE),
            Wrench(0.0, V),
        ),
    ),
    "a smooth attitude reference": (
        attitude_reference.shape_reference,
        (
            attitude_reference.SmoothCommandFilter(LOW, attitude_reference.CommandFilter(*[0.0] * 5)),
            attitude_reference.SmoothCommandFilterState(SLOPE, attitude_reference.CommandFilterState(V, V)),
            V,
        ),
    ),
    "share of a wrench": (allocation.achieved_fraction, (MIXER, Wrench(0.0, V), Wrench(0.0, V), EIGHT)),
    "what joints pass on": (loads.readings_with_load, (LOADS.quadrotors, FRAME, Q, FELT)),
    "feet on the floor": (contact.feet_load, (FLOOR, GRIP, FRAME, STATE)),
    "feet that slip": (contact.grips_after_step, (FLOOR, GRIP, STATE)),
    "rotors, guards and beam on the floor": (hull.hull_contact, (HULL, 0.0, 0.0, STATE, M)),
    "loads of the floor on them": (hull.hull_loads, (LYING, FRAME, M)),
    "damping by a policy": (
        policy.policy_damping,
        (policy.Policy(each(14)(*[0.0] * 14), each(6)(*[0.0] * 6), 0.0, V), low_pass.LowPassState(V, V), V, 0.0),
    ),
    "a record of touches": (
        touches.record_after,
        (touches.TouchRecord(0.0, V, 0.0, 0.0, 0.0), touches.PartContacts(EIGHT, Vec3(EIGHT, EIGHT, EIGHT)), 0.0, 0.0),
    ),
    "near walls": (walls.near_wall_loads, (WALLS, NEAR, FRAME, STATE)),
    "impulses of walls": (
        impulses.impulses_of_walls,
        (WALLS, TOUCHING, FRAME, BODY, STATE, STATE, STATE, 0.0),
    ),
    "nearest walls": (walls.nearest_with, (WALLS, UPRIGHT, NEAR, FRAME, STATE)),
    "motion, pushed at points": (motion, (BODY, State(V, V, Q, V), Wrench(0.0, V), PointPush(V, M))),
}
POSITIVE = {
    "surface rate",
    "watching for a lost rotor",
    "thrusts of rotors",
    "commands to weak rotors",
    "feet on the floor",
    "feet that slip",
    "rotors, guards and beam on the floor",
}
BATCH = 12
EACH = pytest.mark.parametrize("name", LAWS)


def inputs(name: str) -> np.ndarray:
    """Random numbers for a law's arguments: (numbers × BATCH)."""
    rng = np.random.default_rng(len(name))
    numbers = rng.uniform(-1.5, 1.5, (len(flat(LAWS[name][1])), BATCH))
    if name == "reaching time":  # λ₁ > 0, λ₂ > |δ|
        numbers[:6], numbers[9:] = 2.0 + np.abs(numbers[:6]), numbers[9:] * 0.5
    return np.abs(numbers) if name in POSITIVE else numbers


def evaluated(name: str, numbers: Any) -> list[Any]:
    law, arguments = LAWS[name]
    return flat(law(*rebuilt(numbers, record("Arguments", arguments))))


def expected(name: str) -> np.ndarray:
    return np.array([evaluated(name, map(float, column)) for column in inputs(name).T]).T


def assert_agreement(found: Any, wanted: np.ndarray) -> None:
    """To 1e-12 of the largest number of a law's answer."""
    assert np.abs(np.broadcast_to(found, wanted.shape) - wanted).max() < 1e-12 * (1.0 + np.abs(wanted).max())


@EACH
def test_numpy_broadcasts_the_law(name):
    assert_agreement(np.array([np.broadcast_to(row, BATCH) for row in evaluated(name, inputs(name))]), expected(name))


@EACH
def test_jax_evaluates_the_law(name, jax):
    rows = evaluated(name, list(jax.numpy.asarray(inputs(name))))
    assert_agreement(np.array([np.broadcast_to(row, BATCH) for row in rows]), expected(name))


@EACH
def test_casadi_traces_the_law(name, casadi):
    symbols = casadi.SX.sym("numbers", len(inputs(name)))
    outputs = casadi.vertcat(*evaluated(name, casadi.vertsplit(symbols)))
    assert_agreement(np.array(casadi.Function("law", [symbols], [outputs])(inputs(name))), expected(name))


@EACH
def test_machine_code_of_the_law(name):
    law, arguments = LAWS[name]
    alone, block = (answers(law, arguments, inputs(name).T, lanes) for lanes in (1, 8))
    assert_agreement(alone.T, expected(name))
    assert np.array_equal(alone, block)
