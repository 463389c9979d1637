"""ROS 2 by rclpy, as it is installed: a node with a name, services and parameters, over any of ROS 2's middlewares."""

from __future__ import annotations

import array
import contextlib
import importlib
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from tandemlift.apps.export.messages import MessageTypes, modern
from tandemlift.apps.export.topics import MISSION
from tandemlift.apps.ros.middleware import Answer, ParameterFacts, TopicPublisher
from tandemlift.core.errors import InputError

NAME, MARK = "tandemlift", "--ros-args"
DEPTH = 100  # messages that may wait: a second of samples
MEETING, NAP = 3.0, 0.05  # s, within which other nodes are found, and between looks
OWN = ("use_sim_time", "start_type_description_service", "qos_overrides.")  # parameters that rclpy itself has, begin so
FIELDS: dict[str, Callable[[Any], Any]] = {  # what rclpy wants in place of numbers, by the type of the field
    "octet": lambda number: bytes([number]),
    "sequence<double>": lambda numbers: array.array("d", numbers),
}


class UnusableRclpyError(Exception):
    """Rclpy is there and cannot be used."""


class RclpyNode:
    """A node of ROS 2; see `middleware.Middleware`. There can be one in a process.

    Args:
        arguments: remappings NAME:=VALUE, or `--ros-args` and what follows, as a launch file gives them.
        name: of the node.

    Raises:
        UnusableRclpyError: rclpy cannot be imported, or has no middleware.
        InputError: the arguments are none of ROS 2's.
    """

    def __init__(self, arguments: Sequence[str] = (), name: str = NAME) -> None:
        _check_usable()
        import rclpy
        from rclpy.executors import MultiThreadedExecutor
        from rclpy.node import Node
        from rclpy.signals import SignalHandlerOptions

        at = list(arguments).index(MARK) if MARK in arguments else len(arguments)
        words = [MARK, *(part for word in arguments[:at] for part in ("-r", word)), *arguments[at:]]
        try:
            rclpy.init(args=words, signal_handler_options=SignalHandlerOptions.NO)
            self._node = Node(
                name, allow_undeclared_parameters=True, automatically_declare_parameters_from_overrides=True
            )
        except Exception as error:  # rclpy has many, also private ones
            _end_rclpy()
            raise InputError(f"{' '.join(words)}: {error}") from None
        self._rclpy, self._missing = rclpy, set[str]()
        self.types = MessageTypes(self._class_of, numbered=False, numbers=np.array)
        self.name = f"ROS 2 by rclpy ({rclpy.get_rmw_implementation_identifier()})"
        self._facts: Mapping[str, ParameterFacts] = {}
        self._declared, self._keeper = set[str](), 0
        self._change: Callable[[str, object], str] = lambda key, value: "the flight has not begun"
        self._overrides, self._met = self._values(), time.monotonic() + MEETING
        self._node.add_on_set_parameters_callback(self._changed)
        self._executor = MultiThreadedExecutor(2)  # a change of a parameter may take long: pushes go on
        self._executor.add_node(self._node)
        self._spinner = threading.Thread(target=self._spin, name="rclpy", daemon=True)
        self._spinner.start()

    def _spin(self) -> None:
        from rclpy.executors import ExternalShutdownException

        with contextlib.suppress(ExternalShutdownException):
            self._executor.spin()

    def _check_alone(self) -> None:
        """Look for a node of the same name, and for one with the same topics.

        Raises:
            InputError: there is one.
        """
        own, alone = (self._node.get_name(), self._node.get_namespace()), True
        while alone and time.monotonic() < self._met:
            found = self._node.get_publishers_info_by_topic("/parameter_events")  # every node has it
            others = [one for one in found if (one.node_name, one.node_namespace) == own][1:]
            alone = not (others or self._node.count_publishers(MISSION.name))
            time.sleep(NAP)
        if not alone:
            what = f"a node {self._node.get_fully_qualified_name()} or one with its topics is in the graph already"
            raise InputError(f"{what}: end it, or set another ROS_DOMAIN_ID")

    def _class_of(self, name: str) -> Callable[..., Any]:
        """A function that makes messages of a type, also from the values of its fields in their order."""
        kind = self._message_class(name)
        if kind is None:
            return lambda *values, **named: None
        fields = kind.get_fields_and_field_types()
        names = tuple(fields)
        odd = [(field, FIELDS[of]) for field, of in fields.items() if of in FIELDS]

        def make(*values: Any, **named: Any) -> Any:
            named.update(zip(names, values, strict=False))
            for field, convert in odd:
                if field in named:
                    named[field] = convert(named[field])
            return kind(**named)

        return make

    def _message_class(self, name: str) -> Any:
        """The class of a type, or None if its package is not installed, which the log says once."""
        package, _, kind = modern(name).split("/")
        try:
            return getattr(importlib.import_module(f"{package}.msg"), kind)
        except ImportError:
            if package not in self._missing:
                self._missing.add(package)
                self.log(f"{package} is not installed: topics of its types are left out")
            return None

    @property
    def over(self) -> bool:
        """Whether ROS has been shut down from outside."""
        return not self._rclpy.ok()

    def advertise(self, topic: str, kind: str, *, latched: bool = False, depth: int = 1) -> TopicPublisher:
        """A topic to publish on: reliable, a hundred may wait; late subscribers get the last if latched."""
        from rclpy.qos import DurabilityPolicy, QoSProfile

        of = self._message_class(kind)
        if of is None:
            return TopicPublisher(lambda message: None, lambda: 0, latched=False)
        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        profile = QoSProfile(depth=1 if latched else max(depth, DEPTH), durability=durability)
        publisher = self._node.create_publisher(of, topic, profile)
        return TopicPublisher(publisher.publish, publisher.get_subscription_count, latched=latched)

    def subscribe(self, topic: str, kind: str, handle: Callable[[Any], object]) -> None:
        """Call a function with the messages of a topic, one after the other."""
        from rclpy.callback_groups import MutuallyExclusiveCallbackGroup

        of, group = self._message_class(kind), MutuallyExclusiveCallbackGroup()
        if of is not None:
            self._node.create_subscription(of, topic, handle, DEPTH, callback_group=group)

    def serve(self, name: str, answer: Callable[[], Answer]) -> None:
        """Answer `std_srvs/srv/Trigger`."""
        from std_srvs.srv import Trigger

        def respond(request: object, response: Any) -> Any:
            response.success, response.message = answer()
            return response

        self._node.create_service(Trigger, name, respond)

    def declare(self, facts: Mapping[str, ParameterFacts], change: Callable[[str, object], str]) -> None:
        """Give parameters their descriptors; whoever sets one gets the refusal as the reason of the result.

        Raises:
            InputError: a node of this name or with these topics is in the graph.
        """
        self._check_alone()
        self._facts, self._change = facts, change

    def parameters(self) -> dict[str, Any]:
        """The parameters that the node was started with; later ones are changed at once."""
        found, self._overrides = self._overrides, {}
        return found

    def _values(self) -> dict[str, Any]:
        """The values of the node's parameters, but of those that rclpy itself has."""
        found = {name: _plain(one.value) for name, one in self._node.get_parameters_by_prefix("").items()}
        return {name: value for name, value in found.items() if not name.startswith(OWN)}

    def keep(self, values: Mapping[str, Any]) -> None:
        """Declare the parameters, or set what is no longer as it was or was set in another form, such as 2 for 2.0."""
        from rclpy.parameter import Parameter

        self._keeper, present = threading.get_ident(), self._values()
        for name in present.keys() - (self._declared & values.keys()):
            self._node.undeclare_parameter(name)
        for key, value in values.items():
            if key not in self._declared or key not in present:
                self._node.declare_parameter(key, value, self._descriptor(key, value), ignore_override=True)
            elif present[key] != value:
                self._node.set_parameters([Parameter(key, value=value)])
        self._declared = set(values)
        self._keeper = 0

    def _descriptor(self, key: str, value: Any) -> Any:
        """The descriptor that tools show of a parameter; its type is left to our own check, whose text says more."""
        from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor

        about = self._facts.get(key, ParameterFacts(key))
        made = ParameterDescriptor(description=about.meaning, dynamic_typing=True)
        if about.low is not None and about.high is not None:
            made.additional_constraints = f"each from {about.low:g} to {about.high:g}"
            if isinstance(value, float):  # rclpy applies a range to single numbers only
                made.floating_point_range = [FloatingPointRange(from_value=about.low, to_value=about.high)]
        return made

    def _changed(self, parameters: Sequence[Any]) -> Any:
        """Set parameters that another node sets: all, or none."""
        from rcl_interfaces.msg import SetParametersResult

        before, done = self._values(), list[str]()
        if threading.get_ident() != self._keeper:
            for one in parameters:
                refusal = "" if one.name.startswith(OWN) else self._change(one.name, _plain(one.value))
                if refusal:
                    for name in reversed(done):
                        self._change(name, before[name])
                    return SetParametersResult(successful=False, reason=refusal)
                done.append(one.name)
        return SetParametersResult(successful=True)

    def log(self, what: str) -> None:
        """Write an event to ROS's log, which is `/rosout` too: as a warning, if it gives a reason."""
        log = self._node.get_logger()
        if ": " in what:  # one place in the code has one level for good
            log.warning(what)
        else:
            log.info(what)

    def encoded(self, message: Any) -> bytes:
        """A message in XCDR1."""
        from rclpy.serialization import serialize_message

        return bytes(serialize_message(message))

    def shutdown(self) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        _end_rclpy()
        self._spinner.join()


def _check_usable() -> None:
    """Try rclpy in another process: without its middleware it ends the process.

    Raises:
        UnusableRclpyError: that failed.
    """
    tried = subprocess.run([sys.executable, "-c", "import rclpy; rclpy.init()"], capture_output=True, text=True)
    if tried.returncode:
        said = tried.stderr.strip() or f"its process ended with {tried.returncode}"
        raise UnusableRclpyError(said.splitlines()[-1][:300])


def _end_rclpy() -> None:
    """End rclpy, if it runs."""
    with contextlib.suppress(Exception):
        import rclpy

        rclpy.try_shutdown()


def _plain(value: Any) -> Any:
    """A parameter's value, whose several numbers or words may be of any kind of sequence, as a mission has it."""
    return value if isinstance(value, str | int | float | None) else list(value)
