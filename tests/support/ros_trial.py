"""A node whose middleware is dictionaries and whose clock the test advances: its messages in and out."""

import types as plain
from collections import defaultdict

from rosbags.typesys import Stores, get_typestore
from sessions import GUIDED as BY_HAND
from sessions import THRESHOLD

from tandemlift.apps.export.messages import MessageTypes, modern
from tandemlift.apps.live.session.session import Session
from tandemlift.apps.ros.node import FlightNode

STORE = get_typestore(Stores.ROS2_HUMBLE)


def message_class(name):
    """A message class whose fields are given by name, and are zero otherwise."""
    _, fields = STORE.fielddefs[modern(name)]

    def make(*values, **named):
        given = dict(zip((field for field, _ in fields), values, strict=False)) | named
        return plain.SimpleNamespace(**{field: given.get(field, 0) for field, _ in fields})

    return make


class Channel:
    def __init__(self):
        self.wanted, self.sent = True, []

    def publish(self, message):
        self.sent.append(message)


class Middleware:
    def __init__(self):
        self.types, self.name = MessageTypes(message_class, numbered=False), "a ROS of dictionaries"
        self.channels, self.kinds, self.latched = defaultdict(Channel), {}, set()
        self.heeding, self.services, self.set, self.kept, self.over, self.logged = {}, {}, {}, {}, False, []

    def advertise(self, topic, kind, *, latched=False, depth=1):
        self.kinds[topic] = kind
        self.latched |= {topic} if latched else set()
        return self.channels[topic]

    def subscribe(self, topic, kind, heed):
        self.heeding[topic] = heed

    def serve(self, name, answer):
        self.services[name] = answer

    def declare(self, facts, change):
        self.facts, self.change = facts, change

    def parameters(self):
        found, self.set = self.set, {}
        return found

    def keep(self, values):
        self.kept = dict(values)

    def log(self, what):
        self.logged.append(what)

    def shutdown(self):
        self.over = True


def wrench(frame, force=(0.0, 0.0, 0.0), torque=(0.0, 0.0, 0.0)):
    """A `geometry_msgs/WrenchStamped`."""
    vectors = [plain.SimpleNamespace(x=x, y=y, z=z) for x, y, z in (force, torque)]
    return plain.SimpleNamespace(
        header=plain.SimpleNamespace(frame_id=frame), wrench=plain.SimpleNamespace(force=vectors[0], torque=vectors[1])
    )


GUIDED = BY_HAND | {"admittance.threshold": THRESHOLD, "phases.lift_start": 0.0, "phases.lift_duration": 1.0}
UP = 2.0  # s


class Trial:
    """A node whose flight advances on command."""

    def __init__(self, mission, folder, middleware=None):
        self.session, self.middleware = Session(mission, out=folder), middleware or Middleware()
        self.session.prepare()
        self.session.start = self.session.pacer.begin
        self.front = FlightNode(self.session, self.middleware)
        self.front.start()
        self.heed = self.middleware.heeding["/tandemlift/push"]

    def fly(self, seconds):
        self.session._fly(round(seconds / self.session.flight.dt))
        self.front._due = dict.fromkeys(self.front._due, 0.0)  # all is due, however little time this took
        self.front.publish()

    def sent(self, topic):
        return self.middleware.channels[topic].sent

    def said(self):
        """Texts of `/diagnostics` about events."""
        self.front.diagnostics.flush()
        told = [status for array in self.sent("/diagnostics") for status in array.status]
        return [status.message for status in told if status.name == "tandemlift: pilot"]

    def channel(self, name):
        return self.session.channels()[name][0]
