"""The moments that rotors can exert in hover, by SciPy's linear programs; and the command at the start, by flights."""

import re

import numpy as np
import pytest
from random_missions.fleets import random_fleet
from repository import ROOT
from scipy.optimize import linprog

import tandemlift as tl
from tandemlift.missions import check, load_mission, tables_of
from tandemlift.missions.flight_checks import flight_checks
from tandemlift.parts.flight_checks.controller_response import first_command

CASES = {
    "paper": {},
    "iris": {},
    "four": {},
    "flight-ready": {"plant.mass_scale": 1.2},
}


def by_linear_program(hover, axis: int) -> float:
    """The largest moment either way: max of a row of the effect over the box, total thrust and other moments held."""
    effect, most = hover.vehicle.effect, np.repeat(hover.most, 4)
    others = [row for row in range(4) if row != axis + 1]
    held = [hover.weight if row == 0 else 0.0 for row in others]
    found = []
    for sign in (1.0, -1.0):
        answer = linprog(-sign * effect[axis + 1], A_eq=effect[others], b_eq=held, bounds=[(0.0, f) for f in most])
        assert answer.success
        found.append(-answer.fun)
    return min(found)


@pytest.mark.parametrize("mission", CASES)
def test_the_largest_moments_in_hover_are_those_of_linear_programs(mission):
    hover = load_mission(mission, CASES[mission]).hover
    assert hover.largest_moments == pytest.approx([by_linear_program(hover, axis) for axis in range(3)], rel=1e-6)
    assert (hover.authority <= hover.largest_moments * (1.0 + 1e-6)).all()


@pytest.mark.parametrize("number", range(3))
def test_the_most_that_unlike_quadrotors_lift_without_turning_is_that_of_a_linear_program(number):
    tables = tables_of(random_fleet(number, 52))
    tables["plant"] |= {"center_of_mass_offset": [0.02, -0.03, 0.01], "thrust_scale": 0.95}
    hover = check(tables, "unlike", quiet=True).hover
    effect, most = hover.vehicle.effect.copy(), np.repeat(hover.most, 4)
    effect[1] += 0.03 * effect[0]  # (r − c) × F about the real centre of mass c
    effect[2] += 0.02 * effect[0]
    answer = linprog(-effect[0], A_eq=effect[1:], b_eq=np.zeros(3), bounds=[(0.0, f) for f in most])
    assert hover.level_lift == pytest.approx(-answer.fun, rel=1e-5)
    assert hover.level_lift < 0.99 * hover.lift


def test_no_moment_is_left_where_full_thrust_only_just_carries_the_weight():
    hover = load_mission("paper", {"plant.mass_scale": 56.5312 / 34.335 * (1.0 - 1e-9)}).hover
    assert np.abs(hover.largest_moments).max() < 1e-4


def test_the_first_command_is_that_of_the_flight():
    mission = load_mission("paper")
    flown = tl.fly(load_mission("paper", {"mission.duration": 0.01})).metrics()["command_at_start"]
    command = first_command(mission.controller, mission.hover.vehicle, 0.001, mission.initial)
    assert command == pytest.approx(flown, rel=1e-12)


def test_the_check_tells_the_first_command_from_the_linear_response_and_the_allocation_from_the_rotors():
    checks = flight_checks(load_mission("paper", {"actuators.model": "rotors"}))
    (roll,) = [check for check in checks if (check.check, check.subject) == ("start", "roll")]
    assert roll.value == pytest.approx(4110.0, rel=2e-3)
    said = "asks for 4.11e+03 N m in roll (its law commands 1066); the rotors can exert 23 in hover, 4.93 by allocation"
    assert said in roll.text


def test_the_readme_says_the_numbers_of_the_function():
    hover = load_mission("paper").hover
    text = " ".join((ROOT / "README.md").read_text("utf-8").split())
    said = re.search(r"of ([\d,]+) N·m in the first step; two IRIS can exert (\d+) N·m in hover", text)
    command = first_command(load_mission("paper").controller, hover.vehicle, 0.001, load_mission("paper").initial)
    assert said.groups() == (f"{abs(command[1]):,.0f}", f"{hover.largest_moments[0]:.0f}")
