"""Optimised machine code, made in a process of its own: LLVM works on one module at a time in a process.

`python -m tandemlift.trace.optimising LEVEL KEY CHECKSUM` reads a module as text, keeps its object code on disk and
writes it. Such a process ends by itself, a few seconds after the one that began it at the latest.
"""

from __future__ import annotations

import atexit
import contextlib
import hashlib
import os
import subprocess
import sys

from tandemlift.trace import store
from tandemlift.trace.machine import Level, compiled

COURTESY = 10  # of the process: it leaves the processor to those that fly
RUNNING: set[subprocess.Popen[bytes]] = set()


def optimised_beside(text: str, level: Level, key: str) -> bytes | None:
    """The object code of a module, optimised so far, which is kept under a key; None if it cannot be made."""
    data, pipe = text.encode(), subprocess.PIPE
    given = [*[str(int(part)) for part in level], key, hashlib.sha256(data).hexdigest()]
    command = [sys.executable, "-m", "tandemlift.trace.optimising", *given]
    try:
        process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, start_new_session=True)
    except OSError:
        return None
    RUNNING.add(process)
    code, _ = process.communicate(data)
    RUNNING.discard(process)
    return code if process.returncode == 0 and code else None


@atexit.register
def leave() -> None:
    """Let what is being made be finished for the next process, and wait for nothing."""
    for process in list(RUNNING):
        process.returncode = 0


def main(passes: str, code: str, vectors: str, key: str, checksum: str) -> None:
    """Read a module from standard input; keep its object code, and write it to standard output."""
    if hasattr(os, "nice"):
        os.nice(COURTESY)
    data = sys.stdin.buffer.read()
    if hashlib.sha256(data).hexdigest() != checksum:
        sys.exit("the module is cut short: who wrote it has ended")
    made = compiled(data.decode(), Level(int(passes), int(code), bool(int(vectors))))
    if quick := store.read(f"{key}-quick"):
        store.write(f"{key}-best", store.StoredCode(quick.about, made))
        store.remove(f"{key}-text")
    with contextlib.suppress(BrokenPipeError):
        sys.stdout.buffer.write(made)
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
