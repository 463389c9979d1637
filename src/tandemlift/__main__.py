"""`python -m tandemlift`, and `tandemlift`."""

from __future__ import annotations

import gc
import os
import signal
import sys

YOUNG = 100_000  # objects between collections of cycles: most commands end before there are many, and leave few


def main() -> None:
    """Run the command line; Ctrl-C ends it by one line also while it is being loaded."""
    gc.set_threshold(YOUNG)
    try:
        from tandemlift.apps.cli.main import main as run
    except KeyboardInterrupt:
        sys.stderr.write("\nstopped; nothing more is written\n")
        sys.stderr.flush()
        os._exit(130)
    try:
        run()
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # only Python's own exit remains


if __name__ == "__main__":
    main()
