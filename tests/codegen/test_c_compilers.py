"""Compilers and their options: each makes the bits of a native flight, or the self-tests say that it does not."""

import platform
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from c_flights import STRICT

import tandemlift as tl
from tandemlift.codegen.c_package import code_texts, written
from tools import need

HERE = platform.machine() == "x86_64" and "fma" in Path("/proc/cpuinfo").read_text()
LEVELS, MACHINES = ("-O0", "-O1", "-O2", "-O3"), ("", "-mfma", "-march=native")
UNSAFE = ("-O2", "-mfma", "-funsafe-math-optimizations")
RIGHT = [
    *(
        (name, (level, *machine.split()))
        for name in ("gcc", "clang", "zig")
        for level in LEVELS
        for machine in MACHINES
    ),
    *((name, ("-std=gnu17", level, "-march=native")) for name in ("gcc", "clang") for level in ("-O2", "-O3")),
    ("gcc", ("-O2", "-mavx2", "-mfma", "-ftree-vectorize")),
    ("clang", UNSAFE),
]
WRONG = [("clang", ("-O2", "-mfma", "-ffp-contract=fast")), ("zig", UNSAFE)]
REFUSED = [
    *(("gcc", (f"-f{one}",)) for one in ("fast-math", "unsafe-math-optimizations", "finite-math-only")),
    ("clang", ("-ffast-math",)),
]


def of(compiler):
    """The command of a compiler; zig is the wheel `ziglang`."""
    if compiler == "zig":
        pytest.importorskip("ziglang")
        return [sys.executable, "-m", "ziglang", "cc"]
    need(compiler)
    return [compiler]


def instructions(folder, *options):
    """The instructions of a mission's pilot and flight, by gcc."""
    sources = sorted(folder.glob("*_flight.c")) + sorted(folder.glob("*_pilot.c"))
    command = [
        "gcc",
        *STRICT[:-1],
        *options,  # without -ffp-contract=off
        "-S",
        "-o",
        "-",
    ]
    return "".join(subprocess.run([*command, s], check=True, capture_output=True, text=True).stdout for s in sources)


@pytest.mark.thorough
@pytest.mark.skipif(platform.machine() != "x86_64", reason="vfmaddsub is an instruction of x86-64")
@pytest.mark.parametrize("options", [("-O2",), ("-O3", "-march=haswell"), ("-std=gnu17", "-O2")])
def test_gcc_fuses_no_product_and_sum_where_the_processor_could(options, tmp_path):
    need("gcc")
    written(code_texts(tl.load_mission("one-push")), tmp_path)
    assert re.findall(r"\bvfn?m\w+", instructions(tmp_path, "-mfma", *options)) == []


@pytest.fixture(scope="module")
def mission_in_c(tmp_path_factory):
    """The folder with the C of `iris` and its self-tests."""
    folder = tmp_path_factory.mktemp("iris")
    tl.compile_mission(tl.load_mission("iris"), "c", folder)
    return folder


def selftest(folder, program, command):
    """What a self-test, `flight` or `pilot`, says of a compiler and its options: (exit status, text)."""
    sources = [folder / f"iris_{program}.c", folder / f"iris_{program}_selftest.c"]
    subprocess.run([*command, *sources, "-lm", "-o", folder / program], check=True)
    done = subprocess.run([folder / program], check=False, capture_output=True, text=True)
    return done.returncode, done.stdout


def label(case):
    return " ".join((case[0], *case[1]))


@pytest.mark.targets
@pytest.mark.skipif(not HERE, reason="needs a processor of x86-64 with FMA")
@pytest.mark.parametrize("case", RIGHT, ids=map(label, RIGHT))
def test_a_compiler_with_these_options_makes_the_bits_of_a_native_flight(case, mission_in_c):
    for program in ("pilot", "flight"):
        status, text = selftest(mission_in_c, program, [*of(case[0]), *STRICT, *case[1]])
        assert (status, "0 numbers differ" in text or "0 thrusts differ" in text) == (0, True), text


@pytest.mark.targets
@pytest.mark.skipif(not HERE, reason="needs a processor of x86-64 with FMA")
@pytest.mark.parametrize("case", WRONG, ids=map(label, WRONG))
def test_a_self_test_says_that_an_option_changes_results(case, mission_in_c):
    status, text = selftest(mission_in_c, "flight", [*of(case[0]), *STRICT[:-1], *case[1]])
    assert status == 1
    assert "FAILED" in text
    assert "This compiler or an option changes results: compile with -std=c99 -O2 -ffp-contract=off" in text


@pytest.mark.targets
@pytest.mark.parametrize("case", REFUSED, ids=map(label, REFUSED))
def test_an_option_that_a_compiler_tells_of_is_refused(case, mission_in_c):
    command = [*of(case[0]), *STRICT, *case[1], "-fsyntax-only", mission_in_c / "iris_flight.c"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert (done.returncode, "compile without -ffast-math" in done.stderr) == (1, True)


@pytest.mark.targets
def test_a_compiler_for_arm_that_fuses_by_default_makes_the_bits_of_a_native_flight(mission_in_c):
    need("aarch64-linux-gnu-gcc", "qemu-aarch64")
    sources = [mission_in_c / "iris_flight.c", mission_in_c / "iris_flight_selftest.c"]
    for standard in ("-std=gnu17", "-std=c99"):
        command = ["aarch64-linux-gnu-gcc", standard, "-O2", "-static", *sources, "-lm", "-o", mission_in_c / "arm"]
        subprocess.run(command, check=True)
        done = subprocess.run([shutil.which("qemu-aarch64"), mission_in_c / "arm"], check=False, capture_output=True)
        assert done.returncode == 0, done.stdout
