"""A vehicle as a MuJoCo model: the payload on a free joint, and each quadrotor as a body welded to the payload.

The payload's body frame has its origin at the system's centre of mass, and its axes are the body axes. The state of
MuJoCo's free joint then equals ours: position [m] and velocity [m/s] of the centre of mass in world axes, a quaternion
w, x, y, z, and rates [rad/s] in body axes. Applied forces are in world axes [N], applied moments in body axes about
the centre of mass [N·m].

With a small impedance d, MuJoCo's contact constraint (Computation: Parameters) is a spring and damper:
f = (−b v − k r − a)/R with R = (1 − d)/d Â. Its inertia 1/R is a ten-thousandth of the vehicle's effective inertia at
the contact, so a foot of stiffness K sinks by exactly f/K. Friction is MuJoCo's own: a sticking foot creeps by
micrometres per second.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.algebra.constants import GRAVITY
from tandemlift.common.errors import InputError
from tandemlift.common.types import Array
from tandemlift.laws.mechanics.contact import Floor
from tandemlift.laws.mechanics.walls import Beam, Walls
from tandemlift.settings import Mission, Quadrotor, WallTable
from tandemlift.vehicle import Vehicle

try:
    import mujoco
except ModuleNotFoundError as error:
    if error.name != "mujoco":
        raise
    raise InputError("engine 'mujoco' needs the package mujoco: pip install 'tandemlift[mujoco]'") from None
if int(mujoco.__version__.split(".")[0]) < 4:
    raise InputError(
        f"engine 'mujoco' needs mujoco 4.0 or newer, whose Runge-Kutta step is of order four for attitudes too; "
        f"{mujoco.__version__} is installed: pip install --upgrade 'tandemlift[mujoco]'"
    )

Weight = tuple[float, ArrayLike]  # kg; kg m², principal moments

SOFT = 1e-4  # impedance d of contacts, MuJoCo's smallest: almost a pure spring and damper
FRICTION_IMPEDANCE = 1e7  # MuJoCo's impratio: the inertia of friction is a thousand times the vehicle's
STICKING = 0.2  # fraction of a foot's sliding speed that friction below its limit removes in one step
POINT = 1e-4  # m, radius of the sphere that represents a foot's ball joint
THIN = 1e-4  # m, thickness of a wall
NET_FORCE = 3  # MuJoCo's contact sensor: all contacts reduced to one wrench, in world axes
DEEP = 1e3  # m, height of the walls, which reach below any floor


def model_of(mission: Mission, vehicle: Vehicle, floor: Any, walls: Any) -> Any:
    """The compiled `mujoco.MjModel` of a mission's true vehicle.

    Actuator 4 i + j is rotor j of quadrotor i; its control is the thrust [N]. The sensors, in order: accelerometer at
    the payload's centre of mass (3), force at each joint (3 N), torque at each joint (3 N), and with a floor or walls
    the net contact force (3).

    Args:
        mission: gives step, `plant` and walls.
        vehicle: the nominal vehicle.
        floor: a `laws.mechanics.contact.Floor`, or `Nothing`.
        walls: a `laws.mechanics.walls.Walls`, or `Nothing` for a mission without walls.

    Raises:
        TypeError: the mission has walls, but `walls` is not a `Walls`.
    """
    spec = specification(mission, vehicle, floor, walls)
    difference = _add_difference(spec, mission, vehicle)
    model = spec.compile()
    quadrotors = [(q.mass, q.inertia) for q in vehicle.quadrotors]
    _set_inertias(model, [(vehicle.payload.mass, vehicle.payload.moments), *quadrotors, *difference])
    model.dof_damping[:] = [*vehicle.drag.force, *vehicle.drag.moment]
    set_contact_stiffness(model, floor, walls)
    return model


def specification(mission: Mission, vehicle: Vehicle, floor: Any, walls: Any) -> Any:
    """The `mujoco.MjSpec` of `model_of`, before inertias, drag and contact stiffness are set.

    Raises:
        TypeError: the mission has walls, but `walls` is not a `Walls`.
    """
    spec, standing, walled = mujoco.MjSpec(), isinstance(floor, Floor), isinstance(walls, Walls)
    if mission.all_walls and not walled:
        raise TypeError("a mission with walls needs a laws.mechanics.walls.Walls with their contact parameters")
    _set_options(spec, mission.mission.step, touching=standing or walled)
    _add_payload(spec, vehicle)
    for i, (quadrotor, center) in enumerate(zip(vehicle.quadrotors, vehicle.lever_arms, strict=True), 1):
        _add_quadrotor(spec, f"quadrotor{i}", quadrotor, center)
    _add_sensors(spec, vehicle.count, touching=standing or walled)
    if standing:
        _add_floor(spec, floor, vehicle)
    if walled:
        _add_walls(spec, walls, mission.all_walls, vehicle)
    return spec


def _set_options(spec: Any, step: float, *, touching: bool) -> None:
    """Set Runge-Kutta and gravity; disable resets, and contacts where there are no surroundings."""
    option, disable = spec.option, mujoco.mjtDisableBit
    option.timestep, option.gravity = step, [0.0, 0.0, -GRAVITY]
    option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    option.cone, option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, FRICTION_IMPEDANCE
    flags = [disable.mjDSBL_AUTORESET] if touching else [disable.mjDSBL_AUTORESET, disable.mjDSBL_CONSTRAINT]
    option.disableflags = reduce(int.__or__, map(int, flags))


def _add_payload(spec: Any, vehicle: Vehicle) -> None:
    """Add the payload, the root body, with its frame at the system's centre of mass."""
    center = -vehicle.center_of_mass
    body = spec.worldbody.add_body(name="payload", **_placeholder_inertia(center))
    body.add_joint(name="free", type=mujoco.mjtJoint.mjJNT_FREE, align=mujoco.mjtAlignFree.mjALIGNFREE_FALSE)
    body.add_site(name="payload", pos=center)


