"""A vehicle as a MuJoCo model: the payload on a free joint, and each quadrotor as a body welded to the payload.

The payload's body frame has its origin at the system's centre of mass, and its axes are the body axes. The state of
MuJoCo's free joint then equals ours: position [m] and velocity [m/s] of the centre of mass in world axes, a quaternion
w, x, y, z, and rates [rad/s] in body axes. Applied forces are in world axes [N], applied moments in body axes about
the centre of mass [N·m].
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.types import GRAVITY, Array
from tandemlift.engines.models import mujoco_contact
from tandemlift.engines.models.mujoco_import import mujoco
from tandemlift.engines.models.scene import Scene
from tandemlift.parts.contact.feet import Floor
from tandemlift.parts.contact.walls import Walls
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import PlantTable, Quadrotor

Weight = tuple[float, ArrayLike]  # kg; kg m², principal moments

FRICTION_IMPEDANCE = 1e7  # MuJoCo's impratio: the inertia of friction is a thousand times the vehicle's
NET_FORCE = 3  # MuJoCo's contact sensor: all contacts reduced to one wrench, in world axes


def model_of(scene: Scene, vehicle: Vehicle, floor: Any, walls: Any) -> Any:
    """The compiled `mujoco.MjModel` of a mission's true vehicle.

    Actuator 4 i + j is rotor j of quadrotor i; its control is the thrust [N]. The sensors, in order: accelerometer at
    the payload's origin (3), force at each joint (3 N), torque at each joint (3 N), and with a floor or walls
    the net contact force (3).

    Args:
        mission: gives step, `plant` and walls.
        vehicle: the nominal vehicle.
        floor: a `parts.contact.feet.Floor`, or `Absent`.
        walls: a `parts.contact.walls.Walls`, or `Absent` for a mission without walls.

    Raises:
        TypeError: the mission has walls, but `walls` is not a `Walls`.
    """
    spec = specification(scene, vehicle, floor, walls)
    difference = _add_difference(spec, scene, vehicle)
    model = spec.compile()
    quadrotors = [(q.mass, principal_axes(q.tensor)[0]) for q in vehicle.quadrotors]
    _set_inertias(model, [(vehicle.payload.mass, principal_axes(vehicle.payload.tensor)[0]), *quadrotors, *difference])
    model.dof_damping[:] = [*vehicle.drag.force, *vehicle.drag.moment]
    mujoco_contact.set_contact_stiffness(model, floor, walls)
    return model


def specification(scene: Scene, vehicle: Vehicle, floor: Any, walls: Any) -> Any:
    """The `mujoco.MjSpec` of `model_of`, before inertias, drag and contact stiffness are set.

    Raises:
        TypeError: the mission has walls, but `walls` is not a `Walls`.
    """
    spec, standing, walled = mujoco.MjSpec(), isinstance(floor, Floor), isinstance(walls, Walls)
    if scene.all_walls and not walled:
        raise TypeError("a mission with walls needs a parts.contact.walls.Walls with their contact parameters")
    _set_options(spec, scene.mission.step, touching=standing or walled)
    _add_payload(spec, vehicle)
    for i, (quadrotor, center) in enumerate(zip(vehicle.quadrotors, vehicle.lever_arms, strict=True), 1):
        _add_quadrotor(spec, f"quadrotor{i}", quadrotor, center)
    _add_sensors(spec, vehicle.count, touching=standing or walled)
    shapes = mujoco_contact.add_vehicle_shapes(spec, floor, walls, vehicle)
    if standing:
        mujoco_contact.add_floor(spec, floor, shapes)
    if walled:
        mujoco_contact.add_walls(spec, walls, scene.all_walls, shapes)
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
    _, quat = principal_axes(vehicle.payload.tensor)
    body = spec.worldbody.add_body(name="payload", iquat=quat, **_placeholder_inertia(vehicle.payload_center))
    body.add_joint(name="free", type=mujoco.mjtJoint.mjJNT_FREE, align=mujoco.mjtAlignFree.mjALIGNFREE_FALSE)
    body.add_site(name="payload", pos=vehicle.origin)
    for k, hull in enumerate(vehicle.payload.hulls):
        spec.add_mesh(name=mujoco_contact.hull_name(k), uservert=hull.corners.ravel(), userface=hull.triangles.ravel())


def _add_quadrotor(spec: Any, name: str, quadrotor: Quadrotor, center: Array) -> None:
    """Add a quadrotor welded to the payload, with its centre of mass at `center`; sites at its joint and rotors."""
    _, quat = principal_axes(quadrotor.tensor)
    body = spec.body("payload").add_body(name=name, pos=center, iquat=quat, **_placeholder_inertia())
    body.add_site(name=name, pos=np.subtract(quadrotor.joint_position, quadrotor.position))
    for j, ((x, y), spin) in enumerate(zip(quadrotor.rotors, quadrotor.spins, strict=True), 1):
        rotor = f"{name} rotor{j}"
        body.add_site(name=rotor, pos=[x, y, 0.0])
        gear = [0.0, 0.0, 1.0, 0.0, 0.0, quadrotor.torque_per_thrust * spin]
        spec.add_actuator(name=rotor, target=rotor, trntype=mujoco.mjtTrn.mjTRN_SITE, gear=gear)


def _add_difference(spec: Any, scene: Scene, vehicle: Vehicle) -> list[Weight]:
    """Add the real whole at its centre of mass, and take away the modelled one at its own, of negative mass.

    No body is added if there is no difference.
    """
    plant = scene.plant
    if plant == PlantTable():
        return []
    weights: list[Weight] = []
    real = (plant.mass_scale * vehicle.mass, vehicle.real_inertia(plant), np.array(plant.center_of_mass_offset))
    for name, (mass, J, center) in {"real": real, "modelled": (-vehicle.mass, -vehicle.inertia, np.zeros(3))}.items():
        moments, quat = principal_axes(J)
        spec.body("payload").add_body(name=name, iquat=quat, **_placeholder_inertia(center))
        weights.append((mass, moments))
    return weights


def principal_axes(tensor: Array) -> tuple[Array, Array]:
    """The principal moments of a tensor (3 × 3), and the quaternion of their axes; of a diagonal one as they stand."""
    moments, axes, quat = np.diag(tensor), np.eye(3), np.empty(4)
    if np.any(tensor != np.diag(moments)):
        moments, axes = np.linalg.eigh(tensor)
    mujoco.mju_mat2Quat(quat, (axes * [1.0, 1.0, np.linalg.det(axes)]).ravel())
    return moments, quat


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
            reftype=mujoco.mjtObj.mjOBJ_XBODY,  # the body and its parts
            refname="payload",
            intprm=[1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE), NET_FORCE, 1],
        )
