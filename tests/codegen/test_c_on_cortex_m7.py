"""The pilot of missions in C on a Cortex-M7 under QEMU: the same bits, and what compile.md says of a sample."""

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from c_flights import unfused
from repository import ROOT

import tandemlift as tl
from tandemlift.codegen.c.expressions import number
from tandemlift.codegen.c_package import code_texts, written
from tandemlift.core.types import leaves
from tandemlift.simulation.pilot_api import INPUT
from tools import need

HERE = Path(__file__).parent / "cortex_m7"
MACHINE = ("-mcpu=cortex-m7", "-mthumb", "-mfpu=fpv5-d16", "-mfloat-abi=hard")
OPTIONS = ("-std=c99", "-O2", "-ffp-contract=off", "-ffunction-sections", "-Wall", "-Wextra", "-pedantic")
EMULATOR = ("qemu-system-arm", "-M", "mps2-an500", "-nographic", "-icount", "shift=0")
SEMIHOSTING = ("-semihosting-config", "enable=on,target=native")


def closed_loop(mission, count):
    """(Memory, input, thrusts) of samples all over a flight that a pilot outside flies."""
    pilot, sim = tl.Pilot(mission), tl.Simulation(mission)
    flown = tl.fly(mission.model_copy(update={"mission": mission.mission.model_copy(update={"log_interval": sim.dt})}))
    pushes, steps, found = flown["push_force"], mission.mission.steps, []
    kept = set(np.linspace(0, steps - 1, count).astype(int))
    for k in range(steps):
        given = np.zeros(leaves(INPUT))
        given[:13], given[13:16], given[22] = sim.state, pushes[k], 1.0
        memory = pilot.memory
        thrusts = pilot.step(given[:16].copy()).copy()
        if k in kept:
            found.append((memory, given, thrusts))
        sim.step(thrusts=thrusts)
    return found


def vectors_header(vectors, real):
    """The samples as C."""
    columns = [f"    {real} {n}[{len(v)}];" for n, v in zip(("memory", "input", "thrusts"), vectors[0], strict=True)]
    rows = [
        "{" + ", ".join("{" + ", ".join(number(float(x), real) for x in part) + "}" for part in v) + "},"
        for v in vectors
    ]
    lines = [f"typedef {real} number;", f"#define VECTOR_COUNT {len(vectors)}", "static const struct {", *columns]
    return "\n".join([*lines, "} VECTOR[VECTOR_COUNT] = {", *rows, "};", ""])


def measured(mission, vectors, folder, single=False):
    """What the program prints, by name, and the bytes of flash that the pilot takes by itself and with `math.h`."""
    files = written(code_texts(mission, single), folder)
    name = next(f.name for f in files if f.name.endswith("_pilot.c")).removesuffix("_pilot.c")
    (folder / "vectors.h").write_text(vectors_header(vectors, "float" if single else "double"))
    text = (HERE / "measure.c").read_text().replace("mission_", f"{name}_").replace("MISSION_", f"{name.upper()}_")
    (folder / "measure.c").write_text(text)
    objects = []
    for source in (folder / f"{name}_pilot.c", folder / "measure.c", HERE / "start.c"):
        objects.append(folder / f"{source.stem}.o")
        includes = (f"-I{folder}", f"-I{HERE}")
        options = (*MACHINE, *OPTIONS, *includes, "-c", str(source), "-o", str(objects[-1]))
        subprocess.run(["arm-none-eabi-gcc", *options], check=True)
    program = folder / "measure.elf"
    link = (
        "-nostartfiles",
        f"-T{HERE / 'mps2.ld'}",
        "-Wl,--gc-sections",
        "-o",
        str(program),
        *map(str, objects),
        "-lm",
    )
    subprocess.run(["arm-none-eabi-gcc", *MACHINE, *link], check=True)
    run = subprocess.run(
        [*EMULATOR, *SEMIHOSTING, "-kernel", str(program)], capture_output=True, text=True, timeout=300
    )
    lines = [line.split() for line in (run.stdout + run.stderr).splitlines() if len(line.split()) == 2]
    size = subprocess.run(["arm-none-eabi-size", str(objects[0])], capture_output=True, text=True, check=True).stdout
    code, data, *_ = size.splitlines()[1].split()
    return {key: int(value) for key, value in lines} | {"flash": int(code) + int(data)}


@pytest.mark.targets
@pytest.mark.parametrize("name", ["paper", "iris"])
def test_a_sample_has_the_bits_of_the_native_pilot_and_costs_what_the_guide_says(name, tmp_path):
    need("arm-none-eabi-gcc", "qemu-system-arm")
    mission = unfused(tl.load_mission(name))
    vectors = closed_loop(mission, 40)
    span = np.ptp([thrusts for *_, thrusts in vectors])
    guide = (ROOT / "docs" / "how-to" / "compile.md").read_text("utf-8")
    version = subprocess.run(["arm-none-eabi-gcc", "-dumpfullversion"], check=True, capture_output=True, text=True)
    assert f"(arm-none-eabi-gcc {version.stdout.strip()})" in guide  # another compiler takes another stack
    for precision in ("double", "single"):
        found = measured(mission, vectors, tmp_path / precision, precision == "single")
        if precision == "double":
            assert found["wrong"] == 0
        assert found["farthest_uN"] <= 1e3 * span
        wanted = [found[key] for key in ("mean", "most", "stack", "flash")]
        row = re.search(rf"^\| `{name}`, {precision} \|(.*)\|$", guide, re.MULTILINE)[1]
        said = [int(x.replace(",", "")) for x in re.findall(r"[\d,]+", row)]
        assert said[2:] == wanted[2:]
        assert said[:2] == pytest.approx(wanted[:2], rel=0.01)
