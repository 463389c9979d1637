"""WebAssembly modules fly, in Node.js and in browsers and by their manifests alone, with the bits of native code."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from draws import drawn_missions, drawn_numbers
from wasm_flights import Jobs, WasmFlight, flights_in_page, wasm_flights

import tandemlift as tl
from tandemlift.codegen.mission_module import compile_mission
from tandemlift.missions import built_in, changed

Fly = Callable[[Path, str, Jobs], list[WasmFlight]]


@pytest.fixture(scope="module", params=["Chromium", "Firefox"])
def evaluate(request: pytest.FixtureRequest) -> Iterator[Callable[[str], Any]]:
    """Gives the value of an expression in a page of a browser."""
    if request.param == "Firefox":
        from firefox import firefox

        with firefox() as browser:
            browser.open("about:blank")
            yield browser.value
        return
    from chromium import launched

    with launched() as browser:
        yield browser.new_page().evaluate


def check_draws(
    name: str, folder: Path, *, duration: float, count: int, fly: Fly = wasm_flights, **choices: str
) -> int:
    """Fly draws of a mission in both; how many flights were lost. `choices`: values of its keys, with __ for a dot."""
    changes = {"mission.fma": False, **{key.replace("__", "."): value for key, value in choices.items()}}
    mission = changed(tl.load_mission(name, changes), "mission.duration", duration)
    compile_mission(mission, "wasm32", folder)
    manifest = json.loads((folder / f"{name}.json").read_text())
    draws = drawn_numbers(mission, count, {n["key"] for n in manifest["numbers"]})
    flown = fly(folder, name, [{"numbers": draw} for draw in draws])
    lost = 0
    for draw, there, one in zip(draws, flown, drawn_missions(mission, draws), strict=True):
        here = tl.fly(one)
        assert there.guard == 0, draw
        for channel in manifest["channels"]:
            values = np.reshape(here[channel["name"]], (len(here.time), -1))
            assert np.array_equal(there.log[: len(values), channel["columns"]], values, equal_nan=True), (channel, draw)
        lost += here.ending is not None
    return lost


def test_a_module_flies_as_native_code(tmp_path: Path) -> None:
    assert check_draws("paper", tmp_path, duration=3.0, count=5) == 1


@pytest.mark.thorough
def test_a_module_flies_with_a_policy_as_native_code(tmp_path: Path) -> None:
    check_draws("iris", tmp_path, duration=14.0, count=2, compliance__policy__model="network")


@pytest.mark.targets
@pytest.mark.parametrize("wrench", ["kalman", "unscented", "fused"])
def test_a_module_observes_as_native_code(wrench: str, tmp_path: Path) -> None:
    check_draws("iris", tmp_path, duration=14.0, count=1, estimator__wrench=wrench)


@pytest.mark.targets
@pytest.mark.parametrize("name", sorted(built_in()))
def test_all_missions_fly_as_native_code(name: str, tmp_path: Path) -> None:
    assert check_draws(name, tmp_path, duration=4.0, count=20) >= 1


@pytest.mark.targets
@pytest.mark.parametrize("name", sorted(built_in()))
def test_all_missions_fly_in_browsers_as_native_code(name: str, evaluate: Callable[[str], Any], tmp_path: Path) -> None:
    def fly(folder: Path, name: str, jobs: Jobs) -> list[WasmFlight]:
        return flights_in_page(evaluate, folder, name, jobs)

    assert check_draws(name, tmp_path, duration=4.0, count=20, fly=fly) >= 1
