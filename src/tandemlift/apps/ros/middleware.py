"""The interface of a middleware: to publish, to subscribe, to serve requests, and to keep parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from tandemlift.apps.export.messages import MessageTypes

Answer = tuple[bool, str]  # whether it is done, and a message


class TopicPublisher(Protocol):
    """A topic to publish on."""

    @property
    def wanted(self) -> bool:
        """Whether there is a subscriber now or, if it is latched, may be one later."""

    def publish(self, message: object) -> None:
        """Send a message, without waiting for subscribers."""


class Middleware(Protocol):
    """One ROS.

    Attributes:
        types: the classes of its messages.
    """

    types: MessageTypes

    @property
    def over(self) -> bool:
        """Whether it has been shut down from outside."""

    def advertise(self, topic: str, kind: str, *, latched: bool = False, depth: int = 1) -> TopicPublisher:
        """A topic to publish on, by its whole name and its type as ROS 1 calls it.

        Args:
            topic: its name.
            kind: of its messages.
            latched: whether late subscribers get the last message.
            depth: length of the queue for a slow subscriber.
        """

    def subscribe(self, topic: str, kind: str, handle: Callable[[Any], object]) -> None:
        """Call a function with every message of a topic, in a thread of the middleware."""

    def serve(self, name: str, answer: Callable[[], Answer]) -> None:
        """Answer a request without arguments, `std_srvs/Trigger`, in a thread of the middleware's."""

    def parameters(self) -> dict[str, Any]:
        """The parameters set from outside, not by `keep`, by dotted key."""

    def keep(self, values: Mapping[str, Any]) -> None:
        """Set the values of the parameters."""

    def log(self, what: str) -> None:
        """Write an event to ROS's log."""

    def shutdown(self) -> None:
        """Disconnect; nothing is sent or received any more.

        Raises:
            OSError: there was nothing to disconnect from any more.
        """
