"""The diagrams by name. Each is a file with a caption and `draw`, of a mission; that of the corridor, of a flight.

The drawing library is loaded when the diagrams are asked for, not when this file is imported.
"""

from __future__ import annotations

from functools import cache
from typing import Any


@cache
def diagrams() -> dict[str, Any]:
    """All diagrams by name: `draw(mission)` takes the nested tables of a mission, or a flight for `corridor_stages`."""
    from tandemlift.figures.diagrams import (
        control_loop,
        corridor_stages,
        free_body,
        mass_damper_spring,
        vehicle_sizes,
    )

    files = (free_body, control_loop, mass_damper_spring, vehicle_sizes, corridor_stages)
    return {file.__name__.rpartition(".")[2]: file for file in files}
