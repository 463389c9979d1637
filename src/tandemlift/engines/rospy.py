"""ROS 1 in this process: rospy, its Python client, wherever this machine has it, and the process as a node.

Debian installs rospy for its own interpreter, whose packages a virtual environment does not see. It is plain Python, so
its folder is appended to the path, where it hides nothing.

A process is one node with one master for its whole life: one started for it, or one that runs already. If it dies, the
master that it started ends too. Environment: `TANDEMLIFT_GAZEBO_ROS=master` joins the master at `ROS_MASTER_URI`; see
also `gazebo_ros`.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import importlib
import importlib.util
import logging
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from tandemlift.core.errors import InputError
from tandemlift.engines.gazebo_server import export_lines, free_port, root, shell_command

ROOT = "/tandemlift/gazebo"  # of the topics of Gazebo's plugin
PLACES = (ROOT, *(f"{ROOT}_{k}" for k in range(2, 100)))  # of several servers of this process
FOLDERS = ("/usr/lib/python3/dist-packages", "/opt/ros/noetic/lib/python3/dist-packages")  # Debian, Ubuntu 20.04
JOIN = "TANDEMLIFT_GAZEBO_ROS"
URI, IP, HOST = "ROS_MASTER_URI", "ROS_IP", "ROS_HOSTNAME"
LOGS, LOGGING = "ROS_LOG_DIR", "ROS_PYTHON_LOG_CONFIG_FILE"
NODE = "tandemlift_pilot"
START_TIMEOUT = 30.0  # s, after which a master that does not answer is given up
SCRIPT = "rosmaster --core -p {port} & read -r end; kill $!; wait"  # ends when its pipe is closed


def has_rospy() -> bool:
    """Whether this machine has rospy, of any version; nothing is imported."""
    return importlib.util.find_spec("rospy") is not None or bool(_system_folders())


def _system_folders() -> list[str]:
    return [folder for folder in FOLDERS if (Path(folder) / "rospy").is_dir()]


def import_rospy() -> ModuleType:
    """The package rospy, of any version; its messages can be imported from then on.

    Raises:
        InputError: rospy is not installed; the text names the package.
    """
    _mend_threads()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of deprecated features in ROS itself
        rospy = _import("rospy", _system_folders())
        _mend_logging()
    return rospy


def message_type(name: str) -> type:
    """The class of a message or service of ROS 1, by its name, such as `geometry_msgs/WrenchStamped`.

    Raises:
        InputError: its package is not installed.
    """
    package, _, kind = name.partition("/")
    _import(package, [])
    for part in ("msg", "srv"):
        if importlib.util.find_spec(f"{package}.{part}"):
            found = getattr(_import(f"{package}.{part}", []), kind, None)
            if found is not None:
                return found
    raise InputError(f"{package} has no {kind}")


def _import(name: str, more: list[str]) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        absent = error.name
    if absent == name.partition(".")[0] and more:
        sys.path += [folder for folder in more if folder not in sys.path]
        return _import(name, [])
    debian = f"python3-{str(absent).replace('_', '-')}"
    raise InputError(
        f"ROS 1 needs the Python package {absent!r}, which is not to be found: on Debian apt-get install {debian}; "
        "elsewhere set PYTHONPATH to the folder that has it"
    )


def _mend_logging() -> None:
    """Replace the caller look-up of rospy's loggers by Python's: that of 1.15.9 never returns in Python 3.11."""
    loggers = getattr(_import("rosgraph.roslogging", []), "RospyLogger", None)
    if loggers is not None:
        loggers.findCaller = logging.Logger.findCaller


def _mend_threads() -> None:
    """Restore `Thread.isAlive`, which rospy 1.15.9 calls and Python 3.9 has removed."""
    if not hasattr(threading.Thread, "isAlive"):
        threading.Thread.isAlive = threading.Thread.is_alive  # type: ignore[attr-defined]


# ---- The process as a node


def joined() -> str:
    """The environment's choice of what to join: nothing (''), a running `master`, or also the `world` in Gazebo there.

    Raises:
        InputError: the variable has another value.
    """
    given = os.environ.get(JOIN, "")
    if given not in ("", "master", "world"):
        raise InputError(f"{JOIN} = {given}: must be 'master' or 'world'")
    return given


@functools.cache
def node() -> ModuleType:
    """The package rospy, after this process has become a node.

    Raises:
        InputError: there is no rospy, or no master.
    """
    rospy = import_rospy()
    if rospy.core.is_initialized():  # the caller of tandemlift has done so
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
    """Keep a new node from configuring the logging of the whole process."""
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


def ros_environment() -> dict[str, str]:
    """The environment variables with which another process finds the master of this node."""
    import rosgraph

    return {URI: rosgraph.get_master_uri()} | {name: os.environ[name] for name in (IP, HOST) if name in os.environ}


def _check_master() -> None:
    import rosgraph

    uri = os.environ.setdefault(URI, "http://localhost:11311")
    if not rosgraph.is_master_online():
        raise InputError(f"engine 'gazebo-ros': {JOIN} is set, and no ROS master runs at {URI} = {uri}")


class RosMaster:
    """A ROS master started for this process, on a free port.

    Attributes:
        uri: its address.

    Raises:
        InputError: ROS 1 is not installed.
    """

    def __init__(self) -> None:
        port, inside = free_port(socket.SOCK_STREAM), root()
        self.uri = f"http://127.0.0.1:{port}"
        if not ((inside / "usr/bin/rosmaster").exists() if inside else shutil.which("rosmaster")):
            raise InputError(
                "engine 'gazebo-ros' needs ROS 1 beside Gazebo: on Debian apt-get install python3-roslaunch; "
                "a root is brought up to date by running tools/gazebo-root again (docs/how-to/gazebo.md)"
            )
        self._folder = tempfile.mkdtemp(prefix="tandemlift-", dir=inside / "tmp" if inside else None)
        logs = f"/tmp/{Path(self._folder).name}" if inside else self._folder
        script = export_lines({IP: "127.0.0.1", URI: self.uri, LOGS: logs}) + SCRIPT.format(port=port)
        self._process = subprocess.Popen(
            shell_command(inside, script),
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        atexit.register(self.close)
        self._wait(port)

    def _wait(self, port: int) -> None:
        """Wait until the master answers at the port."""
        deadline = time.monotonic() + START_TIMEOUT
        while time.monotonic() < deadline and self._process.poll() is None:
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port)):
                return
            time.sleep(0.05)
        self.close()
        raise InputError("engine 'gazebo-ros': the ROS master did not start (rosmaster --core)")

    def close(self) -> None:
        """End the master."""
        if self._process.stdin:
            self._process.stdin.close()
        self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)
