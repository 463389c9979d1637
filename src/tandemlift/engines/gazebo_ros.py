"""The body in Gazebo 11 as in `gazebo`, driven over ROS 1 (`gazebo/tandemlift_gazebo_ros.cc`) by rospy.

Environment: `TANDEMLIFT_GAZEBO_ROS`, set to `master`, joins the ROS master at `ROS_MASTER_URI`; set to `world`, also
the Gazebo that runs there; not set, both are started for the flight. `TANDEMLIFT_GAZEBO_REAL_TIME` as in `gazebo`.
"""

from __future__ import annotations

import contextlib
import queue
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.engines.gazebo import NONE, STEP_TIMEOUT, GazeboBody, world_from
from tandemlift.engines.gazebo_server import GazeboServer
from tandemlift.engines.gazebo_wire import PluginAnswer
from tandemlift.engines.models.scene import Scene
from tandemlift.engines.rospy import PLACES, ROOT, joined, message_type, node, ros_environment
from tandemlift.parts.mechanics.vehicle import Vehicle

Stamp = tuple[int, int]  # s, ns
MOVED = "sensor_msgs/MultiDOFJointState"
ENDING = 5.0  # s, in which a server may end by itself
SILENCE = 0.05  # s, after which a command is repeated; a waiting world publishes its state every 0.1 s
WAITING = 0.02  # s, between requests to become the pilot

_taken: set[str] = set()


def over_ros(scene: Scene, vehicle: Vehicle, floor: Any = NONE, walls: Any = NONE) -> GazeboBody:
    """A mission's vehicle in Gazebo; see `gazebo.GazeboBody`."""
    return GazeboBody(scene, vehicle, floor, walls, _connect)


def _connect(scene: Scene, vehicle: Vehicle) -> tuple[GazeboServer | None, RosWire]:
    node()
    if joined() == "world":
        return None, RosWire(vehicle.count, STEP_TIMEOUT)
    place = next(place for place in PLACES if place not in _taken)
    _taken.add(place)
    server = GazeboServer(world_from(scene, "ros", namespace=place), ros_environment(), ENDING)
    return server, RosWire(vehicle.count, STEP_TIMEOUT, server.check, place)


def touch_names(count: int) -> list[str]:
    """The names of the rows of `PluginAnswer.touches` in a state."""
    rotors = [f"rotor_{q}_{r}" for q in range(1, count + 1) for r in range(1, 5)]
    parts = [*rotors, *(f"guard_{q}" for q in range(1, count + 1)), "beam"]
    return [f"{surface}/{part}" for surface in ("floor", "wall") for part in parts]


