"""The topics: samples by the recipes of exported bags, frames, paths and markers, and what is published once."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from tandemlift import Flight, Vehicle
from tandemlift.apps.export.coordinate_frames import ALIGNED, BASE, WORLD, fixed, quaternions
from tandemlift.apps.export.messages import SECOND, Maker, MessageTypes, Transforms, message_maker
from tandemlift.apps.export.recipes import POSE, Recipe, Source, Topic
from tandemlift.apps.export.topics import MISSION, ROOT, TF, TF_STATIC, OtherTopic, recipes_for
from tandemlift.apps.ros import scenery
from tandemlift.apps.ros.middleware import Middleware, TopicPublisher
from tandemlift.apps.ros.scenery import MARKERS
from tandemlift.engines.models.written import robot_of
from tandemlift.missions import format_toml

PATH = "nav_msgs/Path"
FLOWN = OtherTopic(f"{ROOT}/path", PATH, "path flown in the last minute, 5 times a second", (WORLD,))
ASKED = OtherTopic(f"{ROOT}/reference/path", PATH, "path of the reference, likewise", (WORLD,))
STILL = OtherTopic(f"{ROOT}/markers/still", MARKERS, "vehicle, floor, walls; latched", (BASE, WORLD))
MOVING = OtherTopic(
    f"{ROOT}/markers/moving",
    MARKERS,
    "push as an arrow of 0.22 m/N; reference, where it is more than 2 cm off; 20 times a second",
    (ALIGNED, WORLD),
)
ROBOT = OtherTopic(
    f"{ROOT}/robot_description", "std_msgs/String", "the vehicle as URDF, with these frames; latched", (BASE,)
)
CLOCK = OtherTopic(
    "/clock", "rosgraph_msgs/Clock", "stamp of each sample, for nodes with `use_sim_time`; only in ROS 2", ()
)
ONLY_LIVE = (FLOWN, ASKED, STILL, MOVING, ROBOT, CLOCK)
PATH_SPAN, PATH_SPACING = 60.0, 0.2  # s of a path that is shown, and between its points


class SampleTopic(NamedTuple):
    """A topic of samples: how its numbers are made, how its messages are, and where they go."""

    recipe: Recipe
    make: Maker
    channel: TopicPublisher


class SampleTopics:
    """The topics that have a message for each sample.

    Args:
        middleware: where to.
        flight: samples as they will be.
        vehicle: what is flown.
    """

    def __init__(self, middleware: Middleware, flight: Flight, vehicle: Vehicle) -> None:
        types, self._vehicle = middleware.types, vehicle
        self._taken = dict[str, float]()  # time of the last reading on a topic
        self._sent = [
            SampleTopic(r, message_maker(types, r), middleware.advertise(r.name, r.kind))
            for r in recipes_for(flight, vehicle)
        ]
        self._transform, self._tf = Transforms(types).moving, middleware.advertise(TF.name, TF.kind, depth=100)
        self._types, self._clock = types, None  # in ROS 1, a clock is Gazebo's
        if not types.numbered:
            self._clock = middleware.advertise(CLOCK.name, CLOCK.kind)

    def publish(self, flight: Flight, stamps: list[int]) -> None:
        """Publish samples on the topics that have subscribers; of readings, each once, stamped when it was taken."""
        take = Source(flight, self._vehicle)
        wanted = [
            (s.channel, s.make, s.recipe.rows(take).tolist(), self._headers(s.recipe, flight, stamps))
            for s in self._sent
            if s.channel.wanted
        ]
        if self._tf.wanted:
            places = np.hstack([flight["position"], flight["attitude"]])
            wanted.append((self._tf, self._transform, places.tolist(), stamps))
        if self._clock and self._clock.wanted:
            wanted.append((self._clock, self._tick, stamps, stamps))
        for k in range(len(stamps)):  # one sample after another, so that none of a topic overtakes the one before
            for channel, make, rows, headers in wanted:
                if headers[k]:
                    channel.publish(make(headers[k], rows[k]))

    def _headers(self, recipe: Recipe, flight: Flight, stamps: list[int]) -> list[int]:
        """The stamps of a topic's messages [ns]; 0 for a reading that was published before."""
        if not recipe.stamp:
            return stamps
        taken = flight[recipe.stamp].tolist()
        before = [self._taken.get(recipe.name), *taken[:-1]]
        self._taken[recipe.name] = taken[-1]
        late = [round((now - then) * SECOND) for now, then in zip(flight.time.tolist(), taken, strict=True)]
        return [
            stamp - back if then != last else 0
            for stamp, back, then, last in zip(stamps, late, taken, before, strict=True)
        ]

    def _tick(self, stamp: int, _: object) -> object:
        return self._types[CLOCK.kind](self._types["builtin_interfaces/Time"](*divmod(stamp, SECOND)))


