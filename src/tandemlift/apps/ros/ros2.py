"""ROS 2, by the DDS that it speaks on the wire; nothing of ROS needs to be installed.

Topics are called, typed and encoded (XCDR1) as ROS 2 does. Services and parameters of ROS 2 are conversations of
several topics, with a header that each of its middlewares writes in its own way: here both are plain topics.
"""

from __future__ import annotations

import logging
import os
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from tandemlift.apps.export.messages import MessageTypes
from tandemlift.apps.export.topics import ROOT, OtherTopic
from tandemlift.apps.ros.dds_types import DdsTypes, UntypedWriter, encoded
from tandemlift.apps.ros.middleware import Answer, ParameterFacts, TopicPublisher
from tandemlift.core.errors import InputError, extra, unknown
from tandemlift.core.files import toml_tables

TEXT = "std_msgs/String"
REQUEST = OtherTopic(f"{ROOT}/request", TEXT, "name of a request")
PARAMETER = OtherTopic(f"{ROOT}/parameter", "diagnostic_msgs/KeyValue", "key and value of a parameter")
ANSWER = OtherTopic(f"{ROOT}/answer", TEXT, "result of a request; published by the node")
ONLY_ROS2 = (REQUEST, PARAMETER, ANSWER)
ROSOUT, LOG, TIME, NAME = "/rosout", "rcl_interfaces/Log", "builtin_interfaces/Time", "tandemlift"
INFO, WARN = 20, 30  # levels of the log
DEPTH = 100  # messages that may wait: a second of samples
NAP = 0.1  # s, timeout of a read, after which the loop checks whether to continue
DOMAINS = 232  # the greatest domain whose ports there are

log = logging.getLogger(__name__)


class Ros2:
    """A participant of ROS 2's DDS; see `middleware.Middleware`.

    Args:
        domain: as ROS_DOMAIN_ID; None for what that says, or 0.

    Raises:
        InputError: a package is missing, or the domain is none.
    """

    def __init__(self, domain: int | None = None) -> None:
        with extra("ros2", "ROS 2"):
            import rosbags  # noqa: F401
            from cyclonedds.core import WaitSet
            from cyclonedds.domain import DomainParticipant

        self._participant = DomainParticipant(_domain() if domain is None else domain)
        self.types, self.name, self.over = MessageTypes(DdsTypes(), numbered=False), "ROS 2 by DDS", False
        self._handlers: list[tuple[Any, Callable[[Any], object]]] = []
        self._services: dict[str, Callable[[], Answer]] = {}
        self._set: dict[str, Any] = {}
        self._some, self._worker = WaitSet(self._participant), ThreadPoolExecutor(1, "requests")
        self._answer = self.advertise(ANSWER.name, TEXT, depth=DEPTH)
        self._rosout = self.advertise(ROSOUT, LOG, latched=True)  # as ROS 2 does
        self.subscribe(REQUEST.name, TEXT, lambda message: self._worker.submit(self._serve, message.data.strip()))
        self.subscribe(PARAMETER.name, PARAMETER.kind, self._take)
        self._listener = threading.Thread(target=self._listen, name="dds", daemon=True)
        self._listener.start()

    def advertise(self, topic: str, kind: str, *, latched: bool = False, depth: int = 1) -> TopicPublisher:
        """A topic to publish on: reliable, a hundred may wait; late subscribers get the last if latched."""
        qos = _qos(latched, 1 if latched else max(depth, DEPTH))
        writer = UntypedWriter(self._participant, f"rt{topic}", self.types[kind], qos)
        return TopicPublisher(writer.write, writer.subscribers, latched=latched)

    def subscribe(self, topic: str, kind: str, handle: Callable[[Any], object]) -> None:
        """Call a function with the messages of a topic."""
        from cyclonedds.core import InstanceState, ReadCondition, SampleState, ViewState
        from cyclonedds.sub import DataReader
        from cyclonedds.topic import Topic

        where = Topic(self._participant, f"rt{topic}", self.types[kind])
        reader = DataReader(self._participant, where, _qos(False, DEPTH))
        self._handlers.append((reader, handle))
        self._some.attach(ReadCondition(reader, SampleState.NotRead | ViewState.Any | InstanceState.Alive))

    def serve(self, name: str, answer: Callable[[], Answer]) -> None:
        """Answer the last word of a service's name, as it comes on the topic of requests."""
        self._services[name.rpartition("/")[2]] = answer

    def declare(self, facts: Mapping[str, ParameterFacts], change: Callable[[str, object], str]) -> None:
        """Nothing: parameters come on their topic."""

    def parameters(self) -> dict[str, Any]:
        """The new values from the topic of parameters."""
        found, self._set = self._set, {}
        return found

    def _take(self, message: Any) -> None:
        """Keep a parameter until it is read."""
        self._set[message.key] = _value(message.value)

    def keep(self, values: Mapping[str, Any]) -> None:
        """Nothing: the latched mission has the settings."""

    def log(self, what: str) -> None:
        """Write an event to `/rosout`, the log of ROS 2: as a warning, if it gives a reason."""
        seconds, rest = divmod(time.time_ns(), 10**9)
        stamp = self.types[TIME](seconds, rest)
        self._rosout.publish(self.types[LOG](stamp, WARN if ": " in what else INFO, NAME, what, "", "", 0))

    encoded = staticmethod(encoded)

    def shutdown(self) -> None:
        """Leave the domain."""
        self.over = True
        self._listener.join()
        self._worker.shutdown()
        self._handlers.clear()
        del self._some, self._participant

    def _listen(self) -> None:
        """Hand messages on as they come."""
        from cyclonedds.internal import InvalidSample

        while not self.over:
            self._some.wait(round(NAP * 1e9))
            for reader, handle in tuple(self._handlers):
                try:
                    for message in reader.take(DEPTH):
                        if not isinstance(message, InvalidSample):  # a notice that a writer has gone
                            handle(message)
                except Exception:  # of bytes that are no such message
                    log.exception("a message could not be handled")

    def _serve(self, what: str) -> None:
        """Handle a request and publish its result."""
        answer = self._services.get(what)
        done, words = answer() if answer else (False, str(unknown("request", what, self._services)))
        self._answer.publish(self.types[TEXT](f"{'done' if done else 'refused'}: {words}"))


def _qos(latched: bool, depth: int) -> Any:
    """The quality of service of ROS 2; a writer never waits for readers."""
    from cyclonedds.qos import Policy, Qos

    return Qos(
        Policy.Reliability.Reliable(0),
        Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile,
        Policy.History.KeepLast(depth),
        Policy.DataRepresentation(use_cdrv0_representation=True),
    )


def _domain() -> int:
    """The domain that ROS_DOMAIN_ID names.

    Raises:
        InputError: it names none.
    """
    text = os.environ.get("ROS_DOMAIN_ID", "").strip() or "0"
    if not text.isdecimal() or int(text) > DOMAINS:
        raise InputError(f"ROS_DOMAIN_ID = {text[:40]}: must be a whole number from 0 to {DOMAINS}")
    return int(text)


def _value(text: str) -> object:
    """A value as TOML writes it, or a word."""
    try:
        return toml_tables(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text
