"""Optimised machine code, made in a separate process, because LLVM compiles one module at a time in a process.

`python -m tandemlift.compiler.machine_code.optimising LEVEL KEY CHECKSUM` reads a module as text, stores its object
code on disk and prints it. The process ends by itself, at most a few seconds after the one that started it.
"""

from __future__ import annotations

import atexit
import contextlib
import hashlib
import os
import subprocess
import sys

from tandemlift.compiler.machine_code import store
from tandemlift.compiler.machine_code.machine import Level, compiled

NICENESS = 10  # of the process, so that flights have priority
RUNNING: set[subprocess.Popen[bytes]] = set()


def optimise_in_process(text: str, level: Level, key: str) -> bytes | None:
    """The optimised object code of a module, also stored under the key; None if it cannot be made."""
    data, pipe = text.encode(), subprocess.PIPE
    given = [*[str(int(part)) for part in level], key, hashlib.sha256(data).hexdigest()]
    command = [sys.executable, "-m", "tandemlift.compiler.machine_code.optimising", *given]
    try:
        process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, start_new_session=True)
    except OSError:
        return None
    RUNNING.add(process)
    code, _ = process.communicate(data)
    RUNNING.discard(process)
    return code if process.returncode == 0 and code else None


@atexit.register
def detach() -> None:
    """Do not wait for running processes: they finish and store their code for the next process."""
    for process in list(RUNNING):
        process.returncode = 0


def main(passes: str, code: str, vectors: str, key: str, checksum: str) -> None:
    """Read a module from standard input, store its object code, and write it to standard output."""
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    data = sys.stdin.buffer.read()
    if hashlib.sha256(data).hexdigest() != checksum:
        sys.exit("the module is incomplete: the process that wrote it has ended")
    made = compiled(data.decode(), Level(int(passes), int(code), bool(int(vectors))))
    if quick := store.read(f"{key}-quick"):
        store.write(f"{key}-best", store.StoredCode(quick.about, made))
        store.remove(f"{key}-text")
    with contextlib.suppress(BrokenPipeError):
        sys.stdout.buffer.write(made)
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
