"""The body in MuJoCo: multibody dynamics that share no equation with the compiled engine, an independent check.

The Runge-Kutta step of order four is MuJoCo's. Over a step the rotors' thrusts turn with the body; pushes and the loads
on the parts are held: forces in world axes, moments in body axes (the quadrotors' in world axes).
"""

from __future__ import annotations

import ctypes
from copy import copy
from typing import Any

import numpy as np

from tandemlift.core.types import Array, flat
from tandemlift.core.vector import Absent, vec3
from tandemlift.engines.models.mujoco_bodies import model_of
from tandemlift.engines.models.mujoco_contact import touching_parts
from tandemlift.engines.models.mujoco_import import mujoco
from tandemlift.engines.models.scene import Scene
from tandemlift.engines.mujoco_step import FUNCTIONS, SLACK, code_of, rows_of
from tandemlift.parts.contact.touches import start_touches
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle

NONE = Absent()
CONTACT = np.dtype([("geom", np.int32, 2), ("pos", float, 3)])
MOST_CONTACTS = 4096
STEP = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 2)
FORCE = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 2, ctypes.c_int, ctypes.POINTER(ctypes.c_double))
ADVANCE = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 6)
CALLED = [getattr(mujoco, name) for name in dir(mujoco) if name.startswith(("get_mjcb_", "get_mju_user_"))]


class MuJoCoBody:
    """A mission's vehicle in MuJoCo; see `registry.EngineBody` and `registry.MachineBody`.

    A step is machine code around MuJoCo's C functions (`models.mujoco_step`). Where these call functions of the user,
    such as that of `mujoco.set_mjcb_control`, or its package hides its structs, it calls MuJoCo in Python.

    Args:
        mission: its step, `initial`, `plant`, `disturbance` and `walls` are the body's.
        vehicle: the pilot's model of it.
        floor: a `parts.contact.feet.Floor` to stand on, or `Absent`.
        walls: a `parts.contact.walls.Walls` with the contact of the mission's walls, or `Absent`.
    """

    def __init__(self, scene: Scene, vehicle: Vehicle, floor: Any = NONE, walls: Any = NONE) -> None:
        self.model, N = model_of(scene, vehicle, floor, walls), vehicle.count
        self.data = mujoco.MjData(self.model)
        self._moved, touches = np.zeros(6 * N + 19), start_touches(floor, walls, 4 * N)
        self.state, self.readings = np.split(self._moved, [13])
        self.touches: Array = np.array(flat(touches))
        self._code = code_of(touches, N, self.model.ngeom, bool(self.model.npair))
        self._errors = list[BaseException]()
        self._bind(scene, vehicle)
        self._set_start(scene)

    def _bind(self, scene: Scene, vehicle: Vehicle) -> None:
        """Bind the functions and the memory of `models.mujoco_step.WORDS`."""
        model, data, free, N = self.model, self.data, copy(self.model), vehicle.count
        free.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
        try:
            contacts, structs = contact_memory(data), [struct._address for struct in (model, free, data)]
            self._functions = functions_in_c()
        except (AttributeError, OSError, ValueError):  # the package hides them: by its functions for Python alone
            found = np.zeros(MOST_CONTACTS, CONTACT)
            contacts, structs, self._functions = [np.zeros(1, np.int32), found["geom"], found["pos"]], [0] * 3, []
        self._in_python = functions_in_python(model, data, [] if self._functions else contacts, self._errors)
        arrays = [data.qpos, data.qvel, data.ctrl, data.qfrc_applied, data.xfrc_applied[2:], data.sensordata]
        limits, spheres = limits_above_floor(model)
        disturbance, place = (scene.disturbance.force, scene.disturbance.moment), skew(vehicle.origin).ravel()
        moments = moments_of_rotors(vehicle).ravel()
        constants = np.concatenate([[scene.mission.step], limits, *disturbance, place, moments])
        rows = np.full((model.ngeom, model.ngeom), -1)
        for (one, other), (surface, kind, index) in touching_parts(model).items():
            first = rows_of(N) * (surface == "wall") + {"rotor": 0, "guard": 4 * N, "beam": 5 * N}[kind]
            rows[one, other] = rows[other, one] = first + index
        memory = *arrays, *contacts, constants, spheres, rows, np.zeros(10 * rows_of(N) + 1)
        run, apart = address_of(self._code.free["advance"]), contacts[1].strides[0]
        self._kept, self._advance = (free, *memory), ADVANCE(run)
        self._words = np.array([run, 0, 0, *structs, *[x.ctypes.data for x in memory], apart, 0])

    @property
    def machine_words(self) -> int:
        """See `registry.MachineBody`; a class with an `advance` of its own has none."""
        if type(self).advance is not MuJoCoBody.advance:
            return 0
        self._choose_functions()
        return int(self._words.ctypes.data)

    def _choose_functions(self) -> None:
        """Call MuJoCo in C, or in Python if it calls functions of the user now."""
        in_python = not self._functions or any(get() is not None for get in CALLED)
        self._words[1:3] = list(map(address_of, self._in_python if in_python else self._functions))

    def raise_error(self) -> None:
        """See `registry.MachineBody`."""
        if self._errors:
            raise self._errors.pop()

    def _set_start(self, scene: Scene) -> None:
        """Put the body where the mission starts."""
        initial, (q, v) = scene.initial, (self.data.qpos, self.data.qvel)
        q[:3], q[3:] = initial.position, quaternion_from_euler(vec3(initial.euler))
        v[:3], v[3:] = initial.velocity, initial.rates
        self.state[:] = [*q[:3], *v[:3], *q[3:], *v[3:]]

    def advance(self, thrusts: Array, loads: Array, force: Array, moment: Array) -> None:
        """Advance by one step; see `registry.EngineBody`."""
        self._choose_functions()
        given = [np.ascontiguousarray(x) for x in (self._words, thrusts, loads, [*force, *moment])]
        self._advance(*[x.ctypes.data if x.size else None for x in (*given, self._moved, self.touches)])
        self.raise_error()


