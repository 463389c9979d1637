"""The census of a study counts flights by outcome and by the kinds of their findings."""

from validation.census import Census
from validation.scenarios import Bench

import tandemlift as tl


def test_flights_are_counted_once_each_whatever_their_findings():
    census = Census()
    found = [[1.0, "off-track", "far"], [2.0, "off-track", "tilted"], [3.0, "saturated", "long"]]
    census.add([{"outcome": "landed", "findings": []}, {"outcome": "crashed", "findings": found}])
    assert census.found == 1
    rows = dict(line.strip("| ").split(" | ") for line in census.table().splitlines()[2:])
    assert (rows["landed"], rows["crashed"], rows["flying"], rows["with findings"]) == ("1", "1", "0", "1")
    assert (rows["with finding: off-track"], rows["with finding: saturated"]) == ("1", "1")
    assert "with finding: touched" not in rows


def test_a_bench_counts_what_it_flies():
    census = Census()
    missions = [tl.load_mission("hover", {"mission.duration": t, "phases.lift_start": 2.0}) for t in (1.0, 1.5)]
    Bench(census=census).fly(missions)
    Bench(census=census).metrics(missions[:1])
    assert dict(census.outcomes) == {"flying": 3}
    Bench().fly(missions[:1])  # which nobody counts
    assert sum(census.outcomes.values()) == 3
