"""The build of the wheel: it compiles the flights that the page carries, so that users need not."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

FLIGHTS = "build/flights"


class CompiledFlights(BuildHookInterface):  # type: ignore[type-arg]
    """Adds compiled flights to a wheel; an editable install compiles them when they are asked for."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile them, a minute or two, into the folder that the package looks in."""
        if version == "editable":
            return
        root = Path(self.root)
        sys.path.insert(0, str(root / "src"))
        from tandemlift.live.offline.page_modules import build_modules

        self.app.display_info("Compiling the flights of the page: a minute or two …")
        build_modules(root / FLIGHTS)
        build_data["force_include"][FLIGHTS] = "tandemlift/data/flights"
