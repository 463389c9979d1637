"""A slow compiler.

As a program: `tandemlift`, whose compiler waits until the file named by COMPILES_UNTIL exists.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

from tandemlift.__main__ import main
from tandemlift.compiler.machine_code import machine

quick = machine.compiled


def compiled(text: str, level: machine.Level = machine.BEST) -> bytes:
    """The object code of a module, once the file exists."""
    while not Path(os.environ["COMPILES_UNTIL"]).exists():
        time.sleep(0.01)
    return quick(text, level)


def make_slow() -> None:
    """Use this compiler in this process."""
    machine.compiled = compiled


if __name__ == "__main__":
    make_slow()
    if "live" in sys.argv:
        from patient_server import make_patient

        make_patient()
    main()