class LatchedTopics:
    """The topics that are published once; latched, so that late subscribers get them too.

    Args:
        middleware: where to.
    """

    def __init__(self, middleware: Middleware) -> None:
        self._types = middleware.types
        self._drawn: object = None
        self._mission = middleware.advertise(MISSION.name, MISSION.kind, latched=True)
        self._static = middleware.advertise(TF_STATIC.name, TF_STATIC.kind, latched=True)
        self._still = middleware.advertise(STILL.name, STILL.kind, latched=True)
        self._robot = middleware.advertise(ROBOT.name, ROBOT.kind, latched=True)

    def publish_mission(self, tables: Mapping[str, Any]) -> None:
        """Publish the mission as it is now."""
        self._mission.publish(self._types[MISSION.kind](format_toml(tables)))

    def publish_vehicle(self, scene: Mapping[str, Any], vehicle: Vehicle, stamp: int) -> None:
        """Publish where the vehicle's parts are, and what it and its surroundings look like."""
        self._static.publish(Transforms(self._types).fixed(stamp, list(fixed(vehicle))))
        self._robot.publish(self._types[ROBOT.kind](robot_of(vehicle, ROOT.strip("/"))))
        self._drawn = scenery.still(self._types, scene, vehicle)
        self.draw()

    def draw(self) -> None:
        """Publish what the vehicle and its surroundings look like; RViz drops what comes before its frame."""
        self._still.publish(self._drawn)


class MarkerTopics:
    """The topics that are only displayed: moving markers, the flown path and the reference path.

    Args:
        middleware: where to.
        vehicle: what is flown.
    """

    def __init__(self, middleware: Middleware, vehicle: Vehicle) -> None:
        types = middleware.types
        self._markers = middleware.advertise(MOVING.name, MOVING.kind)
        self._moving = scenery.PushMarkers(types, vehicle)
        self._paths = [PathTopic(types, middleware.advertise(topic.name, PATH)) for topic in (FLOWN, ASKED)]

    def move(self, flight: Flight, stamp: int) -> None:
        """Show the last sample."""
        if self._markers.wanted:
            last = {name: flight[name][-1:] for name in flight}
            self._markers.publish(self._moving.of(last, stamp))

    def extend_paths(self, flight: Flight, stamp: int) -> None:
        """Extend the paths by the last sample, and publish them."""
        flown = flight["position"][-1], flight["attitude"][-1]
        asked = flight["reference_position"][-1], quaternions(flight["reference_euler"][-1:])[0]
        for path, (place, attitude) in zip(self._paths, (flown, asked), strict=True):
            path.extend(stamp, [*place.tolist(), *attitude.tolist()])


class PathTopic:
    """Poses of the last minute as a `nav_msgs/Path`."""

    def __init__(self, types: MessageTypes, channel: TopicPublisher) -> None:
        self._Path, self._header, self._channel = types[PATH], types.headers(WORLD), channel
        self._make = message_maker(types, Topic("", POSE, WORLD, np.zeros((0, 7))))
        self._poses: deque[Any] = deque(maxlen=round(PATH_SPAN / PATH_SPACING))

    def extend(self, stamp: int, pose: list[float]) -> None:
        """Add a pose, and publish them all if there is a subscriber."""
        self._poses.append(self._make(stamp, pose))
        if self._channel.wanted:
            self._channel.publish(self._Path(self._header(stamp), list(self._poses)))
