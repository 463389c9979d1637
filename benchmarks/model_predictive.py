"""Time of a solve of the model predictive controller: `python benchmarks/model_predictive.py [--duration S]`.

13 states, 8 rotors, 20 nodes, in a flight of `iris`; beside it the time of PIQP alone in the same solves. Wall time.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from machine import describe, heading, number, table

import tandemlift as tl

FILE = Path(__file__).parents[1] / "examples" / "controllers" / "model_predictive.py"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--duration", type=float, default=20.0, help="of the flight [s]")
    options = parser.parse_args()
    controller = tl.load_controller(FILE)
    flight = tl.fly(tl.load_mission("iris", {"mission.duration": options.duration}, controller=controller))
    solves = 1e3 * np.array(sys.modules[controller.start.__module__].SOLVES)
    print(f"Measured on {heading(describe(('tandemlift', 'piqp', 'numpy')))}\n")
    rows = [
        [name, *(number(value) for value in np.percentile(times, (50, 99)))]
        for name, times in zip(("a solve", "PIQP alone in it"), solves.T, strict=True)
    ]
    print(table([f"{len(solves)} solves", "median, ms", "99 %, ms"], rows))
    errors = [number(1e3 * error) for error in flight.metrics()["position_rmse_m"]]
    print(
        f"\nRMS of the position error along x, y, z: {', '.join(errors)} mm; it ended {flight.ending or 'in the air'}."
    )


if __name__ == "__main__":
    main()
