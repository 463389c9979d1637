"""Whole flights in C have the bits of native ones: every built-in mission, twenty draws each, diverging ones too."""

import shutil

import pytest
from c_flights import CFlight, differences, unfused

import tandemlift as tl
from tandemlift.missions import built_in


def mission_of(name, **changes):
    return unfused(tl.load_mission(name, {key.replace("__", "."): value for key, value in changes.items()}))


def test_a_short_flight_in_c_has_the_bits_of_the_native_one(tmp_path):
    mission = mission_of("one-push")
    wrong, lost = differences(CFlight(mission, tmp_path), mission, range(5))
    assert not wrong
    assert lost > 0  # so a flight that diverges was compared too


@pytest.mark.targets
@pytest.mark.parametrize("name", sorted(built_in()))
def test_twenty_draws_of_every_mission_have_the_bits_of_native_flights(name, tmp_path):
    mission = mission_of(name)
    wrong, lost = differences(CFlight(mission, tmp_path), mission, range(20))
    assert not wrong
    assert lost > 0


@pytest.mark.targets
@pytest.mark.parametrize("name", ["paper", "iris", "zigzag", "rotor-loss"])
def test_clang_makes_the_same_bits(name, tmp_path):
    if shutil.which("clang") is None:
        pytest.skip("no clang")
    mission = mission_of(name)
    wrong, _ = differences(CFlight(mission, tmp_path, "clang", "-O3"), mission, range(5))
    assert not wrong


@pytest.mark.targets
@pytest.mark.parametrize("controller", ["geometric", "lqr", "pid", "smc", "super-twisting"])
def test_every_controller_has_the_bits_of_native_flights(controller, tmp_path):
    mission = mission_of("one-push", controller__name=controller)
    wrong, _ = differences(CFlight(mission, tmp_path), mission, range(5))
    assert not wrong
