"""Which missions clients can fly: those in which the vehicle stands on a floor until a client arms it."""

from pathlib import Path

import pytest

import tandemlift as tl
from tandemlift.apps.clients.flight import PILOT_ASIDE, RealTimeFlight, SteppedFlight, quadrotors_of
from tandemlift.missions import built_in, load_mission

PAGE = Path(__file__).parents[3] / "docs" / "how-to" / "fly-with-crazyflie-clients.md"


def stands(name, **changes):
    """Whether the vehicle is where it was after 1 s with standing rotors."""
    aside = dict(setting.split("=") for setting in PILOT_ASIDE)
    mission = load_mission(name, {**aside, "pushes": [], **changes})
    flight = SteppedFlight(mission, quadrotors_of(mission)).simulation
    start = flight.state[2]
    for _ in range(round(1.0 / flight.dt)):
        flight.step(thrusts=[0.0] * 4 * mission.hover.vehicle.count)
    return abs(flight.state[2] - start) < 0.02


def refusal(name, folder, **changes):
    """Why clients cannot fly a mission."""
    mission = load_mission(name, changes)
    with pytest.raises(tl.InputError) as refused:
        RealTimeFlight(mission, quadrotors_of(mission), "compiled", folder)
    return str(refused.value)


def test_a_mission_that_starts_in_the_air_is_refused_and_the_page_names_those_that_stand(tmp_path):
    hovering = [name for name in built_in() if load_mission(name).ground.model == "none"]
    assert not any(map(stands, hovering[:1]))
    for name in hovering:
        wanted = f'{name}: ground.model = "none": must be "floor", as the vehicle stands until a client arms its rotors'
        assert refusal(name, tmp_path) == wanted
    standing, starting = PAGE.read_text("utf-8").split("Missions over a floor fly")[1].split("\n\n")[0].split(" hover:")
    for name in built_in():
        assert f"`{name}`" in (starting if name in hovering else standing), name


@pytest.mark.thorough
def test_a_floor_under_the_vehicle_is_enough_and_one_far_below_is_not(tmp_path):
    assert stands("hover", **{"ground.model": "floor"})
    assert stands("four", **{"ground.model": "floor", "initial.euler": [0.0, 0.0, 0.0]})
    assert "iris: ground.height = -3.0: must be unset, or at the feet" in refusal(
        "iris", tmp_path, **{"ground.height": -3.0}
    )
