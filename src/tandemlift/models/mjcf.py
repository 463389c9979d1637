"""A mission as a MuJoCo model: what the engine `mujoco` flies, as MJCF, with looks and the mission's start.

Control 4 i + j is the thrust of rotor j of quadrotor i [N]; sensors are those of `models.mujoco_bodies.model_of`, by
name. The joints' sensors read what the payload puts on the quadrotor, without what the rotors make.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np

from tandemlift.algebra.vector import vec3
from tandemlift.common.errors import InputError
from tandemlift.common.types import Array
from tandemlift.laws.mechanics.rotation import quaternion_from_euler
from tandemlift.models.mujoco_bodies import mujoco, press, specification
from tandemlift.models.sensor_frames import Link, links_of
from tandemlift.models.surroundings import floor_from, walls_from
from tandemlift.models.visuals import VisualShape, payload_shapes, quadrotor_shapes
from tandemlift.rendering.light import SUN
from tandemlift.rendering.stage import GLASS, WALL
from tandemlift.settings import Mission
from tandemlift.vehicle import Vehicle

GROUND, SKY, ZENITH = "#b9bdc3", "#dbe6f2", "#8fb0d3"
CONTACT_GROUP = 3  # of shapes: MuJoCo's viewer hides it at first
OBJECTS = mujoco.mjtObj
EXACT = {  # attributes that MuJoCo rounds to six digits, of which objects, and the model's arrays that have them all
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


def model_text(mission: Mission) -> str:
    """The text of a mission's model.

    Raises:
        InputError: its true vehicle cannot be a model (`links_of`), MuJoCo does not take it, or is not installed.
    """
    vehicle = Vehicle.from_settings(mission.vehicle)
    floor, walls = floor_from(mission, vehicle), walls_from(mission, vehicle)
    spec = specification(mission, vehicle, floor, walls)
    spec.modelname = mission.mission.name
    _weigh(spec, links_of(mission, vehicle))
    _drag(spec, [*vehicle.drag.force, *vehicle.drag.moment])
    _start(spec, mission)
    _dress(spec, mission, vehicle)
    try:
        model = spec.compile()
        press(model, floor, walls)
        for p, pair in enumerate(spec.pairs):
            pair.solref, pair.solreffriction = model.pair_solref[p], model.pair_solreffriction[p]
        text = _exact(spec.to_xml(), model)
        mujoco.MjModel.from_xml_string(text)
    except ValueError as error:
        raise InputError(f"mission {mission.mission.name!r}: MuJoCo does not take its vehicle: {error}") from error
    return text


def _weigh(spec: Any, links: Sequence[Link]) -> None:
    """Mass, centre of mass and inertia of every body."""
    for link in links:
        body = spec.body(link.name.replace("_", ""))
        moments, axes = np.diag(link.inertia), np.eye(3)
        if not np.array_equal(np.diag(moments), link.inertia):
            moments, axes = np.linalg.eigh(link.inertia)
        mujoco.mju_mat2Quat(body.iquat, (axes * [1.0, 1.0, np.linalg.det(axes)]).ravel())
        body.mass, body.inertia = link.mass, _thick(moments)
        body.ipos = link.center + (link.position if link.name == "payload" else 0.0)


def _thick(moments: Array) -> Array:
    """Moments of a body none of which exceeds the sum of the others, by rounding either, as MuJoCo would refuse it."""
    most = int(np.argmax(moments))
    return np.where(np.arange(3) == most, min(moments[most], np.sum(np.delete(moments, most))), moments)


def _drag(spec: Any, damping: Sequence[float]) -> None:
    """Linear drag: of the free joint, or of an actuator without control along each axis if these differ."""
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


def _start(spec: Any, mission: Mission) -> None:
    """The model begins where the mission does; with its velocities too in the key frame `start`."""
    initial, body = mission.initial, spec.body("payload")
    quat = quaternion_from_euler(vec3(initial.euler))
    body.pos, body.quat = initial.position, quat
    spec.add_key(name="start", qpos=[*initial.position, *quat], qvel=[*initial.velocity, *initial.rates])


def _dress(spec: Any, mission: Mission, vehicle: Vehicle) -> None:
    """Colours, light, and shapes that touch nothing; those that touch are hidden."""
    for geom in spec.geoms:
        if geom.name == "floor":
            geom.rgba = _rgba(GROUND)
        elif geom.name.startswith("wall"):
            geom.rgba = _rgba(WALL, GLASS)
        else:
            geom.group = CONTACT_GROUP
    depth = vehicle.payload.radius or 0.0
    _show(spec.body("payload"), payload_shapes(vehicle.payload, tuple(vehicle.quadrotors)), -vehicle.center_of_mass)
    for i, q in enumerate(vehicle.quadrotors, 1):
        _show(spec.body(f"quadrotor{i}"), quadrotor_shapes(q, depth), np.zeros(3))
    sun = spec.worldbody.add_light(name="sun", pos=20.0 * SUN, dir=-SUN, castshadow=not mission.all_walls)
    sun.type = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    sky = spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=64, height=384)
    sky.builtin, sky.rgb1, sky.rgb2 = mujoco.mjtBuiltin.mjBUILTIN_GRADIENT, _rgba(SKY)[:3], _rgba(ZENITH)[:3]
    spec.stat.center, spec.stat.extent = mission.initial.position, float(np.abs(vehicle.lever_arms).max()) + 1.0


def _show(body: Any, shapes: Sequence[VisualShape], origin: Array) -> None:
    """Add shapes to look at, from an origin in the body's frame."""
    kinds, quat = mujoco.mjtGeom, np.empty(4)
    for shape in shapes:
        mujoco.mju_mat2Quat(quat, np.ascontiguousarray(shape.axes).ravel())
        size = np.zeros(3)
        size[: len(shape.size)] = shape.size
        halves = {"box": [0.5, 0.5, 0.5], "sphere": [1.0, 0.0, 0.0], "cylinder": [1.0, 0.5, 0.0]}[shape.kind]
        body.add_geom(
            name=f"{body.name} {shape.name} look",
            type={"box": kinds.mjGEOM_BOX, "sphere": kinds.mjGEOM_SPHERE, "cylinder": kinds.mjGEOM_CYLINDER}[
                shape.kind
            ],
            size=size * halves,
            pos=origin + shape.position,
            quat=quat,
            rgba=_rgba(shape.color, shape.opacity),
            mass=0.0,
            contype=0,
            conaffinity=0,
        )


def _rgba(color: str, opacity: float = 1.0) -> list[float]:
    return [*(int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5)), opacity]


def _exact(text: str, model: Any) -> str:
    """The text with all digits of the numbers that matter."""
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
