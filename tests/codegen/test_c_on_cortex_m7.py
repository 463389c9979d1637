"""The pilot of `iris` in C on a Cortex-M7 under QEMU: the same bits, and what flight-computer.md says of a sample."""

import re
import subprocess

import numpy as np
import pytest
from c_flights import unfused
from cortex_m7 import closed_loop, measured
from repository import ROOT

import tandemlift as tl
from tools import need


@pytest.mark.targets
@pytest.mark.parametrize("name", ["paper", "iris"])
def test_a_sample_has_the_bits_of_the_native_pilot_and_costs_what_the_guide_says(name, tmp_path):
    need("arm-none-eabi-gcc", "qemu-system-arm")
    mission = unfused(tl.load_mission(name))
    vectors = closed_loop(mission, 40)
    span = np.ptp([thrusts for *_, thrusts in vectors])
    guide = (ROOT / "docs" / "how-to" / "flight-computer.md").read_text("utf-8")
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
