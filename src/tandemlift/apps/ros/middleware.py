"""The interface of a middleware (publish, subscribe, serve requests, keep parameters).

A bag is recorded by a middleware around it.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol, cast

from tandemlift.apps.export.live_bag import LiveBag
from tandemlift.apps.export.messages import MessageTypes
from tandemlift.core.errors import InputError

Answer = tuple[bool, str]  # whether it is done, and a message
AGAIN = 0.2  # s, from one count of subscribers to the next


class TopicPublisher:
    """A topic to publish on, whose subscribers are counted.

    Args:
        publish: sends a message, without waiting for subscribers.
        count: the number of subscribers.
        latched: whether it is wanted without any.
    """

    def __init__(self, publish: Callable[[Any], object], count: Callable[[], int], *, latched: bool) -> None:
        self.publish, self._count, self._latched = publish, count, latched
        self._looked, self._wanted = 0.0, False

    @property
    def wanted(self) -> bool:
        """Whether the topic has subscribers, or is latched for late ones."""
        now = time.monotonic()
        if not self._latched and now - self._looked > AGAIN:
            self._looked, self._wanted = now, self._count() > 0
        return self._latched or self._wanted


class ParameterFacts(NamedTuple):
    """Facts of a parameter that tools show: its meaning with unit and choices, and the bounds of its numbers if any."""

    meaning: str
    low: float | None = None
    high: float | None = None


class Middleware(Protocol):
    """One ROS.

    Attributes:
        types: the classes of its messages.
        name: of the ROS and of how it is spoken, for the person who starts the node.
    """

    types: MessageTypes
    name: str

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

    def declare(self, facts: Mapping[str, ParameterFacts], change: Callable[[str, object], str]) -> None:
        """Tell what parameters there are, before the first `keep`.

        Args:
            facts: of each parameter.
            change: sets one at once and returns the refusal, if any; `parameters` has what is not set by it.
        """

    def parameters(self) -> dict[str, Any]:
        """The parameters set from outside, neither by `keep` nor by `change`, by dotted key."""

    def keep(self, values: Mapping[str, Any]) -> None:
        """Set the values of the parameters."""

    def log(self, what: str) -> None:
        """Write an event to ROS's log."""

    def encoded(self, message: Any) -> bytes:
        """A message as a bag has it."""

    def shutdown(self) -> None:
        """Disconnect; nothing is sent or received any more.

        Raises:
            OSError: there was nothing to disconnect from any more.
        """


class RecordedMiddleware:
    """A middleware whose messages, sent and received, a bag has too.

    Args:
        middleware: does all but the recording.
        bag: open.
    """

    def __init__(self, middleware: Middleware, bag: LiveBag) -> None:
        self._middleware, self._bag = middleware, bag

    def __getattr__(self, name: str) -> Any:
        return getattr(self._middleware, name)

    def advertise(self, topic: str, kind: str, *, latched: bool = False, depth: int = 1) -> TopicPublisher:
        """A topic that the bag wants, too."""
        publisher = self._middleware.advertise(topic, kind, latched=latched, depth=depth)
        return TopicPublisher(self._recording(topic, kind, publisher.publish, latched), lambda: 1, latched=latched)

    def subscribe(self, topic: str, kind: str, handle: Callable[[Any], object]) -> None:
        """Call a function with every message of a topic, once the bag has it."""
        self._middleware.subscribe(topic, kind, self._recording(topic, kind, handle, latched=False))

    def _recording(self, topic: str, kind: str, then: Callable[[Any], object], latched: bool) -> Callable[[Any], None]:
        write = self._bag.topic(topic, kind, latched=latched)

        def record(message: Any) -> None:
            if message is not None:  # of a type that this ROS lacks
                write(message, self._middleware.encoded(message))
            then(message)

        return record


@contextlib.contextmanager
def recorded(middleware: Middleware, folder: str | None) -> Iterator[Middleware]:
    """A middleware that is recorded in a bag until the end of the context, if a folder is given.

    Raises:
        InputError: the folder exists or cannot be written, or the middleware is ROS 1.
    """
    if folder is None:
        yield middleware
        return
    if middleware.types.numbered:
        raise InputError("--bag: needs ROS 2; in ROS 1, rosbag record -a")
    with LiveBag(Path(folder)) as bag:
        yield cast(Middleware, RecordedMiddleware(middleware, bag))


def split_words(words: Sequence[str], default: str) -> tuple[str, list[str]]:
    """The mission among words, and the arguments for ROS itself."""
    missions = [word for word in words if ":=" not in word] or [default]
    if len(missions) > 1:
        raise InputError(f"{' '.join(missions)}: give one mission only")
    return missions[0], [word for word in words if ":=" in word]
