"""The classes of ROS 2's messages for DDS, made from the definitions in `rosbags` on first use.

On the wire a type `nav_msgs/Odometry` is called `nav_msgs::msg::dds_::Odometry_`. Fields that are not given are zero.
"""

from __future__ import annotations

import dataclasses
import importlib.util
from collections.abc import Callable
from typing import Any

from tandemlift.apps.export.messages import modern
from tandemlift.core.errors import extra

PACKAGES = ("cyclonedds", "rosbags")
NUMBERS = {"byte": "uint8", "char": "uint8"}  # what IDL calls otherwise
PYTHON = {"bool": bool, "string": str}
SINGLE, NESTED, ARRAY, SEQUENCE = 1, 2, 3, 4  # kinds of fields, as `rosbags.interfaces.Nodetype` numbers them
Default = Callable[[], Any]


def missing_packages() -> list[str]:
    """The packages of the extra `ros2` that are not installed; nothing is imported."""
    return [name for name in PACKAGES if importlib.util.find_spec(name) is None]


def check_installed() -> None:
    """Check that the extra `ros2` is installed.

    Raises:
        InputError: a package is missing.
    """
    with extra("ros2", "ROS 2"):
        import cyclonedds  # noqa: F401
        import rosbags  # noqa: F401


class DdsTypes:
    """The classes of ROS 2's messages, by their names in ROS 1."""

    def __init__(self) -> None:
        from cyclonedds import idl
        from rosbags.typesys import Stores, get_typestore

        self._idl = idl
        self._definitions = get_typestore(Stores.ROS2_HUMBLE).fielddefs
        self._made: dict[str, Any] = {}

    def __call__(self, name: str) -> type:
        """The class of a type, such as `nav_msgs/Odometry`."""
        return self._class_of(modern(name))

    def _class_of(self, name: str) -> type:
        if name not in self._made:
            self._made[name] = self._make(name)
        return self._made[name]

    def _make(self, name: str) -> type:
        package, _, kind = name.split("/")
        fields = {field: self._field(about) for field, about in self._definitions[name][1]}
        hints = {field: hint for field, (hint, _) in fields.items()}
        made = self._idl.make_idl_struct(kind, f"{package}.msg.dds_.{kind}_", hints, dataclassify=False)
        for field, (_, default) in fields.items():
            setattr(made, field, dataclasses.field(default_factory=default))
        return dataclasses.dataclass(made)

    def _field(self, about: Any) -> tuple[Any, Default]:
        """The type of a field, and the factory of its default."""
        kind, what = int(about[0]), about[1]
        if kind == SINGLE:
            python = PYTHON.get(what[0])
            return python or getattr(self._idl.types, NUMBERS.get(what[0], what[0])), python or _number(what[0])
        if kind == NESTED:
            nested = self._class_of(what)
            return nested, nested
        hint, default = self._field(what[0])
        if kind == ARRAY:
            count = what[1]
            return self._idl.types.array[hint, count], lambda: [default() for _ in range(count)]
        return self._idl.types.sequence[hint], list


def _number(name: str) -> Default:
    return float if name.startswith("float") else int
