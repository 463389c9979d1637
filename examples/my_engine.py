"""An engine: one rigid body without air, floor and walls, with the rotations of SciPy."""

import numpy as np
from scipy.spatial.transform import Rotation

import tandemlift as tl


@tl.plug("engine", "euler")
class EulerBody:
    """One rigid body, by the semi-implicit method of Euler."""

    def __init__(self, scene, vehicle, floor, walls):
        if scene.ground.model != "none" or scene.all_walls:
            raise tl.InputError("euler has no floor and no walls: leave out ground.model and walls")
        self.vehicle, self.dt, start = vehicle, scene.mission.step, scene.initial
        self.turn = Rotation.from_euler("xyz", start.euler)
        self.position, self.velocity = np.array(start.position), np.array(start.velocity)
        self.rates = np.array(start.rates)
        self.readings = np.zeros(6 + 6 * vehicle.count)  # the joints of one body carry nothing
        self._write()

    def _write(self):
        attitude = self.turn.as_quat()[[3, 0, 1, 2]]  # w first
        self.state = np.concatenate([self.position, self.velocity, attitude, self.rates])

    def advance(self, thrusts, loads, force, moment):
        """Advance by one step under rotor thrusts and a push [N, world; N m, body]."""
        if loads.size:
            raise tl.InputError("euler has no air: leave out wind.model")
        J, m = self.vehicle.inertia, self.vehicle.mass
        thrust, *turning = self.vehicle.effect @ thrusts
        lift = (self.turn.apply([0.0, 0.0, thrust]) + force) / m  # N/kg
        self.readings[:3] = self.turn.inv().apply(lift)
        spin = np.cross(self.rates, J @ self.rates)
        self.rates = self.rates + self.dt * np.linalg.solve(J, turning + moment - spin)
        self.velocity = self.velocity + self.dt * (lift - [0.0, 0.0, 9.81])
        self.turn = self.turn * Rotation.from_rotvec(self.dt * self.rates)
        self.position = self.position + self.dt * self.velocity
        self._write()
