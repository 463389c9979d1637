"""A mission as an MJCF model: the model of the engine `mujoco`, with visuals and the mission's initial state.

Control 4 i + j is the thrust of rotor j of quadrotor i [N]. The sensors have the names of
`engines.models.mujoco_bodies.model_of`. A joint's sensors read the load of the payload on the quadrotor, without the
forces and torques of the rotors.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.core.vector import vec3
from tandemlift.engines.models import visuals
from tandemlift.engines.models.links import Link, links_of
from tandemlift.engines.models.mujoco_bodies import principal_axes, specification
from tandemlift.engines.models.mujoco_contact import HULL, set_contact_stiffness
from tandemlift.engines.models.mujoco_import import mujoco
from tandemlift.engines.models.scene import Scene, floor_from, walls_from
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle

GROUND, SKY, ZENITH = "#b9bdc3", "#dbe6f2", "#8fb0d3"
CONTACT_GROUP = 3  # geom group of contact shapes, which MuJoCo's viewer hides by default
OBJECTS = mujoco.mjtObj
EXACT = {  # elements whose attributes MuJoCo rounds to six digits: object type, and the arrays with all digits
    "body": (OBJECTS.mjOBJ_BODY, {"pos": "body_pos", "quat": "body_quat"}),
    "inertial": (
        OBJECTS.mjOBJ_BODY,
        {"pos": "body_ipos", "quat": "body_iquat", "mass": "body_mass", "diaginertia": "body_inertia"},
    ),
    "geom": (OBJECTS.mjOBJ_GEOM, {"pos": "geom_pos", "quat": "geom_quat", "size": "geom_size"}),
    "site": (OBJECTS.mjOBJ_SITE, {"pos": "site_pos"}),
    "joint": (OBJECTS.mjOBJ_JOINT, {"damping": "dof_damping"}),
    "pair": (
        OBJECTS.mjOBJ_PAIR,
        {"solref": "pair_solref", "solreffriction": "pair_solreffriction", "friction": "pair_friction"},
    ),
    "general": (OBJECTS.mjOBJ_ACTUATOR, {"gear": "actuator_gear", "biasprm": "actuator_biasprm"}),
    "key": (OBJECTS.mjOBJ_KEY, {"qpos": "key_qpos", "qvel": "key_qvel"}),
}


def model_text(scene: Scene) -> str:
    """The MJCF text of a scene.

    Raises:
        InputError: the true vehicle has no such model (`links_of`), MuJoCo refuses it, or MuJoCo is not installed.
    """
    vehicle = Vehicle.from_settings(scene.vehicle)
    floor, walls = floor_from(scene, vehicle), walls_from(scene, vehicle)
    spec = specification(scene, vehicle, floor, walls)
    spec.modelname = scene.mission.name
    _set_inertias(spec, links_of(scene, vehicle))
    _add_drag(spec, [*vehicle.drag.force, *vehicle.drag.moment])
    _set_start(spec, scene)
    _add_visuals(spec, scene, vehicle)
    try:
        model = spec.compile()
        set_contact_stiffness(model, floor, walls)
        for p, pair in enumerate(spec.pairs):
            pair.solref, pair.solreffriction = model.pair_solref[p], model.pair_solreffriction[p]
        text = _with_all_digits(spec.to_xml(), model)
        mujoco.MjModel.from_xml_string(text)
    except ValueError as error:
        raise InputError(f"mission {scene.mission.name!r}: MuJoCo refuses the vehicle: {error}") from error
    return text


def _set_inertias(spec: Any, links: Sequence[Link]) -> None:
    """Set mass, centre of mass and inertia of every body."""
    for link in links:
        body = spec.body(link.name.replace("_", ""))
        moments, body.iquat = principal_axes(link.inertia)
        body.mass, body.inertia = link.mass, _realizable(moments)
        body.ipos = link.center + (link.position if link.name == "payload" else 0.0)


def _realizable(moments: Array) -> Array:
    """Principal moments with the largest clipped to the sum of the others, which MuJoCo requires despite rounding."""
    most = int(np.argmax(moments))
    return np.where(np.arange(3) == most, min(moments[most], np.sum(np.delete(moments, most))), moments)


def _add_drag(spec: Any, damping: Sequence[float]) -> None:
    """Add linear drag: damping of the free joint, or where axes differ, an actuator without control along each."""
    if len(set(damping)) == 1:
        spec.joint("free").damping[0] = damping[0]
        return
    for k, (axis, drag) in enumerate(zip(("x", "y", "z", "roll", "pitch", "yaw"), damping, strict=True)):
        spec.add_actuator(
            name=f"drag {axis}",
            target="free",
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            gear=np.eye(6)[k],
            gainprm=np.zeros(10),
            biastype=mujoco.mjtBias.mjBIAS_AFFINE,
            biasprm=[0.0, 0.0, -drag, *[0.0] * 7],
        )


def _set_start(spec: Any, scene: Scene) -> None:
    """Set the initial pose; the key frame `start` has the initial velocities too."""
    initial, body = scene.initial, spec.body("payload")
    quat = quaternion_from_euler(vec3(initial.euler))
    body.pos, body.quat = initial.position, quat
    spec.add_key(name="start", qpos=[*initial.position, *quat], qvel=[*initial.velocity, *initial.rates])


def _add_visuals(spec: Any, scene: Scene, vehicle: Vehicle) -> None:
    """Add colours, light and visual shapes without contact; hide the contact shapes."""
    for geom in spec.geoms:
        if geom.name == "floor":
            geom.rgba = visuals.rgba_of(GROUND)
        elif geom.name.startswith("wall"):
            geom.rgba = visuals.rgba_of(visuals.WALL, visuals.GLASS)
        else:
            geom.group = CONTACT_GROUP
    depth = float(vehicle.payload.box[1][2])
    _add_shapes(
        spec.body("payload"), visuals.payload_shapes(vehicle.payload, tuple(vehicle.quadrotors)), vehicle.origin
    )
    for i, q in enumerate(vehicle.quadrotors, 1):
        _add_shapes(spec.body(f"quadrotor{i}"), visuals.quadrotor_shapes(q, depth), np.zeros(3))
    sun = spec.worldbody.add_light(name="sun", pos=20.0 * visuals.SUN, dir=-visuals.SUN, castshadow=not scene.all_walls)
    sun.type = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    sky = spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=64, height=384)
    sky.builtin, sky.rgb1, sky.rgb2 = (
        mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        visuals.rgba_of(SKY)[:3],
        visuals.rgba_of(ZENITH)[:3],
    )
    spec.stat.center, spec.stat.extent = scene.initial.position, float(np.abs(vehicle.lever_arms).max()) + 1.0


def _add_shapes(body: Any, shapes: Sequence[visuals.VisualShape], origin: Array) -> None:
    """Add visual shapes; `origin` (3) is theirs in the body's frame [m]."""
    kinds, quat = mujoco.mjtGeom, np.empty(4)
    for shape in shapes:
        if shape.kind == "hull":
            place: dict[str, Any] = {"type": kinds.mjGEOM_MESH, "meshname": HULL, "rgba": visuals.rgba_of(shape.color)}
            body.add_geom(name=f"{body.name} visual", pos=origin, mass=0.0, contype=0, conaffinity=0, **place)
            continue
        mujoco.mju_mat2Quat(quat, np.ascontiguousarray(shape.axes).ravel())
        size = np.zeros(3)
        size[: len(shape.size)] = shape.size
        halves = {"box": [0.5, 0.5, 0.5], "sphere": [1.0, 0.0, 0.0], "cylinder": [1.0, 0.5, 0.0]}[shape.kind]
        body.add_geom(
            name=f"{body.name} {shape.name} visual",
            type={"box": kinds.mjGEOM_BOX, "sphere": kinds.mjGEOM_SPHERE, "cylinder": kinds.mjGEOM_CYLINDER}[
                shape.kind
            ],
            size=size * halves,
            pos=origin + shape.position,
            quat=quat,
            rgba=visuals.rgba_of(shape.color, shape.opacity),
            mass=0.0,
            contype=0,
            conaffinity=0,
        )


def _with_all_digits(text: str, model: Any) -> str:
    """The MJCF text with all digits of the numbers in `EXACT`."""
    root = ElementTree.fromstring(text)
    option = root.find("option")
    assert option is not None
    option.set("timestep", repr(model.opt.timestep))
    for parent in root.iter():
        for element in parent:
            owner = parent if element.tag == "inertial" else element
            kind, arrays = EXACT.get(element.tag, (None, {}))
            for attribute in arrays.keys() & element.keys():
                row = getattr(model, arrays[attribute])[mujoco.mj_name2id(model, kind, owner.get("name"))]
                numbers = np.ravel(row).tolist()[: len(element.attrib[attribute].split())]
                element.set(attribute, " ".join(repr(number + 0.0) for number in numbers))
    return ElementTree.tostring(root, "unicode") + "\n"
