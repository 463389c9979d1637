"""Time to tune `flight-ready` from the paper's gains: `python benchmarks/tuning.py [--budget N] [--seed S]`.

The search begins with the gains of the paper, with which no flight of benchmarks/flight-ready-draws.toml ends well.
Every candidate that was the best in its time then flies 200 holdout draws. Printed is when the first of them was found
that is there as good as the gains of today, in seconds of the clock, which depend on what else runs, and of processors.
"""

from __future__ import annotations

import argparse
import time
import tomllib
import warnings
from pathlib import Path
from typing import Any

from machine import describe, heading

import tandemlift as tl
from tandemlift.analysis.studies.tuning.draws import MissionSource
from tandemlift.missions import tables_of

DRAWS = Path(__file__).parent / "flight-ready-draws.toml"
METRIC, HOLDOUT = "position_rmse_after_10s_m", 200
FEW = 8  # draws of the search: half of those in the file, because here time counts
TARGET = [0.08, 0.05, 0.01]  # m: about what today's gains reach, because with the first ones there is nothing to reach
GAINS = ("xi", "eta", "lambda_1", "lambda_2")


def main() -> None:
    parser = argparse.ArgumentParser(description="Time to tune flight-ready from the paper's gains.")
    parser.add_argument("--budget", type=int, default=1440, help="candidates to try (default: 1440)")
    parser.add_argument("--seed", type=int, default=0, help="of the search (default: 0)")
    given = parser.parse_args()
    about = describe(("tandemlift", "numpy", "cma"))
    warnings.simplefilter("ignore", tl.FlightWarning)
    paper = tables_of(tl.load_mission("paper"))["controller"]["gains"]
    changes = {f"controller.gains.{gain}": paper[gain] for gain in GAINS}
    times, began = [(0, 0.0, time.process_time())], time.perf_counter()

    def watch(tried: int, budget: int, lowest: Any) -> None:
        times.append((tried, time.perf_counter() - began, time.process_time()))

    tables = tomllib.loads(DRAWS.read_text("utf-8"))
    tables["study"]["draws"] = FEW
    search: dict[str, Any] = {"draws": tables, "budget": given.budget, "seed": given.seed}
    found = tl.tune("flight-ready", {METRIC: TARGET}, changes=changes, holdout=HOLDOUT, progress=watch, **search)
    task = found.task.for_draws(found.holdout)
    (today,) = task._replace(source=MissionSource("flight-ready", {})).fly([{}], found.holdout)
    limit = task.cost(today)
    print(heading(about))
    print(f"today's gains on {len(found.holdout)} holdout draws: {limit.bad} bad, cost {limit.ratio:.4g}")
    paper_cost, new = found.evidence.costs
    print(f"the paper's: {paper_cost.bad} bad; those of the whole search: {new.bad} bad, cost {new.ratio:.4g}")
    for number, values in found.records:
        (trial,) = task.fly([task.changes(values)], found.holdout)
        cost = task.cost(trial)
        if cost.rank <= limit.rank:
            _, clock, processors = next(entry for entry in times if entry[0] >= number)
            spent = processors - times[0][2]
            print(f"as good: candidate {number}, cost {cost.ratio:.4g}, {clock:.0f} s ({spent:.0f} s of processors)")
            break
    else:
        print("as good: none of the candidates")
    print(f"whole search: {times[-1][1]:.0f} s ({times[-1][2] - times[0][2]:.0f} s of processors)")


if __name__ == "__main__":
    main()
