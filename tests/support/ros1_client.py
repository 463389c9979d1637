"""A client of the node in ROS 1, run by the Python of rospy; it prints its results."""

import json
import sys
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from std_msgs.msg import String
from std_srvs.srv import Trigger

seen = {"events": [], "phases": []}
PATIENCE = 300.0  # s


def note(message):
    for status in message.status:
        seen["events" if status.name == "tandemlift: pilot" else "phases"].append(status.message)


def until(what):
    """Wait until a condition is true."""
    end = time.monotonic() + PATIENCE
    while not what():
        if time.monotonic() > end:
            sys.exit(f"nothing came of it; seen: {seen}")
        time.sleep(0.05)


def ask(what):
    rospy.wait_for_service(f"/tandemlift/{what}", PATIENCE)
    answer = rospy.ServiceProxy(f"/tandemlift/{what}", Trigger)()
    return [answer.success, answer.message]


def push(publisher, frame, force, seconds):
    message = WrenchStamped()
    message.header.frame_id = frame
    message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = force
    for _ in range(round(seconds / 0.05)):
        publisher.publish(message)
        time.sleep(0.05)


rospy.init_node("somebody")
rospy.Subscriber("/diagnostics", DiagnosticArray, note)
publisher = rospy.Publisher("/tandemlift/push", WrenchStamped, queue_size=10)
until(lambda: seen["phases"] and seen["phases"][-1] == "guided")
until(lambda: publisher.get_num_connections())


def place():
    return rospy.wait_for_message("/tandemlift/odometry", Odometry, PATIENCE).pose.pose.position.x


def moved():
    """The distance moved after pushing for some time; a flight on a busy machine is slow."""
    push(publisher, "base_world", (1.5, 0.0, 0.0), 1.5)
    return place() - here


here = place()
until(lambda: moved() > 0.1)
there = place()
push(publisher, "mars", (1.0, 0.0, 0.0), 0.1)
push(publisher, "world", (float("nan"), 0.0, 0.0), 0.1)
until(lambda: sum("push refused" in event for event in seen["events"]) == 2)
rospy.set_param("/tandemlift/admittance/mass", 4)
rospy.set_param("/tandemlift/admittance/threshold", "none")
until(lambda: rospy.get_param("/tandemlift/admittance/mass") == [4.0, 4.0, 4.0])
until(lambda: isinstance(rospy.get_param("/tandemlift/admittance/threshold"), list))
mission = rospy.wait_for_message("/tandemlift/mission", String, PATIENCE).data
asked = {what: ask(what) for what in ("lift", "tare", "land")}
until(lambda: seen["phases"][-1] == "idle")
print(json.dumps({"moved": there - here, "asked": asked, "mission": mission, **seen}))
