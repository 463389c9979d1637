"""This process as a node of ROS 1, and the ROS master that it has: one of its own, where Gazebo is, or one that runs.

A process is one node and has one master, for as long as it lives. If it dies without a word, its own master ends too.

Environment: `TANDEMLIFT_GAZEBO_ROS=master` joins the master at `ROS_MASTER_URI`; see also `gazebo_ros`.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import os
import shutil
import socket
import subprocess
import tempfile
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from tandemlift.common.errors import InputError
from tandemlift.engines.gazebo_server import command, exported, free_port, root
from tandemlift.engines.rospy import import_rospy

JOIN = "TANDEMLIFT_GAZEBO_ROS"
URI, IP, HOST = "ROS_MASTER_URI", "ROS_IP", "ROS_HOSTNAME"
LOGS, LOGGING = "ROS_LOG_DIR", "ROS_PYTHON_LOG_CONFIG_FILE"
NODE = "tandemlift_pilot"
STARTING = 30.0  # s, after which a master that does not answer is given up
SCRIPT = "rosmaster --core -p {port} & read -r end; kill $!; wait"  # ends with the pipe that it reads


def joined() -> str:
    """What is to be joined: nothing (empty), the `master` that runs, or the `world` in Gazebo at that master.

    Raises:
        InputError: it is something else.
    """
    given = os.environ.get(JOIN, "")
    if given not in ("", "master", "world"):
        raise InputError(f"{JOIN} = {given}: must be 'master' or 'world'")
    return given


@functools.cache
def node() -> ModuleType:
    """The package rospy, with this process a node.

    Raises:
        InputError: there is no rospy, or no master.
    """
    rospy = import_rospy()
    if rospy.core.is_initialized():  # whoever uses tandemlift has made it one
        return rospy
    if joined():
        _check_master()
    else:
        os.environ.update({URI: RosMaster().uri, IP: "127.0.0.1"})
    with warnings.catch_warnings(), _quiet():
        warnings.simplefilter("ignore")
        rospy.init_node(NODE, anonymous=True, disable_signals=True, disable_rosout=True)
    atexit.register(rospy.signal_shutdown, "the process ends")
    return rospy


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Let a node begin without a log of its own, for which it would set the logging of the whole process."""
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder, "as_it_is.yaml")
        config.write_text("version: 1\nincremental: true\n", "utf-8")
        before = {name: os.environ.get(name) for name in (LOGS, LOGGING)}
        os.environ.update({LOGS: folder, LOGGING: str(config)})
        try:
            yield
        finally:
            for name, value in before.items():
                os.environ.pop(name)
                if value is not None:
                    os.environ[name] = value


def environment() -> dict[str, str]:
    """The variables by which another process finds the master of this node."""
    import rosgraph

    return {URI: rosgraph.get_master_uri()} | {name: os.environ[name] for name in (IP, HOST) if name in os.environ}


def _check_master() -> None:
    import rosgraph

    uri = os.environ.setdefault(URI, "http://localhost:11311")
    if not rosgraph.is_master_online():
        raise InputError(f"engine 'gazebo-ros': {JOIN} is set, and no ROS master runs at {URI} = {uri}")


class RosMaster:
    """A ROS master of our own, on a free port.

    Attributes:
        uri: its address.

    Raises:
        InputError: there is none to start.
    """

    def __init__(self) -> None:
        port, inside = free_port(socket.SOCK_STREAM), root()
        self.uri = f"http://127.0.0.1:{port}"
        if not ((inside / "usr/bin/rosmaster").exists() if inside else shutil.which("rosmaster")):
            raise InputError(
                "engine 'gazebo-ros' needs ROS 1 beside Gazebo: on Debian apt-get install python3-roslaunch; "
                "a root is brought up to date by running tools/gazebo-root again (docs/gazebo.md)"
            )
        self._folder = tempfile.mkdtemp(prefix="tandemlift-", dir=inside / "tmp" if inside else None)
        logs = f"/tmp/{Path(self._folder).name}" if inside else self._folder
        script = exported({IP: "127.0.0.1", URI: self.uri, LOGS: logs}) + SCRIPT.format(port=port)
        self._process = subprocess.Popen(
            command(inside, script),
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        atexit.register(self.close)
        self._wait(port)

    def _wait(self, port: int) -> None:
        """Until somebody answers at the port."""
        deadline = time.monotonic() + STARTING
        while time.monotonic() < deadline and self._process.poll() is None:
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port)):
                return
            time.sleep(0.05)
        self.close()
        raise InputError("engine 'gazebo-ros': the ROS master did not start (rosmaster --core)")

    def close(self) -> None:
        """End it."""
        if self._process.stdin:
            self._process.stdin.close()
        self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)
