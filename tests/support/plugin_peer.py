"""A stand-in for Gazebo's plugin: a rigid body in NumPy and SciPy, commanded over UDP, on an unreliable network."""

import re
import socket
import struct
import threading

import numpy as np
from patience import joined
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

HEADER = struct.Struct("<IHHIIQ")
MAGIC = int.from_bytes(b"TLGZ", "little")
HELLO, WELCOME, STEP, STATE, BYE, REFUSE = range(1, 7)
OTHER_COUNT, OVER = 2, 5
DOWN = np.array([0.0, 0.0, -9.81])


FLOOR, WALL = 0, 1  # the surfaces of touches
STIFFNESS = 3e3  # N/m, of a surface that is touched


class Push:
    """A push as the plugin reads it from its topic, see `gazebo/push.hh`."""

    def __init__(self, text):
        said = {"point": "0 0 0", "duration": "1"}
        said |= dict(re.findall(r"([a-z]+)((?: [-+.\de]*\d\.?)+)", text))
        self.force, self.point, (self.left,) = (
            np.array(said[word].split(), dtype=float) for word in ("force", "point", "duration")
        )


class Surface:
    """A plane that the discs of rotors touch without friction: "floor" or "wall".

    Args:
        kind: FLOOR or WALL.
        at: a point of it [m, world].
        normal: out of it, of any length [world].
    """

    def __init__(self, kind, at, normal):
        self.kind, self.at = kind, np.array(at, dtype=float)
        self.normal = np.array(normal, dtype=float) / np.linalg.norm(normal)


class RigidBody:
    """The vehicle as one body; joint loads are those that move the quadrotors with it.

    Args:
        vehicle: the vehicle.
        surface: what its rotors may touch; None for nothing.

    Attributes:
        touches: (2, 5N + 1, 4) of the last step, as `gazebo/contacts.hh` counts them.
    """

    def __init__(self, vehicle, surface=None):
        self.vehicle, self.N, self.surface = vehicle, vehicle.count, surface
        self.touches = np.zeros((2, 5 * self.N + 1, 4))
        self.x, self.v, self.w, self.turn = np.zeros(3), np.zeros(3), np.zeros(3), Rotation.identity()

    def place(self, state, rotors):
        self.x, self.v, self.w = state[:3], state[3:6], state[10:]
        self.turn = Rotation.from_quat(state[[7, 8, 9, 6]])
        self.rotors = rotors.reshape(3, self.N, 4)

    def state(self):
        x, y, z, w = self.turn.as_quat()
        return np.array([*self.x, *self.v, w, x, y, z, *self.w])

    def step(self, numbers, dt, pushes=()):
        """Advance by a step with pushes; the readings at its start."""
        N, vehicle = self.N, self.vehicle
        thrusts, central, on_payload, on_quadrotors = np.split(numbers, [4 * N, 4 * N + 6, 4 * N + 12])
        contact, touching = self._touch()
        thrusts, on_quadrotors = thrusts.reshape(N, 4), on_quadrotors.reshape(2, 3, N) + touching
        x, y, torque = self.rotors
        couples = np.array([(y * thrusts).sum(1), -(x * thrusts).sum(1), (torque * thrusts).sum(1)]).T
        lifts = np.outer(thrusts.sum(1), [0.0, 0.0, 1.0])
        held = [(central, np.zeros(3)), (on_payload, -vehicle.center_of_mass)]
        held += [(on_quadrotors[:, :, i].ravel(), vehicle.lever_arms[i]) for i in range(N)]
        held += [(np.append(push.force, np.zeros(3)), push.point) for push in pushes]
        J = vehicle.inertia

        def rates(turn, w):
            force, moment = turn.apply(lifts.sum(0)), couples.sum(0) + np.cross(vehicle.lever_arms, lifts).sum(0)
            for load, at in held:
                force = force + load[:3]
                moment = moment + load[3:] + np.cross(at, turn.inv().apply(load[:3]))
            return force / vehicle.mass + DOWN, np.linalg.solve(J, moment - np.cross(w, J @ w))

        a, alpha = rates(self.turn, self.w)
        felt = np.append(self._felt(a, alpha, lifts, couples, on_quadrotors), contact)

        def motion(_, s):  # attitude as a turn from the step's start, in body axes; it is small
            turned, w = s[6:9], s[9:]
            linear, angular = rates(self.turn * Rotation.from_rotvec(turned), w)
            return [*s[3:6], *linear, *(w + 0.5 * np.cross(turned, w)), *angular]

        start = [*self.x, *self.v, 0.0, 0.0, 0.0, *self.w]
        end = solve_ivp(motion, (0.0, dt), start, rtol=1e-9, atol=1e-12).y[:, -1]
        self.x, self.v, self.w = end[:3], end[3:6], end[9:]
        self.turn = self.turn * Rotation.from_rotvec(end[6:9])
        return felt

    def _felt(self, a, alpha, lifts, couples, loads):
        def feels(r):  # less gravity, body axes
            return self.turn.inv().apply(a - DOWN) + np.cross(alpha, r) + np.cross(self.w, np.cross(self.w, r))

        forces, torques = np.empty((3, self.N)), np.empty((3, self.N))
        for i, q in enumerate(self.vehicle.quadrotors):
            joint, J = np.subtract(q.joint_position, q.position), np.diag(q.inertia)
            force = lifts[i] + self.turn.inv().apply(loads[0, :, i]) - q.mass * feels(self.vehicle.lever_arms[i])
            couple = couples[i] + loads[1, :, i] - J @ alpha - np.cross(self.w, J @ self.w)
            forces[:, i], torques[:, i] = force, couple - np.cross(joint, force)
        return np.array([*feels(-self.vehicle.center_of_mass), *forces.ravel(), *torques.ravel()])

    def _touch(self):
        """Note the touches of a step; their force [N, world] and the loads (2, 3, N) that they put on quadrotors."""
        self.touches[:], loads, total = 0.0, np.zeros((2, 3, self.N)), np.zeros(3)
        if self.surface is None:
            return total, loads
        normal = self.turn.inv().apply(self.surface.normal)
        flat = normal * [1.0, 1.0, 0.0]
        reach = -flat / max(np.linalg.norm(flat), 1e-9)  # from a disc's centre to where it touches first
        for i, q in enumerate(self.vehicle.quadrotors):
            for j, (x, y) in enumerate(q.rotors):
                arm = [x, y, 0.0] + q.rotor_radius * reach
                place = self.x + self.turn.apply(self.vehicle.lever_arms[i] + arm)
                force = STIFFNESS * max((self.surface.at - place) @ self.surface.normal, 0.0)
                if force > 0.0:
                    self.touches[self.surface.kind, 4 * i + j] = force, *place
                    total += force * self.surface.normal
                    loads[:, :, i] += force * self.surface.normal, np.cross(arm, force * normal)
        return total, loads


