"""A compiler that takes long.

As a program: `tandemlift`, whose compiler works on until there is a file of the name that COMPILES_UNTIL holds.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

from tandemlift.__main__ import main
from tandemlift.trace import machine

quick = machine.compiled


def compiled(text: str, level: machine.Level = machine.BEST) -> bytes:
    """The object code of a module, once it may be there."""
    while not Path(os.environ["COMPILES_UNTIL"]).exists():
        time.sleep(0.01)
    return quick(text, level)


def make_slow() -> None:
    """Let this process compile so."""
    machine.compiled = compiled


if __name__ == "__main__":
    make_slow()
    main()
