"""The figure of a way among walls: what it draws is what was flown, and what it measures is plane geometry."""

import dataclasses

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.flight.record import Ending
from tandemlift.missions import tables_of
from tandemlift.parts.contact.corridor import wall_tables
from tandemlift.pictures.drawing.clearances import clearances, grips
from tandemlift.pictures.figures.corridor import NEWTON, arrows, instants
from tandemlift.pictures.figures.registry import figures, figures_for

WIDTH, REACH, GUARD, RADIUS = 4.0, 1.0, 0.375, 0.05
STRAIGHT = {"corridor.centreline": [[-5.0, 0.0], [25.0, 0.0]], "person.grip": 0.6, "corridor.width": WIDTH}


def moved(yaw=0.0, count=400, across=0.0, **changes):
    """A flight along x at a heading, beside the centreline of a straight corridor, pulled by 2 N."""
    x = np.linspace(0.0, 20.0, count)
    none = np.zeros(count)
    channels = {
        "position": np.column_stack([x, none + across, none + 1.0]),
        "velocity": np.tile([0.5, 0.0, 0.0], (count, 1)),
        "attitude": np.tile([np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)], (count, 1)),
        "rates": np.zeros((count, 3)),
        "push_force": np.tile([2.0, 0.0, 0.1], (count, 1)),
    }
    mission = tables_of(tl.load_mission("zigzag", STRAIGHT | changes))
    return tl.Flight(0.1 * np.arange(count), channels, mission, {})


@pytest.mark.parametrize("across", [0.0, 0.3])
def test_clearance_in_a_straight_corridor_is_half_the_width_less_what_sticks_out(across):
    left = WIDTH / 2.0 - across
    wide, long = clearances(moved(across=across)), clearances(moved(-np.pi / 2.0, across=across))
    assert wide.guards == pytest.approx(left - REACH - GUARD)
    assert wide.beam == pytest.approx(left - REACH - RADIUS)
    assert long.guards == pytest.approx(left - GUARD)
    assert long.beam == pytest.approx(left - RADIUS)


def test_the_grip_is_along_the_beam_where_the_person_holds_on():
    wide, long = grips(moved()), grips(moved(-np.pi / 2.0))
    assert wide[:, 1] == pytest.approx(0.6)
    assert long[:, 0] - moved()["position"][:, 0] == pytest.approx(0.6)
    assert wide[:, 2] == pytest.approx(1.0 - 0.0642857, abs=1e-6)
    assert grips(moved(**{"person.model": "none"})) is None


def test_walls_vehicle_path_and_pushes_are_drawn_where_they_were():
    flight = moved()
    above, below = figures()["corridor"].draw(flight).axes
    walls = [line.get_xydata() for line in above.get_lines() if line.get_gid() == "wall"]
    assert np.array_equal(walls, [[w["start"], w["end"]] for w in wall_tables(flight.mission)])
    (path,) = (line.get_xydata() for line in above.get_lines() if line.get_gid() == "path")
    assert {tuple(p) for p in path.tolist()} <= {tuple(p) for p in flight["position"][:, :2].tolist()}
    found = arrows(flight, instants(flight))
    drawn = [patch for patch in above.patches if patch.get_gid() == "push"]
    assert len(drawn) == len(found) == len(instants(flight))
    for patch, (point, force) in zip(drawn, found, strict=True):
        ends = patch.get_path().vertices
        assert point[1] == pytest.approx(0.6)
        assert force == pytest.approx([2.0, 0.0])
        assert ends[0] == pytest.approx(point, abs=0.1)
        assert ends[:, 0].max() == pytest.approx(point[0] + 2.0 * NEWTON, abs=0.2)
    (least,) = (line for line in below.get_lines() if line.get_gid() == "least")
    assert least.get_ydata()[0] == pytest.approx(0.625)


def test_it_is_a_figure_of_flights_among_walls_only():
    assert "corridor" in figures_for(moved())
    assert "corridor" not in figures_for(moved(**{"corridor.centreline": [], "person.model": "none"}))
    assert "corridor" in figures_for(moved(**{"walls": [{"start": [0, 9], "end": [9, 9]}]}))
    assert moved().mission["corridor"]["centreline"]


@pytest.mark.parametrize("count", [1, 5])
def test_it_draws_a_flight_of_few_samples_or_one_that_diverged(count):
    flight = moved(count=count)
    figures()["corridor"].draw(flight)
    if count > 1:
        flight["position"][-1] = np.nan
        lost = dataclasses.replace(flight, ending=Ending("position", 0.1, np.nan, "must be finite"))
        figure = figures()["corridor"].draw(lost)
        assert "diverged" in figure.get_supxlabel()
