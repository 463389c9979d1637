"""A ROS message as a flat table of its numbers and texts; and, run as a program, a ROS 1 bag read by ROS's own reader.

Run by the Python of ROS, so without our packages and NumPy.
"""

import json
import sys


def flat(message, path=""):
    """Leaves of a message by their path, such as pose.position.x and transforms.0.child_frame_id; times in ns."""
    names = getattr(message, "__slots__", None)
    if {"secs", "nsecs"} <= set(names or ()):
        return {path: message.secs * 10**9 + message.nsecs}
    if set(names or ()) == {"sec", "nanosec"}:
        return {path: message.sec * 10**9 + message.nanosec}
    if names is not None:
        parts = [(name.lstrip("_"), getattr(message, name)) for name in names]
    elif isinstance(message, list | tuple):
        parts = list(enumerate(message))
    else:
        return {path: message}
    return {k: v for name, part in parts for k, v in flat(part, f"{path}.{name}".lstrip(".")).items()}


def main(bag):
    """Print a line for each message: topic, type, time [ns], leaves."""
    import rosbag

    with rosbag.Bag(bag) as opened:
        for topic, message, time in opened.read_messages():
            sys.stdout.write(json.dumps([topic, message._type, time.to_nsec(), flat(message)]) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
