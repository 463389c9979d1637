"""ROS 1, by rospy as the machine has it; the package with a launch file for its own tools, and its RViz."""

from __future__ import annotations

import contextlib
import io
import shutil
import subprocess
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from tandemlift.apps.export.messages import MessageTypes
from tandemlift.apps.live.session.parameters import dotted_values
from tandemlift.apps.ros.middleware import Answer, ParameterFacts, TopicPublisher
from tandemlift.core.errors import InputError
from tandemlift.core.files import DATA
from tandemlift.engines.rospy import PLACES, import_rospy, message_type

NAME = "tandemlift"
FOLDER = DATA / "ros"  # of the ROS package `tandemlift`
VIEWS = {"rviz": "tandemlift.rviz", "rviz2": "tandemlift_ros2.rviz"}
OF_GAZEBO = {place.rpartition("/")[2] for place in PLACES}  # parameters of Gazebo's own below those of a node `NAME`
OLD = {"builtin_interfaces/Time": "Time"}  # types without a message in ROS 1: of the package genpy


class Ros1:
    """A node of ROS 1; see `middleware.Middleware`. There can be one in a process.

    Args:
        arguments: remappings NAME:=VALUE, as roslaunch gives them.

    Raises:
        InputError: there is no rospy, or no master.
    """

    def __init__(self, arguments: Sequence[str] = ()) -> None:
        self._rospy = rospy = import_rospy()
        import rosgraph

        self._uri = rosgraph.get_master_uri()
        if not rosgraph.is_master_online():
            raise InputError(f"no ROS master at {self._uri}: start roscore, or set ROS_MASTER_URI")
        rospy.init_node(NAME, argv=["tandemlift", *arguments], disable_signals=True)
        self.types, self.name = MessageTypes(self._class_of, numbered=True), "ROS 1"
        self._seen: dict[str, Any] = {}
        self._kept: dict[str, Any] = {}
        self._own: set[str] = set()  # parameters that only this node has set

    def _class_of(self, name: str) -> type:
        return getattr(self._rospy, OLD[name]) if name in OLD else message_type(name)

    @property
    def over(self) -> bool:
        """Whether ROS is shutting the node down."""
        return self._rospy.is_shutdown()

    def advertise(self, topic: str, kind: str, *, latched: bool = False, depth: int = 1) -> TopicPublisher:
        """A topic to publish on, without Nagle's delay."""
        make, of = self._rospy.Publisher, message_type(kind)
        publisher = make(topic, of, queue_size=depth, latch=latched, tcp_nodelay=True)
        return TopicPublisher(publisher.publish, publisher.get_num_connections, latched=latched)

    def subscribe(self, topic: str, kind: str, handle: Callable[[Any], object]) -> None:
        """Call a function with the messages of a topic; if several wait, with the last."""
        self._rospy.Subscriber(topic, message_type(kind), handle, queue_size=1, tcp_nodelay=True)

    def serve(self, name: str, answer: Callable[[], Answer]) -> None:
        """Answer `std_srvs/Trigger`."""
        Trigger, Response = message_type("std_srvs/Trigger"), message_type("std_srvs/TriggerResponse")
        self._rospy.Service(name, Trigger, lambda request: Response(*answer()))

    def declare(self, facts: Mapping[str, ParameterFacts], change: Callable[[str, object], str]) -> None:
        """Nothing: the parameter server knows no more than values."""

    def parameters(self) -> dict[str, Any]:
        """The parameters of the node's private namespace that differ from the kept values; not those of a Gazebo there.

        Raises:
            ConnectionError: the master does not answer; so do `keep` and `shutdown`.
        """
        with self._master():
            tree = self._rospy.get_param("~", {})
        own = {name: value for name, value in tree.items() if name not in OF_GAZEBO} if tree else {}
        self._seen = found = dict(dotted_values(own))
        return {key: value for key, value in found.items() if key not in self._kept or self._kept[key] != value}

    def keep(self, values: Mapping[str, Any]) -> None:
        """Write what has changed, or was set to something else, to the parameter server.

        What is set since `parameters` looked is left, for it to see the next time.
        """
        with self._master():
            for key, value in values.items():
                if self._seen.get(key) != value:
                    self._rospy.set_param(_private(key), value)
        if not self._kept:
            self._own = set(values) - set(self._seen)
        self._kept = {**self._seen, **values}

    def log(self, what: str) -> None:
        """Write an event to the log of ROS, which is `/rosout` too: as a warning, if it gives a reason."""
        (self._rospy.logwarn if ": " in what else self._rospy.loginfo)("%s", what)

    def encoded(self, message: Any) -> bytes:
        """A message as a ROS 1 bag has it."""
        message.serialize(buffer := io.BytesIO())
        return buffer.getvalue()

    def shutdown(self) -> None:
        """Unregister from the master, and remove values that the next flight would read as its parameters."""
        try:
            for key in () if self.over else self._own:
                with self._master(), contextlib.suppress(KeyError):
                    self._rospy.delete_param(_private(key))
        finally:
            self._rospy.signal_shutdown("the flight has ended")

    @contextlib.contextmanager
    def _master(self) -> Iterator[None]:
        """The message about a master that does not answer."""
        try:
            yield
        except OSError as error:
            raise ConnectionError(f"the ROS master at {self._uri} is gone: {error.strerror or error}") from None


def _private(key: str) -> str:
    """A parameter's name in the node's namespace."""
    return "~" + key.replace(".", "/")


def start_rviz(name: str) -> subprocess.Popen[bytes]:
    """Start `rviz` of ROS 1 or `rviz2` with all displays.

    Raises:
        InputError: it is not installed.
    """
    program = shutil.which(name)
    if program is None:
        raise InputError(f"--rviz: {name} is not installed: on Debian apt-get install rviz; in ROS 2 its package rviz2")
    command = [program, "-d", str(FOLDER / VIEWS[name])]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
