"""A ROS 2 bag that is written while its messages come: a folder with an MCAP file, as `ros2 bag record` makes it.

Chunks of a mebibyte (Zstandard) are written as they fill. A bag that was not closed lacks its index and the last chunk.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tandemlift.apps.export.messages import modern
from tandemlift.apps.export.write import qos_of
from tandemlift.core.errors import InputError, extra

HEAD = 4  # bytes that say how a message is encoded


class LiveBag:
    """A bag to write to, from any thread; a context, which closes it.

    Args:
        folder: of the bag; it must not exist.

    Raises:
        InputError: it exists or cannot be made, or a package is missing.
    """

    def __init__(self, folder: Path) -> None:
        with extra("export", "--bag"):
            from rosbags import typesys
            from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer, WriterError
        self._store, self._turn = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE), threading.Lock()
        try:
            self._bag = Writer(folder, version=8, storage_plugin=StoragePlugin.MCAP)
            self._bag.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
            self._bag.open()
        except (OSError, WriterError) as error:
            raise InputError(f"--bag {folder}: {getattr(error, 'strerror', None) or error}") from None
        self._open = True

    def __enter__(self) -> LiveBag:
        return self

    def __exit__(self, *_: object) -> None:
        with self._turn:
            self._open = False
            self._bag.close()

    def topic(self, name: str, kind: str, *, latched: bool) -> Callable[[Any, bytes], None]:
        """Add a topic, with its type as ROS 1 calls it; return what writes a message that has come now, and its CDR.

        The CDR may be too long: rclpy has some bytes of no meaning at the end, which readers of bags refuse.
        """
        qos, store = qos_of(latched), self._store
        size = store.get_msgdef(modern(kind)).getsize_cdr
        with self._turn:
            made = self._bag.add_connection(name, modern(kind), typestore=store, offered_qos_profiles=qos)

        def write(message: Any, encoded: bytes) -> None:
            with self._turn:
                if self._open:  # a middleware's thread may still have one
                    self._bag.write(made, time.time_ns(), encoded[: HEAD + size(0, message, store)])

        return write
