"""Modules for other machines: what they are made of, what their manifests say, and what is refused."""

from __future__ import annotations

import ctypes
import gzip
import hashlib
import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from listings import LAW

import tandemlift as tl
from tandemlift.codegen.mission_module import TARGETS, compile_mission, module_of
from tandemlift.codegen.wasm_linker import LinkError, Reader, linked, signed, unsigned
from tandemlift.compiler.machine_code import machine
from tandemlift.compiler.tracer import Module
from tandemlift.parts.controllers import load_controller
from tandemlift.simulation.parameter_changes import ParameterRamp, ScheduledChange
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation.memory import WORDS
from tandemlift.simulation.preparation.module_text import write_flight_loop, write_ramp


def wasm_object(mission: tl.Mission) -> bytes:
    """The object of a mission's loop."""
    target = machine.MACHINES["wasm32"]
    loop = write_flight_loop(FlightPlan(mission).loop_code, target.draw_lanes, target.largest)
    return machine.object_code(loop.module.text, target)


def test_unfused_code_has_no_fused_operation() -> None:
    for fused in (True, False):
        kernels = FlightPlan(tl.load_mission("hover", {"mission.fma": fused})).loop_code
        assert ("llvm.fma" in write_flight_loop(kernels, 1, 0).module.text) == fused


def test_a_manifest_says_what_its_module_is() -> None:
    module = module_of(tl.load_mission("hover"), "wasm32")
    manifest = module.manifest
    assert manifest["sha256"] == hashlib.sha256(module.code).hexdigest()
    assert manifest["context"]["words"] == list(WORDS)
    assert json.loads(json.dumps(manifest, allow_nan=False)) == json.loads(json.dumps(manifest))
    mass = next(n for n in manifest["numbers"] if n["key"] == "admittance.mass.0")
    assert (mass["unit"], mass["exclusiveMinimum"], mass["value"]) == ("kg", 0.0, 1.0)
    assert manifest["fixed"]["mission.step"]
    position = next(c for c in manifest["channels"] if c["name"] == "position")
    assert (position["columns"], position["unit"], position["frame"]) == ([0, 1, 2], "m", "world")


def test_a_module_comes_from_the_cache_the_second_time(monkeypatch: pytest.MonkeyPatch) -> None:
    mission = tl.load_mission("hover")
    first = module_of(mission, "wasm32")
    monkeypatch.setattr("tandemlift.codegen.mission_module.object_code", None)
    heavier = tl.load_mission("hover", {"vehicle.payload.mass": 0.7})  # other numbers, the same code
    assert module_of(mission, "wasm32").code == module_of(heavier, "wasm32").code == first.code


@pytest.mark.targets
def test_our_linker_places_what_another_one_places(tmp_path: Path) -> None:
    other = shutil.which("wasm-ld") or shutil.which("wasm-ld-14")
    assert other, "Debian's lld is not installed"
    (tmp_path / "x.o").write_bytes(wasm_object(tl.load_mission("iris", {"mission.fma": False})))
    command = [other, "--no-entry", "--export=fly", "--export=__heap_base", "-o", "x.wasm", "x.o"]
    subprocess.run(command, cwd=tmp_path, check=True)
    ours = linked((tmp_path / "x.o").read_bytes(), ["fly"])
    theirs = (tmp_path / "x.wasm").read_bytes()
    assert abs(len(gzip.compress(ours)) - len(gzip.compress(theirs))) < 0.2 * len(gzip.compress(theirs))


def test_what_our_linker_cannot_link_is_refused() -> None:
    target = machine.MACHINES["wasm32"]
    calling = "declare void @other()\ndefine void @here() {\n  call void @other()\n  ret void\n}\n"
    with pytest.raises(LinkError, match="imports a function: other"):
        linked(machine.object_code(calling, target), ["here"])
    with pytest.raises(LinkError, match="no function there"):
        linked(machine.object_code("define void @here() {\n  ret void\n}\n", target), ["there"])


