"""`python -m tandemlift`, and `tandemlift`."""

from __future__ import annotations

import gc
import os
import signal
import sys
import threading

AGAIN = 0.02  # s, until an interrupt that Python has swallowed is raised again
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
    _raise_swallowed_interrupts()
    try:
        run()
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # only Python's own exit remains


def _raise_swallowed_interrupts() -> None:
    """Raise a Ctrl-C again that Python has swallowed because it came while an object was finalised."""
    previous = sys.unraisablehook

    def hook(what: sys.UnraisableHookArgs) -> None:
        if issubclass(what.exc_type, KeyboardInterrupt):
            again = threading.Timer(AGAIN, signal.raise_signal, [signal.SIGINT])
            again.daemon = True
            again.start()
        else:
            previous(what)

    sys.unraisablehook = hook


if __name__ == "__main__":
    main()
