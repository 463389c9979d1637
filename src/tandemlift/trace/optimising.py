"""Optimised machine code, made in a process of its own: LLVM works on one module at a time in a process.

`python -m tandemlift.trace.optimising LEVEL` reads a module as text, and writes its object code.
"""

from __future__ import annotations

import atexit
import os
import subprocess
import sys

from tandemlift.trace.machine import Level, compiled

COURTESY = 10  # of the process: it leaves the processor to those that fly
RUNNING: set[subprocess.Popen[bytes]] = set()


def optimised_beside(text: str, level: Level) -> bytes | None:
    """The object code of a module, optimised so far; None if it cannot be made."""
    command = [sys.executable, "-m", "tandemlift.trace.optimising", *[str(int(part)) for part in level]]
    pipe = subprocess.PIPE
    try:
        process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, start_new_session=True)
    except OSError:
        return None
    RUNNING.add(process)
    code, _ = process.communicate(text.encode())
    RUNNING.discard(process)
    return code if process.returncode == 0 and code else None


@atexit.register
def end() -> None:
    """Let no process outlive this one."""
    for process in list(RUNNING):
        process.kill()
        process.wait()


def main(passes: str, code: str, vectors: str) -> None:
    """Read a module from standard input, write object code to standard output."""
    if hasattr(os, "nice"):
        os.nice(COURTESY)
    level = Level(int(passes), int(code), bool(int(vectors)))
    sys.stdout.buffer.write(compiled(sys.stdin.buffer.read().decode(), level))


if __name__ == "__main__":
    main(*sys.argv[1:])
