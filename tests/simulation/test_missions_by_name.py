"""Whoever takes a mission takes its name or its path too; a flight is read from the folder of its run."""

import numpy as np
import pytest
from flights import different

import tandemlift as tl

SHORT = 'extends = "one-push"\n[mission]\nname = "short"\nduration = 0.2\n'


@pytest.fixture
def short(tmp_path):
    path = tmp_path / "short.toml"
    path.write_text(SHORT, "utf-8")
    return path


def test_a_flight_by_path_is_that_of_the_loaded_mission(short):
    flight = tl.fly(tl.load_mission(short))
    assert different(tl.fly(short), flight) == []
    assert different(tl.fly(str(short)), flight) == []
    for other in tl.fly_many([short, tl.load_mission(short), str(short)]):
        assert different(other, flight) == []


def test_a_simulation_a_pilot_and_checks_by_name_are_those_of_the_loaded_mission(short):
    mission = tl.load_mission(short)
    assert tl.Simulation(short).mission == mission
    assert tl.check(short) == tl.check(mission)
    assert len(tl.Pilot(short).thrusts) == len(tl.Pilot(mission).thrusts)
    assert np.array_equal(tl.linearize(short, 0.1).A, tl.linearize(mission, 0.1).A)


def test_a_name_that_is_none_is_refused_with_the_nearest_and_one_text_is_no_list(short):
    with pytest.raises(tl.InputError, match="Did you mean 'iris'"):
        tl.fly("irs")
    with pytest.raises(tl.InputError, match=r"missions = 'iris': must be a list, such as \['iris'\]"):
        tl.fly_many("iris")
    (refused,) = tl.fly_many(["irs"], refusals=True)
    assert isinstance(refused, tl.InputError)


def test_a_flight_is_read_from_the_folder_of_its_run(short, tmp_path):
    flight = tl.fly(short)
    flight.save(tmp_path / "run" / "flight.npz")
    assert tl.Flight.load(tmp_path / "run") == flight
    with pytest.raises(tl.InputError, match=r"flight\.npz: No such file"):
        tl.Flight.load(tmp_path)