class RosWire:
    """The pilot's end of the connection; as `gazebo_wire.Wire`.

    Args:
        count: N, the number of quadrotors.
        patience: time without an answer after which the session fails [s].
        alive: called while no answer arrives; raises if the server has ended.
        place: namespace of the plugin's topics.
    """

    def __init__(
        self, count: int, patience: float = 5.0, alive: Callable[[], None] | None = None, place: str = ROOT
    ) -> None:
        self._rospy, self._alive, self._place = node(), alive or (lambda: None), place
        self.count, self.patience, self.answer = count, patience, PluginAnswer(count)
        self.thrusts, self.wrench, self.loads = np.zeros(4 * count), np.zeros(6), np.zeros(6 + 6 * count)
        self._name, self._over = self._rospy.get_name(), False
        self._found: Stamp | None = None  # stamp of the state in which this pilot began
        self._at: Stamp = (0, 0)  # of the last state
        self._states: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._step, self._values = self._wrenches()
        self._touches = dict(zip(touch_names(count), self.answer.touches.reshape(-1, 4), strict=True))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # rospy warns that messages are sent at once, not by a thread
            self._commands = self._rospy.Publisher(f"{place}/command", message_type(MOVED), tcp_nodelay=True)
            self._calls = self._rospy.Publisher(f"{place}/lead", message_type("std_msgs/Empty"), tcp_nodelay=True)
        self._listening = [
            self._rospy.Subscriber(f"{place}/state", message_type(MOVED), self._states.put, tcp_nodelay=True),
            self._rospy.Subscriber(f"{place}/pilot", message_type("std_msgs/Header"), self._on_pilot),
        ]

    def _wrenches(self) -> tuple[Any, Array]:
        """The message of a step, and its wrenches as rows of numbers."""
        quadrotors = range(1, self.count + 1)
        step = message_type(MOVED)()
        step.joint_names = [f"rotor_{q}_{r}" for q in quadrotors for r in range(1, 5)]
        step.joint_names += ["base_link", "payload", *(f"quadrotor_{q}" for q in quadrotors)]
        step.wrench = [message_type("geometry_msgs/Wrench")() for _ in step.joint_names]
        return step, np.zeros((len(step.joint_names), 6))

    def hello(
        self, dt: float, rotors: ArrayLike, state: ArrayLike | None = None, real_time: bool = False
    ) -> PluginAnswer:
        """Begin a session; see `gazebo_wire.Wire.hello`. The rotors are those of the world.

        Raises:
            InputError: the world is of another vehicle.
            TimeoutError: nothing answers.
        """
        self._rospy.set_param(f"{self._place}/real_time", bool(real_time))
        standing = self._lead()
        step, mass, count = (self._rospy.get_param(f"{self._place}/{name}") for name in ("step", "mass", "quadrotors"))
        if count != self.count:
            raise InputError(
                f"engine 'gazebo-ros': the vehicle in Gazebo has {count} quadrotors, the mission's has {self.count}"
            )
        if state is None:
            self._await(standing)
        else:
            self._request(self._placement(np.asarray(state)), standing)
        self.answer.clock[1:] = step, mass
        return self.answer

    def advance(self) -> PluginAnswer:
        """Send the step, and wait until the world has taken it.

        Raises:
            ConnectionError: another pilot leads, or the server has ended.
            TimeoutError: nothing answers.
        """
        values, n = self._values, 4 * self.count
        values[:n, 2] = self.thrusts
        values[n], values[n + 1] = self.wrench, self.loads[:6]
        values[n + 2 :] = self.loads[6:].reshape(6, self.count).T
        for wrench, row in zip(self._step.wrench, values.tolist(), strict=True):
            force, torque = wrench.force, wrench.torque
            force.x, force.y, force.z, torque.x, torque.y, torque.z = row
        try:
            self._request(self._step, self._at)
        except self._rospy.ROSException as error:  # this node was shut down from outside
            raise ConnectionError(f"engine 'gazebo-ros': {error}") from error
        return self.answer

    def keep_alive(self) -> None:
        """Tell the plugin that the pilot is alive: repeat the last step, which is too late to move anything."""
        if not self._over:
            self._commands.publish(self._step)

    def close(self) -> None:
        """End the session and close the topics."""
        with contextlib.suppress(Exception):  # the server has ended already
            self._commands.publish(message_type(MOVED)())
        for topic in (self._commands, self._calls, *self._listening):
            topic.unregister()
        _taken.discard(self._place)

    def _placement(self, state: Array) -> Any:
        """The message that asks for a state (13,)."""
        to = message_type("geometry_msgs/Transform")()
        vector, quaternion = type(to.translation), type(to.rotation)
        to.translation, to.rotation = vector(*state[:3]), quaternion(*np.roll(state[6:10], -1))
        twist = message_type("geometry_msgs/Twist")(vector(*state[3:6]), vector(*state[10:]))
        return message_type(MOVED)(joint_names=["base_link"], transforms=[to], twist=[twist])

    def _request(self, message: Any, at: Stamp) -> None:
        """Send a message that answers the state of that stamp, again and again, until a later one is in `answer`."""
        message.header.stamp.secs, message.header.stamp.nsecs = at
        self._commands.publish(message)
        self._await((at[0], at[1] + 1), lambda: self._commands.publish(message))

    def _await(self, least: Stamp, again: Callable[[], None] = lambda: None) -> None:
        """Wait until a state of that stamp or a later one is in `answer`, calling `again` whenever it is silent."""
        deadline = time.monotonic() + self.patience
        while not self._over:
            try:
                state = self._states.get(timeout=SILENCE)
            except queue.Empty:
                self._alive()
                again()
            else:
                self._at = state.header.stamp.secs, state.header.stamp.nsecs
                if self._at >= least:
                    return self._take(state)
            if time.monotonic() > deadline:
                raise TimeoutError(self._no_answer())
        raise ConnectionError("engine 'gazebo-ros': the session is over: another pilot leads, or this one was given up")

    def _take(self, state: Any) -> None:
        """Write a state message into `answer`."""
        answer, N = self.answer, self.count
        p, q = state.transforms[0].translation, state.transforms[0].rotation
        v, w = state.twist[0].linear, state.twist[0].angular
        answer.clock[0] = self._at[0] + 1e-9 * self._at[1]
        answer.state[:] = p.x, p.y, p.z, v.x, v.y, v.z, q.w, q.x, q.y, q.z, w.x, w.y, w.z
        rows = np.array([[f.x, f.y, f.z, m.x, m.y, m.z] for f, m in ((w.force, w.torque) for w in state.wrench[1:])])
        answer.readings[:3], answer.readings[-3:], answer.pushed[:] = rows[0, :3], rows[N + 1, :3], rows[N + 2]
        answer.readings[3:-3] = rows[1 : N + 1].T.ravel()
        answer.touches.fill(0.0)
        for k, name in enumerate(state.joint_names[N + 4 :], N + 4):
            place = state.transforms[k].translation
            self._touches[name][:] = state.wrench[k].force.x, place.x, place.y, place.z

    def _lead(self) -> Stamp:
        """Become the pilot; the stamp of the state in which the world waits from then on."""
        self._found, self._over = None, False
        deadline = time.monotonic() + self.patience
        while self._found is None:
            self._calls.publish()
            time.sleep(WAITING)
            self._alive()
            if time.monotonic() > deadline:
                raise TimeoutError(self._no_answer())
        return self._found

    def _on_pilot(self, message: Any) -> None:
        """Record whether this pilot leads."""
        if message.frame_id == self._name:
            self._found = message.stamp.secs, message.stamp.nsecs
        elif self._found is not None:
            self._over = True

    def _no_answer(self) -> str:
        return (
            f"engine 'gazebo-ros': the plugin at {self._place} did not answer within {self.patience:g} s; is the world "
            "paused, or has Gazebo ended?"
        )
