"""Import of rospy, the Python client of ROS 1, wherever this machine has it.

Debian installs it for its own interpreter, whose packages a virtual environment does not see. rospy is plain Python, so
its folder is appended to the path, where it hides nothing.
"""

from __future__ import annotations

import importlib
import importlib.util
import logging
import sys
import threading
import warnings
from pathlib import Path
from types import ModuleType

from tandemlift.core.errors import InputError

FOLDERS = ("/usr/lib/python3/dist-packages", "/opt/ros/noetic/lib/python3/dist-packages")  # Debian, Ubuntu 20.04


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
