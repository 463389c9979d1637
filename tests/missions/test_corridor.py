"""A corridor's walls against plane geometry, and what is refused of corridors and of persons."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import tandemlift as tl
from tandemlift.core.types import unflat
from tandemlift.missions import check, tables_of
from tandemlift.parts.contact.corridor import CorridorTable, wall_tables
from tandemlift.parts.person.person import PATH_LEG
from tandemlift.simulation.preparation.assemble import assemble

LINE = ((0.0, 0.0), (5.0, 0.0), (10.0, 3.0), (15.0, 0.0))
WALKED = {"ground.model": "floor", "initial.euler": 0.0, "phases.rotors": "always"}


def from_line(points, start, end):
    """Signed distance of points (n, 2) to the left of the line through two points."""
    along = np.subtract(end, start) / np.linalg.norm(np.subtract(end, start))
    away = np.asarray(points) - np.asarray(start)
    return along[0] * away[:, 1] - along[1] * away[:, 0]


@given(
    turns=st.lists(st.floats(-1.5, 1.5), min_size=0, max_size=5),
    lengths=st.lists(st.floats(4.0, 9.0), min_size=6, max_size=6),
    width=st.floats(0.5, 2.5),
    first=st.floats(-3.0, 3.0),
)
def test_every_wall_is_parallel_to_its_stretch_of_the_centreline_at_half_the_width(turns, lengths, width, first):
    angles = first + np.cumsum([0.0, *turns])
    steps = np.array(lengths[: len(angles)])[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    line = np.vstack([[0.0, 0.0], np.cumsum(steps, axis=0)])
    corridor = CorridorTable(centreline=tuple(map(tuple, line.tolist())), width=width)
    count = len(angles)
    assert len(corridor.walls) == 2 * count
    for side, walls in ((1.0, corridor.walls[:count]), (-1.0, corridor.walls[count:])):
        for wall, (start, end) in zip(walls, pairwise(line), strict=True):
            assert from_line([wall.start, wall.end], start, end) == pytest.approx([side * width / 2.0] * 2)
        for before, after in pairwise(walls):
            assert before.end == after.start
        for corner, wall, turn in zip(line[1:], walls, turns, strict=False):
            assert np.hypot(*(np.array(wall.end) - corner)) == pytest.approx(width / 2.0 / np.cos(turn / 2.0))


def test_open_ends_are_square_and_closed_ones_have_a_wall_across():
    table = CorridorTable(centreline=LINE, width=4.0, ends="closed", height=3.0)
    assert (table.walls[-2].start, table.walls[-2].end) == ((0.0, 2.0), (0.0, -2.0))
    last = np.array([table.walls[-1].start, table.walls[-1].end])
    assert np.mean(last, axis=0) == pytest.approx(LINE[-1])
    assert np.diff(last, axis=0)[0] @ np.subtract(LINE[-1], LINE[-2]) == pytest.approx(0.0, abs=1e-12)
    assert {w.top for w in table.walls} == {3.0}
    assert len(table.walls) == len(CorridorTable(centreline=LINE).walls) + 2


@given(width=st.floats(0.1, 30.0), end=st.floats(-6.0, 6.0))
def test_a_corridor_that_is_accepted_has_walls_that_run_along_it(width, end):
    try:
        corridor = CorridorTable(centreline=((0.0, 0.0), (4.0, 0.0), (6.0, 2.0), (6.0 + end, 6.0)), width=width)
    except ValueError:
        assume(False)
    for walls in (corridor.walls[:3], corridor.walls[3:]):
        for wall, (start, stop) in zip(walls, pairwise(corridor.centreline), strict=True):
            assert np.dot(np.subtract(wall.end, wall.start), np.subtract(stop, start)) > 0.0


def test_the_file_keeps_the_centreline_and_the_loop_gets_walls_and_legs():
    changes = {
        **WALKED,
        "corridor.centreline": LINE,
        "person.model": "steer",
        "walls": [{"start": [0, 9], "end": [9, 9]}],
    }
    mission = tl.load_mission("hover", changes)
    tables = tables_of(mission)
    assert len(tables["walls"]) == 1
    assert wall_tables(tables) == [w.model_dump(mode="json") for w in mission.all_walls]
    assembled = assemble(mission)
    assert len(assembled.tables.walls) == 1 + 6
    legs = [unflat(row, PATH_LEG) for row in assembled.tables.legs]
    assert [(leg.end.x, leg.end.y) for leg in legs] == list(LINE)
    assert [leg.number for leg in legs] == [0.0, 1.0, 2.0, 3.0]
    assert check(tables) == mission