def _add_quadrotor(spec: Any, name: str, quadrotor: Quadrotor, center: Array) -> None:
    """Add a quadrotor welded to the payload, with its centre of mass at `center`; sites at its joint and rotors."""
    body = spec.body("payload").add_body(name=name, pos=center, **_placeholder_inertia())
    body.add_site(name=name, pos=np.subtract(quadrotor.joint_position, quadrotor.position))
    for j, ((x, y), spin) in enumerate(zip(quadrotor.rotors, quadrotor.spins, strict=True), 1):
        rotor = f"{name} rotor{j}"
        body.add_site(name=rotor, pos=[x, y, 0.0])
        gear = [0.0, 0.0, 1.0, 0.0, 0.0, quadrotor.torque_per_thrust * spin]
        spec.add_actuator(name=rotor, target=rotor, trntype=mujoco.mjtTrn.mjTRN_SITE, gear=gear)


def _add_difference(spec: Any, mission: Mission, vehicle: Vehicle) -> list[Weight]:
    """Add a body at the centre of mass with the difference in inertia between true and nominal vehicle.

    Its mass and principal moments may be negative. No body is added if there is no difference.
    """
    scale, J = np.diag(np.sqrt(mission.plant.inertia_scale)), vehicle.inertia
    mass = (mission.plant.mass_scale - 1.0) * vehicle.mass
    moments, axes = np.linalg.eigh(scale @ J @ scale - J)
    if not mass and not moments.any():
        return []
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, (axes * [1.0, 1.0, np.linalg.det(axes)]).ravel())
    spec.body("payload").add_body(name="difference", iquat=quat, **_placeholder_inertia())
    return [(mass, moments)]


def _placeholder_inertia(center: ArrayLike = (0.0, 0.0, 0.0)) -> dict[str, Any]:
    """Placeholder inertia of a body, later set by `_set_inertias`; `center` of mass in the body's frame (3) [m]."""
    return {"explicitinertial": True, "mass": 1.0, "inertia": [1.0, 1.0, 1.0], "ipos": center}


def _set_inertias(model: Any, weights: Sequence[Weight]) -> None:
    """Set mass and principal moments of all bodies in order, and update the constants that depend on them.

    MuJoCo's compiler refuses small and negative values, and flat bodies because of rounding; its dynamics only need
    the total to be a physical mass and inertia.
    """
    for index, (mass, moments) in enumerate(weights, 1):
        model.body_mass[index], model.body_inertia[index] = mass, moments
    mujoco.mj_setConst(model, mujoco.MjData(model))


def _add_sensors(spec: Any, count: int, *, touching: bool) -> None:
    """Add accelerometer, force and torque of every joint, and the net contact force in world axes."""
    kind, at_site = mujoco.mjtSensor, mujoco.mjtObj.mjOBJ_SITE
    spec.add_sensor(name="accelerometer", type=kind.mjSENS_ACCELEROMETER, objtype=at_site, objname="payload")
    for label, what in (("force", kind.mjSENS_FORCE), ("torque", kind.mjSENS_TORQUE)):
        for i in range(1, count + 1):
            spec.add_sensor(name=f"{label}{i}", type=what, objtype=at_site, objname=f"quadrotor{i}")
    if touching:
        spec.add_sensor(
            name="contact",
            type=kind.mjSENS_CONTACT,
            objtype=mujoco.mjtObj.mjOBJ_BODY,
            objname="world",
            reftype=mujoco.mjtObj.mjOBJ_XBODY,  # the body and what it carries
            refname="payload",
            intprm=[1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE), NET_FORCE, 1],
        )