def test_a_ramp_is_that_of_a_native_flight() -> None:
    module = Module()
    write_ramp(module)
    code = machine.Loaded(machine.compiled(module.text), ["ramp"])
    ramp = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_void_p] * 4, *[ctypes.c_int64] * 5)(code.addresses["ramp"])
    chance = np.random.default_rng(3)
    before, after, steps, begin = chance.normal(size=40), chance.normal(size=40), 17, 5
    after[7], before[9], after[11] = np.inf, -np.inf, np.nan
    active = (chance.uniform(size=40) < 0.7).astype(float)
    places = np.flatnonzero(active)
    here, there = before.copy(), before.copy()
    due = ScheduledChange(begin, steps, None)  # type: ignore[arg-type]
    native = ParameterRamp(here, places, after, due)
    for k in range(begin, begin + steps + 2):
        goes_on = native.apply(here, k)
        addresses = (a.ctypes.data for a in (there, before, after, active))
        assert ramp(*addresses, 0, len(before), k, begin, steps) == goes_on
        assert np.array_equal(here, there, equal_nan=True)
    assert np.array_equal(here[places], after[places], equal_nan=True)


def test_unknown_targets_are_refused_with_those_that_there_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mission = tl.load_mission("hover")
    with pytest.raises(tl.InputError, match=r"target = 'arm': must be one of .*cortex-m7"):
        compile_mission(mission, "arm", tmp_path / "x")
    monkeypatch.setitem(TARGETS, "old", "a machine that no LLVM knows")
    monkeypatch.setitem(machine.MACHINES, "old", machine.MACHINES["wasm32"]._replace(triple="pdp11-dec-unix"))
    with pytest.raises(tl.InputError, match=r"'old': this LLVM has no pdp11-dec-unix; of our targets it has wasm32"):
        compile_mission(mission, "old", tmp_path / "x")
    with pytest.raises(tl.InputError, match="single = true: only for target 'c'"):
        compile_mission(mission, "wasm32", tmp_path / "x", single=True)
    assert not (tmp_path / "x").exists()


@pytest.mark.thorough
def test_an_object_does_not_replace_that_of_another_machine(tmp_path: Path) -> None:
    mission = tl.load_mission("hover")
    compile_mission(mission, "aarch64", tmp_path)
    held = (tmp_path / "hover.o").read_bytes()
    compile_mission(mission, "aarch64", tmp_path)
    for target in ("cortex-m7", "wasm32"):
        with pytest.raises(tl.InputError, match=rf"hover\.json: is not for {target}, so it stays: give another folder"):
            compile_mission(mission, target, tmp_path)
    assert (tmp_path / "hover.o").read_bytes() == held


@pytest.mark.parametrize("target", ["wasm32", "c", "fmu"])
def test_missions_that_no_other_machine_can_fly_are_refused(target: str, tmp_path: Path) -> None:
    change = {"time": 1.0, "key": "admittance.mass", "value": 2.0}
    with pytest.raises(tl.InputError, match="changes: 1 given, but other machines fly a mission as it begins"):
        compile_mission(tl.load_mission("hover", {"changes": [change]}), target, tmp_path / "x")
    path = tmp_path / "mine.py"
    path.write_text(LAW.replace("@control.register(Gains)", "@control.register(Gains, compiled=False)"))
    plain = tl.load_mission("hover", controller=load_controller(path))
    said = r"controller.name = '.*': .* line \d+, is plain Python, of which no other machine has code"
    with pytest.raises(tl.InputError, match=said):
        compile_mission(plain, target, tmp_path / "x")
    assert not (tmp_path / "x").exists()


def test_numbers_of_webassembly_are_read_as_they_were_written() -> None:
    for value in (0, 1, 63, 64, 127, 128, 300, 2**31 - 1):
        for padded in (0, 5):
            assert Reader(unsigned(value, padded)).unsigned() == value
            assert [Reader(signed(x, padded)).signed() for x in (value, -value)] == [value, -value]


def test_numbers_of_webassembly_are_those_of_its_specification() -> None:
    assert (unsigned(624485), signed(-123456)) == (b"\xe5\x8e\x26", b"\xc0\xbb\x78")  # the examples of DWARF 5, 7.6
