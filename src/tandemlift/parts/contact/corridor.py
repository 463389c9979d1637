"""A corridor by its centreline: walls on both sides of it, parallel to it at half the width, mitred at its corners.

Where the centreline turns by an angle α, the walls' corner lies on the bisector, w/2 over cos(α/2) from the
centreline's: so each wall keeps its distance of half the width all along.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from tandemlift.core.arrays import array, lengths
from tandemlift.core.caching import cached
from tandemlift.core.errors import CheckResult, refused, shown, warned
from tandemlift.core.keys import PerAxis, Table, key, must
from tandemlift.core.vector import vec3
from tandemlift.parts.contact.wall_geometry import offset, wall
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.mechanics.rotation import rotation_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle

Point2 = Annotated[tuple[float, float], PerAxis(2, single=False)]

SHORTEST_WALL = 1e-3  # m, of a wall
SHARPEST_BEND = math.radians(150.0)  # change of direction of a centreline


class WallTable(Table):
    """`[[walls]]`: upright walls, one table each, from below the floor up; they need `ground.model = "floor"`.

    The guard spheres of the quadrotors and the beam touch them.
    """

    start: Point2 = key(..., "m", "one end of the wall, x and y", example=[2.0, -3.0])
    end: Point2 = key(..., "m", "the wall's other end, x and y", rule="1 mm or more from the start", example=[2.0, 3.0])
    top: float = key(2.5, "m", "height z of the wall's top", source="chosen")


def sides(centreline: Sequence[Sequence[float]], width: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The corners (n, 2) of the walls to the left and to the right of a centreline (n, 2) [m], `width` [m] apart."""
    line = array(centreline)
    along = np.diff(line, axis=0)
    along = along / lengths(along)[:, None]
    left = np.column_stack([-along[:, 1], along[:, 0]])
    before, after = np.vstack([left[:1], left]), np.vstack([left, left[-1:]])
    mitre = (before + after) / (1.0 + np.sum(before * after, axis=1))[:, None]
    return line + 0.5 * width * mitre, line - 0.5 * width * mitre


class CorridorTable(Table, acts="corridor.centreline is given"):
    """`[corridor]`: walls on both sides of a centreline, mitred at its corners; they need `ground.model = "floor"`.

    They add to those of `[[walls]]`. A person without a path of their own follows the centreline.
    """

    centreline: tuple[Point2, ...] = key(
        (),
        "m",
        "corners of the centreline, each x and y; without any there is no corridor",
        rule="none, or two or more, 1 mm or more apart, turning by 150° or less",
    )
    width: Annotated[float, Field(gt=0.0, le=1e3)] = key(
        4.0,
        "m",
        "distance between the walls",
        rule="such that no wall between two corners vanishes",
        source="that of mission zigzag",
    )
    height: float = key(2.5, "m", "height z of the walls' tops", source="chosen")
    ends: Literal["open", "closed"] = key(
        "open", None, "ends of the corridor", choices={"open": "no wall there", "closed": "a wall across each end"}
    )

    @model_validator(mode="after")
    def _can_be_built(self) -> CorridorTable:
        if not self.centreline:
            return self
        if len(self.centreline) < 2 or any(math.dist(a, b) < SHORTEST_WALL for a, b in pairwise(self.centreline)):
            raise must("corridor", f"have a centreline of two points or more, {SHORTEST_WALL} m or more apart")
        along = np.diff(np.array(self.centreline), axis=0)
        angles = np.arctan2(along[:, 1], along[:, 0])
        turns = np.abs((np.diff(angles) + math.pi) % (2.0 * math.pi) - math.pi)
        if len(turns) and turns.max() > SHARPEST_BEND:
            worst = math.degrees(turns.max())
            raise must("corridor", f"turn by 150° or less at each corner: it turns by {worst:.0f}°")
        for side in sides(self.centreline, self.width):
            if np.any(np.sum(np.diff(side, axis=0) * along, axis=1) < SHORTEST_WALL * np.linalg.norm(along, axis=1)):
                raise must(
                    "corridor", "have corners farther apart, or be narrower: a wall between two of them vanishes"
                )
        return self

    @property
    def walls(self) -> tuple[WallTable, ...]:
        """The corridor's walls: left from start to end, right, and across its ends if they are closed."""
        return _walls_of(self) if self.centreline else ()


@cached
def _walls_of(corridor: CorridorTable) -> tuple[WallTable, ...]:
    left, right = (side.tolist() for side in sides(corridor.centreline, corridor.width))
    lines = [*pairwise(left), *pairwise(right)]
    if corridor.ends == "closed":
        lines += [(left[0], right[0]), (left[-1], right[-1])]
    return tuple(WallTable.model_construct(start=tuple(a), end=tuple(b), top=corridor.height) for a, b in lines)


def wall_tables(mission: Mapping[str, Any]) -> list[dict[str, Any]]:
    """All walls of a mission given as nested tables: those of `walls`, then the corridor's."""
    corridor = CorridorTable.model_validate(mission.get("corridor", {}))
    return [*mission.get("walls", []), *(w.model_dump(mode="json") for w in corridor.walls)]


def wall_checks(walls: Sequence[WallTable]) -> Iterator[CheckResult]:
    """Check for walls that are too short."""
    for i, w in enumerate(walls):
        if math.dist(w.start, w.end) < SHORTEST_WALL:
            yield refused(f"walls.{i}.end = {shown(w.end)}: must be {SHORTEST_WALL} m or more from walls.{i}.start")


def wall_warnings(
    walls: Sequence[WallTable], corridor: CorridorTable, initial: InitialTable, vehicle: Vehicle
) -> Iterator[CheckResult]:
    """Check for quadrotors that start in a wall."""
    R = np.array(rotation_from_euler(vec3(initial.euler)))
    centres = np.array(initial.position) + vehicle.lever_arms @ R.T
    for i, w in enumerate((*walls, *corridor.walls)):
        name = f"walls.{i}" if i < len(walls) else f"wall {i - len(walls) + 1} of the corridor"
        upright = wall(w.start, w.end, w.top)
        for j, (q, centre) in enumerate(zip(vehicle.quadrotors, centres, strict=True), 1):
            distance = math.hypot(*offset(upright, vec3(centre)))
            if distance < q.guard_radius:
                yield warned(f"quadrotor {j} starts {q.guard_radius - distance:.2g} m deep in {name}")


def nearest_wall(walls: Sequence[WallTable], place: Sequence[float]) -> int:
    """The number of the wall that is nearest to a place [m], seen from above."""
    at, ends = complex(*place[:2]), [(complex(*wall.start), complex(*wall.end)) for wall in walls]
    beside = [abs(at - a - (b - a) * min(max(((at - a) / (b - a)).real, 0.0), 1.0)) for a, b in ends]
    return beside.index(min(beside))
