"""The ROS front in real time: `python benchmarks/ros.py [--seconds 30] [--versions 1,2-dds]`, which prints Markdown.

Flies `zigzag` as `tandemlift ros` does, in ROS 1 beside a `rosmaster` of its own, in ROS 2 by DDS and, for version 2,
by rclpy; listens to one topic, and to all of them; and tells how many samples a second arrive, how many were lost, how
old they are then, and what the node takes of a processor. Needs Linux; for ROS 1 rospy, for ROS 2 by DDS the extra
`ros2`, and a Python with rclpy.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from machine import describe, heading, table
from waiting import PATIENCE, ended

TOPIC, KIND = "/tandemlift/odometry", "nav_msgs/Odometry"
SETTLE = 5.0  # s
TICKS = os.sysconf("SC_CLK_TCK")
NAMES = {"1": "ROS 1, rospy", "2": "ROS 2, rclpy", "2-dds": "ROS 2, DDS"}
PERIOD = 10_000_000  # ns, from one sample to the next


def processor_time(pid: int) -> float:
    """The processor time of a process until now [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text("ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


@contextlib.contextmanager
def running(*command: str, environment: Mapping[str, str], until: str = "") -> Iterator[subprocess.Popen[Any]]:
    """A process, once it has said something."""
    with tempfile.TemporaryFile() as log:
        process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, env=environment)
        try:
            end = time.monotonic() + PATIENCE
            while until.encode() not in os.pread(log.fileno(), 100_000, 0):
                if process.poll() is not None or time.monotonic() > end:
                    sys.exit(os.pread(log.fileno(), 100_000, 0).decode())
                time.sleep(0.1)
            yield process
        finally:
            ended(process, signal.SIGINT)


class Listener:
    """Notes when messages came, and how old they were."""

    def __init__(self) -> None:
        self.ages, self.stamps, self.others = list[float](), list[int](), 0

    def hear(self, message: Any) -> None:
        """A message with a stamp."""
        stamp = message.header.stamp
        sec, nanosec = (stamp.secs, stamp.nsecs) if hasattr(stamp, "secs") else (stamp.sec, stamp.nanosec)
        self.ages.append(time.time() - sec - nanosec * 1e-9)
        self.stamps.append(sec * 10**9 + nanosec)

    def hear_other(self, message: Any) -> None:
        """Any other."""
        self.others += 1


def listen(version: str, *, everything: bool) -> Listener:
    """Listen to odometry, or to every topic."""
    from tandemlift.apps.ros import rclpy_node, ros1, ros2

    makers = {"1": lambda: ros1.Ros1(["__name:=listener"]), "2": lambda: rclpy_node.RclpyNode(name="listener")}
    listener, middleware = Listener(), makers.get(version, ros2.Ros2)()
    middleware.subscribe(TOPIC, KIND, listener.hear)
    if everything:
        for name, kind in topics().items():
            middleware.subscribe(name, kind, listener.hear_other)
    return listener


def topics() -> dict[str, str]:
    """Every topic that has a message for each sample, but odometry."""
    from tandemlift.apps.export.topics import recipes_for
    from tandemlift.apps.live.session.session import Session
    from tandemlift.apps.ros.sample_queue import SampleBatch, as_flight
    from tandemlift.missions import load_mission
    from tandemlift.parts.mechanics.vehicle import Vehicle

    session = Session(load_mission("zigzag"))
    session.prepare()
    flight = as_flight(SampleBatch([0], [0], session.flight.sample[None]), session.flight, {})
    vehicle = Vehicle.from_settings(session.flight.now.vehicle)
    session.stop()
    return {r.name: r.kind for r in recipes_for(flight, vehicle) if r.name != TOPIC} | {"/tf": "tf2_msgs/TFMessage"}


def listening(version: str, everything: bool, seconds: float) -> dict[str, float]:
    """Listen in a process of its own: messages a second, and their ages [ms]."""
    listener = listen(version, everything=everything)
    time.sleep(SETTLE)
    first, others, began = len(listener.ages), listener.others, time.monotonic()
    time.sleep(seconds)
    span, ages, stamps = time.monotonic() - began, 1e3 * np.array(listener.ages[first:]), listener.stamps[first:]
    return {
        "rate": len(ages) / span,
        "lost": round((stamps[-1] - stamps[0]) / PERIOD) + 1 - len(stamps),
        "others": (listener.others - others) / span,
        "median": float(np.median(ages)),
        "most": float(np.quantile(ages, 0.99)),
    }


def measure(version: str, seconds: float, environment: Mapping[str, str]) -> Iterator[list[str]]:
    """A row for each way to listen."""
    node = [sys.executable, "-m", "tandemlift", "ros", "zigzag", "--version", version]
    for everything in (False, True):
        with running(*node, environment=environment, until="topics below") as flying:
            command = [sys.executable, __file__, "--listen", version, "--seconds", str(seconds)]
            before, began = processor_time(flying.pid), time.monotonic()
            told = subprocess.run(
                command + ["--all"] * everything,
                env=environment,
                stdout=subprocess.PIPE,
                check=True,
                text=True,
                timeout=seconds + PATIENCE,
            ).stdout
            share = (processor_time(flying.pid) - before) / (time.monotonic() - began)
        t = json.loads(told.splitlines()[-1])
        what = f"all topics, {t['rate'] + t['others']:.0f} messages/s" if everything else "odometry"
        yield [
            f"{NAMES[version]}: {what}",
            f"{t['rate']:.1f}",
            f"{t['lost']}",
            f"{t['median']:.1f}",
            f"{t['most']:.1f}",
            f"{100 * share:.0f} %",
        ]


@contextlib.contextmanager
def surroundings(version: str) -> Iterator[Mapping[str, str]]:
    """An environment with a master, or a domain, of its own."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port = one.getsockname()[1]
    if version != "1":
        yield os.environ | {"ROS_DOMAIN_ID": str(100 + port % 100)}
        return
    with tempfile.TemporaryDirectory() as folder:
        own = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "ROS_HOME": folder}
        bare = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
        with running("rosmaster", "--core", "-p", str(port), environment=bare | own):
            time.sleep(2.0)
            yield os.environ | own


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--versions", default="1,2-dds")
    parser.add_argument("--listen", help=argparse.SUPPRESS)
    parser.add_argument("--all", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.listen:
        print(json.dumps(listening(given.listen, given.all, given.seconds)))
        sys.stdout.flush()
        os._exit(0)
    machine, rows = describe(["tandemlift", "cyclonedds", "numpy"]), list[list[str]]()
    for version in given.versions.split(","):
        with surroundings(version) as environment:
            rows += measure(version, given.seconds, environment)
    print(heading(machine))
    print(f"\n`zigzag`, {given.seconds:g} s each.\n")
    print(table(["listening to", "odometry/s", "lost", "age [ms], median", "99 %", "node, of one core"], rows))


if __name__ == "__main__":
    main()