def _add_shape(body: Any, name: str, kind: Any, **attributes: Any) -> None:
    """Add a massless shape that collides only with the shapes that it is paired with."""
    body.add_geom(name=name, type=kind, mass=0.0, contype=0, conaffinity=0, **attributes)


def _add_contact_pair(spec: Any, one: str, other: str, friction: float) -> None:
    """Let two shapes collide, with friction unless its coefficient is zero."""
    flat = [friction, friction, 1.0, 1.0, 1.0]
    spec.add_pair(
        name=f"{one} {other}",
        geomname1=one,
        geomname2=other,
        condim=3 if friction else 1,
        friction=flat,
        solimp=[SOFT, SOFT, 1.0, 0.5, 1.0],
    )


def _add_floor(spec: Any, floor: Floor, vehicle: Vehicle) -> None:
    """Add the floor, and a small sphere at the ball joint of every foot; the pads' radius is left out of both."""
    shape, height = mujoco.mjtGeom, floor.height + floor.radius - POINT
    _add_shape(spec.worldbody, "floor", shape.mjGEOM_PLANE, size=[0.0, 0.0, 1.0], pos=[0.0, 0.0, height])
    centers = np.array(floor.feet).transpose(2, 0, 1)  # (N, 4, 3)
    for i, (feet, center) in enumerate(zip(centers, vehicle.lever_arms, strict=True), 1):
        for j, place in enumerate(feet - center, 1):
            foot = f"quadrotor{i} foot{j}"
            _add_shape(spec.body(f"quadrotor{i}"), foot, shape.mjGEOM_SPHERE, size=[POINT, 0.0, 0.0], pos=place)
            _add_contact_pair(spec, "floor", foot, floor.friction)


def _add_walls(spec: Any, walls: Walls, upright: Sequence[WallTable], vehicle: Vehicle) -> None:
    """Add walls as thin boxes, a sphere around each quadrotor, and a capsule along the payload."""
    shape, touching = mujoco.mjtGeom, []
    for i, radius in enumerate(walls.guards, 1):
        touching.append(f"quadrotor{i} guard")
        _add_shape(spec.body(f"quadrotor{i}"), touching[-1], shape.mjGEOM_SPHERE, size=[radius, 0.0, 0.0])
    if isinstance(walls.beam, Beam):
        touching.append("beam")
        ends = np.array([[0.0, end, 0.0] for end in walls.beam.ends]) - vehicle.center_of_mass
        size = [walls.beam.radius, 0.0, 0.0]
        _add_shape(spec.body("payload"), "beam", shape.mjGEOM_CAPSULE, size=size, fromto=ends.ravel())
    for k, wall in enumerate(upright, 1):
        (x1, y1), (x2, y2), along = wall.start, wall.end, np.subtract(wall.end, wall.start)
        turn = np.arctan2(along[1], along[0]) / 2.0
        box: dict[str, Any] = {
            "pos": [(x1 + x2) / 2.0, (y1 + y2) / 2.0, wall.top - DEEP / 2.0],
            "size": [np.hypot(*along) / 2.0, THIN / 2.0, DEEP / 2.0],
            "quat": [np.cos(turn), 0.0, 0.0, np.sin(turn)],
        }
        _add_shape(spec.worldbody, f"wall{k}", shape.mjGEOM_BOX, **box)
        for part in touching:
            _add_contact_pair(spec, f"wall{k}", part, walls.friction)


def set_contact_stiffness(model: Any, floor: Any, walls: Any) -> None:
    """Set stiffness [N/m] and damping [N·s/m] of every contact pair, from the contact parameters of floor and walls."""
    ground = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, "floor")
    for p in range(model.npair):
        shapes = int(model.pair_geom1[p]), int(model.pair_geom2[p])
        side = floor if ground in shapes else walls
        part = max(shapes, key=lambda shape: model.geom_bodyid[shape])  # the other is fixed to the world
        R_d = (1.0 - SOFT) * model.body_invweight0[model.geom_bodyid[part], 0]
        model.pair_solref[p] = -np.array([side.stiffness, side.damping]) * R_d
        model.pair_solreffriction[p] = [-1.0, -STICKING / model.opt.timestep * SOFT]
