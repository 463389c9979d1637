"""Which ROS a node speaks: the one that is asked for, else the one that this machine has."""

from __future__ import annotations

from collections.abc import Sequence

from tandemlift.apps.ros.dds_types import missing_packages
from tandemlift.apps.ros.middleware import Middleware
from tandemlift.core.errors import InputError, install_command
from tandemlift.engines.rospy import has_rospy

VERSIONS = ("1", "2")


def version_for(asked: str | None) -> str:
    """The version of ROS to speak: 1 if there is rospy, else 2 if there is its DDS, unless one is asked for.

    Args:
        asked: one of `VERSIONS`, or None to take what is there.

    Raises:
        InputError: none is asked for, and there is neither; the text says what to install.
    """
    if asked is not None:
        return asked
    if has_rospy():
        return "1"
    if not missing_packages():
        return "2"
    raise InputError(
        f"no ROS is found. For ROS 2, which needs no installed ROS: {install_command('ros2')}; "
        "for ROS 1, on Debian: apt-get install python3-rospy"
    )


def middleware_for(version: str, arguments: Sequence[str], *, asked: bool) -> Middleware:
    """Connect to a ROS.

    Args:
        version: one of `VERSIONS`.
        arguments: remappings NAME:=VALUE of ROS 1, as roslaunch gives them.
        asked: whether a person asked for this version; if not, the error names the other where there is one.

    Raises:
        InputError: what it needs is not installed, or does not run.
    """
    if version == "2":
        from tandemlift.apps.ros.ros2 import Ros2

        return Ros2()
    from tandemlift.apps.ros.ros1 import Ros1

    try:
        return Ros1(arguments)
    except InputError as error:
        if asked or missing_packages():
            raise
        raise InputError(f"{error}; or fly in ROS 2: --version 2") from None
