"""The classes of ROS 2's messages for DDS, made from the definitions in `rosbags` on first use, and their writers.

On the wire a type `nav_msgs/Odometry` is called `nav_msgs::msg::dds_::Odometry_`. Fields that are not given are zero.
"""

from __future__ import annotations

import ctypes
import dataclasses
import functools
import importlib.util
from collections.abc import Callable
from typing import Any

from tandemlift.apps.export.messages import modern

PACKAGES = ("cyclonedds", "rosbags")
NUMBERS = {"byte": "uint8", "char": "uint8"}  # what IDL calls otherwise
PYTHON = {"bool": bool, "string": str}
SINGLE, NESTED, ARRAY, SEQUENCE = 1, 2, 3, 4  # kinds of fields, as `rosbags.interfaces.Nodetype` numbers them
Default = Callable[[], Any]


def missing_packages() -> list[str]:
    """The packages of the extra `ros2` that are not installed; nothing is imported."""
    return [name for name in PACKAGES if importlib.util.find_spec(name) is None]


class DdsTypes:
    """The classes of ROS 2's messages, by their names in ROS 1."""

    def __init__(self) -> None:
        from cyclonedds import idl
        from rosbags.typesys import Stores, get_typestore

        self._idl = idl
        self._definitions = get_typestore(Stores.ROS2_HUMBLE).fielddefs
        self._class_of = functools.cache(self._make)  # one class for each name, as Cyclone DDS compares them

    def __call__(self, name: str) -> type:
        """The class of a type, such as `nav_msgs/Odometry`."""
        return self._class_of(modern(name))

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


class _Descriptor(ctypes.Structure):
    """The beginning of Cyclone DDS's `dds_topic_descriptor`."""

    _fields_ = (("size", ctypes.c_uint32), ("alignment", ctypes.c_uint32), ("flags", ctypes.c_uint32))


class _Bytes(ctypes.Structure):
    """An `iovec`."""

    _fields_ = (("start", ctypes.c_char_p), ("size", ctypes.c_size_t))


DESCRIBED = 1 << 6  # DDS_TOPIC_XTYPES_METADATA, the flag of a topic that announces its type information
LOCAL, DATA = 1, 2  # DDS_FIND_SCOPE_LOCAL_DOMAIN; SDK_DATA, a sample with all its fields


class UntypedWriter:
    """A writer that announces the name of its type, and no type information.

    Two endpoints of DDS match by type information if both have it, else by name. For a type with an array or a sequence
    that of ROS 2 Kilted and that of Cyclone DDS differ: Kilted's leaves out what becomes of an element that cannot be
    constructed (the flags TRY_CONSTRUCT of XTypes 1.3), without which Cyclone DDS calls it invalid.

    Args:
        participant: of Cyclone DDS.
        name: of the topic on the wire.
        kind: class of its messages.
        qos: of the writer.
    """

    def __init__(self, participant: Any, name: str, kind: Any, qos: Any) -> None:
        from cyclonedds.core import Entity
        from cyclonedds.internal import DDS
        from cyclonedds.pub import DataWriter
        from cyclonedds.topic import Topic

        self._library, domain, typed = DDS._dll_handle, participant._ref, Topic(participant, name, kind)
        self._library.ddsi_serdata_from_ser_iov.restype = ctypes.c_void_p
        info, descriptor, self._type = ctypes.c_void_p(), ctypes.POINTER(_Descriptor)(), ctypes.c_void_p()
        self._call("dds_get_typeinfo", typed._ref, ctypes.byref(info))
        self._call("dds_create_topic_descriptor", LOCAL, domain, info, ctypes.c_int64(0), ctypes.byref(descriptor))
        descriptor.contents.flags &= ~DESCRIBED
        topic = object.__new__(Topic)
        Entity.__init__(topic, self._call("dds_create_topic", domain, descriptor, name.encode(), None, None))
        topic.data_type, topic._keepalive_entities = kind, [participant]
        self._call("dds_delete_topic_descriptor", descriptor)
        self._library.dds_free_typeinfo(info)
        self._writer = DataWriter(participant, topic, qos)
        self._call("dds_get_entity_sertype", self._writer._ref, ctypes.byref(self._type))

    def _call(self, name: str, *arguments: Any) -> int:
        """Call a function of the library; what it returns.

        Raises:
            DDSException: that is an error.
        """
        from cyclonedds.core import DDSException

        code = getattr(self._library, name)(*arguments)
        if code < 0:
            raise DDSException(code, name)
        return int(code)

    def subscribers(self) -> int:
        """The number of matched readers."""
        return len(self._writer.get_matched_subscriptions())

    def write(self, message: Any) -> None:
        """Publish a message; it is dropped if subscribers are too slow."""
        from cyclonedds.core import DDSException

        data = encoded(message)
        sample = self._library.ddsi_serdata_from_ser_iov(
            self._type, DATA, ctypes.c_size_t(1), ctypes.byref(_Bytes(data, len(data))), ctypes.c_size_t(len(data))
        )
        try:
            self._call("dds_writecdr", self._writer._ref, ctypes.c_void_p(sample))
        except DDSException as error:
            if error.code != DDSException.DDS_RETCODE_TIMEOUT:
                raise


def encoded(message: Any) -> bytes:
    """A message in XCDR1, in whole words."""
    data = bytes(message.serialize(use_version_2=False))
    return data.ljust(-len(data) // 4 * -4, b"\0")
