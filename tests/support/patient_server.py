"""A server with the timeouts of tests: on a busy machine a viewer is silent for longer, and answers pings later.

As a program: `tandemlift` with such a server.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from patience import PATIENCE

from tandemlift.apps.live import server, viewers


def make_patient(put: Callable[[Any, str, Any], None] = setattr) -> None:
    """Let pages keep beam and turn although they are silent; `put` is `setattr` or its like."""
    serve = server.serve
    put(viewers, "SILENT", PATIENCE)
    put(viewers, "HAND_TIMEOUT", PATIENCE)
    put(server, "serve", lambda *args, **options: serve(*args, **{**options, "ping_timeout": None}))


if __name__ == "__main__":
    from tandemlift.apps.cli.main import main

    make_patient()
    main()
