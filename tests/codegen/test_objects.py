"""Objects for other processors fly, in emulators and by their manifests alone, with the bits of native code."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from draws import drawn_missions, drawn_numbers
from object_flights import fly_object, link_object

import tandemlift as tl
from tandemlift.codegen.mission_module import compile_mission
from tandemlift.missions import built_in, changed

CORTEX = Path(__file__).parent / "cortex_m7"
CORTEX_M7 = ("-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv5-d16", "--specs=rdimon.specs")
START = ("-T", str(CORTEX / "newlib.ld"), str(CORTEX / "newlib_start.c"))
COMPILERS = {"aarch64": ("aarch64-linux-gnu-gcc", "-static"), "cortex-m7": ("arm-none-eabi-gcc", *CORTEX_M7, *START)}
EMULATORS = {
    "aarch64": ("qemu-aarch64",),
    "cortex-m7": (
        *("qemu-system-arm", "-M", "mps2-an500", "-nographic"),
        *("-semihosting-config", "enable=on,target=native", "-kernel"),
    ),
}
DRAWS = {"aarch64": 20, "cortex-m7": 4}


@pytest.mark.targets
@pytest.mark.parametrize("target", COMPILERS)
@pytest.mark.parametrize("name", sorted(built_in()))
def test_an_object_flies_as_native_code(name: str, target: str, tmp_path: Path) -> None:
    mission = changed(tl.load_mission(name, {"mission.fma": False}), "mission.duration", 2.0)
    compile_mission(mission, target, tmp_path)
    manifest = json.loads((tmp_path / f"{name}.json").read_text())
    program = link_object(tmp_path, name, COMPILERS[target])
    draws = drawn_numbers(mission, DRAWS[target], {n["key"] for n in manifest["numbers"]})
    for draw, one in zip(draws, drawn_missions(mission, draws), strict=True):
        log = fly_object(tmp_path, name, [*EMULATORS[target], str(program)], draw)
        here = tl.fly(one)
        for channel in manifest["channels"]:
            values = np.reshape(here[channel["name"]], (len(here.time), -1))
            assert np.array_equal(log[: len(values), channel["columns"]], values, equal_nan=True), (channel, draw)
