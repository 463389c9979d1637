"""How the real body differs from the modelled one: `[plant]` and `[disturbance]`."""

from __future__ import annotations

from typing import Annotated

from tandemlift.core.keys import Axes3, PerAxis, Scale, Table, key


class DisturbanceTable(Table):
    """`[disturbance]`: a constant force and moment that the pilot does not know of."""

    force: Axes3 = key((0.0, 0.0, 0.0), "N", "force at the centre of mass, world axes")
    moment: Axes3 = key((0.0, 0.0, 0.0), "N m", "moment, body axes")


class PlantTable(Table):
    """`[plant]`: how the real body differs from the pilot's model of it."""

    mass_scale: Scale = key(1.0, "1", "real mass over the modelled mass", source="the model is right")
    inertia_scale: Annotated[tuple[Scale, Scale, Scale], PerAxis(3)] = key(
        (1.0, 1.0, 1.0),
        "1",
        "real inertia over the modelled inertia, about each body axis",
        source="the model is right",
    )
