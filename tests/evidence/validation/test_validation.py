"""What the pilot is held to: rows, their targets, and the command that prints them."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from validate import main
from validation.census import Census
from validation.chapters import Row, table
from validation.rows import below, true_yielding
from validation.scenarios import WINDY, Bench, mission

import tandemlift as tl
from tandemlift.flight.record import Flight
from tandemlift.missions import tables_of


def test_a_row_is_met_if_no_number_exceeds_its_limit():
    assert below("error", [1.0, 2.0], [1.0, 2.0], "mm").met
    assert not below("error", [1.0, 2.1], [1.0, 2.0], "mm").met
    assert not below("error", [1.0, np.nan], [1.0, 2.0], "mm").met
    assert below("error", 0.5, 1.0, "mm", 2).measured == "0.50 mm"


def test_the_table_marks_what_is_met_and_what_is_missed():
    text = table([Row("a", "1", "1", True), Row("b", "1", "2", False), Row("c", "", "3", None)])
    assert text.splitlines()[2:] == ["| a | 1 | 1 | met |", "| b | 1 | 2 | **missed** |", "| c |  | 3 |  |"]


@pytest.mark.parametrize("arguments", [["--chapter", "yav"], ["--engine", "mujoko"]], ids=str)
def test_an_unknown_chapter_or_engine_is_refused_before_anything_flies(arguments, capsys):
    with pytest.raises(SystemExit, match="2"):
        main(arguments)
    assert "choose from" in capsys.readouterr().err


def test_the_unfiltered_admittance_is_that_of_the_true_push():
    given = tl.load_mission("iris", {"mission.duration": 40.0})
    time = np.arange(0.0, 40.0, 0.5)
    flight = Flight(time, {"position": np.zeros((len(time), 3))}, tables_of(given), {})

    def rate(t, y):
        force = sum(np.array(p.force) * np.exp(-((t - p.time) ** 2) / (2.0 * p.sigma**2)) for p in given.pushes)
        beyond = force - np.clip(force, -0.3, 0.3)
        return [*y[3:], *(beyond - 1.6 * y[3:])]

    solution = solve_ivp(rate, (0.0, 40.0), np.zeros(6), t_eval=time, rtol=1e-8, atol=1e-10, max_step=0.05)
    assert np.abs(true_yielding(flight) - solution.y[:3].T).max() < 2e-3  # m: a force held over a step


def test_the_wind_of_the_table_is_three_newtons_along_x_and_y():
    windy = mission(WINDY)
    velocity = np.array(windy.wind.velocity)
    area = sum(q.drag_area[0] * q.drag_coefficient for q in windy.vehicle.quadrotors)
    force = 0.5 * windy.wind.density * area * np.linalg.norm(velocity) * velocity
    assert force == pytest.approx([3.0, 3.0, 0.0], abs=0.01)


def test_flights_are_counted_once_each_whatever_their_findings():
    census = Census()
    found = [[1.0, "off-track", "far"], [2.0, "off-track", "tilted"], [3.0, "saturated", "long"]]
    census.add([{"outcome": "landed", "findings": []}, {"outcome": "crashed", "findings": found}])
    assert census.found == 1
    rows = dict(line.strip("| ").split(" | ") for line in census.table().splitlines()[2:])
    assert (rows["landed"], rows["crashed"], rows["flying"], rows["with findings"]) == ("1", "1", "0", "1")
    assert (rows["with finding: off-track"], rows["with finding: saturated"]) == ("1", "1")
    assert "with finding: touched" not in rows


def test_a_bench_counts_what_it_flies():
    census = Census()
    missions = [tl.load_mission("hover", {"mission.duration": t, "phases.lift_start": 2.0}) for t in (1.0, 1.5)]
    Bench(census=census).fly(missions)
    Bench(census=census).metrics(missions[:1])
    assert dict(census.outcomes) == {"flying": 3}
    Bench().fly(missions[:1])  # which nobody counts
    assert sum(census.outcomes.values()) == 3