def address_of(function: Any) -> int:
    """The address of a function of C."""
    return ctypes.cast(function, ctypes.c_void_p).value or 0


def functions_in_c() -> list[Any]:
    """MuJoCo's own functions."""
    library = ctypes.CDLL(mujoco._functions.__file__)
    return [getattr(library, name) for name in FUNCTIONS]


def functions_in_python(model: Any, data: Any, contacts: list[Array], errors: list[BaseException]) -> list[Any]:
    """MuJoCo's functions by its package for Python; they write count, shapes and places of contacts, if given."""

    def step(*_: int) -> None:
        try:
            mujoco.mj_step(model, data)
            for to, found in zip(contacts, ([data.ncon], data.contact.geom, data.contact.pos), strict=False):
                to[: len(found)] = found
        except BaseException as error:  # of a user's function; the flight ends
            errors.append(error)
            data.qpos[:] = np.nan

    def force(_: int, __: int, contact: int, load: Any) -> None:
        mujoco.mj_contactForce(model, data, contact, np.ctypeslib.as_array(load, (6,)))

    return [STEP(step), FORCE(force)]


def contact_memory(data: Any) -> list[Array]:
    """The memory of count, shapes and places of contacts, of which there is none yet."""
    size = (data.energy.ctypes.data - data._address) // 4  # the energy stands behind the count
    words = np.ctypeslib.as_array((ctypes.c_int32 * size).from_address(data._address))
    before, data.ncon = words.copy(), 1
    (at,) = np.flatnonzero(words != before)
    geoms, places = data.contact.geom, data.contact.pos
    data.ncon = 0
    return [words[at:], geoms, places]


def limits_above_floor(model: Any) -> tuple[Array, Array]:
    """What tells that no shape can reach the floor in a step, which it never does where shapes meet anything else.

    Returns:
        The highest floor [m]; the greatest distance of a shape from the centre of mass [m]; the greatest sum of squares
        of all forces [N] and moments [N m] under which no shape moves by half of `SLACK`. And x, y, z [m, body axes]
        and radius [m] of spheres around the shapes, two for each (2 shapes, 4).
    """
    if not model.npair:
        return np.zeros(3), np.zeros((0, 4))
    kinds, size, data = mujoco.mjtGeom, model.geom_size, mujoco.MjData(model)
    data.qpos[:] = np.eye(7)[3]
    mujoco.mj_kinematics(model, data)
    planes, capsules = model.geom_type == kinds.mjGEOM_PLANE, model.geom_type == kinds.mjGEOM_CAPSULE
    half = data.geom_xmat[:, 2::3] * np.where(capsules, size[:, 1], 0.0)[:, None]
    radius = np.where(capsules, size[:, 0], model.geom_rbound)
    meets_all = (planes[model.pair_geom1] | planes[model.pair_geom2]).all()
    radius = np.where(planes, -np.inf, radius) if meets_all else np.full(model.ngeom, np.inf)
    spheres = np.concatenate([np.c_[data.geom_xpos + end, radius] for end in (half, -half)])
    reach = (np.linalg.norm(spheres[:, :3], axis=1) + spheres[:, 3]).max()
    gain = model.dof_invweight0[0] + 3.0 * model.dof_invweight0[5] * reach * max(reach, 1.0)  # m/s² for 1 N
    calm = (SLACK / (model.opt.timestep**2 * gain)) ** 2 / (12 + 10 * (model.nu // 4))
    return np.array([model.geom_pos[planes, 2].max(initial=-np.inf), reach, calm]), spheres


def skew(a: Array) -> Array:
    """The matrix (3 × 3) of a ×."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def moments_of_rotors(vehicle: Vehicle) -> Array:
    """Moments x, y, z [N·m] at the joint of each quadrotor for 1 N of each of its rotors (3, N, 4)."""
    made = np.zeros((3, vehicle.count, 4))
    for i, q in enumerate(vehicle.quadrotors):
        arms = np.array(q.rotors) - np.subtract(q.joint_position, q.position)[:2]
        made[:, i] = arms[:, 1], -arms[:, 0], q.torque_per_thrust * np.array(q.spins)
    return made
