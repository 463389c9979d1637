"""Speed of WebAssembly modules beside native code: `python benchmarks/wasm.py`.

Prints Markdown: nanoseconds a step of one flight, native with `mission.fma = false`, in Node.js and in Debian's
Chromium, turn by turn; ratios are medians over the turns. Optimised code throughout.
"""

from __future__ import annotations

import argparse
import base64
import json
import subprocess
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

from machine import describe, heading, number, table
from playwright.sync_api import Page, sync_playwright

import tandemlift as tl
from tandemlift.codegen.mission_module import module_of
from tandemlift.simulation.plan import FlightPlan

HERE = Path(__file__).resolve().parent
SCRIPT = (HERE.parent / "examples" / "fly_module.js").read_text() + (HERE / "wasm_steps.js").read_text()
MISSIONS = ("paper", "iris", "zigzag")
TURNS, REPEAT = 5, 3
CHROMIUM = "/usr/bin/chromium"


def native(mission: tl.Mission) -> float:
    """Nanoseconds a step, natively."""
    times = []
    for _ in range(REPEAT):
        metrics = tl.fly(mission).metrics()
        times.append(metrics["wall_s"] / metrics["steps"] * 1e9)
    return median(times)


def optimised(mission: tl.Mission) -> None:
    """Wait until a mission's optimised code flies."""
    code = FlightPlan(mission).loop_code.loop(1)
    code.optimise()
    while not code.is_best:
        time.sleep(0.05)


def in_node(job: dict[str, Any]) -> float:
    """Nanoseconds a step in Node.js."""
    text = f"{SCRIPT}\nconsole.log(stepTime({json.dumps(job)}));"
    done = subprocess.run(["node", "--input-type=module", "-"], input=text, capture_output=True, text=True, check=True)
    return float(done.stdout)


def in_browser(page: Page) -> Callable[[dict[str, Any]], float]:
    """Nanoseconds a step in a page of a browser."""
    page.add_script_tag(content=SCRIPT)
    return lambda job: float(page.evaluate("job => stepTime(job)", job))


def measure(name: str, engines: dict[str, Callable[[dict[str, Any]], float]]) -> list[str]:
    """A row of the table."""
    mission = tl.load_mission(name, {"mission.fma": False, "mission.duration": 20.0})
    module = module_of(mission, "wasm32")
    job = {"base64": base64.b64encode(module.code).decode(), "manifest": module.manifest, "repeat": REPEAT}
    optimised(mission)
    turns = [[native(mission), *[engine(job) for engine in engines.values()]] for _ in range(TURNS)]
    ratios = [median(turn[i] / turn[0] for turn in turns) for i in range(1, len(engines) + 1)]
    times = [median(column) for column in zip(*turns, strict=True)]
    return [f"`{name}`", *map(number, times), *[f"{ratio:.2f}" for ratio in ratios]]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("missions", nargs="*", default=MISSIONS)
    names = parser.parse_args().missions
    warnings.simplefilter("ignore")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        engines = {"Node.js": in_node, "Chromium": in_browser(browser.new_page())}
        node = subprocess.run(["node", "--version"], capture_output=True, text=True, check=True).stdout.strip()
        about = describe(("tandemlift", "llvmlite"))
        about["versions"] |= {"Node.js": node, "Chromium": browser.version}
        print(f"{heading(about)}\n")
        columns = ["mission", "native, ns a step", *engines, *[f"{name} / native" for name in engines]]
        print(table(columns, [measure(name, engines) for name in names]))
        browser.close()


if __name__ == "__main__":
    main()
