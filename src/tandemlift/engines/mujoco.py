"""The body in MuJoCo: multibody dynamics that share no equation with the compiled engine, an independent check.

The Runge-Kutta step of order four is MuJoCo's. Over a step the rotors' thrusts turn with the body; pushes and the loads
on the parts are held: forces in world axes, moments in body axes (the quadrotors' in world axes).
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import Absent, vec3
from tandemlift.engines.models.mujoco_bodies import model_of
from tandemlift.engines.models.mujoco_contact import touching_parts
from tandemlift.engines.models.mujoco_import import mujoco
from tandemlift.engines.models.scene import Scene
from tandemlift.engines.mujoco_machine import UNSOUND, MachineStep, python_is_needed
from tandemlift.engines.touches import ContactLog
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle

NONE = Absent()


class MuJoCoBody:
    """A mission's vehicle in MuJoCo; see `registry.EngineBody`.

    Args:
        mission: its step, `initial`, `plant`, `disturbance` and `walls` are the body's.
        vehicle: the pilot's model of it.
        floor: a `parts.contact.feet.Floor` to stand on, or `Absent`.
        walls: a `parts.contact.walls.Walls` with the contact of the mission's walls, or `Absent`.
    """

    def __init__(self, scene: Scene, vehicle: Vehicle, floor: Any = NONE, walls: Any = NONE) -> None:
        self.model = model_of(scene, vehicle, floor, walls)
        self.data = mujoco.MjData(self.model)
        N = vehicle.count
        self._log, self._parts = ContactLog(floor, walls, N, scene.mission.step), touching_parts(self.model)
        self.numbers = np.concatenate([np.zeros(6 * N + 19), self._log.numbers])
        self.state, self.readings, self.touches = np.split(self.numbers, [13, 6 * N + 19])
        self._log.numbers = self.touches
        self._disturbing_force = np.array(scene.disturbance.force)
        self._disturbing_moment = np.array(scene.disturbance.moment)
        self._payload, self._R = skew(vehicle.origin), np.empty((3, 3))
        self._turned = np.empty((3, N))
        self._made, self._of_rotors = rotor_loads_at_joints(vehicle), np.empty(6 * N)
        self._contact_load = np.zeros(6)
        self._view_memory(N, touching=self.model.npair > 0)
        self._set_start(scene)
        self.machine = None if python_is_needed(self.model) else self._machine_step(scene.mission.step)

    def _machine_step(self, step: float) -> MachineStep | None:
        """The step as machine code; None without the memory or the functions that it needs."""
        N, disturbance = len(self._thrusts) // 4, (self._disturbing_force, self._disturbing_moment)
        moments = np.einsum("aiij->aij", self._made.reshape(2, 3, N, N, 4)[1])
        constants = np.concatenate([*disturbance, self._payload.ravel(), moments.ravel()])
        parts = {pair: self._log.row(*part) for pair, part in self._parts.items()}
        with suppress(AttributeError, ValueError):
            return MachineStep(self.model, self.data, self.numbers, self._log.touches, parts, constants, step)
        return None

    @property
    def machine_words(self) -> int:
        """See `registry.MachineBody`; a class with another `advance` has none."""
        return self.machine.address if self.machine and type(self).advance is MuJoCoBody.advance else 0

    def _view_memory(self, N: int, *, touching: bool) -> None:
        """Make views of MuJoCo's memory and of ours, part by part, so that a step only copies."""
        d, state, readings, joints = self.data, self.state, self.readings, slice(3, 6 * N + 3)
        self._position, self._velocity, self._attitude, self._rates = np.split(state, [3, 6, 10])
        self._true_position, self._true_attitude = d.qpos[:3], d.qpos[3:]
        self._true_velocity, self._true_rates = d.qvel[:3], d.qvel[3:]
        self._thrusts, self._force, self._moment = d.ctrl, d.qfrc_applied[:3], d.qfrc_applied[3:]
        on_quadrotors = d.xfrc_applied[2 : N + 2].T
        self._force_on_quadrotors, self._moment_on_quadrotors = on_quadrotors[:3], on_quadrotors[3:]
        self._specific_force, self._accelerometer = readings[:3], d.sensordata[:3]
        self._at_joints, self._rotor_loads_at_joints = (x.reshape(2, 3, N) for x in (readings[joints], self._of_rotors))
        self._joint_sensors = d.sensordata[joints].reshape(2, N, 3).transpose(0, 2, 1)
        self._contact_force, self._contact_sensor = readings[6 * N + 3 :], d.sensordata[6 * N + 3 :]
        self._touching = touching

    def _set_start(self, scene: Scene) -> None:
        """Put the body where the mission starts."""
        initial = scene.initial
        self._true_position[:], self._true_velocity[:] = initial.position, initial.velocity
        self._true_attitude[:], self._true_rates[:] = quaternion_from_euler(vec3(initial.euler)), initial.rates
        self._read_state()

    def _read_state(self) -> None:
        self._position[:] = self._true_position
        self._velocity[:] = self._true_velocity
        self._attitude[:] = self._true_attitude
        self._rates[:] = self._true_rates

    def _read_sensors(self) -> None:
        # a joint's sensor reads the load of the payload on the quadrotor, without that of the rotors
        self._specific_force[:] = self._accelerometer
        np.subtract(self._rotor_loads_at_joints, self._joint_sensors, out=self._at_joints)
        if self._touching:
            self._contact_force[:] = self._contact_sensor

    def _load(self, loads: Array) -> None:
        """Apply loads to the parts: to the payload about the system's centre of mass, to each quadrotor at its own."""
        R = self._R
        mujoco.mju_quat2Mat(R.ravel(), self._true_attitude)
        force = loads[:3]
        self._force += force
        self._moment += loads[3:6]
        self._moment += self._payload.dot(force.dot(R))
        on_quadrotors = loads[6:].reshape(2, 3, -1)
        self._force_on_quadrotors[:] = on_quadrotors[0]
        R.dot(on_quadrotors[1], out=self._turned)
        self._moment_on_quadrotors[:] = self._turned

    def advance(self, thrusts: Array, loads: Array, force: Array, moment: Array) -> None:
        """Advance by one step; see `registry.EngineBody`."""
        if self.machine is not None:
            self.machine.advance(thrusts, loads, np.concatenate([force, moment]))
            return
        if not thrusts.dot(thrusts) < UNSOUND * UNSOUND:  # also NaN, which is below nothing
            self.state.fill(np.nan)
            self.readings.fill(np.nan)
            return
        self._thrusts[:] = thrusts
        np.add(force, self._disturbing_force, out=self._force)
        np.add(moment, self._disturbing_moment, out=self._moment)
        if len(loads):
            self._load(loads)
        self._made.dot(thrusts, out=self._of_rotors)
        mujoco.mj_step(self.model, self.data)
        self._read_state()
        self._read_sensors()
        self._log_contacts()

    def _log_contacts(self) -> None:
        """Enter the contacts at the end of the step, but those of feet, into the record."""
        if self.data.ncon:
            found = self.data.contact
            for c, (one, other) in enumerate(found.geom.tolist()):
                part = self._parts.get((min(one, other), max(one, other)))
                if part is not None:
                    mujoco.mj_contactForce(self.model, self.data, c, self._contact_load)
                    self._log.add(*part, self._contact_load[0], found.pos[c])
        self._log.end_step()


def skew(a: Array) -> Array:
    """The matrix (3 × 3) of a ×."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def rotor_loads_at_joints(vehicle: Vehicle) -> Array:
    """Matrix (6 N × 4 N) from rotor thrusts [N] to joint loads: force x, y, z [N], torque x, y, z [N·m], each of N."""
    N = vehicle.count
    made = np.zeros((2, 3, N, N, 4))
    for i, q in enumerate(vehicle.quadrotors):
        arms = np.array(q.rotors) - np.subtract(q.joint_position, q.position)[:2]
        made[0, 2, i, i] = 1.0
        made[1, :, i, i] = arms[:, 1], -arms[:, 0], q.torque_per_thrust * np.array(q.spins)
    return made.reshape(6 * N, 4 * N)
