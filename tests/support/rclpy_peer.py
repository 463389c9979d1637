"""A foreign node of ROS 2: what it sees and is answered, as JSON. Run by a Python that has rclpy; knows nothing of us.

Usage: rclpy_peer.py rclpy|dds
"""

import json
import sys
import time

import rclpy
from diagnostic_msgs.msg import DiagnosticArray, KeyValue
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry, Path
from rcl_interfaces.srv import DescribeParameters, GetParameters, SetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

KINDS = {
    "odometry": Odometry,
    "path": Path,
    "rotors/thrusts": JointState,
    "push/true": WrenchStamped,
    "markers/moving": MarkerArray,
    "/diagnostics": DiagnosticArray,
}
LATCHED = {"mission": String, "markers/still": MarkerArray, "robot_description": String}
PATIENCE, COUNT = 120.0, 300


class Peer:
    def __init__(self):
        rclpy.init()
        self.node = rclpy.create_node("peer", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.heard = {name: [] for name in (*KINDS, *LATCHED, "answer")}
        late = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        for name, kind in (*KINDS.items(), ("answer", String)):
            self.listen(name, kind, 100)
        for name, kind in LATCHED.items():
            self.listen(name, kind, late)
        self.push = self.node.create_publisher(WrenchStamped, "/tandemlift/push", 10)
        self.request = self.node.create_publisher(String, "/tandemlift/request", 10)
        self.parameter = self.node.create_publisher(KeyValue, "/tandemlift/parameter", 10)

    def listen(self, name, kind, qos):
        topic = name if name.startswith("/") else f"/tandemlift/{name}"
        self.node.create_subscription(kind, topic, self.heard[name].append, qos)

    def until(self, true, what):
        end = time.monotonic() + PATIENCE
        while not true():
            rclpy.spin_once(self.node, timeout_sec=0.05)
            if time.monotonic() > end:
                counts = {name: len(messages) for name, messages in self.heard.items()}
                sys.exit(f"{what} did not come; heard {counts}; {self.node.get_topic_names_and_types()}")

    def call(self, name, kind, **fields):
        client = self.node.create_client(kind, f"/tandemlift/{name}")
        self.until(client.service_is_ready, name)
        future = client.call_async(kind.Request(**fields))
        self.until(future.done, name)
        self.node.destroy_client(client)
        return future.result()

    def place(self):
        return self.heard["odometry"][-1].pose.pose.position.x

    def pushed(self, frame, force, until):
        """Push until something is true; how far the vehicle went."""
        before, message = self.place(), WrenchStamped()
        message.header.frame_id, message.wrench.force.x = frame, force

        def pushing():
            self.push.publish(message)
            return until(self.place() - before)

        self.until(pushing, f"the effect of a push on {frame}")
        return self.place() - before

    def set(self, *values, kind=SetParameters):
        made = [Parameter(key, value=value).to_parameter_msg() for key, value in values]
        if kind is SetParameters:
            results = self.call("set_parameters", kind, parameters=made).results
        else:
            results = [self.call("set_parameters_atomically", kind, parameters=made).result]
        return [[one.successful, one.reason] for one in results]

    def values(self, *names):
        found = self.call("get_parameters", GetParameters, names=list(names)).values
        return [list(v.double_array_value) if v.type == 8 else v.double_value if v.type == 3 else v.type for v in found]

    def answered(self, text):
        seen = len(self.heard["answer"])
        self.request.publish(String(data=text))
        self.until(lambda: len(self.heard["answer"]) > seen, f"the answer to {text}")
        return self.heard["answer"][-1].data

    def told(self):
        return [s.message for m in self.heard["/diagnostics"] for s in m.status if s.name == "tandemlift: pilot"]


def facts_of(d):
    """What a descriptor says of a parameter."""
    ranges = [[r.from_value, r.to_value] for r in d.floating_point_range]
    return [d.name, d.description, d.additional_constraints, ranges]


def by_rclpy(peer):
    yield "names", peer.node.get_node_names()
    yield "lift", [(r := peer.call("lift", Trigger)).success, r.message]
    described = peer.call("describe_parameters", DescribeParameters, names=["admittance.mass", "person.max_force"])
    yield "described", [facts_of(d) for d in described.descriptors]
    mass = "admittance.mass"
    yield "started", peer.values("admittance.threshold")
    yield "set", peer.set((mass, 4))
    peer.until(lambda: peer.values(mass) == [[4.0, 4.0, 4.0]], "the mass as a mission has it")
    for name, value in (
        ("word", "heavy"),
        ("pair", [1.0, 2.0]),
        ("far", 1e9),
        ("truth", True),
        ("words", ["a", "b", "c"]),
        ("nothing", None),
    ):
        yield name, peer.set((mass, value))
    yield "unknown", peer.set(("admittance.mas", 2.0))
    yield "own", peer.set(("use_sim_time", False))
    yield "atomic", peer.set((mass, 2.0), ("admittance.damping", -1.0), kind=SetParametersAtomically)
    peer.until(lambda: peer.values(mass) == [[4.0, 4.0, 4.0]], "the mass as it was")
    yield "land", [(r := peer.call("land", Trigger)).success, r.message]


def by_dds(peer):
    yield "lift", peer.answered("lift")
    yield "dance", peer.answered("dance")
    peer.parameter.publish(KeyValue(key="admittance.mass", value="4"))
    told = peer.heard["mission"]
    peer.until(lambda: "mass=[4.0,4.0,4.0" in "".join(told[-1].data.split()), "the mass")
    yield "land", peer.answered("land")


def main(node):
    peer = Peer()
    peer.until(lambda: all(peer.heard[name] for name in (*KINDS, *LATCHED)), "a message of each topic")
    peer.heard["odometry"].clear()
    peer.until(lambda: len(peer.heard["odometry"]) >= COUNT, "odometry")
    rows = [
        [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec, m.pose.pose.position.x, m.pose.pose.position.z]
        for m in peer.heard["odometry"][:COUNT]
    ]
    seen = {
        "version": rclpy.get_rmw_implementation_identifier(),
        "odometry": rows,
        "clock": peer.node.get_clock().now().nanoseconds - rows[-1][0],
        "robot": peer.heard["robot_description"][-1].data,
        "pushed": peer.pushed("base_world", 1.5, lambda way: way > 0.1),
        "nowhere": peer.pushed("mars", 1.5, lambda _: any("mars" in said for said in peer.told())),
        **dict((by_rclpy if node == "rclpy" else by_dds)(peer)),
        "told": peer.told(),
    }
    print(json.dumps(seen))
    peer.node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main(*sys.argv[1:])