class Plugin:
    """Answers a pilot as the plugin does, in a thread, until it is closed.

    `network(message)` returns the list of messages that arrive now, for incoming and outgoing ones. `said` is what its
    topic of pushes says before a step, by the number of the step.
    """

    def __init__(self, body, dt, *, version=2, network=lambda message: [message], mass=None, port=0, said=None):
        self.body, self.dt, self.version, self.network = body, dt, version, network
        self.said, self.pushes = said or {}, []
        self.mass = body.vehicle.mass if mass is None else mass
        self.session, self.over, self.sequence, self.answer = None, set(), 0, b""
        self.taken, self.heard = [], []
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", port))
        self.port = self.socket.getsockname()[1]
        self.socket.settimeout(0.01)
        self.closed = False
        self.thread = threading.Thread(target=self._serve, name="plugin", daemon=True)
        self.thread.start()

    def close(self):
        self.closed = True
        joined(self.thread)
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _serve(self):
        while not self.closed:
            try:
                message, pilot = self.socket.recvfrom(65536)
            except TimeoutError:
                continue
            for arrived in self.network(message):
                answer = self._answer(arrived)
                for sent in self.network(answer) if answer else []:
                    self.socket.sendto(sent, pilot)

    def _answer(self, message):
        magic, version, kind, session, count, sequence = HEADER.unpack_from(message)
        if (len(message) - HEADER.size) % 8:
            return b""
        numbers = np.frombuffer(message, offset=HEADER.size).copy()
        assert magic == MAGIC
        self.heard.append(kind)
        if version != self.version:
            return self._message(REFUSE, session, sequence, [1.0])
        if count != self.body.N:
            return self._message(REFUSE, session, sequence, [OTHER_COUNT])
        if kind == HELLO:
            return self._hello(session, numbers)
        if kind == BYE:
            self.session = None if session == self.session else self.session
            return b""
        if session != self.session:
            return self._message(REFUSE, session, sequence, [OVER])
        if sequence == self.sequence + 1:
            self.sequence = sequence
            self.taken.append(sequence)
            self.answer = self._message(STATE, session, sequence, self._step(numbers))
        return self.answer if sequence == self.sequence else b""

    def _hello(self, session, numbers):
        if session == self.session and self.sequence == 0:
            return self.answer
        if session in self.over:
            return b""
        self.over.add(session)
        self.session, self.sequence = session, 0
        place = int(numbers[0]) & 1
        self.pushes = [] if place else self.pushes
        self.body.place(numbers[2:15] if place else self.body.state(), numbers[15:])
        self.body.touches[:] = 0.0
        self.answer = self._message(WELCOME, session, 0, self._told(np.zeros(6 * self.body.N + 6), np.zeros(6)))
        return self.answer

    def _step(self, numbers):
        """Take a step; what is told of it. The moments of pushes are those at its start."""
        text = self.said.get(self.sequence)
        if text:
            self.pushes = [] if text == "off" else [*self.pushes, Push(text)]
        pushed, back = np.zeros(6), self.body.turn.inv()
        for push in self.pushes:
            pushed += [*push.force, *np.cross(push.point, back.apply(push.force))]
            push.left -= self.dt
        told = self._told(self.body.step(numbers, self.dt, self.pushes), pushed)
        self.pushes = [push for push in self.pushes if push.left > 0.5 * self.dt]
        return told

    def _told(self, felt, pushed):
        clock = [len(self.taken) * self.dt, self.dt, self.mass]
        return [*clock, *self.body.state(), *felt, *self.body.touches.ravel(), *pushed]

    def _message(self, kind, session, sequence, numbers):
        head = HEADER.pack(MAGIC, self.version, kind, session, self.body.N, sequence)
        return head + np.array(numbers, dtype=float).tobytes()


class BadNetwork:
    """Loses, duplicates, delays and corrupts messages, each with this probability."""

    def __init__(self, seed, chance=0.1):
        self.rng, self.chance, self.late = np.random.default_rng(seed), chance, []
        self.counts = np.zeros(5, dtype=int)

    def __call__(self, message):
        what = min(int(self.rng.random() / self.chance), 4)
        self.counts[what] += 1
        if what == 2:  # it arrives after the next one
            self.late.append(message)
            return []
        now = {0: [], 1: [message, message], 3: [message[:-3]]}.get(what, [message])
        late, self.late = self.late, []
        return [*now, *late]
