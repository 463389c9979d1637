"""A second process that draws pictures of an animation while the first one draws others, with the same bytes.

Drawing takes longer than flying and encoding, and the drawing library uses little more than one processor. `python -m`
this file is that process: it makes the animation that standard input describes, reads the number of a picture a line,
and answers with its bytes. Whoever is free takes the next picture; one that the process cannot draw is drawn here.
"""

from __future__ import annotations

import math
import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from threading import Condition, Thread
from typing import IO, Protocol

from PIL import Image

MIN_PICTURES = 40  # pictures from which on a second process saves time: it needs that of twenty to start
MAX_LEAD = 12  # pictures that it may be ahead of the one that is shown


class Pictures(Protocol):
    """The pictures of an animation, of one size [pixels]."""

    size: tuple[int, int]

    def __len__(self) -> int: ...

    def picture(self, index: int) -> Image.Image:
        """Draw one picture."""
        ...


class _Shared:
    """Which pictures are taken by one of the processes, and those that are drawn and wait to be shown."""

    def __init__(self, count: int) -> None:
        self._count, self._next, self._shown = count, 0, 0
        self._change, self._drawn = Condition(), dict[int, Image.Image | None]()

    def take(self, ahead: float = math.inf) -> int | None:
        """Take the next picture, once it is at most so far ahead of the shown one; None if all are taken."""
        with self._change:
            self._change.wait_for(lambda: self._next < self._shown + ahead or self._next >= self._count)
            index, self._next = self._next, self._next + 1
            return index if index < self._count else None

    def put(self, index: int, image: Image.Image | None) -> None:
        """Put down a picture; None if it could not be drawn."""
        with self._change:
            self._drawn[index] = image
            self._change.notify_all()

    def is_drawn(self, index: int) -> bool:
        """Whether a picture that is to be shown has been put down."""
        with self._change:
            self._shown = index
            self._change.notify_all()
            return index in self._drawn

    def wait(self, index: int) -> Image.Image | None:
        """Wait for a picture, and pick it up."""
        with self._change:
            self._change.wait_for(lambda: index in self._drawn)
            return self._drawn.pop(index)

    def end(self) -> None:
        """Let nobody take another one."""
        with self._change:
            self._next = self._count
            self._change.notify_all()


def drawn_by_two(pictures: Pictures, make: Callable[[], Pictures]) -> Iterator[Image.Image]:
    """All pictures in order, drawn here and by a second process if that saves time; `make`: how it makes them."""
    if len(pictures) < MIN_PICTURES or (os.cpu_count() or 1) < 2 or not sys.executable:
        yield from map(pictures.picture, range(len(pictures)))
        return
    shared, pipe = _Shared(len(pictures)), subprocess.PIPE
    command = [sys.executable, "-m", __name__]
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL) as process:
        assert process.stdin
        assert process.stdout
        other = Thread(target=_draw, args=(process.stdin, process.stdout, pickle.dumps(make), pictures.size, shared))
        other.start()
        try:
            for index in range(len(pictures)):
                while not shared.is_drawn(index) and (free := shared.take()) is not None:
                    shared.put(free, pictures.picture(free))
                yield shared.wait(index) or pictures.picture(index)
        finally:
            shared.end()
            process.kill()
            other.join()
            with suppress(OSError):  # a request that it did not read
                process.stdin.close()


def _draw(requests: IO[bytes], answers: IO[bytes], make: bytes, size: tuple[int, int], shared: _Shared) -> None:
    """Have the other process draw pictures until none is left, or it fails."""
    bytes_of_one = 3 * size[0] * size[1]
    with suppress(OSError, ValueError):  # it has ended: what it has read is lost
        requests.write(make)
    while (index := shared.take(MAX_LEAD)) is not None:
        drawn = b""
        with suppress(OSError, ValueError):
            requests.write(b"%d\n" % index)
            requests.flush()
            drawn = answers.read(bytes_of_one)
        whole = len(drawn) == bytes_of_one
        shared.put(index, Image.frombytes("RGB", size, drawn) if whole else None)
        if not whole:
            return


def main() -> None:
    """Draw the pictures whose numbers standard input gives, until it ends."""
    answers = sys.stdout.buffer
    sys.stdout = sys.stderr  # whatever else prints
    pictures: Pictures = pickle.load(sys.stdin.buffer)()
    for line in sys.stdin.buffer:
        answers.write(pictures.picture(int(line)).tobytes())
        answers.flush()


if __name__ == "__main__":
    main()
